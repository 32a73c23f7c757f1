//! Whatever an adapter sends: both decoders, the words for traffic, and both ends of SDO take it without harm.
#![no_main]

use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_mcp_wire::canopen::describe_frame;
use brushwork_canopen::sdo::{Abort, Dictionary, Server, Transfer};
use libfuzzer_sys::fuzz_target;

struct Objects(Vec<u8>);

impl Dictionary for Objects {
    fn read(&mut self, _index: u16, _subindex: u8) -> Result<Vec<u8>, Abort> {
        Ok(self.0.clone())
    }

    fn write(&mut self, _index: u16, _subindex: u8, value: &[u8]) -> Result<(), Abort> {
        self.0 = value.to_vec();
        Ok(())
    }
}

fuzz_target!(|bytes: &[u8]| {
    for form in Form::ALL {
        let (mut server, mut objects) = (Server::default(), Objects(vec![7; 30]));
        let mut client = Transfer::upload(0x2015, 1);
        for frame in Decoder::new(form).feed_all(bytes) {
            let _ = describe_frame(&frame);
            let _ = server.take(frame.bytes(), &mut objects);
            let _ = client.take(frame.bytes());
        }
    }
});

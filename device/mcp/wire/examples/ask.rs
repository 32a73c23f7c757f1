//! Asks a RoboClaw or MCP for its version, its battery and its encoders, byte by byte. It only reads, so nothing moves.
//!
//! `cargo run -p brushwork-mcp-wire --example ask` talks to a made-up controller. With a port it talks to a real one:
//!
//! ```text
//! stty -F /dev/ttyACM0 raw -echo min 0 time 10
//! cargo run -p brushwork-mcp-wire --example ask -- /dev/ttyACM0
//! ```
//!
//! `min 0 time 10` lets a read give up after a second, since a controller answers what it does not understand with silence.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_mcp_wire::packet_serial::{
    Address, Generation, ReplyProgress, Request, describe_reply, encode_reply_named, number, parse_reply,
};
use brushwork_values::hex;
use brushwork_values::{Value, Values};
use std::error::Error;
use std::fs::OpenOptions;
use std::io::{self, Cursor, Read, Write};

/// Reads whose layout is the same in every generation of firmware.
const READS: [u8; 3] = [number::READ_VERSION, number::READ_MAIN_BATTERY, number::READ_ENCODERS];

/// Any will do for those.
const GENERATION: Generation = Generation::Gen1;

fn main() -> Result<(), Box<dyn Error>> {
    for command in READS {
        let request = Request::new(Address::DEFAULT, command, &[]);
        let values = match std::env::args().nth(1) {
            Some(path) => ask(&mut OpenOptions::new().read(true).write(true).open(path)?, &request)?,
            None => ask(&mut MadeUp::for_request(&request)?, &request)?,
        };
        println!("{}", describe_reply(&request, &values, GENERATION));
    }
    Ok(())
}

/// Sends a request and waits for its reply.
fn ask(port: &mut (impl Read + Write), request: &Request) -> Result<Values, Box<dyn Error>> {
    let bytes = request.encode(GENERATION)?;
    println!("> {}", hex(&bytes));
    port.write_all(&bytes)?;
    let mut heard = Vec::new();
    loop {
        match parse_reply(request, GENERATION, &heard) {
            ReplyProgress::Done { values, .. } => {
                println!("< {}", hex(&heard));
                return Ok(values);
            }
            ReplyProgress::NeedMore { at_least } => {
                let mut more = vec![0; at_least.saturating_sub(heard.len()).max(1)];
                let count = port.read(&mut more)?;
                if count == 0 {
                    return Err(format!("no whole reply to {}: {}", hex(&bytes), hex(&heard)).into());
                }
                heard.extend_from_slice(&more[..count]);
            }
            other => return Err(format!("not a reply to {}: {other:?}", hex(&bytes)).into()),
        }
    }
}

/// A controller that knows one reply by heart.
struct MadeUp {
    reply: Cursor<Vec<u8>>,
}

impl MadeUp {
    fn for_request(request: &Request) -> Result<Self, Box<dyn Error>> {
        let value_of = |name: &str| match name {
            "version" => Some(Value::Text("MCP266 2x60A v1.0.0".to_owned())),
            "main_battery" => Some(Value::Int(243)),
            "encoder_m1" => Some(Value::Int(1200)),
            "encoder_m2" => Some(Value::Int(-40)),
            _ => None,
        };
        Ok(Self { reply: Cursor::new(encode_reply_named(request, GENERATION, value_of)?) })
    }
}

impl Read for MadeUp {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.reply.read(into)
    }
}

impl Write for MadeUp {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

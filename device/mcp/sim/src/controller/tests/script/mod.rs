//! Scripts inside the simulated controller, in virtual time and over wire bytes.

mod buses;
mod debugging;
mod life;
mod motors;
mod registers;
mod streams;

use super::support::Bench;
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_plant::machine::{Machine, StreamIndex};
use std::time::Duration;

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

/// Stream type "MCL" for the USB port; from then on it takes no packets.
const USB_TO_SCRIPTS: [i64; 4] = [0, 0, 115_200, 1000];

/// Gives the USB port to scripts, and starts one by command 248 on RS-232.
fn run(bench: &mut Bench, text: &str) {
    bench.install(text);
    // The encoders' first readings are zeroed in the first tick.
    bench.wait(ms(10));
    bench.ask(commands::SET_STREAM, &USB_TO_SCRIPTS);
    bench.bus.receive(StreamIndex::Uart0, &start_bytes());
    bench.wait(Duration::from_micros(60));
    assert_eq!(bench.bus.take_output(StreamIndex::Uart0), Some(vec![0xFF]));
}

/// The same on the default controller.
fn running(text: &str) -> Bench {
    let mut bench = Bench::new(Generation::Gen2);
    run(&mut bench, text);
    bench
}

/// Command 248 as bytes: address, command, CRC.
fn start_bytes() -> Vec<u8> {
    let mut bytes = vec![0x80, 248];
    bytes.extend(brushwork_mcp_wire::crc::crc16_xmodem(&bytes).to_be_bytes());
    bytes
}

//! What bytes on the line ask for: `cargo run -p brushwork-protocol --example decode -- 80 20 20 00 5D 18`.
//!
//! Takes the bytes that a client sent, as hexadecimal pairs with a comma for each pause, and tells the requests in them, first as packet
//! serial in the layouts of generation 1, then as frames of a Motion Mind. Without arguments it decodes a few that it brings along.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_protocol::motion_mind::{FrameEvent, FrameReader, describe_command};
use brushwork_protocol::packet_serial::{Generation, RequestFramer, describe_event, hex};
use std::error::Error;
use std::num::ParseIntError;
use std::time::Duration;

/// A quarter duty on motor 1 and a read of the version, noise, and a Motion Mind's read of register 0.
const BROUGHT_ALONG: &str = "80 20 20 00 5D 18 80 15, 42, 1D 01 00 1E";

/// A pause that ends a packet in either protocol, whole or not.
const PAUSE: Duration = Duration::from_millis(20);

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let text = if given.is_empty() { BROUGHT_ALONG.to_owned() } else { given.join(" ") };
    let bytes = timed_bytes(&text)?;
    let end = bytes.last().map_or(PAUSE, |(_, at)| *at + PAUSE);

    println!("As packet serial:");
    let mut framer = RequestFramer::new(Generation::Gen1);
    let found: Vec<_> = bytes.iter().filter_map(|(byte, at)| framer.feed(*byte, *at)).collect();
    for event in found.into_iter().chain(framer.silence(end)) {
        println!("  {}", describe_event(&event, Generation::Gen1));
    }

    println!("As frames of a Motion Mind:");
    let mut reader = FrameReader::new();
    let found: Vec<_> = bytes.iter().filter_map(|(byte, at)| reader.feed(*byte, *at)).collect();
    for event in found.into_iter().chain(reader.silent_until(end)) {
        match event {
            FrameEvent::Command(address, command) => println!("  {}", describe_command(address, &command)),
            FrameEvent::Dropped(bytes) => println!("  dropped {}", hex(&bytes)),
        }
    }
    Ok(())
}

/// Bytes with the time that each came at.
fn timed_bytes(text: &str) -> Result<Vec<(u8, Duration)>, ParseIntError> {
    let mut bytes = Vec::new();
    let mut at = Duration::ZERO;
    for burst in text.split(',') {
        for pair in burst.split_whitespace() {
            bytes.push((u8::from_str_radix(pair, 16)?, at));
        }
        at += PAUSE;
    }
    Ok(bytes)
}

//! What bytes on the line ask for: `cargo run -p brushwork-mcp-wire --example mcp_decode -- 80 20 20 00 5D 18`.
//!
//! Takes the bytes that a client sent, as hexadecimal pairs with a comma for each pause, and tells the requests of packet
//! serial in them, in the layouts of generation 1. Without arguments it decodes a few that it brings along.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_mcp_wire::packet_serial::{Generation, RequestFramer, describe_event};
use std::error::Error;
use std::num::ParseIntError;
use std::time::Duration;

/// A quarter duty on motor 1 and a read of the version, and noise.
const BROUGHT_ALONG: &str = "80 20 20 00 5D 18 80 15, 42";

/// A pause that ends a packet, whole or not.
const PAUSE: Duration = Duration::from_millis(20);

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let text = if given.is_empty() { BROUGHT_ALONG.to_owned() } else { given.join(" ") };
    let bytes = timed_bytes(&text)?;
    let end = bytes.last().map_or(PAUSE, |(_, at)| *at + PAUSE);

    let mut framer = RequestFramer::new(Generation::Gen1);
    let found: Vec<_> = bytes.iter().filter_map(|(byte, at)| framer.feed(*byte, *at)).collect();
    for event in found.into_iter().chain(framer.silence(end)) {
        println!("{}", describe_event(&event, Generation::Gen1));
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

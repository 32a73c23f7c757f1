//! What bytes on the line ask for: `cargo run -p brushwork-motion-mind-wire --example motion_mind_decode -- 1D 01 00 1E`.
//!
//! Takes the bytes that a client sent, as hexadecimal pairs with a comma for each pause, and tells the commands in
//! them. Without arguments it decodes one that it brings along, with noise before it.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use brushwork_motion_mind_wire::{FrameEvent, FrameReader, describe_command};
use std::error::Error;
use std::num::ParseIntError;
use std::time::Duration;

/// Noise, and a read of register 0.
const BROUGHT_ALONG: &str = "42, 1D 01 00 1E";

/// A pause that ends a command, whole or not.
const PAUSE: Duration = Duration::from_millis(20);

fn main() -> Result<(), Box<dyn Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let text = if given.is_empty() { BROUGHT_ALONG.to_owned() } else { given.join(" ") };
    let bytes = timed_bytes(&text)?;
    let end = bytes.last().map_or(PAUSE, |(_, at)| *at + PAUSE);

    let mut reader = FrameReader::new();
    let found: Vec<_> = bytes.iter().filter_map(|(byte, at)| reader.feed(*byte, *at)).collect();
    for event in found.into_iter().chain(reader.silent_until(end)) {
        match event {
            FrameEvent::Command(address, command) => println!("{}", describe_command(address, &command)),
            FrameEvent::Dropped(bytes) => println!(
                "dropped {}",
                bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
            ),
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

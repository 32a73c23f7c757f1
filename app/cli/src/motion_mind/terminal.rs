//! Commands of a Motion Mind as they are typed in a terminal.
//!
//! A unit in text takes lines; one in binary takes frames in hexadecimal, whose checksum is added.

use std::time::Duration;

use brushwork_link::device::Described;
use brushwork_motion_mind_client::{MotionMindFacts, describe_received, describe_sent};
use brushwork_motion_mind_wire::{
    Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Protocol, checksum,
};
use brushwork_values::hex;

use crate::family::Terminal;

impl Terminal for MotionMindFacts {
    fn set_up(&self) -> String {
        format!("{}, {}", self.mode, self.protocol)
    }

    fn bytes_of(&self, line: &str) -> Result<Vec<u8>, String> {
        bytes_of(line, self.protocol)
    }

    fn stops_the_motor(&self, bytes: &[u8]) -> bool {
        stops_the_motor(bytes, self.protocol)
    }

    fn shown(&self, bytes: &[u8]) -> String {
        match self.protocol {
            Protocol::Binary => hex(bytes),
            Protocol::Text => String::from_utf8_lossy(bytes).trim_end().replace("\r\n", " | "),
        }
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes, self.protocol)
    }

    fn describe_received(&self, sent: &[u8], reply: &[u8]) -> Described {
        describe_received(sent, reply, self.protocol)
    }
}

/// Whether the bytes are a command that writes EEPROM or starts the unit anew.
fn stops_the_motor(bytes: &[u8], protocol: Protocol) -> bool {
    let commands = commands_of(bytes, protocol);
    commands.iter().any(|command| command.effect() == Effect::Stopping)
}

fn commands_of(bytes: &[u8], protocol: Protocol) -> Vec<Command> {
    let (mut frames, mut lines) = (FrameReader::new(), LineReader::new());
    let read = |byte: &u8| match protocol {
        Protocol::Binary => match frames.feed(*byte, Duration::ZERO) {
            Some(FrameEvent::Command(_, command)) => Some(command),
            _ => None,
        },
        Protocol::Text => match lines.feed(*byte) {
            Some(LineEvent::Command(_, command)) => Some(command),
            _ => None,
        },
    };
    bytes.iter().filter_map(read).collect()
}

/// The bytes of a typed command: a line gets its end, a frame its checksum.
fn bytes_of(line: &str, protocol: Protocol) -> Result<Vec<u8>, String> {
    match protocol {
        Protocol::Text => Ok(format!("{}\r\n", line.trim()).into_bytes()),
        Protocol::Binary => {
            let parse = |byte: &str| u8::from_str_radix(byte.trim_start_matches("0x"), 16).ok();
            let bytes: Option<Vec<u8>> =
                line.split([' ', ',', '\t']).filter(|part| !part.is_empty()).map(parse).collect();
            let mut bytes = bytes.ok_or_else(|| {
                format!("Could not read \"{line}\": give the bytes of a frame in hexadecimal, for example 1D 01 04.")
            })?;
            bytes.push(checksum(&bytes));
            Ok(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gets_its_end_and_a_frame_its_checksum() {
        assert_eq!(bytes_of(" R01 04 ", Protocol::Text).unwrap(), b"R01 04\r\n");
        // READ REGISTER 1 of unit 1: 1D 01 01, sum 1F.
        assert_eq!(bytes_of("1d 01,0x01", Protocol::Binary).unwrap(), [0x1D, 0x01, 0x01, 0x1F]);
        assert!(bytes_of("1D 01 R", Protocol::Binary).unwrap_err().contains("hexadecimal"));
    }
}

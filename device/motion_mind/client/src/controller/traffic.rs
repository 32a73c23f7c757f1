//! What bytes on the wire mean, for the traffic view and the terminal.

use crate::controller::registers::all_returns;
use brushwork_link::device::Described;
use brushwork_motion_mind_wire::{
    Address, Command, FrameEvent, FrameReader, LineEvent, LineReader, Part, Progress, Protocol, Returns,
    describe_command, describe_reply, parse_frame_reply, parse_line_reply,
};
use brushwork_values::hex;
use std::time::Duration;

/// The commands that a write holds, in words.
#[must_use]
pub fn describe_sent(bytes: &[u8], protocol: Protocol) -> Described {
    let (commands, whole) = commands_in(bytes, protocol);
    let reported: Vec<_> =
        commands.iter().map(|(address, command)| describe_command(*address, command)).collect();
    let text = if reported.is_empty() { plain(bytes, protocol) } else { reported.join("; ") };
    Described { text, sound: whole && !commands.is_empty() }
}

/// What came after a write, in words: read as the reply to its last command, else as it stands.
#[must_use]
pub fn describe_received(sent: &[u8], reply: &[u8], protocol: Protocol) -> Described {
    let Some((address, command)) = commands_in(sent, protocol).0.pop() else {
        return Described { text: plain(reply, protocol), sound: false };
    };
    let parse = |returns: Returns| match protocol {
        Protocol::Binary => parse_frame_reply(address, &command, returns, reply),
        Protocol::Text => parse_line_reply(&command, returns, reply),
    };
    let known = all_returns().into_iter();
    let mut whole = known.map(parse).filter_map(|progress| match progress {
        Progress::Done { reply: said, used } if used == reply.len() => Some(said),
        Progress::Incomplete | Progress::Done { .. } | Progress::Bad(_) => None,
    });
    match whole.next() {
        Some(said) => Described { text: describe_reply(&said), sound: true },
        None => {
            let why = match parse(Returns::default()) {
                Progress::Bad(bad) => format!("{bad}: "),
                Progress::Incomplete => "part of a reply: ".to_owned(),
                Progress::Done { .. } => "a reply and more: ".to_owned(),
            };
            Described { text: why + &plain(reply, protocol), sound: false }
        }
    }
}

/// The commands in bytes that were written together, and whether the bytes hold nothing else.
fn commands_in(bytes: &[u8], protocol: Protocol) -> (Vec<(Address, Command)>, bool) {
    let mut commands = Vec::new();
    let mut whole = true;
    match protocol {
        Protocol::Binary => {
            let mut reader = FrameReader::new();
            for byte in bytes {
                match reader.feed(*byte, Duration::ZERO) {
                    Some(FrameEvent::Command(address, command)) => commands.push((address, command)),
                    Some(FrameEvent::Dropped(_)) => whole = false,
                    None => {}
                }
            }
            whole &= reader.silent_until(Duration::from_secs(1)).is_none();
        }
        Protocol::Text => {
            let mut reader = LineReader::new();
            for byte in bytes {
                match reader.feed(*byte) {
                    Some(LineEvent::Command(address, command)) => commands.push((address, command)),
                    Some(_) => whole = false,
                    None => {}
                }
            }
            whole &= bytes.ends_with(b"\n");
        }
    }
    // A read of what the unit does not have is answered by nothing that could be read.
    commands
        .retain(|(_, command)| !matches!(command, Command::ReadText(Part::Register(index)) if *index > 31));
    (commands, whole)
}

fn plain(bytes: &[u8], protocol: Protocol) -> String {
    match protocol {
        Protocol::Binary => hex(bytes),
        Protocol::Text => bytes.escape_ascii().to_string(),
    }
}

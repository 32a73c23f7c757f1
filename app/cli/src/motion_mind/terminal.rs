//! `brushwork terminal`: commands of a Motion Mind as they are typed, with what comes back and what it means.
//!
//! A unit in text takes lines; one in binary takes frames in hexadecimal, whose checksum is added. Nothing that moves the motor
//! goes out: that takes arming, which a terminal does not do.

use crate::messages::CliLinkMessage;
use std::time::{Duration, Instant};

use brushwork_link::device::{Event, PollRate, Request};
use brushwork_motion_mind_client::{MotionMindFacts, describe_received, describe_sent};
use brushwork_motion_mind_wire::{
    Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Protocol, checksum,
};
use brushwork_values::hex;
use clap::Args;
use serde_json::json;

use crate::client::ask;
use crate::interrupt::meanwhile;
use crate::{Client, ConnectArgs, Exit, Interrupt, Output, say};

/// How long a reply may take.
const REPLY_LIMIT: Duration = Duration::from_secs(10);

/// Arguments of `brushwork terminal`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork terminal --connect /dev/ttyUSB0,family=motion-mind 'R01 04' 'W01 04 5000'\n  \
    brushwork terminal --connect sim:motion-mind-3 '1A 01 01 00 01 00'\n\n\
    Without commands each line of standard input is one. A unit in ASCII takes lines, one in binary takes the bytes of a\n\
    frame in hexadecimal without their checksum. Commands that move the motor are refused; use `brushwork drive`.")]
pub struct TerminalArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// What to send.
    #[arg(value_name = "COMMAND")]
    pub commands: Vec<String>,
    /// Print each exchange as a JSON object a line.
    #[arg(long)]
    pub json: bool,
}

/// Sends each command that is given, or each line of standard input.
pub fn run(args: &TerminalArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::Off, interrupt)?;
    let Some(facts) = MotionMindFacts::of(&client.identity) else {
        return Err(Exit::Refused.saying(CliLinkMessage::OtherFamily {
            title: client.identity.title().to_owned(),
            family: "Motion Mind",
        }));
    };
    say(CliLinkMessage::TerminalOf {
        title: client.identity.title().to_owned(),
        unit: client.identity.place(),
        port: client.identity.port.clone(),
        mode: facts.mode.to_string(),
        protocol: facts.protocol.to_string(),
    });
    let mut given = args.commands.iter().cloned();
    let mut failed = false;
    for id in 1.. {
        let line = if args.commands.is_empty() { typed(&client, interrupt)? } else { given.next() };
        let Some(line) = line else { break };
        failed |= !exchange(&line, id, facts, args, &client, out, interrupt)?;
    }
    Ok(if failed { Exit::Refused } else { Exit::Done })
}

/// The next line of standard input; `None` at its end.
fn typed(client: &Client, interrupt: &Interrupt) -> Result<Option<String>, Exit> {
    let read = || std::io::stdin().lines().next()?.ok();
    let breathe = || {
        if let Some(Event::Failure(failure)) = client.next_event(interrupt)? {
            say(failure.to_string());
        }
        Ok(())
    };
    Ok(meanwhile(read, &breathe)?.flatten())
}

/// Sends one command; whether it went out.
fn exchange(
    line: &str,
    id: u64,
    facts: MotionMindFacts,
    args: &TerminalArgs,
    client: &Client,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<bool, Exit> {
    if line.trim().is_empty() {
        return Ok(true);
    }
    let bytes = match bytes_of(line, facts.protocol) {
        Ok(bytes) => bytes,
        Err(sentence) => {
            say(sentence);
            return Ok(false);
        }
    };
    if stops_the_motor(&bytes, facts.protocol) {
        say(CliLinkMessage::TerminalStops);
    }
    ask(client.device(), Request::Raw { id, bytes: bytes.clone() })?;
    let deadline = Instant::now() + REPLY_LIMIT;
    while Instant::now() < deadline {
        match client.next_event(interrupt)? {
            Some(Event::RawReply { id: answered, result }) if answered == id => {
                return match result {
                    Ok(reply) => tell(&bytes, &reply, facts.protocol, args, out).map(|()| true),
                    Err(failure) => {
                        say(failure.to_string());
                        Ok(false)
                    }
                };
            }
            Some(Event::Failure(failure)) => say(failure.to_string()),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoAnswer))
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

fn tell(
    sent: &[u8],
    reply: &[u8],
    protocol: Protocol,
    args: &TerminalArgs,
    out: &mut Output,
) -> Result<(), Exit> {
    let asked = describe_sent(sent, protocol);
    let (shown, meaning) = if reply.is_empty() {
        (String::new(), "silence".to_owned())
    } else {
        (shown(reply, protocol), describe_received(sent, reply, protocol).text)
    };
    let printed = if args.json {
        out.json_line(&json!({
            "sent": hex(sent),
            "asked": asked.text,
            "received": hex(reply),
            "meaning": meaning,
        }))
    } else {
        out.line(format!("> {:<32}  {}", self::shown(sent, protocol), asked.text))
            .and_then(|()| out.line(format!("< {shown:<32}  {meaning}")))
    };
    printed.map_err(Exit::from)
}

fn shown(bytes: &[u8], protocol: Protocol) -> String {
    match protocol {
        Protocol::Binary => hex(bytes),
        Protocol::Text => String::from_utf8_lossy(bytes).trim_end().replace("\r\n", " | "),
    }
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

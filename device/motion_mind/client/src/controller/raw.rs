//! Bytes as a person typed them: one command, checked before it goes out.
//!
//! The self-test of the text protocol is never sent: a unit needs a power cycle after it. What is no command of the manual goes to
//! simulated units alone, but for a line that cannot be one, which a unit in text answers with BAD COMMAND.

use crate::controller::registers::all_returns;
use crate::controller::speaker::{GAP, Speaker};
use crate::messages::MotionMindCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing};
use brushwork_motion_mind_wire::{
    Address, Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Progress, Protocol, Returns,
    parse_frame_reply, parse_line_reply,
};
use std::time::Duration;

/// How long bytes that answer nothing known are listened to.
const LISTEN_FOR: Duration = Duration::from_millis(120);

/// What typed bytes are.
pub enum Typed {
    /// One command.
    Command(Address, Command),
    /// A line that is none.
    BadLine,
    /// Other bytes.
    Unknown,
}

/// Looks at bytes before they go out. Refuses what must not be sent at all.
pub fn look(bytes: &[u8], protocol: Protocol) -> Result<Typed, ExchangeError> {
    match protocol {
        Protocol::Binary => look_at_frame(bytes),
        Protocol::Text => look_at_line(bytes),
    }
}

fn look_at_frame(bytes: &[u8]) -> Result<Typed, ExchangeError> {
    let mut reader = FrameReader::new();
    let mut found: Vec<_> = bytes.iter().filter_map(|byte| reader.feed(*byte, Duration::ZERO)).collect();
    found.extend(reader.silent_until(Duration::from_secs(1)));
    match found.as_slice() {
        [FrameEvent::Command(address, command)] => Ok(Typed::Command(*address, *command)),
        [FrameEvent::Command(..), ..] => impossible(MotionMindCauseMessage::OneCommand),
        _ => Ok(Typed::Unknown),
    }
}

fn look_at_line(bytes: &[u8]) -> Result<Typed, ExchangeError> {
    if bytes.iter().any(|byte| byte.eq_ignore_ascii_case(&b'Z')) {
        return impossible(MotionMindCauseMessage::NeverZ);
    }
    if !bytes.ends_with(b"\r\n") || bytes.iter().filter(|byte| **byte == b'\n').count() > 1 {
        return impossible(MotionMindCauseMessage::OneLine);
    }
    let mut reader = LineReader::new();
    match bytes.iter().find_map(|byte| reader.feed(*byte)) {
        Some(LineEvent::Command(address, command)) => Ok(Typed::Command(address, command)),
        Some(LineEvent::SelfTest(_)) => impossible(MotionMindCauseMessage::NeverSelfTest),
        Some(LineEvent::NotUnderstood { .. }) | None => Ok(Typed::BadLine),
    }
}

/// Sends typed bytes and gives what came back, whatever it was.
pub fn send(
    speaker: Speaker,
    line: &mut Line<'_>,
    bytes: &[u8],
    typed: &Typed,
) -> Result<Vec<u8>, ExchangeError> {
    gate(line, typed)?;
    let mut heard = Vec::new();
    let (exchange, watch) = line.parts();
    exchange.wait(GAP, watch)?;
    if let Typed::Command(address, _) = typed
        && address.is_broadcast()
    {
        exchange.write_now(bytes)?;
        return Ok(heard);
    }
    let patience = match typed {
        Typed::Command(_, command) => speaker.work(command),
        Typed::BadLine | Typed::Unknown => LISTEN_FOR,
    };
    let outgoing = Outgoing { bytes, reply_length: 40, patience, retries: 0, once: true };
    let done = exchange.exchange(&outgoing, watch, &mut |bytes| {
        heard = bytes.to_vec();
        judge(speaker.protocol, typed, bytes)
    });
    match done {
        Ok(_) => Ok(heard),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        // Silence is an answer too: a frame for another unit, or none.
        Err(_) => Ok(heard),
    }
}

fn gate(line: &Line<'_>, typed: &Typed) -> Result<(), ExchangeError> {
    match typed {
        Typed::Command(_, command) if matches!(command.effect(), Effect::Motion | Effect::RelativeMotion) => {
            if !line.permit().motion {
                let command = "a command that moves the motor".to_owned();
                return Err(ExchangeError::NotArmed { command });
            }
            line.motion_begins();
            Ok(())
        }
        Typed::Unknown if !line.permit().guesses => Err(ExchangeError::Unproven {
            command: "these bytes".to_owned(),
            why: "they are no command of the manual".to_owned(),
        }),
        Typed::Command(..) | Typed::BadLine | Typed::Unknown => Ok(()),
    }
}

fn judge(protocol: Protocol, typed: &Typed, bytes: &[u8]) -> Judgement {
    match (protocol, typed) {
        (Protocol::Binary, Typed::Command(address, command)) => {
            let whole = all_returns().into_iter().any(|returns| {
                matches!(
                    parse_frame_reply(*address, command, returns, bytes),
                    Progress::Done { used, .. } if used == bytes.len()
                )
            });
            if whole { Judgement::Good(bytes.len()) } else { Judgement::More(1) }
        }
        (Protocol::Text, Typed::Command(_, command)) => {
            let known = parse_line_reply(command, Returns::default(), bytes);
            match known {
                Progress::Done { used, .. } => Judgement::Good(used),
                _ if bytes.ends_with(b"\n") && command.takes_returns() => Judgement::Good(bytes.len()),
                Progress::Incomplete | Progress::Bad(_) => Judgement::More(1),
            }
        }
        (Protocol::Text, Typed::BadLine) if bytes.ends_with(b"\n") => Judgement::Good(bytes.len()),
        _ => Judgement::More(1),
    }
}

fn impossible<T>(what: MotionMindCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}

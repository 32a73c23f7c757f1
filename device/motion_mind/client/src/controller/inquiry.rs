//! Questions to a firmware in bytes, for an examination: which may go out, and when their answer is whole.
//!
//! Reads may come several in a row, since whether they may is a question. Besides them a write to a register that only the unit changes goes out,
//! where its owner agreed to writes: the manual gives it no effect.

use crate::controller::speaker::{GAP, Speaker};
use crate::messages::MotionMindCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{Heard, Inquiry, Leave};
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing};
use brushwork_link::messages::CauseMessage;
use brushwork_motion_mind_wire::{
    Address, Command, Effect, FrameEvent, FrameReader, LineEvent, LineReader, Progress, Protocol,
    parse_frame_reply, parse_line_reply, register,
};
use std::time::Duration;

/// What a person could count as one question.
const MOST_COMMANDS: usize = 4;

/// Asks it.
pub fn inquire(speaker: Speaker, line: &mut Line<'_>, inquiry: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
    let commands = check(speaker, inquiry)?;
    let mut heard = Vec::new();
    let patience = commands.iter().map(|command| speaker.work(command)).sum::<Duration>();
    let outgoing =
        Outgoing { bytes: inquiry.bytes, reply_length: 1, patience, retries: inquiry.retries, once: false };
    let (exchange, watch) = line.parts();
    exchange.wait(GAP, watch)?;
    let span = exchange.exchange(&outgoing, watch, &mut |reply| {
        heard = reply.to_vec();
        if is_whole(speaker, &commands, reply) { Judgement::Good(reply.len()) } else { Judgement::More(1) }
    });
    match span {
        Ok(span) => Ok(Heard { bytes: heard, took: Some(span.replied_at.saturating_sub(span.requested_at)) }),
        Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
        Err(_) => Ok(Heard { bytes: heard, took: None }),
    }
}

/// The commands of a question, each for this unit and agreed to.
fn check(speaker: Speaker, inquiry: &Inquiry<'_>) -> Result<Vec<Command>, ExchangeError> {
    let commands = match speaker.protocol {
        Protocol::Binary => frames(inquiry.bytes),
        Protocol::Text => lines(inquiry.bytes),
    };
    if commands.is_empty() || commands.len() > MOST_COMMANDS {
        return Err(ExchangeError::impossible(MotionMindCauseMessage::OneCommand));
    }
    for (address, command) in &commands {
        let is_idle_write = matches!(*command, Command::Write { register: number, .. }
            if register(number).is_some_and(|row| !row.is_writable()));
        let is_agreed = command.effect() == Effect::Query || is_idle_write && inquiry.leave >= Leave::Write;
        let is_agreed = is_agreed && *address == speaker.address;
        if !is_agreed {
            return Err(ExchangeError::impossible(CauseMessage::NotAgreedTo));
        }
    }
    Ok(commands.into_iter().map(|(_, command)| command).collect())
}

/// The frames that a unit would take, if it did not wait for a pause behind each; nothing where something else is among them.
fn frames(bytes: &[u8]) -> Vec<(Address, Command)> {
    let mut reader = FrameReader::new();
    let mut events: Vec<_> = bytes.iter().filter_map(|byte| reader.feed(*byte, Duration::ZERO)).collect();
    events.extend(reader.silent_until(Duration::from_secs(1)));
    let command = |event| match event {
        FrameEvent::Command(address, command) => Some((address, command)),
        FrameEvent::Dropped(_) => None,
    };
    events.into_iter().map(command).collect::<Option<_>>().unwrap_or_default()
}

fn lines(bytes: &[u8]) -> Vec<(Address, Command)> {
    let mut reader = LineReader::new();
    let command = |event| match event {
        LineEvent::Command(address, command) => Some((address, command)),
        LineEvent::SelfTest(_) | LineEvent::NotUnderstood { .. } => None,
    };
    let events = bytes.iter().filter_map(|byte| reader.feed(*byte));
    events.map(command).collect::<Option<_>>().unwrap_or_default()
}

fn is_whole(speaker: Speaker, commands: &[Command], mut reply: &[u8]) -> bool {
    for command in commands {
        let returns = speaker.returns.unwrap_or_default();
        let progress = match speaker.protocol {
            Protocol::Binary => parse_frame_reply(speaker.address, command, returns, reply),
            Protocol::Text => parse_line_reply(command, returns, reply),
        };
        match progress {
            Progress::Done { used, .. } => reply = reply.get(used..).unwrap_or_default(),
            Progress::Incomplete | Progress::Bad(_) => return false,
        }
    }
    reply.is_empty()
}

//! One order to the host library and its answer, and who is there at all.

use crate::family::Half;
use crate::messages::MotorvatorCauseMessage;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing, Span};
use brushwork_motorvator_wire::host::{HostAnswer, HostOrder, VERSION, flags};
use brushwork_motorvator_wire::{LINE_END, PREFIX};
use std::time::Duration;

/// Time for what the library does before it answers: some hundred instructions, and more for a busy computer. Assumed.
const WORK: Duration = Duration::from_millis(100);
/// Bytes of an answer: nine triplets and the end of the line.
const ANSWER_BYTES: usize = 28;
/// The library tells every half second that it runs, while nobody asks; the rest is for a busy computer.
const BEACON_WITHIN: Duration = Duration::from_millis(1200);
/// After so many frames of another program the library is not there: it would have told in between.
const FOREIGN_FRAMES: usize = 2;
/// The answer to `H`, at the longest. Assumed: nobody has written it down.
const HELP_BYTES: usize = 128;
/// Words that only a MotorVator's command line uses (maker's other pages).
const NAMES: [&str; 2] = ["motorvator", "awos"];

/// Who is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The host library of this version.
    Library(u8),
    /// The command line alone, or another program's frames.
    CommandLine,
    /// Bytes that are no MotorVator's.
    Bytes,
    /// Nobody.
    Nothing,
}

/// Who is spoken to and what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct Speaker {
    /// The number of the last order. The two halves take odd and even ones.
    number: u8,
    /// Whether the library that this program knows runs, as far as anybody has heard.
    pub has_library: bool,
}

impl Speaker {
    pub fn new(half: Half, found: Found) -> Self {
        Self { number: half.number(), has_library: found == Found::Library(VERSION) }
    }

    /// Sends an order and reads its answer.
    pub fn ask(
        &mut self,
        line: &mut Line<'_>,
        order: &HostOrder,
    ) -> Result<(HostAnswer, Span), ExchangeError> {
        if order.may_move() {
            if !line.permit().motion {
                return Err(ExchangeError::NotArmed { command: order.to_string() });
            }
            line.motion_begins();
        }
        if !self.has_library {
            return Err(ExchangeError::impossible(MotorvatorCauseMessage::NoLibrary));
        }
        self.number = self.number.wrapping_add(2);
        let (number, letter) = (self.number, order.letter());
        let bytes = order.line(number);
        // A move of a stepper that went out twice would go twice as far.
        let once = matches!(order, HostOrder::Steps { .. });
        let retries = if once { 0 } else { line.retries() };
        let outgoing = Outgoing { bytes: &bytes, reply_length: ANSWER_BYTES, patience: WORK, retries, once };
        let mut found = None;
        let (exchange, watch) = line.parts();
        let span = exchange.exchange(&outgoing, watch, &mut |heard| match answers(heard)
            .find(|(answer, _)| answer.number == number && answer.order == letter)
        {
            Some((answer, end)) => {
                found = Some(answer);
                Judgement::Good(end)
            }
            None => Judgement::More(1),
        })?;
        match found {
            Some(answer) if answer.flags & flags::UNKNOWN_ORDER == 0 => Ok((answer, span)),
            Some(_) | None => {
                let what = MotorvatorCauseMessage::UnknownOrder { order: char::from(letter) };
                Err(ExchangeError::Refused { what: what.to_string(), is_absent: true })
            }
        }
    }

    /// Looks who is there, by listening for the library and asking the command line for its version. No program hears of it.
    pub fn look(&mut self, line: &mut Line<'_>) -> Result<Found, ExchangeError> {
        let found = look(line)?;
        self.has_library = found == Found::Library(VERSION);
        Ok(found)
    }
}

/// Looks who is there. A line that was cut short is ended first, as a frame of another board, which the command line ignores.
pub fn look(line: &mut Line<'_>) -> Result<Found, ExchangeError> {
    let bytes = [PREFIX.as_bytes(), &[LINE_END], b"H", &[LINE_END]].concat();
    let outgoing = Outgoing {
        bytes: &bytes,
        reply_length: HELP_BYTES,
        patience: BEACON_WITHIN,
        retries: 0,
        once: false,
    };
    let mut heard = Vec::new();
    let (exchange, watch) = line.parts();
    let done = exchange.exchange(&outgoing, watch, &mut |bytes| {
        heard = bytes.to_vec();
        match answers(bytes).find(|(answer, _)| answer.version().is_some()) {
            Some((_, end)) => Judgement::Good(end),
            // Another program that sends again and again never falls silent: it is not waited for.
            None if foreign_frames(bytes) >= FOREIGN_FRAMES => Judgement::Good(bytes.len()),
            None => Judgement::More(1),
        }
    });
    match done {
        Ok(_) => {}
        Err(error) if error.is_link_lost() || error.interruption().is_some() => return Err(error),
        Err(_) => {}
    }
    Ok(judge(&heard))
}

/// Frames among bytes that the library does not send.
fn foreign_frames(heard: &[u8]) -> usize {
    let lines =
        heard.split_inclusive(|byte| *byte == LINE_END).filter_map(|line| line.strip_suffix(&[LINE_END]));
    let lines = lines.map(|line| line.strip_prefix(b"\n").unwrap_or(line));
    let is_foreign = |line: &&[u8]| {
        HostAnswer::parse(line).is_none() && brushwork_motorvator_wire::parse_line_of_board(line).is_some()
    };
    lines.filter(is_foreign).count()
}

fn judge(heard: &[u8]) -> Found {
    if let Some(version) = answers(heard).find_map(|(answer, _)| answer.version()) {
        return Found::Library(version);
    }
    let words = String::from_utf8_lossy(heard).to_lowercase();
    // What has not ended may be a frame that was cut short.
    let mut lines =
        heard.split_inclusive(|byte| *byte == LINE_END).filter_map(|line| line.strip_suffix(&[LINE_END]));
    let is_frame = |line: &[u8]| brushwork_motorvator_wire::parse_line_of_board(line).is_some();
    if NAMES.iter().any(|name| words.contains(name)) || lines.any(is_frame) {
        Found::CommandLine
    } else if heard.is_empty() {
        Found::Nothing
    } else {
        Found::Bytes
    }
}

/// The library's answers among bytes, each with where it ends.
fn answers(heard: &[u8]) -> impl Iterator<Item = (HostAnswer, usize)> {
    let mut from = 0;
    heard.split_inclusive(|byte| *byte == LINE_END).filter_map(move |line| {
        from += line.len();
        // Words of the command line end in a line feed, which stands before the frame then.
        let line = line.strip_suffix(&[LINE_END])?;
        let line = line.strip_prefix(b"\n").unwrap_or(line);
        Some((HostAnswer::parse(line)?, from))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_there_is_told_by_frames_and_by_the_words_of_the_command_line() {
        assert_eq!(judge(b"073082066000002"), Found::Bytes, "cut short");
        assert_eq!(judge(b"073082066000002000000000000\r"), Found::Library(2));
        assert_eq!(judge(b"MotorVator AWOS 2.32\r\n073082066000001000000000000\r"), Found::Library(1));
        assert_eq!(judge(b"073084088049050051052053054\r"), Found::CommandLine, "of another program");
        assert_eq!(judge(b"AWOS 2.32"), Found::CommandLine);
        assert_eq!(judge(b"H\r\n?"), Found::Bytes);
        assert_eq!(judge(b""), Found::Nothing);
    }
}

//! One command to one unit and its reply, in the unit's protocol, with the pause that both ends need.

use crate::controller::registers::{all_returns, returns_of, value_in};
use crate::messages::MotionMindCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::{ExchangeError, Fault, Judgement, Outgoing, Span};
use brushwork_motion_mind_wire::{
    Address, BadReply, Command, Effect, EncodeError, Part, Progress, Protocol, Reply, Returns, command_row,
    encode_frame, encode_line, parse_all_loosely, parse_frame_reply, parse_line_reply, register,
    register_number as number,
};
use std::time::Duration;

/// No byte is sent sooner after the last one of a reply or of a command: 5 ms of silence end a frame (Motion Mind manual 5.1),
/// and some for the clocks of both ends.
pub const GAP: Duration = Duration::from_millis(6);
/// Time for the work behind a reply (Motion Mind manual 3.2: "1 to 50 ms"; ASCII 5 to 10 ms).
const WORK: [Duration; 2] = [Duration::from_millis(10), Duration::from_millis(15)];
/// The same for what writes EEPROM: up to 40 ms for a register, and RESTORE writes all. Assumed: 32 of them.
const STORE_WORK: Duration = Duration::from_millis(60);
const RESTORE_WORK: Duration = Duration::from_millis(1400);
/// The same for the long reads in text.
const LONG_TEXT_WORK: Duration = Duration::from_millis(60);
/// Time for the work of what only speaks like a unit: a public simulator looks at its line ten times a second.
const LOOSE_WORK: Duration = Duration::from_millis(300);
/// Characters of the longest answer in text, to all registers.
const LONGEST_TEXT: usize = 200;

/// Who is spoken to and how.
#[derive(Clone, Copy, Debug)]
pub struct Speaker {
    pub address: Address,
    pub protocol: Protocol,
    /// The return bits of its FUNCTION; `None` while nobody knows.
    pub returns: Option<Returns>,
    /// It is no unit of the manual but speaks like one: of all reads it answers that of all registers alone, with any values, and takes
    /// its time.
    pub is_loose: bool,
}

impl Speaker {
    pub fn new(address: Address, protocol: Protocol) -> Self {
        Self { address, protocol, returns: None, is_loose: false }
    }

    /// Takes note of a write to FUNCTION.
    pub fn note_write(&mut self, register: u8, value: i64) {
        if register == number::FUNCTION {
            self.returns = Some(returns_of(value));
        }
    }

    /// Sends a command in the unit's own words that was looked at, and gives what came back.
    pub fn send(&mut self, line: &mut Line<'_>, command: &Command) -> Result<(Reply, Span), ExchangeError> {
        self.pause(line)?;
        let bytes = self.encode(command)?;
        let retries = line.retries();
        let outgoing = Outgoing {
            bytes: &bytes,
            reply_length: self.reply_length(command),
            patience: self.work(command),
            retries,
            once: command.effect() == Effect::RelativeMotion,
        };
        let mut reply = Reply::Acknowledged;
        let (exchange, watch) = line.parts();
        let span =
            exchange.exchange(&outgoing, watch, &mut |bytes| self.judge(command, bytes, &mut reply))?;
        if let Command::Write { register, value } | Command::WriteStore { register, value } = *command {
            self.note_write(register, value);
        }
        Ok((reply, span))
    }

    /// As [`Speaker::ask`], once and with so much time for the answer: is anybody there?
    pub fn probe(
        self,
        line: &mut Line<'_>,
        index: u8,
        patience: Duration,
    ) -> Result<Option<i64>, ExchangeError> {
        let command = self.in_own_words(&Command::ReadRegister(index));
        self.pause(line)?;
        let bytes = self.encode(&command)?;
        let mut reply = Reply::Acknowledged;
        let length = self.reply_length(&command);
        let (exchange, watch) = line.parts();
        // What a unit makes of probes in the other protocol may come first: a line that says that it is none.
        let answered = exchange.exchange_within(&bytes, length, patience, watch, &mut |bytes| {
            self.judge_behind_others(&command, bytes, &mut reply)
        });
        match answered {
            Ok(_) => Ok(value_in(&reply, index)),
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            Err(_) => Ok(None),
        }
    }

    /// Judges the answer to a probe; in text, lines that are none may stand in front of it.
    fn judge_behind_others(&self, command: &Command, bytes: &[u8], reply: &mut Reply) -> Judgement {
        if self.protocol == Protocol::Binary {
            return self.judge(command, bytes, reply);
        }
        let after_ends = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
        for start in std::iter::once(0).chain(after_ends).filter(|start| *start < bytes.len()) {
            if let Judgement::Good(used) = self.judge(command, &bytes[start..], reply) {
                return Judgement::Good(start + used);
            }
        }
        Judgement::More(1)
    }

    /// The bytes of a command, for a stop that waits for nothing.
    pub fn encode(&self, command: &Command) -> Result<Vec<u8>, ExchangeError> {
        let encoded = match self.protocol {
            Protocol::Binary => encode_frame(self.address, command),
            Protocol::Text => encode_line(self.address, command).map(String::into_bytes),
        };
        encoded.map_err(|source| cannot(&source))
    }

    /// A read as the unit's protocol has it.
    pub fn in_own_words(&self, command: &Command) -> Command {
        match (self.protocol, *command) {
            (Protocol::Text, Command::ReadRegister(_) | Command::Read(_) | Command::ReadText(_))
                if self.is_loose =>
            {
                Command::ReadText(Part::All)
            }
            (Protocol::Text, Command::ReadRegister(index)) => Command::ReadText(Part::Register(index)),
            (Protocol::Text, Command::Read(mask)) if mask.is_power_of_two() => {
                Command::ReadText(Part::Register(u8::try_from(mask.trailing_zeros()).unwrap_or_default()))
            }
            (Protocol::Text, Command::Read(_)) => Command::ReadText(Part::All),
            (Protocol::Binary, Command::ReadText(Part::Register(index))) => Command::ReadRegister(index),
            (Protocol::Binary, Command::ReadText(Part::All)) => Command::Read(u32::MAX),
            (_, command) => command,
        }
    }

    /// What drives the motor needs arming; a unit that would give no answer is not spoken to.
    pub fn gate(&self, line: &Line<'_>, command: &Command) -> Result<(), ExchangeError> {
        if let Command::ReadRegister(index) | Command::ReadText(Part::Register(index)) = command
            && register(*index).is_none()
        {
            let what = MotionMindCauseMessage::UnknownRegister { register: *index };
            return Err(ExchangeError::impossible(what));
        }
        if matches!(command.effect(), Effect::Motion | Effect::RelativeMotion) {
            if !line.permit().motion {
                return Err(ExchangeError::NotArmed { command: title(command).to_owned() });
            }
            line.motion_begins();
        }
        Ok(())
    }

    fn pause(&self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        let (exchange, watch) = line.parts();
        let quiet_until = exchange.last_reply_at() + GAP;
        let left = quiet_until.saturating_sub(exchange.clock().now());
        if left.is_zero() { Ok(()) } else { exchange.wait(left, watch) }
    }

    fn judge(&self, command: &Command, bytes: &[u8], reply: &mut Reply) -> Judgement {
        let known = self.returns.unwrap_or_default();
        let mut progress = self.parse(command, known, bytes);
        if command.takes_returns() && !matches!(progress, Progress::Done { .. }) {
            // The return bits may be others than is known: whichever makes a whole reply of it counts.
            let others = all_returns().map(|returns| self.parse(command, returns, bytes));
            let whole =
                |progress: &Progress| matches!(progress, Progress::Done { used, .. } if *used == bytes.len());
            progress = others.into_iter().find(whole).unwrap_or(Progress::Incomplete);
        }
        match progress {
            Progress::Incomplete => Judgement::More(1),
            // The command is one, so that something of it was lost, or something stood in the line before it.
            Progress::Done { reply: Reply::NotUnderstood, .. } => {
                let what = format!("it answered \"BAD COMMAND\" to {}", title(command));
                Judgement::Bad(Fault::NotUnderstood(what))
            }
            Progress::Done { reply: done, used } => {
                *reply = done;
                Judgement::Good(used)
            }
            Progress::Bad(BadReply::Checksum { expected, got }) => {
                Judgement::Bad(Fault::Crc { expected: expected.into(), got: got.into() })
            }
            Progress::Bad(bad) => Judgement::Bad(Fault::Malformed(bad.to_string())),
        }
    }

    fn parse(&self, command: &Command, returns: Returns, bytes: &[u8]) -> Progress {
        match self.protocol {
            Protocol::Binary => parse_frame_reply(self.address, command, returns, bytes),
            Protocol::Text if self.is_loose && *command == Command::ReadText(Part::All) => {
                parse_all_loosely(bytes)
            }
            Protocol::Text => parse_line_reply(command, returns, bytes),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn work(&self, command: &Command) -> Duration {
        match command {
            Command::Restore => RESTORE_WORK,
            _ if self.is_loose => LOOSE_WORK,
            Command::WriteStore { .. } => STORE_WORK,
            Command::ReadText(Part::All | Part::StatusBits | Part::FunctionBits) => LONG_TEXT_WORK,
            _ => WORK[usize::from(self.protocol == Protocol::Text)],
        }
    }

    fn reply_length(&self, command: &Command) -> usize {
        match (self.protocol, command) {
            (Protocol::Binary, Command::Read(mask)) => {
                2 + (0..32).filter(|bit| mask >> bit & 1 == 1).map(width).sum::<usize>()
            }
            (Protocol::Binary, Command::ReadRegister(index)) => 2 + width(*index),
            (Protocol::Binary, _) => 12,
            (Protocol::Text, Command::ReadText(Part::Register(_))) => 18,
            (Protocol::Text, Command::ReadText(_)) => LONGEST_TEXT,
            (Protocol::Text, _) => 40,
        }
    }
}

/// A command's name for sentences.
fn title(command: &Command) -> &'static str {
    command_row(command.number()).map_or("an unknown command", |row| row.name)
}

fn width(index: u8) -> usize {
    register(index).map_or(0, |row| row.kind.bytes())
}

fn cannot(source: &EncodeError) -> ExchangeError {
    ExchangeError::impossible(Message::error(source.clone()))
}

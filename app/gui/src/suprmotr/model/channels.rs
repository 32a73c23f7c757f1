//! The digital channels and the analog lines of a SuprMotr, as they are read while their screen is open.
//!
//! `#` tells the channels and no macro minds it. The analog lines are told to lines alone, which would end a macro or a wait: they are read
//! while the status has neither. No command tells a direction: it is known where it was set here, or where an output is on.

use std::time::Duration;

use brushwork_link::device::{Event, Identity, Request, StatusReport};
use brushwork_suprmotr_client::{SuprMotrFacts, status_of_word};
use brushwork_suprmotr_wire::{CHANNELS, Mnemonic, Status, operation};
use brushwork_values::{Value, Values};

use crate::command::Command;

/// Answers to this screen's commands begin with this number, far from those of other screens.
const FIRST_ID: u64 = 1 << 46;
/// Time between two reads.
const INTERVAL: Duration = Duration::from_millis(150);
/// Time between two reads of the analog lines.
const ANALOG_INTERVAL: Duration = Duration::from_millis(600);
/// After so long an answer is not waited for any more.
const PATIENCE: Duration = Duration::from_secs(3);

/// Volts of one step of an analog line: 5 V at 255 (SuprMotr manual, SO and TA).
pub const STEP_VOLTS: f64 = 5.0 / 255.0;

/// What a channel is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Input,
    Output,
}

/// What a person has done to a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// CI or CT: a channel, from 1, is turned round.
    Turn(u8, Direction),
    /// CN or CF: an output is switched on or off.
    Switch(u8, bool),
    /// SO: the analog output, in steps.
    Analog(u8),
    /// CP: all channels become outputs at once, channel 1 in bit 0.
    Pattern(u16),
}

impl Act {
    /// The command with its number.
    pub const fn command(self) -> (Mnemonic, u16) {
        match self {
            Self::Turn(channel, Direction::Input) => (Mnemonic::CI, channel as u16),
            Self::Turn(channel, Direction::Output) => (Mnemonic::CT, channel as u16),
            Self::Switch(channel, true) => (Mnemonic::CN, channel as u16),
            Self::Switch(channel, false) => (Mnemonic::CF, channel as u16),
            Self::Analog(steps) => (Mnemonic::SO, steps as u16),
            Self::Pattern(word) => (Mnemonic::CP, word),
        }
    }
}

/// What waits for an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Read,
    Act(Act),
}

/// Channels and analog lines as they were read last.
#[derive(Debug, Default)]
pub struct Channels {
    /// Outputs and inputs, channel 1 in bit 0.
    words: Option<(u16, u16)>,
    directions: [Option<Direction>; CHANNELS as usize],
    analog: [Option<u8>; 2],
    analog_output: Option<u8>,
    /// What the analog output is to be set to, volts.
    pub wanted_volts: f64,
    /// What all channels are to give, channel 1 in bit 0; and whether a person has said that all of them may be outputs.
    pub wanted_pattern: f64,
    pub accepts_outputs: bool,
    /// Why the last act was not done.
    pub trouble: Option<String>,
    /// The status that was told last, and whose it is.
    status: Option<(u8, Status)>,
    waiting: Vec<(u64, Asked)>,
    /// When the last read was asked for, and the last one of analog lines.
    read_at: Option<Duration>,
    analog_at: Option<Duration>,
    /// Which of them comes next.
    is_output_next: bool,
    asked: u64,
}

/// Whether a macro or a wait is in process, which a line would end.
pub const fn holds_lines(status: Status) -> bool {
    status.operation & (operation::MACRO | operation::WAIT) != 0
}

/// The status of a report.
pub fn status_in(report: &StatusReport) -> Status {
    status_of_word(report.word)
}

impl Channels {
    /// What is read next, when it is time for it.
    pub fn read(&mut self, identity: &Identity, now: Duration) -> Option<Request> {
        SuprMotrFacts::of(identity)?;
        let since = |at: Option<Duration>| at.map(|at| now.saturating_sub(at));
        let is_waiting = self.waiting.iter().any(|(_, asked)| *asked == Asked::Read);
        let is_lost = since(self.read_at).is_none_or(|gone| gone >= PATIENCE);
        if is_waiting && !is_lost || since(self.read_at).is_some_and(|gone| gone < INTERVAL) {
            return None;
        }
        self.waiting.retain(|(_, asked)| *asked != Asked::Read);
        let is_analog_due = since(self.analog_at).is_none_or(|gone| gone >= ANALOG_INTERVAL);
        let takes_lines =
            self.status.is_some_and(|(address, status)| address == identity.address && !holds_lines(status));
        let mnemonic = if is_analog_due && takes_lines {
            self.is_output_next = !self.is_output_next;
            self.analog_at = (!self.is_output_next).then_some(now).or(self.analog_at);
            if self.is_output_next { Mnemonic::TA } else { Mnemonic::TO }
        } else {
            Mnemonic::TC
        };
        self.read_at = Some(now);
        let id = self.ask(Asked::Read);
        Some(Request::Transact { id, command: mnemonic.number(), values: Vec::new() })
    }

    fn ask(&mut self, asked: Asked) -> u64 {
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        self.waiting.push((id, asked));
        id
    }

    /// Does something to a line.
    pub fn act(&mut self, act: Act) -> Command {
        self.trouble = None;
        let id = self.ask(Asked::Act(act));
        let (mnemonic, number) = act.command();
        Command::Transact { id, command: mnemonic.number(), values: vec![Value::Int(number.into())] }
    }

    /// A request was not taken.
    pub fn not_sent(&mut self) {
        if self.waiting.pop().is_some_and(|(_, asked)| asked != Asked::Read) {
            self.trouble = Some("Not sent: the link is busy. Try it again in a moment.".to_owned());
        }
    }

    /// Takes in an event. True where it was the answer to one of this screen's commands.
    pub fn take(&mut self, event: &Event) -> bool {
        if let Event::Status(report) = event {
            self.status = Some((report.address, status_in(report)));
        }
        let Event::Transacted { id, result } = event else { return false };
        let Some(place) = self.waiting.iter().position(|(waiting, _)| waiting == id) else {
            return *id > FIRST_ID;
        };
        let (_, asked) = self.waiting.remove(place);
        match (asked, result) {
            (Asked::Read, Ok(values)) => self.note(values),
            // A macro that began in between; the next read is one of channels.
            (Asked::Read, Err(_)) => {}
            (Asked::Act(act), Ok(_)) => self.done(act),
            (Asked::Act(_), Err(why)) => self.trouble = Some(why.to_string()),
        }
        true
    }

    fn note(&mut self, values: &Values) {
        let int = |name: &str| values.try_int(name);
        let byte = |name: &str| int(name).and_then(|value| u8::try_from(value).ok());
        let word = |name: &str| int(name).and_then(|value| u16::try_from(value).ok());
        if let Some((outputs, inputs)) = word("outputs").zip(word("inputs")) {
            self.words = Some((outputs, inputs));
            for channel in (1..=CHANNELS).filter(|channel| is_set(outputs, *channel)) {
                self.directions[usize::from(channel) - 1] = Some(Direction::Output);
            }
        }
        for (at, name) in ["analog_1", "analog_2"].into_iter().enumerate() {
            self.analog[at] = byte(name).or(self.analog[at]);
        }
        self.analog_output = byte(Mnemonic::TO.name()).or(self.analog_output);
    }

    fn done(&mut self, act: Act) {
        match act {
            Act::Turn(channel, direction) => {
                self.directions[usize::from(channel) - 1] = Some(direction);
            }
            // What became of them the next reads tell.
            Act::Switch(..) | Act::Analog(_) => {}
            Act::Pattern(_) => self.directions = [Some(Direction::Output); CHANNELS as usize],
        }
    }

    /// What a channel is for, as far as that is known.
    pub fn direction(&self, channel: u8) -> Option<Direction> {
        self.directions[usize::from(channel) - 1]
    }

    /// Whether a channel reads as on.
    pub fn input(&self, channel: u8) -> Option<bool> {
        self.words.map(|(_, inputs)| is_set(inputs, channel))
    }

    /// Whether a channel is told to be on.
    pub fn output(&self, channel: u8) -> Option<bool> {
        self.words.map(|(outputs, _)| is_set(outputs, channel))
    }

    /// Analog input 1 or 2, in steps.
    pub fn analog(&self, number: u8) -> Option<u8> {
        self.analog[usize::from(number) - 1]
    }

    /// The analog output, in steps.
    pub fn analog_output(&self) -> Option<u8> {
        self.analog_output
    }

    /// Nothing is known: another unit, or none.
    pub fn forget(&mut self) {
        *self = Self { asked: self.asked, ..Self::default() };
    }
}

const fn is_set(word: u16, channel: u8) -> bool {
    word >> (channel - 1) & 1 != 0
}

/// The nearest step to so many volts.
pub fn steps_of(volts: f64) -> u8 {
    (volts / STEP_VOLTS).round().clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_volts_are_255_steps_and_each_act_has_its_command() {
        assert_eq!([-1.0, 0.0, 0.0196, 2.5, 5.0, 9.0].map(steps_of), [0, 0, 1, 128, 255, 255]);
        for (act, command) in [
            (Act::Turn(3, Direction::Input), "CI3"),
            (Act::Turn(3, Direction::Output), "CT3"),
            (Act::Switch(16, true), "CN16"),
            (Act::Switch(16, false), "CF16"),
            (Act::Analog(255), "SO255"),
            (Act::Pattern(0x8001), "CP32769"),
        ] {
            let (mnemonic, number) = act.command();
            assert_eq!(format!("{}{number}", mnemonic.name()), command);
            assert!(!mnemonic.row().effect.may_move());
        }
    }
}

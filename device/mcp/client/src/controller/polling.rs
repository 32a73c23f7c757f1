//! What is read from a unit in a sweep, and which signal each reply carries.

use crate::controller::channels::pins;
use crate::controller::indicators::indicators;
use crate::controller::speaker::Speaker;
use crate::messages::McpCauseMessage;
use brushwork_link::device::StatusReport;
use brushwork_link::device::controller::{Line, PollItem, PollList};
use brushwork_link::device::{Channel, PinSignal, Sample};
use brushwork_link::exchange::{ExchangeError, Span};
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_mcp_wire::packet_serial::{Read, Typed, commands, scale};
use std::time::Duration;

/// Signals that change quickly, each read in every sweep.
const FAST: [&dyn Polled; 6] = [
    &Poll(commands::READ_STATUS, "status", |reply, to| to.status = Some((reply.int(STATUS), None))),
    &Poll(commands::READ_ENCODERS, "encoders", |reply, to| {
        to.set(Channel::M1_POSITION, reply.physical(ENCODER_M1));
        to.set(Channel::M2_POSITION, reply.physical(ENCODER_M2));
    }),
    &Poll(commands::READ_SPEED_M1, "M1 speed", |reply, to| to.set(Channel::M1_VELOCITY, signed_speed(reply))),
    &Poll(commands::READ_SPEED_M2, "M2 speed", |reply, to| to.set(Channel::M2_VELOCITY, signed_speed(reply))),
    &Poll(commands::READ_PWMS, "PWM outputs", |reply, to| {
        to.set(Channel::M1_PWM, reply.physical(DUTY_M1));
        to.set(Channel::M2_PWM, reply.physical(DUTY_M2));
    }),
    &Poll(commands::READ_CURRENTS, "motor currents", |reply, to| {
        to.set(Channel::M1_CURRENT, reply.physical(CURRENT_M1));
        to.set(Channel::M2_CURRENT, reply.physical(CURRENT_M2));
    }),
];

/// Signals that change slowly, read in turn.
const SLOW: [&dyn Polled; 6] = [
    &Poll(commands::READ_MAIN_BATTERY, "main battery", |reply, to| {
        to.set(Channel::MAIN_BATTERY, reply.physical(MAIN_BATTERY));
    }),
    &Poll(commands::READ_LOGIC_BATTERY, "logic battery", |reply, to| {
        to.set(Channel::LOGIC_BATTERY, reply.physical(LOGIC_BATTERY));
    }),
    &Poll(commands::READ_TEMPERATURE_1, "temperature 1", |reply, to| {
        to.set(Channel::TEMPERATURE_1, reply.physical(TEMPERATURE_1));
    }),
    &Poll(commands::READ_TEMPERATURE_2, "temperature 2", |reply, to| {
        to.set(Channel::TEMPERATURE_2, reply.physical(TEMPERATURE_2));
    }),
    &Poll(commands::READ_SPEED_ERRORS, "speed errors", |reply, to| {
        to.set(Channel::M1_SPEED_ERROR, reply.physical(ERROR_M1));
        to.set(Channel::M2_SPEED_ERROR, reply.physical(ERROR_M2));
    }),
    &Poll(commands::READ_POSITION_ERRORS, "position errors", |reply, to| {
        to.set(Channel::M1_POSITION_ERROR, reply.physical(ERROR_M1));
        to.set(Channel::M2_POSITION_ERROR, reply.physical(ERROR_M2));
    }),
];

/// What a unit that answers it needs alone.
const ALL_STATUS: &dyn Polled = &Poll(commands::READ_ALL_STATUS, "all status", |reply, to| {
    to.status = Some((reply.int(STATUS), Some(reply.int(TICK))));
    to.set(Channel::M1_POSITION, reply.physical(ENCODER_M1));
    to.set(Channel::M2_POSITION, reply.physical(ENCODER_M2));
    to.set(Channel::M1_VELOCITY, reply.physical(SPEED_M1));
    to.set(Channel::M2_VELOCITY, reply.physical(SPEED_M2));
    to.set(Channel::M1_PWM, reply.physical(DUTY_M1));
    to.set(Channel::M2_PWM, reply.physical(DUTY_M2));
    to.set(Channel::M1_CURRENT, reply.physical(CURRENT_M1));
    to.set(Channel::M2_CURRENT, reply.physical(CURRENT_M2));
    to.set(Channel::TEMPERATURE_1, reply.physical(TEMPERATURE_1));
    to.set(Channel::TEMPERATURE_2, reply.physical(TEMPERATURE_2));
    to.set(Channel::MAIN_BATTERY, reply.physical(MAIN_BATTERY));
    to.set(Channel::LOGIC_BATTERY, reply.physical(LOGIC_BATTERY));
    to.set(Channel::M1_SPEED_ERROR, reply.physical(SPEED_ERROR_M1));
    to.set(Channel::M2_SPEED_ERROR, reply.physical(SPEED_ERROR_M2));
    to.set(Channel::M1_POSITION_ERROR, reply.physical(POSITION_ERROR_M1));
    to.set(Channel::M2_POSITION_ERROR, reply.physical(POSITION_ERROR_M2));
});

/// What newer units answer in place of two commands.
const SPEEDS: &dyn Polled = &Poll(commands::READ_SPEEDS, "speeds", |reply, to| {
    to.set(Channel::M1_VELOCITY, reply.physical(SPEED_M1));
    to.set(Channel::M2_VELOCITY, reply.physical(SPEED_M2));
});

/// What reads the input pins of an MCP.
const SIGNALS: &dyn Polled = &Poll(commands::READ_SIGNAL_VALUES, "input signals", pin_signals);

/// One thing that is read: its command, its name for sentences, and which signals its reply carries.
struct Poll<const L: u8>(Typed<L>, &'static str, fn(&Read<L>, &mut Taken<'_>));

/// [`Poll`] of any layout.
trait Polled: Sync {
    fn item(&self) -> PollItem;
    fn is_known(&self, speaker: Speaker, line: &mut Line<'_>) -> Result<bool, ExchangeError>;
    fn read(&self, speaker: Speaker, line: &mut Line<'_>, sample: &mut Sample)
    -> Result<Word, ExchangeError>;
}

/// A status word with the running time, where an item brings it, and when it came.
type Word = (Option<(i64, Option<i64>)>, Duration);

/// What a reply brings.
struct Taken<'a> {
    sample: &'a mut Sample,
    span: Span,
    status: Option<(i64, Option<i64>)>,
}

impl Taken<'_> {
    fn set(&mut self, channel: Channel, value: f64) {
        self.sample.set(channel, value, self.span.requested_at, self.span.replied_at);
    }
}

impl<const L: u8> Polled for Poll<L> {
    fn item(&self) -> PollItem {
        PollItem { id: u16::from(self.0.number()), name: self.1 }
    }

    fn is_known(&self, speaker: Speaker, line: &mut Line<'_>) -> Result<bool, ExchangeError> {
        Ok(speaker.ask_if_known(line, self.0)?.is_some())
    }

    fn read(
        &self,
        speaker: Speaker,
        line: &mut Line<'_>,
        sample: &mut Sample,
    ) -> Result<Word, ExchangeError> {
        let reply = speaker.ask(line, self.0, &[])?;
        let mut taken = Taken { sample, span: reply.span, status: None };
        (self.2)(&reply.values, &mut taken);
        Ok((taken.status, reply.span.replied_at))
    }
}

/// Finds out what a unit answers, by asking once for everything. A unit that answers 73 needs nothing else.
pub fn find(speaker: Speaker, line: &mut Line<'_>) -> Result<PollList, ExchangeError> {
    if ALL_STATUS.is_known(speaker, line)? {
        let all = ALL_STATUS.item();
        return Ok(PollList { fast: vec![all], slow: Vec::new(), status: Some(all), signals: None });
    }
    let both_speeds = SPEEDS.is_known(speaker, line)?;
    let mut fast = Vec::new();
    for poll in FAST {
        if both_speeds && is_one_speed(poll.item()) {
            // One of the two stands for both.
            if !fast.contains(&SPEEDS.item()) {
                fast.push(SPEEDS.item());
            }
        } else if poll.is_known(speaker, line)? {
            fast.push(poll.item());
        }
    }
    let mut slow = Vec::new();
    for poll in SLOW {
        if poll.is_known(speaker, line)? {
            slow.push(poll.item());
        }
    }
    let status = fast.iter().find(|item| **item == FAST[0].item()).copied();
    Ok(PollList { fast, slow, status, signals: None })
}

/// Whether an item is what 108 reads for both motors.
fn is_one_speed(item: PollItem) -> bool {
    [commands::READ_SPEED_M1, commands::READ_SPEED_M2]
        .iter()
        .any(|speed| u16::from(speed.number()) == item.id)
}

/// Reads that the unit is known to answer: its version, by which it was found, and all that is polled.
pub fn commands(polls: &PollList) -> Vec<u8> {
    let polled = polls.fast.iter().chain(&polls.slow).filter_map(|item| u8::try_from(item.id).ok());
    std::iter::once(commands::READ_VERSION.number()).chain(polled).collect()
}

/// What is read again and again of a unit that answers so: one command that brings everything, or those of the signals that change quickly.
#[must_use]
pub fn sweep_of(is_answered: impl Fn(u8) -> bool) -> Vec<u8> {
    let number = |poll: &dyn Polled| u8::try_from(poll.item().id).ok().filter(|number| is_answered(*number));
    match number(ALL_STATUS) {
        Some(all) => vec![all],
        None => FAST.iter().filter_map(|poll| number(*poll)).collect(),
    }
}

/// What reads the input pins of an MCP.
pub fn signals() -> PollItem {
    SIGNALS.item()
}

/// Names of what could be read but is not answered.
pub fn missing(polls: &PollList) -> Vec<&'static str> {
    let known = |item: PollItem| polls.fast.iter().chain(&polls.slow).any(|polled| *polled == item);
    if known(ALL_STATUS.item()) {
        return Vec::new();
    }
    let always = FAST.iter().chain(&SLOW[..3]).map(|poll| poll.item());
    let is_missing = |item: &PollItem| !(known(*item) || is_one_speed(*item) && known(SPEEDS.item()));
    always.filter(is_missing).map(|item| item.name).collect()
}

/// Reads one item into a sample.
pub fn read(
    speaker: Speaker,
    line: &mut Line<'_>,
    item: PollItem,
    sample: &mut Sample,
) -> Result<Option<StatusReport>, ExchangeError> {
    let (status, at) = polled(item)?.read(speaker, line, sample)?;
    Ok(status.map(|(word, ticks)| {
        let word = u32::try_from(word).unwrap_or(0);
        StatusReport {
            address: speaker.id(),
            at,
            word,
            indicators: indicators(speaker.generation),
            running_ticks: ticks.and_then(|ticks| u32::try_from(ticks).ok()),
        }
    }))
}

/// What an item reads. Nothing else can go out: there is no command to fall back to.
fn polled(item: PollItem) -> Result<&'static dyn Polled, ExchangeError> {
    let all = FAST.into_iter().chain(SLOW).chain([ALL_STATUS, SPEEDS, SIGNALS]);
    let what = || McpCauseMessage::NothingToRead { id: item.id, name: item.name };
    all.into_iter().find(|poll| poll.item().id == item.id).ok_or_else(|| ExchangeError::impossible(what()))
}

/// Commands 18 and 19 carry the magnitude, and the direction in a byte: 1 is backwards (public clients, 2015-2025).
fn signed_speed<const L: u8>(reply: &Read<L>) -> f64 {
    let magnitude = reply.physical(SPEED);
    if reply.int(STATUS) == 1 { -magnitude } else { magnitude }
}

fn pin_signals<const L: u8>(reply: &Read<L>, to: &mut Taken<'_>) {
    let whole = |raw: i64| i32::try_from(raw).unwrap_or_default();
    let mut channels = pins();
    for record in reply.records() {
        let signal = PinSignal {
            command: whole(record.int(COMMAND)),
            position: whole(record.int(POSITION)),
            percent: whole(record.int(PERCENT)),
            speed: whole(record.int(SPEED)),
            average_speed: whole(record.int(AVERAGE_SPEED)),
        };
        to.sample.signals.push(signal);
        if let Some(channel) = channels.next() {
            to.set(channel, f64::from(signal.percent) / scale::FULL_DUTY_RAW as f64 * 100.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::packet_serial::{Effect, Generation, lookup};

    #[test]
    fn an_item_that_is_no_read_has_no_command_and_none_is_put_in_its_place() {
        for id in 0..=u16::MAX {
            let Ok(poll) = polled(PollItem { id, name: "anything" }) else { continue };
            assert_eq!(poll.item().id, id);
            let row = u8::try_from(id).ok().and_then(lookup).expect("a command");
            for generation in Generation::ALL {
                assert_eq!(row.effect(generation), Effect::Query, "{id}");
            }
        }
        let driving = PollItem { id: 256, name: "a number that fits no command" };
        let refused = polled(driving).err().map(|error| error.to_string()).unwrap();
        assert_eq!(refused, "nothing can be read under the number 256 (a number that fits no command)");
    }
}

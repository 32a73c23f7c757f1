//! What is read from a unit in a sweep, and which signal each reply carries.

use crate::controller::channels::pins;
use crate::controller::indicators::indicators;
use crate::controller::speaker::Speaker;
use brushwork_link::device::StatusReport;
use brushwork_link::device::controller::{Line, PollItem, PollList};
use brushwork_link::device::{Channel, PinSignal, Sample};
use brushwork_link::exchange::{ExchangeError, Reply};
use brushwork_mcp_wire::packet_serial::{Effect, Generation, lookup, number, scale};

/// Signals that change quickly, each read in every sweep.
const FAST: [(u8, &str); 6] = [
    (number::READ_STATUS, "status"),
    (number::READ_ENCODERS, "encoders"),
    (number::READ_SPEED_M1, "M1 speed"),
    (number::READ_SPEED_M2, "M2 speed"),
    (number::READ_PWMS, "PWM outputs"),
    (number::READ_CURRENTS, "motor currents"),
];

/// Signals that change slowly, read in turn.
const SLOW: [(u8, &str); 6] = [
    (number::READ_MAIN_BATTERY, "main battery"),
    (number::READ_LOGIC_BATTERY, "logic battery"),
    (number::READ_TEMPERATURE_1, "temperature 1"),
    (number::READ_TEMPERATURE_2, "temperature 2"),
    (number::READ_SPEED_ERRORS, "speed errors"),
    (number::READ_POSITION_ERRORS, "position errors"),
];

/// Finds out what a unit answers, by asking once for everything. A unit that answers 73 needs nothing else.
pub fn find(speaker: Speaker, line: &mut Line<'_>) -> Result<PollList, ExchangeError> {
    let all = item(number::READ_ALL_STATUS, "all status");
    if speaker.ask_if_known(line, number::READ_ALL_STATUS, &[])?.is_some() {
        return Ok(PollList { fast: vec![all], slow: Vec::new(), status: Some(all), signals: None });
    }
    let mut fast = Vec::new();
    let both_speeds = speaker.ask_if_known(line, number::READ_SPEEDS, &[])?.is_some();
    for (command, name) in FAST {
        match command {
            number::READ_SPEED_M1 if both_speeds => fast.push(item(number::READ_SPEEDS, "speeds")),
            number::READ_SPEED_M2 if both_speeds => {}
            _ if speaker.ask_if_known(line, command, &[])?.is_some() => fast.push(item(command, name)),
            _ => {}
        }
    }
    let mut slow = Vec::new();
    for (command, name) in SLOW {
        if speaker.ask_if_known(line, command, &[])?.is_some() {
            slow.push(item(command, name));
        }
    }
    let status = fast.iter().find(|item| item.id == u16::from(number::READ_STATUS)).copied();
    Ok(PollList { fast, slow, status, signals: None })
}

/// Reads that the unit is known to answer: its version, by which it was found, and all that is polled.
pub fn commands(polls: &PollList) -> Vec<u8> {
    let polled = polls.fast.iter().chain(&polls.slow).filter_map(|item| u8::try_from(item.id).ok());
    std::iter::once(number::READ_VERSION).chain(polled).collect()
}

/// What reads the input pins of an MCP.
pub fn signals() -> PollItem {
    item(number::READ_SIGNAL_VALUES, "input signals")
}

/// Names of what could be read but is not answered.
pub fn missing(polls: &PollList) -> Vec<&'static str> {
    if polls.fast.iter().any(|item| item.id == u16::from(number::READ_ALL_STATUS)) {
        return Vec::new();
    }
    let known = |command: u8| polls.fast.iter().chain(&polls.slow).any(|item| item.id == u16::from(command));
    let always = FAST.iter().chain(&SLOW[..3]);
    let speeds = known(number::READ_SPEEDS);
    always
        .filter(|(command, _)| {
            let is_speed = matches!(*command, number::READ_SPEED_M1 | number::READ_SPEED_M2);
            !(known(*command) || is_speed && speeds)
        })
        .map(|(_, name)| *name)
        .collect()
}

/// Reads one item into a sample.
pub fn read(
    speaker: Speaker,
    line: &mut Line<'_>,
    item: PollItem,
    sample: &mut Sample,
) -> Result<Option<StatusReport>, ExchangeError> {
    let command = read_command(item, speaker.generation)?;
    let reply = speaker.ask(line, command, &[])?;
    match command {
        number::READ_SPEED_M1 => signed_speed(sample, &reply, Channel::M1_VELOCITY),
        number::READ_SPEED_M2 => signed_speed(sample, &reply, Channel::M2_VELOCITY),
        number::READ_SPEED_ERRORS => errors(sample, &reply, Channel::M1_SPEED_ERROR, Channel::M2_SPEED_ERROR),
        number::READ_POSITION_ERRORS => {
            errors(sample, &reply, Channel::M1_POSITION_ERROR, Channel::M2_POSITION_ERROR);
        }
        number::READ_SIGNAL_VALUES => pin_signals(sample, &reply),
        _ => {}
    }
    for (name, channel) in NAMED {
        if let Some(value) = reply.values.physical(name) {
            sample.set(*channel, value, reply.span.requested_at, reply.span.replied_at);
        }
    }
    Ok(reply.values.try_int("status").filter(|_| brings_status(command)).map(|word| {
        let word = u32::try_from(word).unwrap_or(0);
        StatusReport {
            address: speaker.id(),
            at: reply.span.replied_at,
            word,
            indicators: indicators(speaker.generation),
            running_ticks: reply.values.try_int("tick").and_then(|ticks| u32::try_from(ticks).ok()),
        }
    }))
}

/// The command of an item. Whatever else came here must never go out: command 0 drives motor 1 forward.
fn read_command(item: PollItem, generation: Generation) -> Result<u8, ExchangeError> {
    let reads = |command: &u8| lookup(*command).is_some_and(|row| row.effect(generation) == Effect::Query);
    let what = || format!("nothing can be read under the number {} ({})", item.id, item.name);
    u8::try_from(item.id).ok().filter(reads).ok_or_else(|| ExchangeError::Impossible { what: what() })
}

/// The fields of the replies above and the channels they are. In 18 and 19 a field "status" is the direction.
const NAMED: &[(&str, Channel)] = &[
    ("encoder_m1", Channel::M1_POSITION),
    ("encoder_m2", Channel::M2_POSITION),
    ("speed_m1", Channel::M1_VELOCITY),
    ("speed_m2", Channel::M2_VELOCITY),
    ("duty_m1", Channel::M1_PWM),
    ("duty_m2", Channel::M2_PWM),
    ("current_m1", Channel::M1_CURRENT),
    ("current_m2", Channel::M2_CURRENT),
    ("temperature_1", Channel::TEMPERATURE_1),
    ("temperature_2", Channel::TEMPERATURE_2),
    ("main_battery", Channel::MAIN_BATTERY),
    ("logic_battery", Channel::LOGIC_BATTERY),
    ("speed_error_m1", Channel::M1_SPEED_ERROR),
    ("speed_error_m2", Channel::M2_SPEED_ERROR),
    ("position_error_m1", Channel::M1_POSITION_ERROR),
    ("position_error_m2", Channel::M2_POSITION_ERROR),
];

fn brings_status(command: u8) -> bool {
    matches!(command, number::READ_STATUS | number::READ_ALL_STATUS)
}

/// Commands 18 and 19 carry the magnitude, and the direction in a byte: 1 is backwards (public clients, 2015-2025).
fn signed_speed(sample: &mut Sample, reply: &Reply, channel: Channel) {
    let magnitude = reply.values.physical("speed").unwrap_or(f64::NAN);
    let speed = if reply.values.try_int("status") == Some(1) { -magnitude } else { magnitude };
    sample.set(channel, speed, reply.span.requested_at, reply.span.replied_at);
}

fn errors(sample: &mut Sample, reply: &Reply, first: Channel, second: Channel) {
    for (name, channel) in [("error_m1", first), ("error_m2", second)] {
        let error = reply.values.physical(name).unwrap_or(f64::NAN);
        sample.set(channel, error, reply.span.requested_at, reply.span.replied_at);
    }
}

fn pin_signals(sample: &mut Sample, reply: &Reply) {
    let whole = |raw: i64| i32::try_from(raw).unwrap_or_default();
    let mut channels = pins();
    for record in reply.values.records() {
        let signal = PinSignal {
            command: whole(record.int("command")),
            position: whole(record.int("position")),
            percent: whole(record.int("percent")),
            speed: whole(record.int("speed")),
            average_speed: whole(record.int("average_speed")),
        };
        sample.signals.push(signal);
        if let Some(channel) = channels.next() {
            let percent = f64::from(signal.percent) / scale::FULL_DUTY_RAW as f64 * 100.0;
            sample.set(channel, percent, reply.span.requested_at, reply.span.replied_at);
        }
    }
}

fn item(command: u8, name: &'static str) -> PollItem {
    PollItem { id: u16::from(command), name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_item_that_is_no_read_has_no_command_and_none_is_put_in_its_place() {
        for id in 0..=u16::MAX {
            let item = PollItem { id, name: "anything" };
            for generation in Generation::ALL {
                let Ok(command) = read_command(item, generation) else { continue };
                assert_eq!(u16::from(command), id);
                let row = lookup(command).expect("it was found");
                assert_eq!(row.effect(generation), Effect::Query, "{id}");
            }
        }
        let driving = PollItem { id: 256, name: "a number that fits no command" };
        let refused = read_command(driving, Generation::Gen1).unwrap_err().to_string();
        assert_eq!(refused, "nothing can be read under the number 256 (a number that fits no command)");
    }
}

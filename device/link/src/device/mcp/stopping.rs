//! Stopping a unit: at once without asking, then again with its confirmation, and what can still drive it after that.

use super::{Speaker, Wire};
use crate::device::controller::Line;
use crate::device::stop::UnitStop;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use brushwork_protocol::codes::{self, Code};
use brushwork_protocol::models::Model;
use brushwork_protocol::packet_serial::{Generation, Record, Request, number, scale};

/// Duty 0 on both motors at the highest acceleration (command 54).
const DUTY_ZERO: [i64; 4] = [0, scale::MAX_DUTY_ACCEL_RAW, 0, scale::MAX_DUTY_ACCEL_RAW];
/// A move of no distance at no speed that drops what waits in the buffers (command 43 with its buffer byte at 1).
const DROP_BUFFERS: [i64; 5] = [0, 0, 0, 0, 1];
/// Buffer length that means "empty" (MCP manual 2.4.9, command 47).
const EMPTY: i64 = 0x80;

/// What to do when a stop is not confirmed.
const CUT_POWER: &str = "Cut the motor power now: the motors may still be running";

/// The packets that stop a unit, back to back. With `buffered` the moves that wait are dropped too; duty 0 follows once
/// more, since dropping is itself a move.
///
/// Assumed: a duty command ends the move that runs, and leaves open whether it drops those that wait.
pub fn bytes(speaker: Speaker, scripts: bool, buffered: bool) -> Vec<u8> {
    if let Wire::Objects(place) = speaker.wire {
        // Dropping buffers takes several accesses; the confirmation does that.
        return place.stop_bytes(scripts);
    }
    let mut packets: Vec<(u8, &[i64])> = Vec::new();
    if scripts {
        packets.push((number::STOP_SCRIPT, &[]));
    }
    packets.push((number::DUTY_ACCEL_BOTH, &DUTY_ZERO));
    if buffered {
        packets.push((number::SPEED_DISTANCE_BOTH, &DROP_BUFFERS));
        packets.push((number::DUTY_ACCEL_BOTH, &DUTY_ZERO));
    }
    packets.into_iter().flat_map(|(command, values)| encode(speaker, command, values)).collect()
}

/// Stops with confirmation and empties the buffers. Only what breaks in and a lost link are errors.
pub fn confirm(
    speaker: Speaker,
    line: &mut Line<'_>,
    scripts: bool,
    on: &str,
) -> Result<UnitStop, ExchangeError> {
    let mut stop = UnitStop {
        address: speaker.id(),
        confirmed: false,
        script_ended: None,
        buffers_empty: None,
        still_driven_by: Vec::new(),
        failures: Vec::new(),
    };
    if let Err(error) = speaker.ask(line, number::DUTY_ACCEL_BOTH, &DUTY_ZERO) {
        pass_on(&error)?;
        stop.failures.push(Failure::new("stop the motors", on, error.full(), CUT_POWER));
        return Ok(stop);
    }
    stop.confirmed = true;
    if scripts && stop_script(speaker, line, &mut stop)? {
        // It may have driven the motors again since they were told to stand.
        if let Err(error) = speaker.ask(line, number::DUTY_ACCEL_BOTH, &DUTY_ZERO) {
            pass_on(&error)?;
            stop.confirmed = false;
            stop.failures.push(Failure::new("stop the motors", on, error.full(), CUT_POWER));
            return Ok(stop);
        }
    }
    match empty_buffers(speaker, line) {
        Ok(empty) => stop.buffers_empty = empty,
        Err(error) => {
            pass_on(&error)?;
            stop.failures.push(Failure::new("empty the motion buffers", on, error.full(), CUT_POWER));
        }
    }
    Ok(stop)
}

/// What can drive a motor without this program: pins whose signal is aimed at a motor or starts a script, at a priority
/// level that is on.
pub fn other_drivers(
    speaker: Speaker,
    line: &mut Line<'_>,
    model: Option<&'static Model>,
) -> Result<Vec<String>, ExchangeError> {
    let Some(priorities) = speaker.ask_if_known(line, number::READ_PRIORITIES, &[])? else {
        return Ok(Vec::new());
    };
    let levels: Vec<i64> = priorities.values.ints().collect();
    if !levels.iter().any(|level| is_pin_level(*level)) {
        return Ok(Vec::new());
    }
    let Some(signals) = speaker.ask_if_known(line, number::READ_SIGNALS, &[])? else {
        return Ok(Vec::new());
    };
    let named = signals.values.records().enumerate();
    Ok(named.flat_map(|(index, record)| drivers_of(&pin_name(model, index), &record, &levels)).collect())
}

/// The sentences about one pin.
fn drivers_of(pin: &str, record: &Record<'_>, levels: &[i64]) -> Vec<String> {
    let kind = codes::by_raw(codes::SIGNAL_TYPES, record.int("type")).map_or("", |code| code.key);
    let mut sentences = Vec::new();
    let target = record.int("target");
    if target != 0 && levels.iter().any(|level| level_key(*level) == kind) {
        let motors = codes::by_raw(codes::SIGNAL_TARGETS, target).map_or("a motor", |code| code.label);
        sentences.push(format!("The {kind} input {pin} can drive {}.", lower_first(motors)));
    }
    let starts = |name: &str| action_key(record, name) == Some("run_script");
    if kind != "none" && (starts("min_action") || starts("max_action")) {
        sentences.push(format!("The input {pin} can start the script."));
    }
    sentences
}

/// The key of an action in whichever numbering its width has.
fn action_key(record: &Record<'_>, name: &str) -> Option<&'static str> {
    let field = record.fields().iter().find(|field| field.name == name)?;
    codes::by_raw(field.codes, record.int(name)).map(|code: &Code| code.key)
}

fn pin_name(model: Option<&'static Model>, index: usize) -> String {
    model
        .and_then(|model| model.pins.get(index))
        .map_or(format!("{}", index + 1), |pin| pin.name().to_owned())
}

/// The name of what drives the motors at a priority level; the pin levels are named as the signal types are.
fn level_key(level: i64) -> &'static str {
    codes::by_raw(codes::PRIORITY_SIGNALS, level).map_or("", |code| code.key)
}

fn is_pin_level(level: i64) -> bool {
    matches!(level_key(level), "pulse" | "analog")
}

fn lower_first(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

/// Stops the script and says whether that was confirmed. A unit without scripts does not answer, which is no failure; then nobody knows
/// whether one runs.
fn stop_script(speaker: Speaker, line: &mut Line<'_>, stop: &mut UnitStop) -> Result<bool, ExchangeError> {
    let retries = line.retries();
    line.set_retries(1);
    let stopped = speaker.ask(line, number::STOP_SCRIPT, &[]);
    line.set_retries(retries);
    stop.script_ended = Some(stopped.is_ok());
    if let Err(error) = stopped {
        pass_on(&error)?;
        stop.still_driven_by
            .push("A script may still run: the controller did not confirm its end.".to_owned());
        return Ok(false);
    }
    Ok(true)
}

/// Whether the buffers are empty at the end; `None` if the unit does not tell.
fn empty_buffers(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<bool>, ExchangeError> {
    match are_empty(speaker, line)? {
        Some(false) => {}
        known => return Ok(known),
    }
    let dropped = speaker.ask(line, number::SPEED_DISTANCE_BOTH, &DROP_BUFFERS);
    speaker.ask(line, number::DUTY_ACCEL_BOTH, &DUTY_ZERO)?;
    dropped?;
    are_empty(speaker, line)
}

fn are_empty(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<bool>, ExchangeError> {
    let Some(reply) = speaker.ask_if_known(line, number::READ_BUFFERS, &[])? else {
        return Ok(None);
    };
    Ok(Some(reply.values.ints().all(|length| is_empty(length, speaker.generation))))
}

/// The clients of 2025 say that 0 means empty; the manual's 0x80 holds everywhere.
fn is_empty(length: i64, generation: Generation) -> bool {
    length == EMPTY || length == 0 && generation == Generation::Gen4
}

/// Passes on what ends a stop: a lost link, and a new Stop.
fn pass_on(error: &ExchangeError) -> Result<(), ExchangeError> {
    if error.is_link_lost() || error.interruption().is_some() { Err(error.clone()) } else { Ok(()) }
}

fn encode(speaker: Speaker, command: u8, values: &[i64]) -> Vec<u8> {
    Request::new(speaker.address, command, values)
        .encode(speaker.generation)
        .expect("the stop packets have one form in every generation, which a test keeps")
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_protocol::packet_serial::Address;

    #[test]
    fn the_stop_bytes_are_the_same_in_every_generation() {
        for generation in Generation::ALL {
            for address in Address::ALL {
                let speaker = Speaker::packets(address, generation);
                let first = Speaker::packets(address, Generation::Gen1);
                assert_eq!(bytes(speaker, true, true), bytes(first, true, true));
            }
        }
    }

    #[test]
    fn stop_is_end_of_script_then_duty_zero_then_empty_buffers_then_duty_zero() {
        let speaker = Speaker::packets(Address::DEFAULT, Generation::Gen1);
        // 0x80, command 54, duty 0, accel 655359 (0009 FFFF), twice, CRC.
        let duty_zero =
            crate::testing::with_crc(&[0x80, 54, 0, 0, 0x00, 0x09, 0xFF, 0xFF, 0, 0, 0x00, 0x09, 0xFF, 0xFF]);
        // 0x80, command 249, CRC.
        let end_script = crate::testing::with_crc(&[0x80, 249]);
        // 0x80, command 43, speed and distance 0 for both, buffer byte 1, CRC.
        let drop = crate::testing::with_crc(&[[0x80, 43].as_slice(), &[0; 16], &[1]].concat());
        assert_eq!(bytes(speaker, false, false), duty_zero);
        assert_eq!(bytes(speaker, true, false), [end_script.clone(), duty_zero.clone()].concat());
        assert_eq!(bytes(speaker, true, true), [end_script, duty_zero.clone(), drop, duty_zero].concat());
    }

    #[test]
    fn no_read_request_can_swallow_the_head_of_a_stop_as_its_own_crc() {
        use brushwork_protocol::packet_serial::{COMMANDS, Direction};
        for address in Address::ALL {
            let reads = COMMANDS.iter().filter(|row| {
                row.forms.iter().any(|form| form.direction == Direction::Read && form.request.is_empty())
            });
            for row in reads {
                let crc = brushwork_protocol::crc::crc16_xmodem(&[address.get(), row.number]);
                for head in [number::STOP_SCRIPT, number::DUTY_ACCEL_BOTH] {
                    let collides =
                        Address::ALL.iter().any(|unit| crc == u16::from_be_bytes([unit.get(), head]));
                    assert!(!collides, "command {} at {address}", row.number);
                }
            }
        }
    }
}

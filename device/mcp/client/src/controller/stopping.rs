//! Stopping a unit: at once without asking, then again with its confirmation, and what can still drive it after that.

use crate::controller::speaker::{Speaker, Wire};
use crate::messages::{McpActMessage, McpDriverMessage, McpRemedyMessage};
use crate::packet::{Ask, encode_error, gate};
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{StopBytes, UnitStop};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::exchange::{Bracketed, transact_between};
use brushwork_link::failure::Failure;
use brushwork_link::messages::ActMessage;
use brushwork_mcp_wire::codes;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::name::{MAX_ACTION, MIN_ACTION, TARGET, TYPE};
use brushwork_mcp_wire::packet_serial::{
    ACK, Generation, Record, ReplyProgress, Request, Typed, commands, number, parse_reply, scale,
};
use std::time::Duration;

/// Duty 0 on both motors at the highest acceleration (command 54).
const DUTY_ZERO: [i64; 4] = [0, scale::MAX_DUTY_ACCEL_RAW, 0, scale::MAX_DUTY_ACCEL_RAW];
/// A move of no distance at no speed that drops what waits in the buffers (command 43 with its buffer byte at 1).
const DROP_BUFFERS: [i64; 5] = [0, 0, 0, 0, 1];
/// Buffer length that means "empty" (MCP manual 2.4.9, command 47).
const EMPTY: i64 = 0x80;

/// An acknowledgement that did not come at once is asked for in the way that no late reply can disturb.
const QUICK_RETRIES: u32 = 1;

/// The packets that stop a unit, back to back: duty 0, since that is what every unit knows and nothing may come before it. A unit
/// discards what follows a packet that it does not know (MCP manual 2.2.4). With `scripts` the script is ended then, with
/// `buffered` the moves that wait are dropped; duty 0 follows once more, since a script may have driven in between and dropping is
/// itself a move.
///
/// Assumed: a duty command ends the move that runs, and leaves open whether it drops those that wait.
pub fn bytes(speaker: Speaker, scripts: bool, buffered: bool) -> StopBytes {
    if let Wire::Objects(place) = speaker.wire {
        // Dropping buffers takes several accesses; the confirmation does that.
        return place.stop_bytes(scripts);
    }
    let end_script = scripts.then_some((number::STOP_SCRIPT, [].as_slice()));
    let drop_buffers = buffered.then_some((number::SPEED_DISTANCE_BOTH, DROP_BUFFERS.as_slice()));
    let duty_zero = encode(speaker, number::DUTY_ACCEL_BOTH, &DUTY_ZERO);
    let with_duty_zero =
        |(command, values): (u8, &[i64])| [encode(speaker, command, values), duty_zero.clone()];
    StopBytes {
        first: vec![duty_zero.clone()],
        after: [end_script, drop_buffers].into_iter().flatten().flat_map(with_duty_zero).collect(),
        gap: Duration::ZERO,
    }
}

/// Stops with confirmation and empties the buffers. `reads` are commands that the unit is known to answer. Only what breaks in and
/// a lost link are errors.
pub fn confirm(
    speaker: Speaker,
    line: &mut Line<'_>,
    reads: &[u8],
    scripts: bool,
    on: &str,
) -> Result<UnitStop, ExchangeError> {
    let stand = |line: &mut Line<'_>| ask_surely(speaker, line, reads, commands::DUTY_ACCEL_BOTH, &DUTY_ZERO);
    let mut stop = UnitStop::new(speaker.id());
    if let Err(error) = stand(line) {
        pass_on(&error)?;
        stop.failures.push(Failure::new(ActMessage::Stop, on, error.message(), McpRemedyMessage::CutPower));
        return Ok(stop);
    }
    stop.confirmed = true;
    if scripts && stop_script(speaker, line, reads, &mut stop)? {
        // It may have driven the motors again since they were told to stand.
        if let Err(error) = stand(line) {
            pass_on(&error)?;
            stop.confirmed = false;
            stop.failures.push(Failure::new(
                ActMessage::Stop,
                on,
                error.message(),
                McpRemedyMessage::CutPower,
            ));
            return Ok(stop);
        }
    }
    match empty_buffers(speaker, line) {
        Ok(empty) => stop.buffers_empty = empty,
        Err(error) => {
            pass_on(&error)?;
            stop.failures.push(Failure::new(
                McpActMessage::EmptyBuffers,
                on,
                error.message(),
                McpRemedyMessage::CutPower,
            ));
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
) -> Result<Vec<Message>, ExchangeError> {
    let Some(priorities) = speaker.ask_if_known(line, commands::READ_PRIORITIES)? else {
        return Ok(Vec::new());
    };
    let levels: Vec<i64> = priorities.values.ints().collect();
    if !levels.iter().any(|level| is_pin_level(*level)) {
        return Ok(Vec::new());
    }
    let Some(signals) = speaker.ask_if_known(line, commands::READ_SIGNALS)? else {
        return Ok(Vec::new());
    };
    let named = signals.values.records().enumerate();
    Ok(named.flat_map(|(index, record)| drivers_of(&pin_name(model, index), &record, &levels)).collect())
}

/// The sentences about one pin.
fn drivers_of<const L: u8>(pin: &str, record: &Record<'_, L>, levels: &[i64]) -> Vec<Message> {
    let kind = record.key(TYPE).unwrap_or_default();
    let mut sentences = Vec::new();
    let target = record.int(TARGET);
    if target != 0 && levels.iter().any(|level| level_key(*level) == kind) {
        let motors =
            brushwork_values::by_raw(codes::SIGNAL_TARGETS, target).map_or("a motor", |code| code.label);
        let (pin, motors) = (pin.to_owned(), lower_first(motors));
        sentences.push(McpDriverMessage::InputDrives { kind, pin, motors }.into());
    }
    let starts = [record.key(MIN_ACTION), record.key(MAX_ACTION)].contains(&Some("run_script"));
    if kind != "none" && starts {
        sentences.push(McpDriverMessage::InputStartsScript { pin: pin.to_owned() }.into());
    }
    sentences
}

fn pin_name(model: Option<&'static Model>, index: usize) -> String {
    model
        .and_then(|model| model.pins.get(index))
        .map_or(format!("{}", index + 1), |pin| pin.name().to_owned())
}

/// The name of what drives the motors at a priority level; the pin levels are named as the signal types are.
fn level_key(level: i64) -> &'static str {
    brushwork_values::by_raw(codes::PRIORITY_SIGNALS, level).map_or("", |code| code.key)
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
fn stop_script(
    speaker: Speaker,
    line: &mut Line<'_>,
    reads: &[u8],
    stop: &mut UnitStop,
) -> Result<bool, ExchangeError> {
    let stopped = ask_surely(speaker, line, reads, commands::STOP_SCRIPT, &[]);
    stop.script_ended = Some(stopped.is_ok());
    if let Err(error) = stopped {
        pass_on(&error)?;
        stop.still_driven_by.push(McpDriverMessage::ScriptMayRun.into());
        return Ok(false);
    }
    Ok(true)
}

/// Sends a command that may be repeated, until its acknowledgement is certain: no byte of a late reply counts as one, and none is taken
/// for a refusal.
fn ask_surely<const L: u8>(
    speaker: Speaker,
    line: &mut Line<'_>,
    reads: &[u8],
    command: Typed<L>,
    values: &[i64],
) -> Result<(), ExchangeError> {
    if matches!(speaker.wire, Wire::Objects(_)) {
        // The answers of a node name the object that they answer for.
        return speaker.ask(line, command, values).map(drop);
    }
    if !line.exchange().may_hear_late_replies() {
        let retries = line.retries();
        line.set_retries(QUICK_RETRIES);
        let asked = speaker.ask(line, command, values);
        line.set_retries(retries);
        match asked {
            Err(error) if error.is_unusable_answer() => {}
            done => return done.map(drop),
        }
    }
    let request = Request::new(speaker.address, command.number(), values);
    let (permit, retries) = (line.permit(), line.retries());
    let ask = Ask { request: &request, generation: speaker.generation, permit, retries };
    let (exchange, watch) = line.parts();
    gate(&ask)?;
    let bytes = request.encode(speaker.generation).map_err(|source| encode_error(&source))?;
    let reads: Vec<_> = reads.iter().map(|read| Request::new(speaker.address, *read, &[])).collect();
    let end_of = |read: usize, bytes: &[u8]| match parse_reply(reads.get(read)?, speaker.generation, bytes) {
        ReplyProgress::Done { used, .. } => Some(used),
        ReplyProgress::NeedMore { .. }
        | ReplyProgress::BadCrc { .. }
        | ReplyProgress::BadAck { .. }
        | ReplyProgress::Malformed { .. } => None,
    };
    let encoded = reads.iter().map(|read| read.encode(speaker.generation).unwrap_or_default()).collect();
    let bracketed = Bracketed { request: &bytes, acknowledgement: ACK, reads: encoded, end_of: &end_of };
    transact_between(exchange, watch, &bracketed)
}

/// Whether the buffers are empty at the end; `None` if the unit does not tell.
fn empty_buffers(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<bool>, ExchangeError> {
    match are_empty(speaker, line)? {
        Some(false) => {}
        known => return Ok(known),
    }
    let dropped = speaker.ask(line, commands::SPEED_DISTANCE_BOTH, &DROP_BUFFERS);
    speaker.ask(line, commands::DUTY_ACCEL_BOTH, &DUTY_ZERO)?;
    dropped?;
    are_empty(speaker, line)
}

fn are_empty(speaker: Speaker, line: &mut Line<'_>) -> Result<Option<bool>, ExchangeError> {
    let Some(reply) = speaker.ask_if_known(line, commands::READ_BUFFERS)? else {
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
    use brushwork_mcp_wire::packet_serial::Address;

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
    fn stop_is_duty_zero_then_end_of_script_and_duty_zero_then_empty_buffers_and_duty_zero() {
        let speaker = Speaker::packets(Address::DEFAULT, Generation::Gen1);
        // 0x80, command 54, duty 0, accel 655359 (0009 FFFF), twice, CRC.
        let duty_zero = crate::tests::testing::with_crc(&[
            0x80, 54, 0, 0, 0x00, 0x09, 0xFF, 0xFF, 0, 0, 0x00, 0x09, 0xFF, 0xFF,
        ]);
        // 0x80, command 249, CRC.
        let end_script = crate::tests::testing::with_crc(&[0x80, 249]);
        // 0x80, command 43, speed and distance 0 for both, buffer byte 1, CRC.
        let drop = crate::tests::testing::with_crc(&[[0x80, 43].as_slice(), &[0; 16], &[1]].concat());
        let bytes = |scripts, buffered| bytes(speaker, scripts, buffered).concat();
        assert_eq!(bytes(false, false), duty_zero);
        assert_eq!(bytes(true, false), [&*duty_zero, &end_script, &duty_zero].concat());
        assert_eq!(bytes(false, true), [&*duty_zero, &drop, &duty_zero].concat());
        assert_eq!(bytes(true, true), [&*duty_zero, &end_script, &duty_zero, &drop, &duty_zero].concat());
    }

    #[test]
    fn no_read_request_can_swallow_the_head_of_a_stop_as_its_own_crc() {
        use brushwork_mcp_wire::packet_serial::{COMMANDS, Direction};
        for address in Address::ALL {
            let reads = COMMANDS.iter().filter(|row| {
                row.forms.iter().any(|form| form.direction == Direction::Read && form.request.is_empty())
            });
            for row in reads {
                let crc = brushwork_mcp_wire::crc::crc16_xmodem(&[address.get(), row.number]);
                for head in [number::STOP_SCRIPT, number::DUTY_ACCEL_BOTH] {
                    let collides =
                        Address::ALL.iter().any(|unit| crc == u16::from_be_bytes([unit.get(), head]));
                    assert!(!collides, "command {} at {address}", row.number);
                }
            }
        }
    }
}

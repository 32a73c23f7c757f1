//! A simulated unit that behaves as an examination says, and what of that it cannot.

use crate::config::config_of;
use crate::sim_spec::UnitSpec;
use brushwork_canopen::NodeId;
use brushwork_family::examine::{CommandFound, Examination, State};
use brushwork_link::capability::Presence;
use brushwork_mcp_sim::controller::{ControllerConfig, FirmwareOptions, Quirks};
use brushwork_mcp_sim::motion::{ControlLaw, GainTiming};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::{Address, Generation, lookup, number};
use brushwork_plant::presets;
use serde_json::{Value, json};
use std::time::Duration;

/// The model that stands in for one that is not known.
const STAND_IN: &str = "mcp266";
/// A line that is later than this is imitated; what is quicker is the computer's own share.
const LATE: Duration = Duration::from_millis(5);
/// Bytes of a reply with a record for each input beside the records, and those of a record of command 147.
const COUNT_AND_CRC: usize = 3;
const SIGNAL_VALUES: usize = 20;
/// Seed of noise.
const SEED: u64 = 1;

/// What such a unit is made of, and what it does otherwise than the examined one, a sentence each.
///
/// # Errors
/// A clause: the examination is of no unit of this family.
pub fn config_like(examination: &Examination) -> Result<(ControllerConfig, Vec<String>), String> {
    let mut unlike = Vec::new();
    let generation = Generation::from_number(examination.unit.generation)
        .ok_or_else(|| format!("there is no firmware generation {}", examination.unit.generation))?;
    let unit = UnitSpec {
        model: model_of(examination, &mut unlike)?,
        generation,
        address: Address::DEFAULT,
        presets: [presets::DEFAULT.to_owned(), presets::DEFAULT.to_owned()],
        node: NodeId::DEFAULT,
    };
    let acknowledges_legacy = examination.value("legacy_acknowledgement") != Some(&json!(false));
    let text = Some(examination.unit.version_text.clone());
    let config = ControllerConfig {
        law: law_of(examination, &mut unlike),
        options: FirmwareOptions { text, acknowledges_legacy, ..FirmwareOptions::default() },
        quirks: quirks_of(examination, unit.model, generation, &mut unlike),
        ..config_of(&unit, SEED)
    };
    habits(examination, &mut unlike);
    Ok((config, unlike))
}

fn model_of(examination: &Examination, unlike: &mut Vec<String>) -> Result<&'static Model, String> {
    let named = &examination.unit.version_text;
    if let Some(model) = models::identify(named) {
        return Ok(model);
    }
    unlike.push(format!(
        "\"{named}\" is no model that is known here: ratings, pins and motors are those of an MCP266."
    ));
    models::lookup(STAND_IN).ok_or_else(|| "there is no model to stand in".to_owned())
}

fn law_of(examination: &Examination, unlike: &mut Vec<String>) -> ControlLaw {
    let usual = ControlLaw::default();
    let found = |key: &str| examination.value(key);
    let timing = found("loop_rate");
    let rate_hz = timing.and_then(|timing| timing["rate_hz"].as_f64()).map(|rate| rate.round() as u32);
    let base = if rate_hz == Some(625) { ControlLaw::at_625_hz() } else { usual };
    let rate_hz = rate_hz.unwrap_or(usual.rate_hz);
    let step = found("speed_step").and_then(Value::as_f64).filter(|step| *step > 0.0);
    let per_tick = |answer: Option<&Value>| match answer.and_then(|timing| timing["per_tick"].as_bool()) {
        Some(false) => Some(GainTiming::PerSecond),
        Some(true) => Some(GainTiming::PerTick),
        None => None,
    };
    let gain_timing = per_tick(timing).unwrap_or(usual.gain_timing);
    let derivative_timing = per_tick(found("derivative")).filter(|timing| *timing != gain_timing);
    for (key, what) in [
        ("loop_rate", "at which rate its loop runs, and over what I sums"),
        ("position_scale", "the scale of its position gains"),
        ("derivative", "over which time D takes a change"),
        ("feed_forward", "whether it adds the feed-forward"),
        ("speed_step", "over which time it counts the unfiltered speed"),
    ] {
        if found(key).is_none() {
            unlike.push(format!("The examination does not say {what}; it is as in every simulated unit."));
        }
    }
    ControlLaw {
        rate_hz,
        gain_timing,
        derivative_timing,
        position_gain_scale: found("position_scale")
            .and_then(Value::as_f64)
            .unwrap_or(usual.position_gain_scale),
        feed_forward: found("feed_forward").and_then(Value::as_bool).unwrap_or(usual.feed_forward),
        raw_speed_ticks: step.map_or(base.raw_speed_ticks, |step| {
            (f64::from(rate_hz) / step).round().clamp(1.0, 1_000.0) as u16
        }),
        ..base
    }
}

fn quirks_of(
    examination: &Examination,
    model: &Model,
    generation: Generation,
    unlike: &mut Vec<String>,
) -> Quirks {
    let mut quirks =
        Quirks { silent: silent_guesses(examination).into_iter().collect(), ..Quirks::default() };
    if inputs(examination).is_some_and(|inputs| inputs != model.pins.len()) {
        unlike.push(format!(
            "Its inputs and outputs are others than those of the {} that is known here.",
            model.name
        ));
    }
    let shortest_ms = examination.line.lateness.map_or(0.0, |late| late.shortest_ms);
    quirks.late = Some(milliseconds(shortest_ms)).filter(|late| *late > LATE).unwrap_or_default();
    for reply in &examination.commands {
        let row = lookup(reply.command);
        let is_known = row.is_some_and(|row| row.is_known_to(model.family));
        let own = row.and_then(|row| row.form(generation)).filter(|_| is_known);
        match reply.presence {
            Presence::Absent | Presence::Refused => {
                quirks.silent.insert(reply.command);
            }
            Presence::Present | Presence::Slow => match other_layout(reply, generation) {
                None if own.is_some() && !reply.generations.is_empty() => {}
                Some(other) if is_known => {
                    quirks.layouts.insert(reply.command, other);
                }
                None | Some(_) => {
                    let what = &reply.title;
                    unlike.push(format!(
                        "Command {} ({what}) is answered as no simulated unit can.",
                        reply.command
                    ));
                }
            },
        }
        if reply.presence == Presence::Slow {
            let took = milliseconds(reply.quickest_ms.unwrap_or_default());
            quirks.slow.insert(reply.command, took.saturating_sub(milliseconds(shortest_ms)));
        }
    }
    quirks
}

/// Reads by guess that were not answered.
fn silent_guesses(examination: &Examination) -> Vec<u8> {
    let mut silent: Vec<u8> = Vec::new();
    if let Some(Value::Object(widths)) = examination.value("guessed_reads") {
        let unanswered = widths.iter().filter(|(_, bytes)| bytes.is_null());
        silent.extend(unanswered.filter_map(|(command, _)| command.parse::<u8>().ok()));
    }
    for (key, command) in
        [("can_errors", number::READ_CAN_ERRORS), ("can_dictionary", number::READ_CAN_DICTIONARY)]
    {
        silent.extend(examination.value(key).filter(|value| value.is_null()).map(|_| command));
    }
    silent
}

/// Inputs that the unit has, by the length of the reply that tells them all.
fn inputs(examination: &Examination) -> Option<usize> {
    let bytes = examination.command(number::READ_SIGNAL_VALUES)?.reply_bytes?;
    Some(bytes.checked_sub(COUNT_AND_CRC)? / SIGNAL_VALUES)
}

/// The generation whose layout a reply has, where that is not the unit's own.
fn other_layout(reply: &CommandFound, own: Generation) -> Option<Generation> {
    let is_own = reply.generations.contains(&own.number());
    reply.generations.first().copied().filter(|_| !is_own).and_then(Generation::from_number)
}

fn milliseconds(ms: f64) -> Duration {
    Duration::from_secs_f64(ms.clamp(0.0, 10_000.0) / 1e3)
}

/// What simulated units do in one way alone.
fn habits(examination: &Examination, unlike: &mut Vec<String>) {
    let silent = json!({ "answer": "silent", "changed": false });
    let taken = json!({ "answer": "acknowledged", "changed": false });
    for (key, own, otherwise) in [
        ("appended_crc", json!(true), "It takes no read with a CRC behind it."),
        ("idle_buffer", json!([128, 128]), "Its empty buffers read otherwise."),
        ("tick", json!(1_000.0), "It counts its running time otherwise."),
        ("acknowledgement", json!("FF"), "It acknowledges writes otherwise."),
        ("longer_payload", silent.clone(), "It takes writes that are too long otherwise."),
        ("shorter_payload", silent, "It takes writes that are too short otherwise."),
        ("doubled_address", taken, "It takes writes whose address comes twice otherwise."),
        (
            "save_restarts",
            json!({ "restarts": false, "acknowledged": true }),
            "It does otherwise when it saves.",
        ),
    ] {
        if examination.value(key).is_some_and(|value| *value != own) {
            unlike.push(format!("{otherwise} A simulated unit cannot."));
        }
    }
    let is_open = |key: &str| examination.answer(key).is_some_and(|answer| answer.state == State::NotAsked);
    if is_open("acknowledgement") && is_open("loop_rate") {
        unlike.push(
            "The unit was only read from; how it takes writes and moves is as in every simulated unit."
                .to_owned(),
        );
    }
}

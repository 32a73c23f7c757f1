//! A RoboClaw's settings judged together: what contradicts what, and what can set a motor in motion by itself.

use crate::messages::RoboClawMessage;
use brushwork_link::Message;
use brushwork_link::settings::{SettingValue, SettingsImage, SettingsTable};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::roboclaw::{
    ADDRESS_OR_SWITCHES, BAUD_OR_OPTIONS, CONTROL_MODES, ConfigWord, ControlMode,
};
use brushwork_values::Code;

use super::pins::{Conflict, ConflictKind, Lookup, choice};
use crate::model_of;

const MODE: &str = "roboclaw.config.mode";
const BATTERY: &str = "roboclaw.config.battery";
const OPTIONS: &str = "roboclaw.config.baud";
const SWITCHES: &str = "roboclaw.config.address";

/// Whether the table is of a RoboClaw.
pub(super) fn is_of(table: &SettingsTable) -> bool {
    model_of(table.subject()).is_some_and(|model| model.family == Family::RoboClaw)
}

/// Every contradiction among the settings that are known.
pub(super) fn conflicts(table: &SettingsTable, get: Lookup<'_>) -> Vec<Conflict> {
    let mut found = Vec::new();
    found.extend(own_limits_overruled(get));
    found.extend(MOTORS.into_iter().filter_map(|motor| never_homes(table, get, motor)));
    found.extend(["s1", "s2"].into_iter().filter_map(|input| no_range(get, input)));
    found
}

/// The motors with the pin of their home switch.
const MOTORS: [(usize, &str); 2] = [(1, "s4"), (2, "s5")];

/// A number of cells takes the place of the unit's own limits.
fn own_limits_overruled(get: Lookup<'_>) -> Option<Conflict> {
    let cells = choice(get, BATTERY).filter(|mode| *mode != "user")?;
    let how = match cells {
        "auto" => "detected at power-up".to_owned(),
        cells => format!("set to {}", cells.replace('_', " ")),
    };
    Some(Conflict {
        kind: ConflictKind::Overruled,
        keys: vec![
            BATTERY.to_owned(),
            "limits.main_battery.min_volts".to_owned(),
            "limits.main_battery.max_volts".to_owned(),
        ],
        sentence: RoboClawMessage::OwnLimitsOverruled { how }.into(),
    })
}

/// A home switch that its motor is to look for, and no time or no duty to do so.
fn never_homes(table: &SettingsTable, get: Lookup<'_>, (motor, pin): (usize, &str)) -> Option<Conflict> {
    let pin = format!("roboclaw.pin.{pin}");
    choice(get, &pin).filter(|function| function.starts_with("home_auto"))?;
    let is_zero = |field: &str| {
        let key = format!("motor{motor}.home.{field}");
        (table.row(&key).is_some() && get(&key) == Some(SettingValue::Number(0.0))).then_some(key)
    };
    let missing: Vec<String> = ["timeout_seconds", "duty"].into_iter().filter_map(is_zero).collect();
    let zero = match missing.as_slice() {
        [] => return None,
        [one] if one.ends_with("duty") => "homing duty is 0",
        [_] => "homing time-out is 0",
        _ => "homing duty and time-out are 0",
    };
    let sentence = RoboClawMessage::NeverHomes { motor, missing: zero }.into();
    let keys = std::iter::once(pin).chain(missing).collect();
    Some(Conflict { kind: ConflictKind::ActionNeverFires, keys, sentence })
}

/// An input whose range leaves nothing; a range of zeros is the unit's own.
fn no_range(get: Lookup<'_>, input: &str) -> Option<Conflict> {
    let key = |field: &str| format!("roboclaw.{input}.{field}");
    let value = |field: &str| get(&key(field))?.int();
    let (min, center, max) = (value("min")?, value("center")?, value("max")?);
    let is_sound = (min, center, max) == (0, 0, 0) || (min < center && center < max);
    (!is_sound).then(|| Conflict {
        kind: ConflictKind::NoRange,
        keys: ["center", "min", "max"].map(key).to_vec(),
        sentence: RoboClawMessage::NoInputRange { input: input.to_uppercase(), min, center, max }.into(),
    })
}

/// What `changes` lets happen by itself.
pub(super) fn dangers(after: &SettingsImage, changes: &SettingsImage) -> Vec<Message> {
    let get: Lookup<'_> = &|key| after.get(key);
    let mut dangers = Vec::new();
    dangers.extend(inputs_command(get, changes));
    dangers.extend(runs_on(get, changes));
    dangers.extend(MOTORS.into_iter().filter_map(|motor| homes(get, changes, motor)));
    dangers.extend((1..=2).filter_map(|motor| turns_the_other_way(get, changes, motor)));
    dangers.extend(changes.get("roboclaw.config.swap_encoders").map(|_| RoboClawMessage::EncodersSwapped));
    dangers.into_iter().map(Message::from).collect()
}

/// From the next power-up S1 and S2 drive, and bits of the configuration word mean other things.
fn inputs_command(get: Lookup<'_>, changes: &SettingsImage) -> Option<RoboClawMessage> {
    let mode = changes.get(MODE)?.choice()?;
    let signal = match mode {
        "rc" => "pulses",
        "analog" => "voltages",
        "simple_serial" => return Some(RoboClawMessage::BytesCommand),
        _ => return None,
    };
    let words = |of: fn(ConfigWord) -> String| inputs_word(get).map_or_else(|| "unknown".to_owned(), of);
    let (options, switches) = (words(ConfigWord::options_text), words(ConfigWord::switches_text));
    Some(RoboClawMessage::InputsCommand { signal, options, switches })
}

/// What the configuration word says of the inputs.
fn inputs_word(get: Lookup<'_>) -> Option<ConfigWord> {
    let raw = |key: &str, codes: &[Code]| {
        let chosen = choice(get, key)?;
        u16::try_from(codes.iter().find(|code| code.key == chosen)?.raw).ok()
    };
    let (mode, options) = (raw(MODE, CONTROL_MODES)?, raw(OPTIONS, BAUD_OR_OPTIONS)?);
    Some(ConfigWord(mode | options << 5 | raw(SWITCHES, ADDRESS_OR_SWITCHES)? << 8))
}

/// With MCU and no time-out a motor goes on for ever on the last pulse.
fn runs_on(get: Lookup<'_>, changes: &SettingsImage) -> Option<RoboClawMessage> {
    let is_new = [MODE, OPTIONS, SWITCHES].iter().any(|key| changes.get(key).is_some());
    let word = inputs_word(get)?;
    let goes_on = word.mode() == ControlMode::Rc && word.is_for_mcu() && !word.has_rc_timeout();
    (is_new && goes_on).then_some(RoboClawMessage::RunsOn)
}

/// A motor that looks for its home switch at power-up.
fn homes(get: Lookup<'_>, changes: &SettingsImage, (motor, pin): (usize, &str)) -> Option<RoboClawMessage> {
    let pin = format!("roboclaw.pin.{pin}");
    let keys = [pin.clone(), format!("motor{motor}.home.duty"), format!("motor{motor}.home.timeout_seconds")];
    let is_new = keys.iter().any(|key| changes.get(key).is_some());
    let is_auto = choice(get, &pin).is_some_and(|function| function.starts_with("home_auto"));
    let timeout_s = get(&keys[2]).and_then(SettingValue::number).filter(|seconds| *seconds > 0.0)?;
    (is_new && is_auto).then_some(RoboClawMessage::Homes { motor, timeout_s })
}

/// Motor and encoder have to be turned round together, or a closed loop runs away.
fn turns_the_other_way(get: Lookup<'_>, changes: &SettingsImage, motor: usize) -> Option<RoboClawMessage> {
    let keys = ["motor_reversed", "reversed"].map(|field| format!("motor{motor}.encoder.{field}"));
    let is_new = keys.iter().any(|key| changes.get(key).is_some());
    let [is_motor, is_encoder] = keys.map(|key| get(&key) == Some(SettingValue::Bool(true)));
    is_new.then(|| {
        let what = match (is_motor, is_encoder) {
            (true, true) => RoboClawMessage::BothTurned { motor },
            (true, false) => RoboClawMessage::MotorTurned { motor },
            (false, true) => RoboClawMessage::EncoderTurned { motor },
            (false, false) => RoboClawMessage::NoneTurned { motor },
        };
        RoboClawMessage::TurnedRound { what: what.into() }
    })
}

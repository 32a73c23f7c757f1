//! What a port, pin or output does at present, in a few words for lists.

use crate::model_of;
use crate::settings::pins::mode::PinMode;
use crate::settings::pins::values::{Lookup, PinValues, choice};
use brushwork_link::settings::Group;
use brushwork_link::settings::SettingValue;
use brushwork_link::settings::SettingsTable;

/// The current function of number `number` (from 1) of a group of ports, pins or outputs; `None` while it is not known.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn function_text(table: &SettingsTable, get: Lookup<'_>, group: Group, number: usize) -> Option<String> {
    match group {
        Group::PINS => pin(table, get, number),
        Group::STREAMS => stream(table, get, number),
        Group::OUTPUTS => output(table, get, number),
        _ => None,
    }
}

fn pin(table: &SettingsTable, get: Lookup<'_>, number: usize) -> Option<String> {
    let mode = PinMode::of(get, number)?;
    let values = PinValues::new(get, number);
    let mut text = match (mode, holder(table, get, number)) {
        (PinMode::None, Some(holder)) => return Some(format!("{holder} in use")),
        (PinMode::None, None) => return Some(mode.label().to_owned()),
        _ => mode.label().to_owned(),
    };
    match values.choice("target") {
        Some("motor1") => text += ", M1",
        Some("motor2") => text += ", M2",
        Some("both") => text += ", M1 + M2",
        _ => {}
    }
    let acts = |end: &str| values.choice(end).is_some_and(|action| action != "none");
    if acts("min_action") || acts("max_action") {
        text += ", action";
    }
    Some(text)
}

/// The short name of the UART that is in use on the pin.
fn holder(table: &SettingsTable, get: Lookup<'_>, number: usize) -> Option<String> {
    let uart = model_of(table.subject())?.pins.get(number - 1)?.uart()?;
    (choice(get, &format!("stream.ttl{uart}.type"))? != "disabled").then(|| format!("UART{uart}"))
}

fn stream(table: &SettingsTable, get: Lookup<'_>, number: usize) -> Option<String> {
    let row = table.group(Group::STREAMS).find(|row| {
        row.pattern == "stream.{n}.type" && row.instance.as_ref().is_some_and(|one| one.number == number)
    })?;
    let kind = choice(get, &row.key)?;
    let shared = match row.key.as_str() {
        "stream.rs232.type" => "CANopen",
        "stream.ttl1.type" => "I2C master",
        _ => "Disabled",
    };
    let text = if kind == "disabled" { shared.to_owned() } else { row.format(SettingValue::Choice(kind)) };
    Some(text)
}

fn output(table: &SettingsTable, get: Lookup<'_>, number: usize) -> Option<String> {
    let key = format!("dout.{number}.action");
    let mut text = table.row(&key)?.format(get(&key)?);
    if get(&format!("dout.{number}.inverted")) == Some(SettingValue::Bool(true)) {
        text += ", inverted";
    }
    Some(text)
}

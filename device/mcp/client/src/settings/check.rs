//! Settings judged together: pairs that contradict each other, and changes that can set a motor in motion.

use crate::messages::McpSettingsMessage;
use brushwork_link::Message;
use brushwork_link::settings::SettingValue;
use brushwork_link::settings::SettingsImage;
use brushwork_link::settings::SettingsTable;

use super::pins::{self, Conflict, Lookup};
use super::roboclaw;

/// Rows of which the first must not be above the second.
pub(super) const ORDERED_PAIRS: &[(&str, &str)] = &[
    ("limits.main_battery.min_volts", "limits.main_battery.max_volts"),
    ("limits.logic_battery.min_volts", "limits.logic_battery.max_volts"),
    ("motor1.position.min", "motor1.position.max"),
    ("motor2.position.min", "motor2.position.max"),
];

/// The row that drives one motor with both channels.
const BRIDGE_CHANNELS: &str = "unit.bridge_channels";

/// A script autorun delay below this switches autorun off (MCP manual 2.3.1, command 246).
pub const SHORTEST_AUTORUN_MS: i64 = 100;

/// Every contradiction among the settings that are known.
pub fn conflicts(table: &SettingsTable, get: Lookup<'_>) -> Vec<Conflict> {
    if roboclaw::is_of(table) { roboclaw::conflicts(table, get) } else { pins::conflicts(table, get) }
}

/// What `changes` lets happen by itself: an input that commands a motor, a script that starts at power-up.
pub(super) fn dangers(table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<Message> {
    let mut dangers = Vec::new();
    for pin in 1..=table.subject().pins {
        dangers.extend(input_danger(table, after, changes, pin));
    }
    if let (Some(SettingValue::Int(delay_ms)), Some(_)) =
        (after.get("script.autorun_delay"), changes.get("script.autorun_delay"))
        && delay_ms >= SHORTEST_AUTORUN_MS
    {
        dangers.push(McpSettingsMessage::Autorun { delay_ms }.into());
    }
    dangers.extend(arming_obstacle(after, changes));
    dangers.extend(torque_control(table, after, changes));
    dangers.extend(bridging(changes).map(Message::from));
    dangers.extend(roboclaw::dangers(after, changes));
    dangers
}

/// One motor on both channels, or one on each: the wiring must fit before power is put on it (MCP manual 1.8).
fn bridging(changes: &SettingsImage) -> Option<McpSettingsMessage> {
    Some(match changes.get(BRIDGE_CHANNELS)? == SettingValue::Bool(true) {
        true => McpSettingsMessage::Bridged,
        false => McpSettingsMessage::Separated,
    })
}

/// Without the serial input in a priority level this program may not move a motor.
fn arming_obstacle(after: &SettingsImage, changes: &SettingsImage) -> Option<Message> {
    let levels = ["priority.1", "priority.2", "priority.3"];
    let is_new = levels.iter().any(|level| changes.get(level).is_some());
    let has_serial = levels.iter().any(|level| after.get(level) == Some(SettingValue::Choice("serial")));
    (is_new && !has_serial).then(|| McpSettingsMessage::SerialNowhere.into())
}

/// Inductance and resistance together change what duty commands mean (MCP manual 1.2.11, 3.1 MOTORL).
fn torque_control(table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<Message> {
    let reported = |motor: usize| {
        let keys = [format!("motor{motor}.inductance_henries"), format!("motor{motor}.resistance_ohms")];
        let is_new = keys.iter().any(|key| changes.get(key).is_some());
        let is_set = |key: &String| {
            table.row(key).is_some() && after.get(key).is_some_and(|value| value != SettingValue::Number(0.0))
        };
        (is_new && keys.iter().all(is_set)).then(|| McpSettingsMessage::TorqueControl { motor }.into())
    };
    (1..=2).filter_map(reported).collect()
}

/// Whether a pin begins to command motors: it has a target, its kind of input is in a priority level, and one
/// of the two is new.
fn input_danger(
    table: &SettingsTable,
    after: &SettingsImage,
    changes: &SettingsImage,
    pin: usize,
) -> Option<Message> {
    let key = |field: &str| format!("pin.{pin}.{field}");
    let choice = |key: &str| after.get(key)?.choice();
    let (kind, target) = (choice(&key("type"))?, choice(&key("target"))?);
    let level = (1..=3).find(|level| choice(&format!("priority.{level}")) == Some(kind))?;
    let level_key = format!("priority.{level}");
    let is_new = [key("type"), key("target"), level_key].iter().any(|key| changes.get(key).is_some());
    if target == "none" || !is_new {
        return None;
    }
    let target_row = table.row(&key("target"))?;
    let pin = table.subject().pin_name(pin - 1);
    let target = target_row.format(SettingValue::Choice(target)).to_lowercase();
    Some(McpSettingsMessage::InputCommands { pin, target, kind, level }.into())
}

//! SYS..., DOUT, PRIORITY..., VERSION and I2CERROR.

use super::super::ScriptHost;
use super::Binding;
use crate::priority::Source;
use brushwork_mcp_wire::packet_serial::status::Condition;
use std::time::Duration;

pub const BINDINGS: &[Binding] = &[
    ("VERSION", |host, _| version(host), None),
    ("SYSSTATUS", |host, _| status(host), None),
    ("SYSCLK", |host, _| (host.up_for.as_nanos() * CLOCK_MHZ / 1000) as u32, None),
    ("SYSUSTICK", |host, _| host.up_for.as_micros() as u32, None),
    ("SYSTICK", |host, _| ticks(host.up_for), None),
    ("SYSTEMP", |host, _| host.unit.temperature_raw(0) as u32, None),
    ("SYSTEMP2", |host, _| second_temperature(host), None),
    ("SYSMBAT", |host, _| host.unit.main_battery_raw() as u32, None),
    ("SYSLBAT", |host, _| host.unit.logic_battery_raw() as u32, None),
    (
        "SYSMINMBAT",
        |host, _| host.unit.settings.battery.main_min_tenths.into(),
        Some(|host, _, value| host.unit.settings.battery.main_min_tenths = value as u16),
    ),
    (
        "SYSMAXMBAT",
        |host, _| host.unit.settings.battery.main_max_tenths.into(),
        Some(|host, _, value| host.unit.settings.battery.main_max_tenths = value as u16),
    ),
    (
        "SYSMINLBAT",
        |host, _| host.unit.settings.battery.logic_min_tenths.into(),
        Some(|host, _, value| host.unit.settings.battery.logic_min_tenths = value as u16),
    ),
    (
        "SYSMAXLBAT",
        |host, _| host.unit.settings.battery.logic_max_tenths.into(),
        Some(|host, _, value| host.unit.settings.battery.logic_max_tenths = value as u16),
    ),
    (
        "DOUTACTION",
        |host, index| host.unit.settings.outputs.get(index).map_or(0, |output| output.action.into()),
        Some(|host, index, value| {
            host.unit.set_output_action(index, value as u8);
        }),
    ),
    (
        "DOUT",
        |host, index| host.unit.output_is_on(index).into(),
        Some(|host, index, value| host.unit.override_output(index, value != 0)),
    ),
    ("PRIORITYLEVEL", |host, _| level(host) as u32, None),
    ("PRIORITYACTIVE", |host, _| rising_mask(host), None),
    ("I2CERROR", |host, _| host.unit.script.i2c.error() as u32, None),
];

/// Rate of SYSCLK (MCP manual 3.1.15).
const CLOCK_MHZ: u128 = 160;

/// The bits of SYSSTATUS as its page prints them, which are not those of command 90: there is one for a low main battery, and the page
/// of SYSMINMBAT has it set below the limit that is a warning for command 90.
const STATUS_BITS: [(Condition, u32); 14] = [
    (Condition::M1CurrentError, 0x0001),
    (Condition::M2CurrentError, 0x0002),
    (Condition::M1OverCurrentWarning, 0x0001),
    (Condition::M2OverCurrentWarning, 0x0002),
    (Condition::EStop, 0x0004),
    (Condition::Temperature2Error, 0x0010),
    (Condition::MainBatteryHighError, 0x0020),
    (Condition::MainBatteryLowError, 0x0040),
    (Condition::MainBatteryLowWarning, 0x0040),
    (Condition::LogicBatteryHighError, 0x0080),
    (Condition::LogicBatteryLowError, 0x0100),
    (Condition::MainBatteryHighWarning, 0x0800),
    (Condition::Temperature1Warning, 0x4000),
    (Condition::Temperature1Error, 0x8000),
];

/// Milliseconds as SYSTICK counts them; it begins again after 49 days.
pub fn ticks(up_for: Duration) -> u32 {
    up_for.as_millis() as u32
}

fn status(host: &ScriptHost<'_>) -> u32 {
    let conditions = host.unit.conditions();
    let bits = STATUS_BITS.iter().filter(|(condition, _)| conditions.contains(*condition));
    bits.fold(0, |word, (_, bit)| word | bit)
}

/// The version as two bytes: "1.0.4" is 0x0100.
fn version(host: &ScriptHost<'_>) -> u32 {
    let text = host.unit.options.version_number(host.unit.model).to_owned();
    let mut parts = text.split('.').map(|part| part.parse::<u8>().unwrap_or(0));
    let mut next = || u32::from(parts.next().unwrap_or(0));
    next() << 8 | next()
}

fn second_temperature(host: &ScriptHost<'_>) -> u32 {
    if host.unit.model.second_temperature { host.unit.temperature_raw(1) as u32 } else { 0 }
}

/// The level in force from 0. Assumed: with no input active it is the last level that is not disabled, to which the time-outs lead.
fn level(host: &ScriptHost<'_>) -> usize {
    let levels = host.unit.settings.priority;
    let last = levels.iter().rposition(|raw| Source::from_wire(*raw).is_some());
    host.unit.source.map_or(last.unwrap_or(0), |(level, _)| level)
}

/// The inputs whose activity would raise the level.
fn rising_mask(host: &ScriptHost<'_>) -> u32 {
    let above = host.unit.source.map_or(host.unit.settings.priority.len(), |(level, _)| level);
    let sources = host.unit.settings.priority[..above].iter().filter_map(|raw| Source::from_wire(*raw));
    sources.fold(0, |mask, source| {
        mask | match source {
            Source::Serial => 1,
            Source::Pulse => 2,
            Source::Analog => 4,
        }
    })
}

//! SIGNAL...: settings and values of the input pins, numbered as in command 143.
//!
//! SIGNALTARGET counts motors from 0 where command 143 has 0 for none: here 0 and 1 are the motors as its page says, 2 is both and 255
//! none, which the page leaves out. SIGNALMINACTION and SIGNALMAXACTION have the bits of their page in every generation; in the first,
//! whose wire has a number instead, a combination that has no number is not taken.

use super::super::ScriptHost;
use super::Binding;
use super::system::ticks;
use crate::settings::SignalSettings;
use crate::signals::{ActionBits, Signal, SignalValues};
use brushwork_mcp_wire::packet_serial::Generation;

/// A setting that a script reads and writes as it lies on the wire.
macro_rules! setting {
    ($name:literal, $field:ident) => {
        (
            $name,
            |host, index| of(host, index, |signal| signal.$field),
            Some(|host, index, value| set(host, index, |signal| signal.$field = value)),
        )
    };
    ($name:literal, $field:ident, signed) => {
        (
            $name,
            |host, index| of(host, index, |signal| signal.$field as u32),
            Some(|host, index, value| set(host, index, |signal| signal.$field = value as i32)),
        )
    };
}

pub const BINDINGS: &[Binding] = &[
    ("SIGNALACTIVE", is_active, None),
    (
        "SIGNALTYPE",
        |host, index| of(host, index, |signal| signal.kind.into()),
        Some(|host, index, value| {
            set(host, index, |signal| {
                signal.kind = value as u8;
                signal.digital &= signal.kind == 0;
            });
        }),
    ),
    (
        "SIGNALTARGET",
        |host, index| of(host, index, |signal| signal.target.wrapping_sub(1).into()),
        Some(|host, index, value| set(host, index, |signal| signal.target = (value as u8).wrapping_add(1))),
    ),
    (
        "SIGNALMINACTION",
        |host, index| action(host, index, |signal| signal.min_action),
        Some(|host, index, value| set_action(host, index, value, |signal| &mut signal.min_action)),
    ),
    (
        "SIGNALMAXACTION",
        |host, index| action(host, index, |signal| signal.max_action),
        Some(|host, index, value| set_action(host, index, value, |signal| &mut signal.max_action)),
    ),
    (
        "SIGNALLOWPASS",
        |host, index| of(host, index, |signal| signal.low_pass.into()),
        Some(|host, index, value| set(host, index, |signal| signal.low_pass = value as u8)),
    ),
    setting!("SIGNALTIMEOUT", timeout_ms),
    ("SIGNALTICK", last_activity, None),
    ("SIGNALITER", |host, index| host.unit.signals.get(index).map_or(0, Signal::updates), None),
    setting!("SIGNALLOADHOME", load_home, signed),
    setting!("SIGNALMIN", min, signed),
    setting!("SIGNALMAX", max, signed),
    setting!("SIGNALCENTER", center, signed),
    setting!("SIGNALDEADBAND", deadband),
    setting!("SIGNALPOWEREXP", power_exp_raw, signed),
    setting!("SIGNALPOWERMIN", power_min),
    ("SIGNALMODE", |host, index| of(host, index, |signal| signal.mode.into()), None),
    setting!("SIGNALMINOUT", min_output, signed),
    setting!("SIGNALMAXOUT", max_output, signed),
    ("SIGNALPOSITION", |host, index| values(host, index).position as u32, None),
    ("SIGNALPERCENT", |host, index| values(host, index).percent as u32, None),
    ("SIGNALSPEED", |host, index| values(host, index).speed as u32, None),
    ("SIGNALSPEEDS", |host, index| values(host, index).average_speed as u32, None),
    ("SIGNALCOMMAND", |host, index| values(host, index).command as u32, None),
];

fn of(host: &ScriptHost<'_>, index: usize, read: impl Fn(&SignalSettings) -> u32) -> u32 {
    host.unit.settings.signals.get(index).map_or(0, read)
}

fn set(host: &mut ScriptHost<'_>, index: usize, set: impl FnOnce(&mut SignalSettings)) {
    if let Some(signal) = host.unit.settings.signals.get_mut(index) {
        set(signal);
    }
}

fn both<'a>(host: &'a ScriptHost<'_>, index: usize) -> Option<(&'a Signal, &'a SignalSettings)> {
    Some((host.unit.signals.get(index)?, host.unit.settings.signals.get(index)?))
}

fn values(host: &ScriptHost<'_>, index: usize) -> SignalValues {
    both(host, index).map(|(signal, settings)| signal.values(settings)).unwrap_or_default()
}

fn is_active(host: &mut ScriptHost<'_>, index: usize) -> u32 {
    let now = host.unit.now;
    both(host, index).is_some_and(|(signal, settings)| signal.is_active(settings, now)).into()
}

fn last_activity(host: &mut ScriptHost<'_>, index: usize) -> u32 {
    let at = host.unit.signals.get(index).and_then(Signal::last_activity);
    at.map_or(0, |at| ticks(at.saturating_sub(host.unit.booted_at)))
}

fn action(host: &ScriptHost<'_>, index: usize, read: impl Fn(&SignalSettings) -> u16) -> u32 {
    let one_byte = host.unit.generation == Generation::Gen1;
    of(host, index, |signal| ActionBits::from_raw(read(signal), one_byte).bits().into())
}

fn set_action(
    host: &mut ScriptHost<'_>,
    index: usize,
    value: u32,
    place: impl Fn(&mut SignalSettings) -> &mut u16,
) {
    let one_byte = host.unit.generation == Generation::Gen1;
    if let Some(raw) = ActionBits::from_bits(value as u16).to_raw(one_byte) {
        set(host, index, |signal| *place(signal) = raw);
    }
}

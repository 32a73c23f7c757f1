//! STREAM...: the four streams of scripts. The CAN stream has the rate of the CAN port, no type but "script", and a time-out that is
//! forgotten with the power, since command 145 has no place for one.

use super::super::streams::{CAN, port_of};
use super::super::{ScriptHost, ScriptState};
use super::Binding;
use super::system::ticks;
use crate::settings::StreamSettings;
use std::time::Duration;

pub const BINDINGS: &[Binding] = &[
    (
        "STREAMTYPE",
        |host, index| settings(host, index).map_or(0, |stream| stream.kind.into()),
        Some(|host, index, value| set(host, index, |stream| stream.kind = value as u8)),
    ),
    (
        "STREAMRATE",
        |host, index| match settings(host, index) {
            Some(stream) => stream.rate_bps,
            None if index == CAN => host.unit.settings.unit.can_rate_bps,
            None => 0,
        },
        Some(|host, index, value| {
            if index == CAN {
                host.unit.settings.unit.can_rate_bps = value;
            } else {
                set(host, index, |stream| stream.rate_bps = value);
            }
        }),
    ),
    (
        "STREAMTIMEOUT",
        |host, index| timeout_ms(host, index),
        Some(|host, index, value| {
            if index == CAN {
                host.unit.script.can_timeout_ms = value;
            } else {
                set(host, index, |stream| stream.timeout_ms = value);
            }
        }),
    ),
    ("STREAMTICK", |host, index| last_byte_at(host, index).map_or(0, ticks), None),
    ("STREAMISBUSY", |host, index| is_busy(host, index).into(), None),
    ("STREAMCOUNT", |host, index| waiting(&host.unit.script, index), None),
];

fn settings<'a>(host: &'a ScriptHost<'_>, index: usize) -> Option<&'a StreamSettings> {
    host.unit.settings.streams.get(port_of(index)?.index())
}

fn set(host: &mut ScriptHost<'_>, index: usize, set: impl FnOnce(&mut StreamSettings)) {
    if let Some(stream) = port_of(index).and_then(|port| host.unit.settings.streams.get_mut(port.index())) {
        set(stream);
    }
}

fn timeout_ms(host: &ScriptHost<'_>, index: usize) -> u32 {
    settings(host, index).map_or(host.unit.script.can_timeout_ms, |stream| stream.timeout_ms)
}

/// Time since power-up at which the last byte came, whatever the stream's type.
fn last_byte_at(host: &ScriptHost<'_>, index: usize) -> Option<Duration> {
    match port_of(index) {
        Some(port) => {
            host.unit.ports.last_bytes[port.index()].map(|at| at.saturating_sub(host.unit.booted_at))
        }
        None => host.unit.script.streams.last_byte_at(index),
    }
}

/// Whether a byte has come within the time-out. Assumed: a time-out of 0 never runs out, as among the priority levels.
fn is_busy(host: &ScriptHost<'_>, index: usize) -> bool {
    let timeout = Duration::from_millis(timeout_ms(host, index).into());
    let in_time = |at: Duration| timeout.is_zero() || host.up_for.saturating_sub(at) <= timeout;
    last_byte_at(host, index).is_some_and(in_time)
}

fn waiting(script: &ScriptState, index: usize) -> u32 {
    u32::try_from(script.streams.count(index)).unwrap_or(u32::MAX)
}

//! Which kind of input commands the motors: priority levels and the time-outs that move between them (MCP manual, commands
//! 139 and 145).
//!
//! Assumed: a time-out of 0 never runs out; a stream that is not disabled counts as serial activity whatever its mode; with
//! Serial in no level, motion commands are acknowledged and have no effect.

use crate::settings::StreamSettings;
use std::time::Duration;

/// A kind of control input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Packet serial on any stream.
    Serial,
    /// Pulse inputs with a motor as target.
    Pulse,
    /// Analog inputs with a motor as target.
    Analog,
}

impl Source {
    /// From the number of command 139; 0 and anything unknown are no source.
    pub fn from_wire(raw: u8) -> Option<Self> {
        match raw {
            1 => Some(Self::Serial),
            2 => Some(Self::Pulse),
            3 => Some(Self::Analog),
            _ => None,
        }
    }
}

/// The sources that are active right now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Activity {
    /// A byte came within its stream's time-out.
    pub serial: bool,
    /// A targeted pulse input sees pulses.
    pub pulse: bool,
    /// An analog input has a motor as target.
    pub analog: bool,
}

impl Activity {
    fn has(self, source: Source) -> bool {
        match source {
            Source::Serial => self.serial,
            Source::Pulse => self.pulse,
            Source::Analog => self.analog,
        }
    }
}

/// The highest level whose source is active: its index, 0 for level 1, and the source.
pub fn select(levels: [u8; 3], activity: Activity) -> Option<(usize, Source)> {
    levels
        .into_iter()
        .enumerate()
        .filter_map(|(level, raw)| Some((level, Source::from_wire(raw)?)))
        .find(|(_, source)| activity.has(*source))
}

/// Whether any stream has seen a byte within its time-out.
pub fn serial_is_active(
    streams: &[StreamSettings; 5],
    last_bytes: &[Option<Duration>; 5],
    now: Duration,
) -> bool {
    const DISABLED: u8 = 2;
    streams.iter().zip(last_bytes).any(|(stream, last)| {
        let timeout = Duration::from_millis(stream.timeout_ms.into());
        let in_time = |last: &Duration| timeout.is_zero() || now.saturating_sub(*last) <= timeout;
        stream.kind != DISABLED && last.as_ref().is_some_and(in_time)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_level_with_an_active_source_wins() {
        let all = Activity { serial: true, pulse: true, analog: true };
        assert_eq!(select([1, 2, 3], all), Some((0, Source::Serial)));
        assert_eq!(select([1, 2, 3], Activity { serial: false, ..all }), Some((1, Source::Pulse)));
        assert_eq!(select([3, 2, 1], all), Some((0, Source::Analog)));
        assert_eq!(select([0, 0, 1], all), Some((2, Source::Serial)));
        assert_eq!(select([0, 0, 0], all), None);
        assert_eq!(select([1, 2, 3], Activity::default()), None);
        assert_eq!(select([9, 1, 0], all), Some((1, Source::Serial)));
    }

    #[test]
    fn a_stream_is_active_until_its_own_time_out_has_passed() {
        let streams =
            std::array::from_fn(|_| StreamSettings { timeout_ms: 100, ..StreamSettings::default() });
        let mut last = [None; 5];
        let at = |ms| Duration::from_millis(ms);
        assert!(!serial_is_active(&streams, &last, at(0)));
        last[2] = Some(at(1000));
        assert!(serial_is_active(&streams, &last, at(1100)));
        assert!(!serial_is_active(&streams, &last, at(1101)));
    }

    #[test]
    fn a_time_out_of_zero_never_ends_and_a_disabled_stream_never_counts() {
        let mut streams: [StreamSettings; 5] =
            std::array::from_fn(|_| StreamSettings { timeout_ms: 0, ..StreamSettings::default() });
        let last = [Some(Duration::ZERO), None, None, None, None];
        assert!(serial_is_active(&streams, &last, Duration::from_secs(1_000_000)));
        streams[0].kind = 2;
        assert!(!serial_is_active(&streams, &last, Duration::ZERO));
    }
}

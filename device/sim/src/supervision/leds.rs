//! The three LEDs as a function of time (MCP manual 1.6).
//!
//! Assumed: the lengths of the flashes, and that of several conditions the one nearest the top of table 1.6.3 shows.

use super::{EStop, Protection};
use serde::Serialize;
use std::time::Duration;

/// How long all three LEDs light after power up.
pub const POWER_UP_BLINK: Duration = Duration::from_millis(500);
/// One flash and the gap after it.
const FLASH: Duration = Duration::from_millis(200);
/// Dark time between two counts of flashes.
const PAUSE: Duration = Duration::from_millis(1000);
/// STAT1 goes dark for this long when a byte arrives.
const DATA_BLINK: Duration = Duration::from_millis(30);
/// STAT1 and STAT2 take turns at this rate while the unit waits for new firmware.
const BOOT_TURN: Duration = Duration::from_millis(250);

/// Which LEDs are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Leds {
    /// Green STAT1.
    pub stat1: bool,
    /// Green STAT2.
    pub stat2: bool,
    /// Red ERR.
    pub err: bool,
}

/// What the LEDs show.
#[derive(Clone, Copy, Debug, Default)]
pub struct LedInputs {
    /// Time since power up.
    pub up_for: Duration,
    /// Time since the last received byte.
    pub since_last_byte: Option<Duration>,
    /// Either bridge drives.
    pub driving: bool,
    /// The unit waits for new firmware.
    pub in_boot_mode: bool,
    /// The emergency stop.
    pub estop: EStop,
    /// Limits.
    pub protection: Protection,
}

/// The LEDs at one moment.
pub fn leds(inputs: &LedInputs) -> Leds {
    let protection = &inputs.protection;
    if inputs.up_for < POWER_UP_BLINK || inputs.estop.is_tripped() {
        return Leds { stat1: true, stat2: true, err: true };
    }
    if inputs.in_boot_mode {
        let first = (inputs.up_for.as_millis() / BOOT_TURN.as_millis()).is_multiple_of(2);
        return Leds { stat1: first, stat2: !first, err: false };
    }
    if protection.temperature_error || protection.temperature_2_error {
        return Leds { err: flashes(inputs.up_for, 1), ..Leds::default() };
    }
    Leds {
        stat1: inputs.since_last_byte.is_none_or(|since| since >= DATA_BLINK),
        stat2: inputs.driving,
        err: error_led(inputs.up_for, protection),
    }
}

fn error_led(up_for: Duration, protection: &Protection) -> bool {
    let count =
        [(protection.logic_high_error, 3), (protection.logic_low_error, 4), (protection.main_high_error, 5)]
            .into_iter()
            .find_map(|(present, count)| present.then_some(count));
    match count {
        Some(count) => flashes(up_for, count),
        None => is_steady(protection),
    }
}

fn is_steady(protection: &Protection) -> bool {
    protection.temperature_warning
        || protection.temperature_2_warning
        || protection.over_current.contains(&true)
        || protection.main_high_warning
        || protection.main_low_warning
}

/// Whether an LED that flashes `count` times, pauses and starts again is lit.
fn flashes(up_for: Duration, count: u32) -> bool {
    let period = FLASH * 2 * count + PAUSE;
    let phase_ms = up_for.as_millis() % period.as_millis();
    phase_ms < (FLASH * 2 * count).as_millis() && (phase_ms / FLASH.as_millis()).is_multiple_of(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATER: Duration = Duration::from_secs(100);

    /// Rising edges of ERR during one repetition of a code of `count` flashes.
    fn err_flashes(inputs: &LedInputs, count: u32) -> usize {
        let period_ms = u64::from(count) * 400 + 1000;
        let start = LATER.as_millis() as u64 / period_ms * period_ms;
        let lit = |ms: u64| leds(&LedInputs { up_for: Duration::from_millis(ms), ..*inputs }).err;
        (start..start + period_ms).filter(|ms| lit(*ms) && !lit(ms - 1)).count()
    }

    fn with(protection: Protection) -> LedInputs {
        LedInputs { up_for: LATER, protection, ..LedInputs::default() }
    }

    #[test]
    fn all_three_blink_after_power_up_and_in_an_emergency_stop() {
        let all = Leds { stat1: true, stat2: true, err: true };
        assert_eq!(leds(&LedInputs::default()), all);
        let mut inputs = with(Protection::default());
        assert_eq!(leds(&inputs), Leds { stat1: true, stat2: false, err: false });
        inputs.estop.update(true, crate::supervision::EStopReset::Hardware);
        assert_eq!(leds(&inputs), all);
    }

    #[test]
    fn each_error_has_its_number_of_flashes() {
        for (protection, count) in [
            (Protection { temperature_error: true, ..Protection::default() }, 1),
            (Protection { logic_high_error: true, ..Protection::default() }, 3),
            (Protection { logic_low_error: true, ..Protection::default() }, 4),
            (Protection { main_high_error: true, ..Protection::default() }, 5),
        ] {
            assert_eq!(err_flashes(&with(protection), count), count as usize, "{protection:?}");
        }
    }

    #[test]
    fn warnings_light_err_steadily() {
        for protection in [
            Protection { temperature_warning: true, ..Protection::default() },
            Protection { over_current: [false, true], ..Protection::default() },
            Protection { main_high_warning: true, ..Protection::default() },
            Protection { main_low_warning: true, ..Protection::default() },
        ] {
            for ms in (0..5000).step_by(50) {
                let up_for = LATER + Duration::from_millis(ms);
                assert!(leds(&LedInputs { up_for, ..with(protection) }).err, "{protection:?}");
            }
        }
    }

    #[test]
    fn stat1_blinks_with_data_and_stat2_shows_a_driving_bridge() {
        let idle = with(Protection::default());
        let receiving = LedInputs { since_last_byte: Some(Duration::ZERO), driving: true, ..idle };
        assert_eq!(leds(&receiving), Leds { stat1: false, stat2: true, err: false });
        assert!(leds(&LedInputs { since_last_byte: Some(DATA_BLINK), ..idle }).stat1);
    }

    #[test]
    fn in_boot_mode_the_green_leds_take_turns() {
        let at = |ms| {
            leds(&LedInputs { up_for: Duration::from_millis(ms), in_boot_mode: true, ..LedInputs::default() })
        };
        assert_eq!(at(1000), Leds { stat1: true, stat2: false, err: false });
        assert_eq!(at(1250), Leds { stat1: false, stat2: true, err: false });
    }
}

//! What a controller's three LEDs show (MCP manual 1.6.1 and 1.6.3), as a function of time.
//!
//! Assumed: the lengths of the flashes, that of several conditions the one nearest the top of table 1.6.3 shows, and that a
//! condition which the table does not name leaves ERR dark.

use std::time::Duration;

use super::status::{Condition, Conditions};

/// One flash and the gap after it.
const FLASH: Duration = Duration::from_millis(200);
/// Dark time between two counts of flashes.
const PAUSE: Duration = Duration::from_millis(1000);
/// STAT1 and STAT2 take turns at this rate while the unit waits for new firmware.
const BOOT_TURN: Duration = Duration::from_millis(250);

/// What one LED does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Light {
    /// It is dark.
    #[default]
    Dark,
    /// It is lit.
    Lit,
    /// It flashes so many times, pauses and starts again.
    Flashes(u32),
    /// It takes turns with another, lit first or second.
    TakesTurns {
        /// Whether it begins.
        first: bool,
    },
}

/// What the three LEDs say together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlinkCode {
    /// Green STAT1. Where it is lit it goes dark for a moment with each byte received (1.6.1).
    pub stat1: Light,
    /// Green STAT2: either bridge drives (1.6.1).
    pub stat2: Light,
    /// Red ERR.
    pub err: Light,
    /// The row of table 1.6.3 in words.
    pub meaning: &'static str,
}

impl Light {
    /// Whether it is lit at a moment of an endless time.
    pub fn is_lit(self, at: Duration) -> bool {
        match self {
            Self::Dark => false,
            Self::Lit => true,
            Self::Flashes(count) => {
                let flashing = FLASH * 2 * count;
                let phase_ms = at.as_millis() % (flashing + PAUSE).as_millis();
                phase_ms < flashing.as_millis() && (phase_ms / FLASH.as_millis()).is_multiple_of(2)
            }
            Self::TakesTurns { first } => (at.as_millis() / BOOT_TURN.as_millis()).is_multiple_of(2) == first,
        }
    }

    /// Time until it starts again, the pause included; `None` for what does not count.
    pub fn period(self) -> Option<Duration> {
        match self {
            Self::Flashes(count) => Some(FLASH * 2 * count + PAUSE),
            Self::Dark | Self::Lit | Self::TakesTurns { .. } => None,
        }
    }

    /// Time until it next changes; `None` if it does not.
    pub fn changes_in(self, at: Duration) -> Option<Duration> {
        let to_next = |step: Duration| {
            let over_ns = at.as_nanos() % step.as_nanos();
            step - Duration::from_nanos(u64::try_from(over_ns).unwrap_or(0))
        };
        match self {
            Self::Dark | Self::Lit => None,
            // Flashes, gaps and pauses are all whole flashes long.
            Self::Flashes(_) => Some(to_next(FLASH)),
            Self::TakesTurns { .. } => Some(to_next(BOOT_TURN)),
        }
    }

    /// In words: "lit", "dark", "flashes 3 times".
    pub fn words(self) -> String {
        match self {
            Self::Dark => "dark".to_owned(),
            Self::Lit => "lit".to_owned(),
            Self::Flashes(1) => "flashes once".to_owned(),
            Self::Flashes(count) => format!("flashes {count} times"),
            Self::TakesTurns { .. } => "takes turns".to_owned(),
        }
    }
}

/// What the LEDs show under these conditions, with a bridge that drives or not.
pub fn blink_code(conditions: Conditions, driving: bool) -> BlinkCode {
    use Condition as C;
    let has = |condition| conditions.contains(condition);
    let any = |rows: &[Condition]| rows.iter().any(|condition| has(*condition));
    if has(C::EStop) {
        let lit = Light::Lit;
        return BlinkCode {
            stat1: lit,
            stat2: lit,
            err: lit,
            meaning: "emergency stop: the motors are braked",
        };
    }
    if any(&[C::Temperature1Error, C::Temperature2Error]) {
        let dark = Light::Dark;
        let meaning = "over 100 °C: the motors freewheel while it lasts";
        return BlinkCode { stat1: dark, stat2: dark, err: Light::Flashes(1), meaning };
    }
    let (err, meaning) = if has(C::LogicBatteryHighError) {
        (Light::Flashes(3), "logic battery high: the motors freewheel until a restart")
    } else if has(C::LogicBatteryLowError) {
        (Light::Flashes(4), "logic battery low: the motors freewheel until a restart")
    } else if has(C::MainBatteryHighError) {
        (Light::Flashes(5), "main battery high: the motors are braked until a restart")
    } else if any(&[C::Temperature1Warning, C::Temperature2Warning]) {
        (Light::Lit, "over 85 °C: the current limit is reduced")
    } else if any(&[C::M1OverCurrentWarning, C::M2OverCurrentWarning]) {
        (Light::Lit, "over current: motor power is limited")
    } else if has(C::MainBatteryHighWarning) {
        (Light::Lit, "main battery high: the motors are braked while it lasts")
    } else if has(C::MainBatteryLowWarning) {
        (Light::Lit, "main battery low: the motors freewheel while it lasts")
    } else {
        (Light::Dark, "neither warning nor error that has a code")
    };
    let stat2 = if driving { Light::Lit } else { Light::Dark };
    BlinkCode { stat1: Light::Lit, stat2, err, meaning }
}

/// What the LEDs show while the unit waits for new firmware.
pub const BOOT_CODE: BlinkCode = BlinkCode {
    stat1: Light::TakesTurns { first: true },
    stat2: Light::TakesTurns { first: false },
    err: Light::Dark,
    meaning: "boot mode: the unit waits for new firmware",
};

#[cfg(test)]
mod tests {
    use super::*;

    const LATER: Duration = Duration::from_secs(100);

    fn code(conditions: &[Condition]) -> BlinkCode {
        blink_code(conditions.iter().copied().collect(), false)
    }

    /// Rising edges during one repetition of a code of `count` flashes.
    fn flashes(light: Light, count: u32) -> usize {
        let period_ms = u64::from(count) * 400 + 1000;
        let start = LATER.as_millis() as u64 / period_ms * period_ms;
        let lit = |ms: u64| light.is_lit(Duration::from_millis(ms));
        (start..start + period_ms).filter(|ms| lit(*ms) && !lit(ms - 1)).count()
    }

    #[test]
    fn table_1_6_3_row_by_row() {
        use Condition as C;
        let all = code(&[C::EStop, C::LogicBatteryHighError]);
        assert_eq!([all.stat1, all.stat2, all.err], [Light::Lit; 3]);
        let hot = blink_code([C::Temperature2Error].into_iter().collect(), true);
        assert_eq!([hot.stat1, hot.stat2], [Light::Dark; 2]);
        for (condition, count) in [
            (C::Temperature1Error, 1),
            (C::LogicBatteryHighError, 3),
            (C::LogicBatteryLowError, 4),
            (C::MainBatteryHighError, 5),
        ] {
            let err = code(&[condition]).err;
            assert_eq!(err, Light::Flashes(count));
            assert_eq!(flashes(err, count), count as usize, "{condition}");
        }
        for condition in [
            C::Temperature1Warning,
            C::M2OverCurrentWarning,
            C::MainBatteryHighWarning,
            C::MainBatteryLowWarning,
        ] {
            assert_eq!(code(&[condition]).err, Light::Lit, "{condition}");
        }
        assert_eq!(code(&[]).err, Light::Dark);
        assert_ne!(BOOT_CODE.stat1.is_lit(LATER), BOOT_CODE.stat2.is_lit(LATER));
    }

    #[test]
    fn stat2_shows_a_bridge_that_drives() {
        assert_eq!(blink_code(Conditions::NONE, true).stat2, Light::Lit);
        assert_eq!(blink_code(Conditions::NONE, false).stat2, Light::Dark);
        assert_eq!(Light::Flashes(3).words(), "flashes 3 times");
    }

    #[test]
    fn a_light_is_never_asked_for_more_often_than_it_changes() {
        assert_eq!(Light::Lit.changes_in(LATER), None);
        let mut at = Duration::from_millis(50);
        for _ in 0..100 {
            let step = Light::Flashes(3).changes_in(at).unwrap();
            assert!(step <= FLASH && step > Duration::ZERO);
            at += step;
            assert_eq!(at.as_millis() % FLASH.as_millis(), 0);
        }
    }
}

//! The bits of STATUS as indicators, and the status row with a place for each.

use brushwork_link::device::Indicator;
use brushwork_motion_mind_wire::{Mode, status};
use brushwork_values::Severity;

macro_rules! indicators {
    ($(#[$of:meta])* $name:ident: $($bit:ident $key:literal $title:literal $severity:ident;)*) => {
        $(#[$of])*
        pub static $name: &[Indicator] = &[$(Indicator {
            mask: status::$bit as u32,
            key: $key,
            short: stringify!($bit),
            title: $title,
            severity: Severity::$severity,
        }),*];
    };
}

/// The table with what the inputs POS_LIM and NEG_LIM stand for.
macro_rules! with_inputs {
    ($(#[$of:meta])* $name:ident: $negative:literal $positive:literal $severity:ident) => {
        indicators! {
            $(#[$of])* $name:
            BRAKE "brake" "Brake input at ground: the bridge is off" Error;
            TEMPFAULT "temp_fault" "Too hot: the bridge is off until it has cooled to 80 °C" Error;
            CURRENTLIMIT "current_limit" "Current above AMPSLIMIT: the drive is reduced" Warning;
            BADRC "bad_rc" "R/C pulse missing, too short or too long" Warning;
            NEGLIMIT "negative_limit" $negative $severity;
            POSLIMIT "positive_limit" $positive $severity;
            VNLIMIT "virtual_negative_limit" "At the negative virtual limit" Warning;
            VPLIMIT "virtual_positive_limit" "At the positive virtual limit" Warning;
            PWMLIMIT "pwm_limit" "Drive at PWMLIMIT" Signal;
            INDEX "index" "Index input at ground" Signal;
            INPOSITION "in_position" "The motor is where it was sent" Signal;
        }
    };
}

with_inputs! {
    /// Every bit of STATUS (Motion Mind manual, figure 22). What takes the drive away is an error, what limits it a warning, the rest is
    /// nothing but news.
    INDICATORS: "Negative limit input at ground" "Positive limit input at ground" Warning
}

with_inputs! {
    /// The same in modes 1 and 2, where those two inputs are switches that say what to do (Motion Mind manual 4.4, 4.5).
    INDICATORS_OF_SWITCHES:
    "ANA_MODE or BTN_DN at ground, on the pin of the negative limit" "ANA_DIR or BTN_UP at ground, on the pin of the positive limit" Signal
}

/// What the bits of STATUS mean in a mode, or in one that is not known.
pub fn in_mode(mode: Option<Mode>) -> &'static [Indicator] {
    match mode {
        Some(Mode::Analog | Mode::Buttons) => INDICATORS_OF_SWITCHES,
        Some(
            Mode::RadioControl
            | Mode::Serial
            | Mode::SerialPid
            | Mode::AnalogPid
            | Mode::FactoryRestore
            | Mode::FactoryTest,
        )
        | None => INDICATORS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_motion_mind_wire::STATUS_BITS;

    #[test]
    fn every_bit_of_status_is_an_indicator_by_its_name() {
        for indicators in [INDICATORS, INDICATORS_OF_SWITCHES] {
            assert_eq!(indicators.len(), STATUS_BITS.len());
            for bit in STATUS_BITS {
                let indicator =
                    indicators.iter().find(|indicator| indicator.mask == u32::from(bit.mask())).unwrap();
                assert_eq!(indicator.short, bit.name);
            }
        }
    }

    #[test]
    fn what_is_a_switch_in_a_mode_is_no_limit_that_warns() {
        let worst = |mode| {
            let inputs =
                in_mode(Some(mode)).iter().filter(|bit| ["NEGLIMIT", "POSLIMIT"].contains(&bit.short));
            inputs.map(|bit| bit.severity).collect::<Vec<_>>()
        };
        for mode in [Mode::Analog, Mode::Buttons] {
            assert_eq!(worst(mode), [Severity::Signal; 2], "{mode:?}");
        }
        for mode in [Mode::RadioControl, Mode::Serial, Mode::SerialPid, Mode::AnalogPid] {
            assert_eq!(worst(mode), [Severity::Warning; 2], "{mode:?}");
        }
    }
}

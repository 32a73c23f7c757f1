//! The flags of the library, the inputs, and what the display shows, in one word of indicators.

use brushwork_link::device::{Indicator, PlaceState, StatusPlace, StatusReport};
use brushwork_motorvator_wire::host::flags;
use brushwork_values::Severity;

/// Where what lies in the word: the flags, the inputs that have changed, whether the library is there, and the display.
const INPUTS_SHIFT: u32 = 8;
const DISPLAY_SHIFT: u32 = 16;
const NIBBLE: u8 = 0x0F;
/// The word while the library does not answer.
pub const NO_LIBRARY: u32 = 1 << 12;

/// The word of what the library told.
#[must_use]
pub fn word_of(flags: u8, ([left, right], changed): ([u8; 2], u8)) -> u32 {
    u32::from(flags)
        | u32::from(changed & NIBBLE) << INPUTS_SHIFT
        | u32::from(left) << DISPLAY_SHIFT
        | u32::from(right) << (DISPLAY_SHIFT + 8)
}

/// The characters of the display; `None` while nobody tells them.
#[must_use]
pub fn display_of(word: u32) -> Option<[u8; 2]> {
    let [_, _, left, right] = word.to_le_bytes();
    (word & NO_LIBRARY == 0).then_some([left, right])
}

macro_rules! indicators {
    ($($mask:expr, $key:literal $short:literal $title:literal $severity:ident;)*) => {
        /// The bits that say something to people.
        pub static INDICATORS: &[Indicator] = &[$(Indicator {
            mask: $mask,
            key: $key,
            short: $short,
            title: $title,
            severity: Severity::$severity,
        }),*];
    };
}

indicators! {
    NO_LIBRARY, "no_library" "HOST" "The host library does not answer" Warning;
    flags::DEAD_MAN as u32, "dead_man" "DEAD" "No order came for 250 ms: the library has stopped the motors" Warning;
    flags::STEPPER_1 as u32, "stepper_1" "STEP1" "Stepper 1 moves" Signal;
    flags::STEPPER_2 as u32, "stepper_2" "STEP2" "Stepper 2 moves" Signal;
    1 << INPUTS_SHIFT, "input_1" "IN1" "On/off input 1 has changed since the library began" Signal;
    1 << (INPUTS_SHIFT + 1), "input_2" "IN2" "On/off input 2 has changed since the library began" Signal;
    1 << (INPUTS_SHIFT + 2), "input_3" "IN3" "On/off input 3 has changed since the library began" Signal;
    1 << (INPUTS_SHIFT + 3), "input_4" "IN4" "On/off input 4 has changed since the library began" Signal;
}

/// The status row, in the order of the table.
#[must_use]
pub fn status_row(report: Option<&StatusReport>) -> Vec<StatusPlace> {
    let state = |indicator: &Indicator| match report {
        None => PlaceState::Unknown,
        Some(report) if report.word & indicator.mask == 0 => PlaceState::Clear,
        Some(_) => PlaceState::Active(indicator.severity),
    };
    let place = |indicator: &'static Indicator| StatusPlace {
        short: indicator.short,
        title: indicator.title,
        state: state(indicator),
    };
    INDICATORS.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_indicator_has_a_bit_of_its_own_and_the_display_comes_back() {
        for (index, indicator) in INDICATORS.iter().enumerate() {
            assert_eq!(indicator.mask.count_ones(), 1, "{}", indicator.key);
            assert_eq!(INDICATORS.iter().position(|other| other.mask == indicator.mask), Some(index));
        }
        let word = word_of(flags::STEPPER_2, (*b"O3", 0b0100));
        assert_eq!(display_of(word), Some(*b"O3"));
        let report = StatusReport::new(1, std::time::Duration::ZERO, word, INDICATORS);
        assert_eq!(report.active().map(|on| on.key).collect::<Vec<_>>(), ["stepper_2", "input_3"]);
        assert_eq!(display_of(NO_LIBRARY), None);
    }
}

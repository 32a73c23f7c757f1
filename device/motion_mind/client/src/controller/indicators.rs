//! The bits of STATUS as indicators, and the status row with a place for each.

use brushwork_link::device::{Indicator, PlaceState, StatusPlace, StatusReport};
use brushwork_motion_mind_wire::status;
use brushwork_values::Severity;

/// Every bit of STATUS (Motion Mind manual, figure 22). What takes the drive away is an error, what limits it a warning, the rest is
/// nothing but news.
pub static INDICATORS: &[Indicator] = &[
    bit(status::BRAKE, "brake", "BRAKE", "Brake input at ground: the bridge is off", Severity::Error),
    bit(
        status::TEMPFAULT,
        "temp_fault",
        "TEMPFAULT",
        "Too hot: the bridge is off until it has cooled to 80 °C",
        Severity::Error,
    ),
    bit(
        status::CURRENTLIMIT,
        "current_limit",
        "CURRENTLIMIT",
        "Current above AMPSLIMIT: the drive is reduced",
        Severity::Warning,
    ),
    bit(status::BADRC, "bad_rc", "BADRC", "R/C pulse missing, too short or too long", Severity::Warning),
    bit(status::NEGLIMIT, "negative_limit", "NEGLIMIT", "Negative limit input at ground", Severity::Warning),
    bit(status::POSLIMIT, "positive_limit", "POSLIMIT", "Positive limit input at ground", Severity::Warning),
    bit(
        status::VNLIMIT,
        "virtual_negative_limit",
        "VNLIMIT",
        "At the negative virtual limit",
        Severity::Warning,
    ),
    bit(
        status::VPLIMIT,
        "virtual_positive_limit",
        "VPLIMIT",
        "At the positive virtual limit",
        Severity::Warning,
    ),
    bit(status::PWMLIMIT, "pwm_limit", "PWMLIMIT", "Drive at PWMLIMIT", Severity::Signal),
    bit(status::INDEX, "index", "INDEX", "Index input at ground", Severity::Signal),
    bit(status::INPOSITION, "in_position", "INPOSITION", "The motor is where it was sent", Severity::Signal),
];

const fn bit(
    mask: u16,
    key: &'static str,
    short: &'static str,
    title: &'static str,
    severity: Severity,
) -> Indicator {
    Indicator { mask: mask as u32, key, short, title, severity }
}

/// The status row, in the order of the word.
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
    use brushwork_motion_mind_wire::STATUS_BITS;

    #[test]
    fn every_bit_of_status_is_an_indicator_by_its_name() {
        assert_eq!(INDICATORS.len(), STATUS_BITS.len());
        for bit in STATUS_BITS {
            let indicator =
                INDICATORS.iter().find(|indicator| indicator.mask == u32::from(bit.mask())).unwrap();
            assert_eq!(indicator.short, bit.name);
        }
    }
}

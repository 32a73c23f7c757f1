//! The bits of STATUS as indicators, and the status row with a place for each.

use brushwork_link::device::Indicator;
use brushwork_motion_mind_wire::status;
use brushwork_values::Severity;

macro_rules! indicators {
    ($($bit:ident $key:literal $title:literal $severity:ident;)*) => {
        /// Every bit of STATUS (Motion Mind manual, figure 22). What takes the drive away is an error, what limits it a warning, the rest is
        /// nothing but news.
        pub static INDICATORS: &[Indicator] = &[$(Indicator {
            mask: status::$bit as u32,
            key: $key,
            short: stringify!($bit),
            title: $title,
            severity: Severity::$severity,
        }),*];
    };
}

indicators! {
    BRAKE "brake" "Brake input at ground: the bridge is off" Error;
    TEMPFAULT "temp_fault" "Too hot: the bridge is off until it has cooled to 80 °C" Error;
    CURRENTLIMIT "current_limit" "Current above AMPSLIMIT: the drive is reduced" Warning;
    BADRC "bad_rc" "R/C pulse missing, too short or too long" Warning;
    NEGLIMIT "negative_limit" "Negative limit input at ground" Warning;
    POSLIMIT "positive_limit" "Positive limit input at ground" Warning;
    VNLIMIT "virtual_negative_limit" "At the negative virtual limit" Warning;
    VPLIMIT "virtual_positive_limit" "At the positive virtual limit" Warning;
    PWMLIMIT "pwm_limit" "Drive at PWMLIMIT" Signal;
    INDEX "index" "Index input at ground" Signal;
    INPOSITION "in_position" "The motor is where it was sent" Signal;
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

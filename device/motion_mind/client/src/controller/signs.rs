//! The bits of STATUS as signs.

use brushwork_link::device::Sign;
use brushwork_mcp_wire::packet_serial::status::Severity;
use brushwork_motion_mind_wire::status;

/// Every bit of STATUS (Motion Mind manual, figure 22). What takes the drive away is an error, what limits it a warning, the rest is
/// nothing but news.
pub static SIGNS: &[Sign] = &[
    sign(status::BRAKE, "brake", "BRAKE", "Brake input at ground: the bridge is off", Severity::Error),
    sign(
        status::TEMPFAULT,
        "temp_fault",
        "TEMPFAULT",
        "Too hot: the bridge is off until it has cooled to 80 °C",
        Severity::Error,
    ),
    sign(
        status::CURRENTLIMIT,
        "current_limit",
        "CURRENTLIMIT",
        "Current above AMPSLIMIT: the drive is reduced",
        Severity::Warning,
    ),
    sign(status::BADRC, "bad_rc", "BADRC", "R/C pulse missing, too short or too long", Severity::Warning),
    sign(status::NEGLIMIT, "negative_limit", "NEGLIMIT", "Negative limit input at ground", Severity::Warning),
    sign(status::POSLIMIT, "positive_limit", "POSLIMIT", "Positive limit input at ground", Severity::Warning),
    sign(
        status::VNLIMIT,
        "virtual_negative_limit",
        "VNLIMIT",
        "At the negative virtual limit",
        Severity::Warning,
    ),
    sign(
        status::VPLIMIT,
        "virtual_positive_limit",
        "VPLIMIT",
        "At the positive virtual limit",
        Severity::Warning,
    ),
    sign(status::PWMLIMIT, "pwm_limit", "PWMLIMIT", "Drive at PWMLIMIT", Severity::Signal),
    sign(status::INDEX, "index", "INDEX", "Index input at ground", Severity::Signal),
    sign(status::INPOSITION, "in_position", "INPOSITION", "The motor is where it was sent", Severity::Signal),
];

const fn sign(
    mask: u16,
    key: &'static str,
    short: &'static str,
    title: &'static str,
    severity: Severity,
) -> Sign {
    Sign { mask: mask as u32, key, short, title, severity }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_motion_mind_wire::STATUS_BITS;

    #[test]
    fn every_bit_of_status_is_a_sign_by_its_name() {
        assert_eq!(SIGNS.len(), STATUS_BITS.len());
        for bit in STATUS_BITS {
            let sign = SIGNS.iter().find(|sign| sign.mask == u32::from(bit.mask())).unwrap();
            assert_eq!(sign.short, bit.name);
        }
    }
}

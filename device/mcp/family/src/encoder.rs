//! What kind of encoder a motor has, as the controller's settings say.

use brushwork_link::settings::SettingValue;
use brushwork_mcp_client::settings::PinMode;
use brushwork_tuning::axis::EncoderClass;
use brushwork_values::Motor;

/// Bit of a RoboClaw's encoder mode that stands for an absolute encoder (public clients, 2015-2025, command 92).
const ABSOLUTE_BIT: i64 = 1;

/// The settings that tell it: where to look in a list of keys.
#[must_use]
pub fn is_asked(key: &str) -> bool {
    key.ends_with(".encoder.mode")
        || key.ends_with(".encoder.pin")
        || key.starts_with("pin.") && (key.ends_with(".type") || key.ends_with(".digital"))
}

/// The class of a motor's encoder by commands 91 to 93 and, on an MCP, by the type of the pin that they name (command 144). `None`
/// where the controller does not tell. Whether an absolute encoder wraps no setting says.
#[must_use]
pub fn class(get: &dyn Fn(&str) -> Option<SettingValue>, motor: Motor) -> Option<EncoderClass> {
    let number = |key: &str| match get(&format!("motor{}.encoder.{key}", motor.index() + 1)) {
        Some(SettingValue::Int(number)) => Some(number),
        _ => None,
    };
    if let Some(mode) = number("mode") {
        let is_absolute = mode & ABSOLUTE_BIT != 0;
        return Some(if is_absolute { EncoderClass::Absolute } else { EncoderClass::Quadrature });
    }
    let pin = usize::try_from(number("pin")?).ok()? + 1;
    match PinMode::of(get, pin)? {
        PinMode::Analog | PinMode::Pulse => Some(EncoderClass::Absolute),
        PinMode::Encoder | PinMode::None => Some(EncoderClass::Quadrature),
        PinMode::Digital | PinMode::PacketSerial => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn of(held: &[(&str, SettingValue)], motor: Motor) -> Option<EncoderClass> {
        let held: BTreeMap<&str, SettingValue> = held.iter().copied().collect();
        class(&|key| held.get(key).copied(), motor)
    }

    #[test]
    fn a_roboclaw_tells_by_a_bit_of_its_mode() {
        for (mode, wanted) in
            [(0, EncoderClass::Quadrature), (1, EncoderClass::Absolute), (0x81, EncoderClass::Absolute)]
        {
            let held = [("motor2.encoder.mode", SettingValue::Int(mode))];
            assert_eq!(of(&held, Motor::M2), Some(wanted), "mode {mode:#x}");
            assert_eq!(of(&held, Motor::M1), None);
        }
    }

    #[test]
    fn an_mcp_tells_by_the_type_of_the_pin() {
        for (kind, wanted) in [
            ("analog", Some(EncoderClass::Absolute)),
            ("pulse", Some(EncoderClass::Absolute)),
            ("encoder", Some(EncoderClass::Quadrature)),
            ("none", Some(EncoderClass::Quadrature)),
            ("packet_serial", None),
        ] {
            let held =
                [("motor1.encoder.pin", SettingValue::Int(2)), ("pin.3.type", SettingValue::Choice(kind))];
            assert_eq!(of(&held, Motor::M1), wanted, "{kind}");
        }
        assert_eq!(of(&[("motor1.encoder.pin", SettingValue::Int(255))], Motor::M1), None);
    }
}

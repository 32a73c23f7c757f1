//! What a pin is used as: one choice for people, two rows of the table; and what changes with it.

use crate::model_of;
use crate::settings::pins::values::{Lookup, PinValues};
use brushwork_link::settings::Group;
use brushwork_link::settings::SettingValue;
use brushwork_link::settings::SettingsImage;
use brushwork_link::settings::SettingsTable;

/// What a pin is used as (MCP manual 1.9.8).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinMode {
    /// Nothing.
    None,
    /// A switch: 0 or 4095.
    Digital,
    /// A voltage: 0 to 4095.
    Analog,
    /// The width of pulses, in microseconds.
    Pulse,
    /// One of the two lines of an encoder, in counts.
    Encoder,
    /// The signal type of that name in command 143; the manual does not say what it measures.
    PacketSerial,
}

impl PinMode {
    /// The modes that a person chooses from.
    pub const OFFERED: [Self; 5] = [Self::None, Self::Digital, Self::Analog, Self::Pulse, Self::Encoder];

    /// What a pin (from 1) is used as, if that is known.
    pub fn of(get: Lookup<'_>, pin: usize) -> Option<Self> {
        let pin = PinValues::new(get, pin);
        let by_type = match pin.choice("type")? {
            "analog" => Self::Analog,
            "pulse" => Self::Pulse,
            "encoder" => Self::Encoder,
            "packet_serial" => Self::PacketSerial,
            _ if pin.is_on("digital") => Self::Digital,
            _ => Self::None,
        };
        Some(by_type)
    }

    /// Name for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Digital => "Digital",
            Self::Analog => "Analog",
            Self::Pulse => "Pulse",
            Self::Encoder => "Encoder",
            Self::PacketSerial => "Packet serial",
        }
    }

    /// The unit of what the pin reads.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Pulse => "µs",
            Self::Encoder => "counts",
            Self::None | Self::Digital | Self::Analog | Self::PacketSerial => "",
        }
    }

    /// The lowest and highest reading that the input can give; an encoder has none.
    pub fn reach(self) -> Option<(f64, f64)> {
        match self {
            Self::Digital | Self::Analog => Some((0.0, FULL_READING)),
            Self::Pulse => Some((0.0, LONGEST_PULSE_US)),
            Self::None | Self::Encoder | Self::PacketSerial => None,
        }
    }

    /// The priority level signal that inputs of this mode count as. Assumed: all but pulses count as Analog.
    pub fn priority(self) -> Option<&'static str> {
        match self {
            Self::None | Self::PacketSerial => None,
            Self::Pulse => Some("pulse"),
            Self::Digital | Self::Analog | Self::Encoder => Some("analog"),
        }
    }

    /// Whether a pin with that label has the function.
    pub fn is_on(self, pin: brushwork_mcp_wire::models::Pin) -> bool {
        match self {
            Self::None | Self::PacketSerial => true,
            Self::Digital => pin.functions().any(|function| function.starts_with("DIN")),
            Self::Analog => pin.is_analog(),
            Self::Pulse => pin.is_pulse(),
            Self::Encoder => pin.encoder_channel().is_some(),
        }
    }

    fn type_key(self) -> &'static str {
        match self {
            Self::None | Self::Digital => "none",
            Self::Analog => "analog",
            Self::Pulse => "pulse",
            Self::Encoder => "encoder",
            Self::PacketSerial => "packet_serial",
        }
    }
}

/// The reading of a high digital pin and of a full voltage (MCP manual 1.9.8).
const FULL_READING: f64 = 4095.0;
/// Assumed: pulses are measured in microseconds in 16 bits.
const LONGEST_PULSE_US: f64 = 65_535.0;
/// Assumed: an encoder stays within this while its range is found out.
const OPEN_COUNTS: i64 = 1 << 30;

/// The modes that can be chosen for a pin (from 1), each with the reason where it cannot.
pub fn modes(table: &SettingsTable, pin: usize, simulated: bool) -> Vec<(PinMode, Option<&'static str>)> {
    let label = pin.checked_sub(1).and_then(|index| model_of(table.subject())?.pins.get(index));
    let why_not = |mode: PinMode| {
        if label.is_some_and(|label| !mode.is_on(*label)) {
            return Some("This pin has no such function.");
        }
        let digital = table.row(&format!("pin.{pin}.digital"));
        (mode == PinMode::Digital).then(|| digital.and_then(|row| row.locked(simulated))).flatten()
    };
    PinMode::OFFERED.into_iter().map(|mode| (mode, why_not(mode))).collect()
}

/// What choosing a mode for a pin (from 1) makes of its settings: everything but the mode goes to its default (MCP manual
/// 1.9.8: "The settings will reset each time the mode is changed"). Rows that cannot be written here are left out.
pub fn change_mode(table: &SettingsTable, pin: usize, mode: PinMode, simulated: bool) -> SettingsImage {
    let own = format!("pin.{pin}.");
    let rows = table.group(Group::PINS).filter(|row| row.key.starts_with(&own));
    let value = |key: &str, default: SettingValue| match key.strip_prefix(&own) {
        Some("type") => SettingValue::Choice(mode.type_key()),
        Some("digital") => SettingValue::Bool(mode == PinMode::Digital),
        _ => default,
    };
    rows.filter(|row| row.locked(simulated).is_none())
        .map(|row| (row.key.clone(), value(&row.key, row.default)))
        .collect()
}

/// Settings under which a pin's position is its bare reading, wherever that lies, and under which the pin commands nothing
/// and triggers no action: for calibration.
pub fn open_range(pin: usize, mode: PinMode) -> SettingsImage {
    // One beyond what can be read, so that no action is triggered.
    let (min, max) = match mode.reach() {
        Some((_, highest)) => (-1, highest as i64 + 1),
        None => (-OPEN_COUNTS, OPEN_COUNTS),
    };
    let values = [
        ("mode", SettingValue::Choice("position")),
        ("target", SettingValue::Choice("none")),
        ("min", SettingValue::Int(min)),
        ("center", SettingValue::Int(0)),
        ("max", SettingValue::Int(max)),
        ("deadband", SettingValue::Int(0)),
        ("power_exp", SettingValue::Number(0.0)),
        ("power_min", SettingValue::Int(0)),
    ];
    values.into_iter().map(|(field, value)| (format!("pin.{pin}.{field}"), value)).collect()
}

#[cfg(test)]
mod tests {
    use brushwork_mcp_wire::models;
    use brushwork_mcp_wire::packet_serial::Generation;

    use super::*;
    use crate::settings::pins::SignalShape;

    fn table(generation: Generation) -> SettingsTable {
        brushwork_link::register(&crate::McpDriver);
        SettingsTable::new(crate::subject(models::lookup("mcp266").unwrap(), generation))
    }

    #[test]
    fn a_new_mode_resets_every_other_setting_of_the_pin() {
        let table = table(Generation::Gen2);
        let reset = change_mode(&table, 3, PinMode::Pulse, true);
        assert_eq!(reset.get("pin.3.type"), Some(SettingValue::Choice("pulse")));
        assert_eq!(reset.get("pin.3.digital"), Some(SettingValue::Bool(false)));
        assert_eq!(reset.get("pin.3.center"), Some(SettingValue::Int(2048)));
        assert_eq!(reset.get("pin.3.target"), Some(SettingValue::Choice("none")));
        let own = table.rows().iter().filter(|row| row.key.starts_with("pin.3."));
        assert_eq!(reset.len(), own.count(), "all of this pin and of no other");
    }

    #[test]
    fn digital_is_a_mode_of_its_own_and_only_simulated() {
        let table = table(Generation::Gen1);
        let reset = change_mode(&table, 1, PinMode::Digital, true);
        assert_eq!(PinMode::of(&|key| reset.get(key), 1), Some(PinMode::Digital));
        let real = change_mode(&table, 1, PinMode::Analog, false);
        assert_eq!(real.get("pin.1.digital"), None);
        assert_eq!(real.get("pin.1.min_action"), None, "its numbers are a guess in generation 1");
        let why = |simulated| modes(&table, 1, simulated)[1];
        assert_eq!(why(true), (PinMode::Digital, None));
        assert!(why(false).1.unwrap().contains("not public"));
    }

    #[test]
    fn a_pin_offers_only_what_its_label_says() {
        let table = table(Generation::Gen1);
        let offered = |pin| -> Vec<_> {
            let all = modes(&table, pin, true).into_iter();
            all.filter(|(_, why)| why.is_none()).map(|(mode, _)| mode.label()).collect()
        };
        assert_eq!(offered(3), ["None", "Digital", "Analog"], "DIN3/AN3");
        assert_eq!(offered(5), ["None", "Digital"], "DIN5/TX2");
        assert_eq!(offered(7), ["None", "Digital", "Analog", "Pulse", "Encoder"], "DIN7/AN7/P7/ENC1A");
    }

    #[test]
    fn in_the_open_range_the_position_is_the_reading() {
        let mut image = table(Generation::Gen1).default_image();
        image.merge(&open_range(1, PinMode::Pulse));
        let shape = SignalShape::of(&|key| image.get(key), 1).unwrap();
        for reading in [0.0, 1.0, 900.0, 1500.0, 65_535.0] {
            assert_eq!(shape.position(reading), reading);
        }
    }
}

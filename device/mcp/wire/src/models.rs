//! The motor controllers: ratings, input pins and digital outputs.
//!
//! One list for everybody: the client takes ranges and pin names from it, the simulated controller its
//! limits. It holds no protocol and no settings. What the manual does not print is marked in
//! [`Model::assumed`]; on a real unit the counts that commands 138 and 144 return win over the lists here.

/// Which product line a model belongs to. MCP and RoboClaw share packet serial, not all settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// MCP: configurable pins, streams and priority levels (commands 137 to 147).
    Mcp,
    /// RoboClaw: pins S1 to S5 and the configuration word (commands 74 to 77, 98, 99).
    RoboClaw,
}

impl Family {
    /// The family's name as printed on the board.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mcp => "MCP",
            Self::RoboClaw => "RoboClaw",
        }
    }
}

/// One controller model.
#[derive(Debug, PartialEq)]
pub struct Model {
    /// Name in command lines and files: lower case, no spaces ("mcp266").
    pub key: &'static str,
    /// Name as printed ("MCP266").
    pub name: &'static str,
    /// The text before the version number in the reply to command 21 ("MCP266 2x60A").
    pub title: &'static str,
    /// Product line.
    pub family: Family,
    /// Highest current limit per motor, in amperes.
    pub max_amps: f64,
    /// Lowest and highest main battery voltage the limits can be set to, in volts (MCP manual 1.1.3, 1.2.10).
    pub main_volts: (f64, f64),
    /// Lowest and highest logic battery voltage the limits can be set to, in volts (MCP manual 1.5.4, command
    /// 26).
    pub logic_volts: (f64, f64),
    /// Configurable input pins in the order of command 144.
    pub pins: &'static [Pin],
    /// Digital outputs in the order of command 138.
    pub douts: usize,
    /// Serial streams in the order of command 146: USB, RS-232 UART0, TTL UART1 to 3.
    pub streams: usize,
    /// Whether the board has a second temperature sensor.
    pub second_temperature: bool,
    /// What of this row is taken from the nearest documented model; empty when nothing is.
    pub assumed: &'static str,
}

impl Model {
    /// The model's current channels as on the label, e.g. "2x60A".
    pub fn rating(&self) -> &'static str {
        self.title.rsplit(' ').next().unwrap_or(self.title)
    }

    /// Whether it runs scripts: MCL is the MCP's alone (MCP manual 3.0.1).
    pub fn runs_scripts(&self) -> bool {
        self.family == Family::Mcp
    }

    /// Whether a stream (by the index of command 145) shares its lines with an encoder. Such a UART keeps the
    /// encoder from counting while it is in use (MCP manual 1.9.7). Assumed: it is disabled when the unit
    /// leaves the factory.
    pub fn stream_shares_encoder(&self, stream: usize) -> bool {
        let shares = |pin: &Pin| {
            pin.encoder_channel().is_some() && pin.uart().is_some_and(|uart| usize::from(uart) + 1 == stream)
        };
        self.pins.iter().any(shares)
    }
}

/// One input pin, named after the functions that share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// Label in the pin list of Ion Studio, e.g. "DIN3/AN3/P3/ENC1A/TX2" (MCP manual 1.9).
    pub label: &'static str,
}

impl Pin {
    /// Short name: the first function of the label, e.g. "DIN3".
    pub fn name(self) -> &'static str {
        self.functions().next().unwrap_or(self.label)
    }

    /// The functions that share the pin, in the order of the label.
    pub fn functions(self) -> impl Iterator<Item = &'static str> {
        self.label.split('/')
    }

    /// Whether the pin can measure a voltage (an "AN" function).
    pub fn is_analog(self) -> bool {
        self.functions().any(|function| function.starts_with("AN"))
    }

    /// Whether the pin can measure pulses (a "P" function).
    pub fn is_pulse(self) -> bool {
        self.functions()
            .any(|function| function.strip_prefix('P').is_some_and(|rest| rest.parse::<u8>().is_ok()))
    }

    /// The encoder channel the pin carries: encoder number (1 or 2) and phase ('A' or 'B').
    pub fn encoder_channel(self) -> Option<(u8, char)> {
        let rest = self.functions().find_map(|function| function.strip_prefix("ENC"))?;
        let mut letters = rest.chars();
        let number = letters.next()?.to_digit(10)?;
        Some((u8::try_from(number).ok()?, letters.next()?))
    }

    /// The TTL UART whose line shares the pin (2 or 3); while that UART is in use the pin is not an input
    /// (1.9.7).
    pub fn uart(self) -> Option<u8> {
        let digits = self
            .functions()
            .find_map(|function| function.strip_prefix("TX").or(function.strip_prefix("RX")))?;
        digits.parse().ok()
    }
}

/// The model whose key or printed name is `name`, whatever its case.
pub fn lookup(name: &str) -> Option<&'static Model> {
    MODELS
        .iter()
        .chain(UNLISTED)
        .find(|model| model.key.eq_ignore_ascii_case(name) || model.name.eq_ignore_ascii_case(name))
}

/// The model that reports itself as `version` in the reply to command 21 ("MCP266 2x60A v1.0.0"). A board of
/// either line that is not listed is one of [`UNLISTED`]; `None` means that it is of no known family.
pub fn identify(version: &str) -> Option<&'static Model> {
    let version = version.trim().to_ascii_lowercase();
    let by_title = MODELS.iter().find(|model| version.starts_with(&model.title.to_ascii_lowercase()));
    let by_name = || {
        let first = version.split_whitespace().next()?;
        MODELS.iter().find(|model| first == model.key)
    };
    let by_line = || UNLISTED.iter().find(|model| version.contains(&model.title.to_ascii_lowercase()));
    by_title.or_else(by_name).or_else(by_line)
}

/// Every model, MCP first, small to large.
pub static MODELS: &[Model] = &[
    Model { key: "mcp233", name: "MCP233", title: "MCP233 2x30A", max_amps: 30.0, ..small(34.0) },
    Model { key: "mcp236", name: "MCP236", title: "MCP236 2x30A", max_amps: 30.0, ..small(60.0) },
    Model { key: "mcp263", name: "MCP263", title: "MCP263 2x60A", max_amps: 60.0, ..medium(34.0) },
    Model { key: "mcp266", name: "MCP266", title: "MCP266 2x60A", max_amps: 60.0, ..medium(60.0) },
    Model {
        key: "mcp2126",
        name: "MCP2126",
        title: "MCP2126 2x120A",
        max_amps: 120.0,
        assumed: LIKE_160A,
        ..large(60.0)
    },
    Model {
        key: "mcp2128",
        name: "MCP2128",
        title: "MCP2128 2x120A",
        max_amps: 120.0,
        assumed: LIKE_160A,
        ..large(80.0)
    },
    Model { key: "mcp2163", name: "MCP2163", title: "MCP2163 2x160A", max_amps: 160.0, ..large(34.0) },
    Model { key: "mcp2166", name: "MCP2166", title: "MCP2166 2x160A", max_amps: 160.0, ..large(60.0) },
    Model {
        key: "mcp2168",
        name: "MCP2168",
        title: "MCP2168 2x160A",
        max_amps: 160.0,
        assumed: LIKE_160A,
        ..large(80.0)
    },
    Model {
        key: "mcp2206",
        name: "MCP2206",
        title: "MCP2206 2x200A",
        max_amps: 200.0,
        assumed: "Current from the model number; pins, outputs and the second sensor as on the 2x160A.",
        ..large(60.0)
    },
    Model {
        key: "roboclaw-2x7a",
        name: "RoboClaw 2x7A",
        title: "USB Roboclaw 2x7a",
        family: Family::RoboClaw,
        max_amps: 15.0,
        main_volts: (6.0, 34.0),
        logic_volts: (6.0, 34.0),
        pins: &[],
        douts: 0,
        streams: 0,
        second_temperature: false,
        assumed: "Peak current 15 A and a 6 V to 34 V main battery, as its data sheets state; not in the MCP manual.",
    },
];

/// What stands for a board that is not in [`MODELS`]: bounds as wide as its line has them, no named pins. Its
/// own data sheet says what it stands; commands 138, 144 and 146 say how many pins, streams and outputs it
/// has.
pub static UNLISTED: &[Model] = &[
    Model {
        key: "roboclaw",
        name: "RoboClaw",
        title: "Roboclaw",
        family: Family::RoboClaw,
        max_amps: 200.0,
        main_volts: (6.0, 80.0),
        logic_volts: (6.0, 34.0),
        streams: 0,
        assumed: NOT_LISTED,
        ..mcp(80.0)
    },
    Model { key: "mcp", name: "MCP", title: "MCP", max_amps: 200.0, assumed: NOT_LISTED, ..mcp(80.0) },
];

const NOT_LISTED: &str = "Not a listed model: the bounds are the widest of its line.";
const LIKE_160A: &str =
    "Ratings from the model number; pins, outputs and the second sensor as on the 2x160A.";

/// 2x30A boards: pin list of MCP manual 1.9.4.
const fn small(max_volts: f64) -> Model {
    Model { pins: SMALL_PINS, douts: 2, ..mcp(max_volts) }
}

/// 2x60A boards: pin list of MCP manual 1.2.10.
const fn medium(max_volts: f64) -> Model {
    Model { pins: MEDIUM_PINS, douts: 2, ..mcp(max_volts) }
}

/// 2x160A boards: pin list of MCP manual 1.9.1.
const fn large(max_volts: f64) -> Model {
    Model { pins: LARGE_PINS, douts: 8, second_temperature: true, ..mcp(max_volts) }
}

const fn mcp(max_volts: f64) -> Model {
    Model {
        key: "",
        name: "",
        title: "",
        family: Family::Mcp,
        max_amps: 0.0,
        main_volts: (10.0, max_volts),
        logic_volts: (6.0, 15.0),
        pins: &[],
        douts: 0,
        streams: 5,
        second_temperature: false,
        assumed: "",
    }
}

const fn pin(label: &'static str) -> Pin {
    Pin { label }
}

static SMALL_PINS: &[Pin] = &[
    pin("DIN1/AN1/P1/TX3"),
    pin("DIN2/AN2/P2/RX3"),
    pin("DIN3/AN3/P3/ENC1A/TX2"),
    pin("DIN4/AN5/P5/ENC2A"),
    pin("DIN5/AN4/P4/ENC1B/RX2"),
    pin("DIN6/AN6/P6/ENC2B"),
];

static MEDIUM_PINS: &[Pin] = &[
    pin("DIN1/AN1/P1/TX3"),
    pin("DIN2/AN2/P2/RX3"),
    pin("DIN3/AN3"),
    pin("DIN4/AN4/P4"),
    pin("DIN5/TX2"),
    pin("DIN6/RX2"),
    pin("DIN7/AN7/P7/ENC1A"),
    pin("DIN8/AN9/P9/ENC2A"),
    pin("DIN9/AN8/P8/ENC1B"),
    pin("DIN10/AN10/P10/ENC2B"),
];

static LARGE_PINS: &[Pin] = &[
    pin("DIN1/AN1/P1"),
    pin("DIN2/P2"),
    pin("DIN3/AN3/P3"),
    pin("DIN4/P4"),
    pin("DIN5/AN5"),
    pin("DIN6/P6"),
    pin("DIN7/AN7/P7"),
    pin("DIN8/P8"),
    pin("DIN9/AN9"),
    pin("DIN10/TX3"),
    pin("DIN11/AN11"),
    pin("DIN12/RX3"),
    pin("DIN13/AN13/P13"),
    pin("DIN14/P14"),
    pin("DIN15/AN15/P15/ENC1A/TX2"),
    pin("DIN16/AN16/P16/ENC2A"),
    pin("DIN17/AN17/P17/ENC1B/RX2"),
    pin("DIN18/AN18/P18/ENC2B"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_has_its_own_key_and_name_and_a_sane_rating() {
        for (index, model) in MODELS.iter().enumerate() {
            assert!(!model.key.is_empty() && !model.name.is_empty() && !model.title.is_empty());
            assert!(model.max_amps > 0.0 && model.main_volts.0 < model.main_volts.1, "{}", model.key);
            assert!(MODELS[..index].iter().all(|other| other.key != model.key && other.title != model.title));
            assert_eq!(lookup(model.key), Some(model));
            assert_eq!(lookup(&model.name.to_lowercase()), Some(model));
        }
    }

    #[test]
    fn the_version_text_names_the_model() {
        assert_eq!(identify("MCP266 2x60A v1.0.0\n").map(|model| model.key), Some("mcp266"));
        assert_eq!(identify("USB Roboclaw 2x7a v4.2.8\n").map(|model| model.key), Some("roboclaw-2x7a"));
        assert_eq!(identify("MCP2163 2x160A v1.0.2").map(Model::rating), Some("2x160A"));
        assert_eq!(identify("USB Roboclaw 2x15a v4.1.34\n").map(|model| model.key), Some("roboclaw"));
        assert_eq!(identify("MCP2999 2x1A v9").map(|model| model.key), Some("mcp"));
        assert_eq!(lookup("roboclaw").map(|model| model.family), Some(Family::RoboClaw));
        assert_eq!(identify("Some other device"), None);
        assert_eq!(identify(""), None);
    }

    #[test]
    fn pin_labels_tell_what_a_pin_can_do() {
        let pin = MODELS.iter().find(|model| model.key == "mcp233").map(|model| model.pins[2]);
        let pin = pin.expect("the MCP233 is in the list");
        assert_eq!(pin.name(), "DIN3");
        assert!(pin.is_analog() && pin.is_pulse());
        assert_eq!(pin.encoder_channel(), Some((1, 'A')));
        assert_eq!(pin.uart(), Some(2));
        let plain = Pin { label: "DIN5/TX2" };
        assert!(!plain.is_analog() && !plain.is_pulse());
        assert_eq!(plain.encoder_channel(), None);
    }

    #[test]
    fn the_uart_on_encoder_pins_is_known() {
        let shared = |key: &str| {
            let model = lookup(key).expect("the model is in the list");
            (0..5).filter(|stream| model.stream_shares_encoder(*stream)).collect::<Vec<_>>()
        };
        assert_eq!(shared("mcp233"), [3], "TX2 and RX2 are ENC1A and ENC1B");
        assert_eq!(shared("mcp266"), [0; 0]);
        assert_eq!(shared("mcp2166"), [3]);
    }

    #[test]
    fn every_mcp_has_both_phases_of_both_encoders() {
        for model in MODELS.iter().filter(|model| model.family == Family::Mcp) {
            for wanted in [(1, 'A'), (1, 'B'), (2, 'A'), (2, 'B')] {
                assert!(model.pins.iter().any(|pin| pin.encoder_channel() == Some(wanted)), "{}", model.key);
            }
        }
    }
}

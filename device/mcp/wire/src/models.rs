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
    /// Other texts that stand there, or that the board's USB port calls itself.
    pub other_titles: &'static [&'static str],
    /// Product line.
    pub family: Family,
    /// Motors it drives, 1 or 2.
    pub motors: usize,
    /// Highest current limit per motor, in amperes: the peak current where the data sheet states one.
    pub max_amps: f64,
    /// Lowest and highest main battery voltage the limits can be set to, in volts (MCP manual 1.1.3, 1.2.10).
    pub main_volts: (f64, f64),
    /// Lowest and highest logic battery voltage the limits can be set to, in volts (MCP manual 1.5.4, command
    /// 26).
    pub logic_volts: (f64, f64),
    /// Configurable input pins in the order of command 144.
    pub pins: &'static [Pin],
    /// The control pins of a RoboClaw: inputs S1 and S2, and those whose functions command 74 sets.
    pub control_pins: &'static [&'static str],
    /// Switched outputs of a RoboClaw, 0 or 2: CTRL1 and CTRL2 (commands 100 to 104), D1 and D2 in command 74 of generation 4.
    pub control_outputs: usize,
    /// Digital outputs in the order of command 138.
    pub douts: usize,
    /// Serial streams in the order of command 146: USB, RS-232 UART0, TTL UART1 to 3.
    pub streams: usize,
    /// Whether the board has a second temperature sensor.
    pub second_temperature: bool,
    /// Where the ratings are from.
    pub source: &'static str,
    /// What of this row is taken from the nearest documented model; empty when nothing is.
    pub assumed: &'static str,
}

impl Model {
    /// The model's current channels as on the label, e.g. "2x60A".
    pub fn rating(&self) -> &'static str {
        self.title.rsplit(' ').next().unwrap_or(self.title)
    }

    /// The current it carries for good, per motor, in amperes: the number on its label.
    pub fn continuous_amps(&self) -> f64 {
        rated_amps(self.rating()).map_or(self.max_amps, f64::from)
    }

    /// How many pins can have something connected to them.
    pub fn wired_pins(&self) -> usize {
        self.pins.len() + self.control_pins.len()
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
/// either line that is not listed is one of [`UNLISTED`], by the current in its name; `None` means that it is of
/// no known family.
pub fn identify(version: &str) -> Option<&'static Model> {
    let version = version.trim().to_ascii_lowercase();
    let is_titled = |title: &str| {
        let rest = version.strip_prefix(&title.to_ascii_lowercase());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(char::is_whitespace))
    };
    let by_title = MODELS
        .iter()
        .find(|model| is_titled(model.title) || model.other_titles.iter().any(|title| is_titled(title)));
    let by_name = || {
        let first = version.split_whitespace().next()?;
        MODELS.iter().find(|model| first == model.key)
    };
    by_title.or_else(by_name).or_else(|| by_rating(&version))
}

/// The row of [`UNLISTED`] for a board whose version text, in lower case, is in no list: the one of its line with the current and
/// the voltage that its name states, the next lower where none has just that; the most cautious where it states none.
fn by_rating(version: &str) -> Option<&'static Model> {
    let family = [Family::Mcp, Family::RoboClaw]
        .into_iter()
        .find(|family| version.contains(&family.name().to_ascii_lowercase()))?;
    let amps = version.split_whitespace().find_map(rated_amps).map_or(0.0, f64::from);
    let is_high_voltage = family == Family::RoboClaw && version.contains("hv");
    let motors = if version.contains("solo") { 1 } else { 2 };
    let of_line = || {
        UNLISTED.iter().filter(move |model| {
            (model.family, model.motors, model.main_volts.1 > 34.0) == (family, motors, is_high_voltage)
        })
    };
    of_line().rfind(|model| model.max_amps <= amps).or_else(|| of_line().next())
}

/// The current in a word such as "2x15a", "60A" or "2x60HV60": the number after the "x", if any.
fn rated_amps(word: &str) -> Option<u16> {
    let word = word.to_ascii_lowercase();
    let rest = word.strip_prefix("2x").unwrap_or(&word);
    let digits = rest.len() - rest.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
    let (number, unit) = rest.split_at(digits);
    let is_rating = unit == "a" || (rest != word && (unit.is_empty() || unit.starts_with("hv")));
    number.parse().ok().filter(|_| is_rating)
}

/// Every model, MCP first, small to large, then RoboClaws.
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
        key: "roboclaw-solo-30a",
        name: "RoboClaw Solo 30A",
        title: "USB Roboclaw Solo 30A",
        max_amps: 45.0,
        source: "RoboClaw Solo data sheet, 2016: 30 A, peak 45 A, 34 V",
        ..solo(34.0)
    },
    Model {
        key: "roboclaw-solo-60a",
        name: "RoboClaw Solo 60A",
        title: "USB Roboclaw Solo 60A",
        max_amps: 100.0,
        source: "RoboClaw Solo data sheet, 2016: 60 A, peak 100 A, 34 V",
        ..solo(34.0)
    },
    Model {
        key: "roboclaw-solo-300a",
        name: "RoboClaw Solo 300A",
        title: "USB Roboclaw Solo 300",
        max_amps: 300.0,
        assumed: FROM_NAME,
        ..solo(34.0)
    },
    Model {
        key: "roboclaw-solo-300ahv",
        name: "RoboClaw Solo 300AHV",
        title: "USB Roboclaw Solo 300A",
        max_amps: 300.0,
        assumed: FROM_NAME,
        ..solo(60.0)
    },
    Model {
        key: "roboclaw-2x5a",
        name: "RoboClaw 2x5A",
        title: "USB Roboclaw 2x5a",
        max_amps: 10.0,
        control_pins: &["S1", "S2", "S3"],
        control_outputs: 0,
        source: "RoboClaw 2x5A data sheet, 2013: 5 A, peak 10 A",
        assumed: "Main battery of 34 V as on the other boards without HV.",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x7a",
        name: "RoboClaw 2x7A",
        title: "USB Roboclaw 2x7a",
        max_amps: 15.0,
        source: "RoboClaw 2x7A data sheet: 7.5 A, peak 15 A, 34 V",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x15a",
        name: "RoboClaw 2x15A",
        title: "USB Roboclaw 2x15a",
        max_amps: 30.0,
        source: "RoboClaw 2x15A data sheet, 2016: 15 A, peak 30 A, 34 V",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x30a",
        name: "RoboClaw 2x30A",
        title: "USB Roboclaw 2x30a",
        max_amps: 60.0,
        source: "RoboClaw 2x30A data sheet, 2020: 30 A, peak 60 A, 34 V",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x45a",
        name: "RoboClaw 2x45A",
        title: "USB Roboclaw 2x45a",
        max_amps: 60.0,
        source: "RoboClaw 2x45A data sheet: 45 A, peak 60 A, 34 V",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x60a",
        name: "RoboClaw 2x60A",
        title: "USB Roboclaw 2x60a",
        max_amps: 120.0,
        source: "RoboClaw 2x60A data sheet, 2020: 60 A, peak 120 A, 34 V",
        ..claw(34.0)
    },
    Model {
        key: "roboclaw-2x60ahv",
        name: "RoboClaw 2x60AHV",
        title: "USB Roboclaw HV60 2x60A",
        other_titles: &["USB Roboclaw 2x60HV60"],
        max_amps: 120.0,
        source: "RoboClaw 2x60AHV data sheet: 60 A, peak 120 A; RoboClaw manual 2018: 10.5 V to 60 V",
        ..claw(60.0)
    },
    Model {
        key: "roboclaw-2x120a",
        name: "RoboClaw 2x120A",
        title: "USB Roboclaw 2x120a",
        max_amps: 120.0,
        source: LARGE_SHEET,
        assumed: NO_PEAK,
        ..large_claw(34.0)
    },
    Model {
        key: "roboclaw-2x120ahv",
        name: "RoboClaw 2x120AHV",
        title: "USB Roboclaw 2x120HV60",
        max_amps: 120.0,
        source: LARGE_SHEET,
        assumed: NO_PEAK,
        ..large_claw(60.0)
    },
    Model {
        key: "roboclaw-2x160a",
        name: "RoboClaw 2x160A",
        title: "USB Roboclaw 2x160a",
        max_amps: 160.0,
        source: LARGE_SHEET,
        assumed: NO_PEAK,
        ..large_claw(34.0)
    },
    Model {
        key: "roboclaw-2x160ahv",
        name: "RoboClaw 2x160AHV",
        title: "USB Roboclaw 2x160HV60",
        max_amps: 160.0,
        source: LARGE_SHEET,
        assumed: NO_PEAK,
        ..large_claw(60.0)
    },
    Model {
        key: "roboclaw-2x200ahv",
        name: "RoboClaw 2x200AHV",
        title: "USB Roboclaw 2x200HV60",
        max_amps: 200.0,
        source: LARGE_SHEET,
        assumed: NO_PEAK,
        ..large_claw(60.0)
    },
    Model {
        key: "roboclaw-2x300ahv",
        name: "RoboClaw 2x300AHV",
        title: "USB Roboclaw 2x300HV60",
        max_amps: 300.0,
        assumed: FROM_NAME,
        ..large_claw(60.0)
    },
    Model {
        key: "roboclaw-2x400ahv",
        name: "RoboClaw 2x400AHV",
        title: "USB Roboclaw 2x400HV60",
        max_amps: 400.0,
        assumed: FROM_NAME,
        ..large_claw(60.0)
    },
];

/// As many pins, outputs or streams as any board of [`MODELS`] has, whichever is most.
pub(crate) fn most_records() -> usize {
    MODELS.iter().flat_map(|model| [model.pins.len(), model.douts, model.streams]).max().unwrap_or_default()
}

/// Boards of either line that are not in [`MODELS`], by the current in their name, ascending. The first row of a line stands for a
/// board whose name states none.
macro_rules! unlisted {
    ($($amps:literal)*) => {
        &[
            Model { key: "roboclaw", name: "RoboClaw", title: "Roboclaw", max_amps: 5.0, ..unlisted_claw(34.0) },
            $(Model {
                key: concat!("roboclaw-", $amps, "a"),
                name: concat!("RoboClaw of ", $amps, " A"),
                title: concat!("Roboclaw 2x", $amps, "A"),
                max_amps: whole($amps),
                ..unlisted_claw(34.0)
            },)*
            $(Model {
                key: concat!("roboclaw-", $amps, "ahv"),
                name: concat!("RoboClaw HV of ", $amps, " A"),
                title: concat!("Roboclaw 2x", $amps, "HV60"),
                max_amps: whole($amps),
                ..unlisted_claw(60.0)
            },)*
            $(Model {
                key: concat!("roboclaw-solo-of-", $amps, "a"),
                name: concat!("RoboClaw Solo of ", $amps, " A"),
                title: concat!("Roboclaw Solo ", $amps, "A"),
                max_amps: whole($amps),
                motors: 1,
                ..unlisted_claw(34.0)
            },)*
            Model { key: "mcp", name: "MCP", title: "MCP", max_amps: 5.0, assumed: NOT_LISTED, ..mcp(34.0) },
            $(Model {
                key: concat!("mcp-", $amps, "a"),
                name: concat!("MCP of ", $amps, " A"),
                title: concat!("MCP 2x", $amps, "A"),
                max_amps: whole($amps),
                assumed: NOT_LISTED,
                ..mcp(34.0)
            },)*
        ]
    };
}

/// What stands for a board that is not in [`MODELS`]: the current in its name, 34 V unless its name says HV, no named pins. Its
/// own data sheet says what it stands; commands 138, 144 and 146 say how many pins, streams and outputs it
/// has.
pub static UNLISTED: &[Model] = unlisted![5 7 10 15 20 25 30 40 45 50 60 80 100 120 160 200 250 300 400];

#[allow(clippy::cast_lossless, reason = "f64::from is not const")]
const fn whole(amps: u16) -> f64 {
    amps as f64
}

const NOT_LISTED: &str = "Not a listed model: the current in its name and 34 V; 60 V where its name says HV.";
const LIKE_160A: &str =
    "Ratings from the model number; pins, outputs and the second sensor as on the 2x160A.";
const FROM_NAME: &str = "Ratings from the name; not in a public data sheet.";
const NO_PEAK: &str = "No peak current is stated: the continuous one is the limit.";
const LARGE_SHEET: &str =
    "RoboClaw 120A/160A/200A data sheet, 2016: continuous current, logic battery 6 V to 14 V";

/// Control pins of a RoboClaw with two channels (RoboClaw manual 2018).
const S1_TO_S5: &[&str] = &["S1", "S2", "S3", "S4", "S5"];

/// RoboClaws with two channels (RoboClaw manual 2018). Assumed: they have the outputs CTRL1 and CTRL2, which "select models" have.
const fn claw(max_volts: f64) -> Model {
    Model {
        family: Family::RoboClaw,
        main_volts: (if max_volts > 34.0 { 10.5 } else { 6.0 }, max_volts),
        logic_volts: (6.0, 34.0),
        control_pins: S1_TO_S5,
        control_outputs: 2,
        streams: 0,
        source: "public clients, 2015-2025",
        ..mcp(max_volts)
    }
}

/// RoboClaws of 120 A and more, whose logic battery stands less. Assumed: they have the second temperature sensor that "supported
/// units" have.
const fn large_claw(max_volts: f64) -> Model {
    Model { logic_volts: (6.0, 14.0), second_temperature: true, ..claw(max_volts) }
}

/// RoboClaws with one channel, which have no S4 and S5 (RoboClaw Solo data sheet, 2016).
const fn solo(max_volts: f64) -> Model {
    Model { motors: 1, control_pins: &["S1", "S2", "S3"], control_outputs: 0, ..claw(max_volts) }
}

const fn unlisted_claw(max_volts: f64) -> Model {
    Model { assumed: NOT_LISTED, ..claw(max_volts) }
}

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
        other_titles: &[],
        family: Family::Mcp,
        motors: 2,
        max_amps: 0.0,
        main_volts: (10.0, max_volts),
        logic_volts: (6.0, 15.0),
        pins: &[],
        control_pins: &[],
        control_outputs: 0,
        douts: 0,
        streams: 5,
        second_temperature: false,
        source: "MCP manual 1.1.3, 1.2.10 and 1.9",
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
        assert_eq!(identify("USB Roboclaw 2x15a v4.1.34\n").map(|model| model.key), Some("roboclaw-2x15a"));
        assert_eq!(
            identify("USB Roboclaw HV60 2x60A v4.4.3").map(|model| model.key),
            Some("roboclaw-2x60ahv")
        );
        assert_eq!(identify("USB Roboclaw Solo 300 v4.3.2").map(|model| model.main_volts.1), Some(34.0));
        assert_eq!(identify("USB Roboclaw Solo 300A v4.3.2").map(|model| model.main_volts.1), Some(60.0));
        assert_eq!(identify("MCP2999 2x1A v9").map(|model| model.key), Some("mcp"));
        assert_eq!(lookup("roboclaw").map(|model| model.family), Some(Family::RoboClaw));
        assert_eq!(identify("Some other device"), None);
        assert_eq!(identify(""), None);
    }

    #[test]
    fn a_board_that_no_list_has_gets_the_current_in_its_name_and_no_more() {
        for (version, amps, volts, motors) in [
            ("USB Roboclaw 2x25a v4.1.34", 25.0, 34.0, 2),
            ("Roboclaw 2x10A v4.0.1", 10.0, 34.0, 2),
            ("USB Roboclaw 2x55A v9", 50.0, 34.0, 2),
            ("USB Roboclaw 2x100HV60 v9", 100.0, 60.0, 2),
            ("USB Roboclaw Solo 120A v9", 120.0, 34.0, 1),
            ("USB Roboclaw 2x999a v9", 400.0, 34.0, 2),
            ("USB Roboclaw v4", 5.0, 34.0, 2),
            ("USB Roboclaw HV v4", 5.0, 60.0, 2),
            ("MCP299 2x20A v1", 20.0, 34.0, 2),
        ] {
            let model = identify(version).expect(version);
            assert_eq!(
                (model.max_amps, model.main_volts.1, model.motors),
                (amps, volts, motors),
                "{version}"
            );
            assert!(!model.assumed.is_empty(), "{version}");
            assert_eq!(lookup(model.key), Some(model));
        }
    }

    #[test]
    fn every_roboclaw_is_found_by_its_titles_and_carries_at_least_its_label() {
        for model in MODELS.iter().filter(|model| model.family == Family::RoboClaw) {
            for title in std::iter::once(&model.title).chain(model.other_titles) {
                assert_eq!(identify(&format!("{title} v4.2.8")), Some(model));
            }
            assert!(
                model.continuous_amps() > 0.0 && model.continuous_amps() <= model.max_amps,
                "{}",
                model.key
            );
            assert!(!model.source.is_empty());
            assert_eq!(model.motors == 1, model.name.contains("Solo"));
        }
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

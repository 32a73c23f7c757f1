//! What the switches of the board choose: mode and protocol (Motion Mind manual 3.5 and chapter 4).

use serde::Serialize;
use std::fmt;

brushwork_values::listed! {
    /// What moves the motor (Motion Mind manual, chapter 4). The switches of the board choose it at power-up.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
    #[serde(rename_all = "snake_case")]
    #[repr(u8)]
    pub enum Mode {
        /// Pulses of a radio receiver.
        RadioControl "R/C",
        /// A voltage.
        Analog "analog",
        /// Two buttons.
        Buttons "buttons",
        /// Serial commands, open loop.
        Serial "serial",
        /// Serial commands, closed loop.
        SerialPid "serial PID",
        /// A voltage or serial commands, closed loop on a voltage or the encoder.
        AnalogPid "analog PID",
        /// Nothing; both limit inputs at ground bring back the factory's values.
        FactoryRestore "factory restore",
        /// Nothing.
        FactoryTest "factory test",
    }
    /// Its name for people.
    fn label;
}

impl Mode {
    /// The mode of that number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Its number in register 18.
    pub fn number(self) -> u8 {
        self as u8
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mode {} ({})", self.number(), self.label())
    }
}

/// Which protocol switch 6 of the board selects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Protocol {
    /// Frames with a checksum.
    #[default]
    Binary,
    /// Lines of text.
    Text,
}

impl Protocol {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Binary, Self::Text];

    /// Its name on the command line and in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Binary => "binary",
            Self::Text => "ascii",
        }
    }

    /// The protocol of that name.
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|protocol| protocol.key().eq_ignore_ascii_case(key))
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Binary => "binary",
            Self::Text => "ASCII",
        })
    }
}

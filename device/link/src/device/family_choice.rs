//! The protocol family that a user chooses for a link, or leaves to be found out.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Which protocol family the units of a link speak.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FamilyChoice {
    /// Packet serial is looked for first, then a Motion Mind at its factory address; where one is, a scan goes on to the others.
    #[default]
    Auto,
    /// MCP and RoboClaw.
    PacketSerial,
    /// Motion Minds, in either of their protocols, at all addresses.
    MotionMind,
}

impl FamilyChoice {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::PacketSerial, Self::MotionMind];

    /// Name on the command line and in files.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::PacketSerial => "mcp",
            Self::MotionMind => "motion-mind",
        }
    }

    /// Name for people.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Auto => "Find out",
            Self::PacketSerial => "MCP or RoboClaw",
            Self::MotionMind => "Motion Mind",
        }
    }
}

impl fmt::Display for FamilyChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}

impl FromStr for FamilyChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|choice| choice.key().eq_ignore_ascii_case(text));
        found.ok_or_else(|| format!("\"{text}\" is no protocol family. Use auto, mcp or motion-mind"))
    }
}

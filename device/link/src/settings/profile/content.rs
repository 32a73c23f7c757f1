//! What a profile holds: the settings of one controller, and whose they are.

use super::super::image::SettingsImage;
use super::super::subject::Subject;
use super::super::table::SettingsTable;
use super::error::Problem;
use crate::unit::UnitAddress;
use brushwork_values::Message;

/// The schema this program writes, and the newest it reads.
pub const SCHEMA: u64 = 3;
/// What the "format" member of a profile says.
pub const FORMAT: &str = "brushwork-settings";

/// The settings of one controller, to be kept in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The controller they were read from: model, generation, numbers of pins, streams and outputs.
    pub subject: Subject,
    /// What the unit says it is: of packet serial the reply to command 21, "MCP266 2x60A v1.0.0".
    pub firmware: String,
    /// The address they were read at.
    pub address: UnitAddress,
    /// When they were read, as the caller writes dates; ISO 8601 is advised.
    pub date: String,
    /// What tells the unit from others of its kind, as far as anything does: a serial number, or the port it was
    /// at; may be empty.
    pub unit: String,
    /// Why the settings were kept: "before a write"; may be empty.
    pub note: String,
    /// The values, by key.
    pub settings: SettingsImage,
}

/// A profile as it was read, with what reading it changed.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenedProfile {
    /// The profile.
    pub profile: Profile,
    /// What an older schema said otherwise, a sentence each.
    pub upgraded: Vec<Message>,
    /// Faults that were corrected.
    pub corrected: Vec<Problem>,
}

/// Whether faults are refused or mended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strictness {
    /// Any fault refuses the profile.
    Refuse,
    /// Faults of single settings are corrected, each with a warning; others still refuse it.
    Repair,
}

impl Profile {
    /// The date for people: "2026-01-05 10:00:00 UTC" where it is of the advised form, else as it stands.
    pub fn date_text(&self) -> String {
        match self.date.strip_suffix('Z').and_then(|date| date.split_once('T')) {
            Some((day, time)) => format!("{day} {time} UTC"),
            None => self.date.clone(),
        }
    }

    /// The table of the controller the profile was read from.
    pub fn table(&self) -> SettingsTable {
        SettingsTable::new(self.subject)
    }
}

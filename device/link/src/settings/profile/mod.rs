//! A profile: the settings of one controller in a file, with what is needed to judge whether they fit another
//! one.
//!
//! The form is JSON with a schema number; each value carries its unit. Reading takes all or nothing: every
//! fault is told with its place, and nothing is half taken over. The date comes from outside, there is no
//! clock here.

mod error;
mod file;
mod fit;
mod json;
mod parse;
mod schema;

use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_mcp_wire::models::Model;

use super::difference::changes;
use super::image::SettingsImage;
use super::subject::Subject;
use super::table::SettingsTable;

pub use error::{Problem, ProfileError, ProfileFileError};
pub use file::replace_file;
pub use fit::Fitted;

/// The schema this program writes, and the newest it reads.
pub const SCHEMA: u64 = 2;
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
    pub upgraded: Vec<String>,
    /// Faults that were mended.
    pub mended: Vec<Problem>,
}

/// What a profile asks of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileChanges {
    /// The values that differ and can be written.
    pub wanted: SettingsImage,
    /// Those that differ and cannot be written on this controller, a sentence each.
    pub left_out: Vec<String>,
}

/// Whether faults are refused or mended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strictness {
    /// Any fault refuses the profile.
    Refuse,
    /// Faults of single settings are mended, each with a warning; others still refuse it.
    Repair,
}

impl Profile {
    /// The profile in `text`. Refuses anything that is not exactly right, with every fault it found.
    pub fn parse(text: &str) -> Result<Self, ProfileError> {
        Self::read(text, Strictness::Refuse).map(|opened| opened.profile)
    }

    /// The profile in `text`, with what reading it changed: an older schema is brought to the newest, and with
    /// [`Strictness::Repair`] settings that are unknown or of a wrong type are left out. A value out of range is
    /// no fault: a unit may hold it. What is wrong with the file as a whole refuses it either way.
    pub fn read(text: &str, strictness: Strictness) -> Result<OpenedProfile, ProfileError> {
        parse::parse(text, strictness)
    }

    /// The profile as text: one line per setting, in screen order.
    pub fn to_json(&self) -> String {
        json::write(self)
    }

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

    /// What brings a controller to this profile, values out of range as they stand. Refuses, with every reason, when the profile
    /// was made for another model or generation, or holds what that controller does not have or cannot hold.
    pub fn changes_for(
        &self,
        table: &SettingsTable,
        ram: &SettingsImage,
        simulated: bool,
    ) -> Result<ProfileChanges, ProfileError> {
        let mut problems = self.misfits(table.subject());
        let is_foreign = !problems.is_empty();
        let mut left_out = Vec::new();
        let mut wanted = changes(table, ram, &self.settings);
        for (key, value) in self.settings.iter() {
            match table.row(key) {
                None => problems.push(Problem::at_key(key, "The connected controller has no such setting.")),
                Some(_) if wanted.get(key).is_none() => {}
                Some(row) => match row.locked(simulated) {
                    Some(reason) => {
                        left_out.push(format!(
                            "{}: {} is not written. {reason}",
                            row.title(),
                            row.format(value)
                        ));
                        wanted.remove(key);
                    }
                    None => {
                        let why =
                            if is_foreign { row.check(value).err() } else { row.check_as_read(value).err() };
                        problems.extend(why.map(|why| Problem::at_key(key, why)));
                    }
                },
            }
        }
        if problems.is_empty() {
            Ok(ProfileChanges { wanted, left_out })
        } else {
            Err(ProfileError { problems })
        }
    }

    /// Why the profile is not for that controller as a whole.
    fn misfits(&self, other: &Subject) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.subject.model != other.model {
            problems.push(Problem::at_key("model", model_misfit(self.subject.model, other.model)));
        }
        if self.subject.generation != other.generation {
            problems.push(Problem::at_key(
                "generation",
                generation_misfit(self.subject.generation, other.generation),
            ));
        }
        problems
    }
}

fn model_misfit(profile: &Model, connected: &Model) -> String {
    format!(
        "The profile was made for the {} ({}), the connected controller is the {} ({}).",
        profile.name,
        profile.rating(),
        connected.name,
        connected.rating()
    )
}

fn generation_misfit(profile: FirmwareGeneration, connected: FirmwareGeneration) -> String {
    format!("The profile was made for firmware {profile}, the connected controller has {connected}.")
}

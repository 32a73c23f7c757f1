//! The journal of one act: what there was, what was to come, as text.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use thiserror::Error;

use super::super::profile::{Profile, ProfileError};

brushwork_values::listed! {
    /// What can be done with all settings.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Act {
        /// Settings are written to RAM.
        Write "write",
        /// RAM is saved to EEPROM.
        Save "save",
        /// The factory settings are restored in RAM.
        Defaults "defaults",
        /// EEPROM is loaded over RAM.
        Reload "reload",
        /// The firmware is replaced.
        Firmware "firmware change",
        /// Settings are changed for a while: a tuning run, a calibration.
        Trial "trial",
    }
    /// The act as a noun: "write".
    fn label;
}

/// What an act began with and what it was to bring.
#[derive(Clone, Debug, PartialEq)]
pub struct Journal {
    /// What was begun.
    pub act: Act,
    /// What was there before, with the date on which the act began. Of a save: what EEPROM held as last known, with
    /// no settings at all when that was not known.
    pub before: Profile,
    /// The values that were to come; settings that were to stay as they were are not in it, except for a save,
    /// which writes all.
    pub wanted: Profile,
}

/// A journal that cannot be read.
#[derive(Debug, Error)]
pub enum JournalError {
    /// It is no JSON.
    #[error("it is no JSON: {source}")]
    Json {
        /// Where.
        source: serde_json::Error,
    },
    /// A member is missing or of another form.
    #[error("it says no {member}")]
    Member {
        /// Which.
        member: &'static str,
    },
    /// One of its two profiles is faulty.
    #[error("{source}")]
    Profile {
        /// Its faults.
        source: ProfileError,
    },
}

const FORMAT: &str = "brushwork-journal";

impl Journal {
    /// The journal as text.
    pub fn to_json(&self) -> String {
        let profile =
            |profile: &Profile| serde_json::from_str::<Value>(&profile.to_json()).unwrap_or_default();
        let object = json!({
            "format": FORMAT,
            "act": self.act,
            "before": profile(&self.before),
            "wanted": profile(&self.wanted),
        });
        format!("{object:#}\n")
    }

    /// The journal in `text`. Its profiles may be of an older schema.
    pub fn parse(text: &str) -> Result<Self, JournalError> {
        let object: Value = serde_json::from_str(text).map_err(|source| JournalError::Json { source })?;
        if object["format"] != FORMAT {
            return Err(JournalError::Member { member: "format" });
        }
        let act = Act::deserialize(&object["act"]).map_err(|_| JournalError::Member { member: "act" })?;
        let profile = |member: &str| {
            Profile::parse(&object[member].to_string()).map_err(|source| JournalError::Profile { source })
        };
        Ok(Self { act, before: profile("before")?, wanted: profile("wanted")? })
    }

    /// When the act began, for people.
    pub fn begun(&self) -> String {
        self.before.date_text()
    }
}

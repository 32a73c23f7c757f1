//! What is known of a unit's EEPROM: its content as last proven, and how often it was written from here.

use brushwork_link::Message;
use std::fs;
use std::path::PathBuf;

use brushwork_link::settings::Profile;
use serde::{Deserialize, Serialize};

use super::store::{KeepError, Store};
use super::unit::{OWNER, UnitId};
use crate::examine::RawWrite;
use crate::messages::WearMessage;

const EEPROM: &str = "eeprom";
const WEAR: &str = "wear";
const RAW: &str = "raw";
/// As many raw writes as are remembered of a unit.
const MOST_RAW_WRITES: usize = 200;

/// Assumed: writes that each byte of the EEPROM stands. Makers of EEPROMs state 100 000, of flash that stands in for
/// one 10 000; the controllers' manuals state nothing, so the lower figure counts.
pub const ENDURANCE: u64 = 10_000;

/// How often a unit's EEPROM was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wear {
    /// Saves begun from this computer.
    pub saves: u64,
    /// The date of the first of them.
    pub since: String,
}

/// How near an EEPROM is to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WearLevel {
    /// Far from it.
    Fine,
    /// Half of what it stands for certain is used.
    Half,
    /// It may fail any time.
    Worn,
}

impl Wear {
    /// How near the EEPROM is to its end.
    pub fn level(&self) -> WearLevel {
        match self.saves {
            saves if saves >= ENDURANCE => WearLevel::Worn,
            saves if saves >= ENDURANCE / 2 => WearLevel::Half,
            _ => WearLevel::Fine,
        }
    }

    /// The count in a sentence, with a warning where one is due.
    pub fn sentence(&self) -> Message {
        let since = self.since.clone();
        let count = match self.saves {
            0 => WearMessage::None,
            1 => WearMessage::One { since },
            saves => WearMessage::Saves { saves, since },
        };
        match self.level() {
            WearLevel::Fine => count.into(),
            WearLevel::Half => WearMessage::Half { count: count.into(), endurance: ENDURANCE }.into(),
            WearLevel::Worn => WearMessage::Worn { count: count.into(), endurance: ENDURANCE }.into(),
        }
    }
}

impl Store {
    /// The file of what is known of a unit's memory.
    fn memory_path(&self, kind: &str, unit: &UnitId) -> Result<PathBuf, KeepError> {
        self.path(&[kind, &format!("{}{}.json", unit.owner(), unit.file_name())])
    }

    /// Keeps something of a unit's memory, and forgets the memories of simulated units that are gone.
    fn put_memory(&self, kind: &str, unit: &UnitId, text: &str) -> Result<(), KeepError> {
        if unit.is_simulated {
            let is_gone = |path: &PathBuf| {
                let name =
                    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                name.starts_with(OWNER) && !name.starts_with(&unit.owner())
            };
            // What stays is a few bytes.
            self.files(&[kind])
                .iter()
                .filter(|path| is_gone(path))
                .for_each(|path| drop(fs::remove_file(path)));
        }
        self.put(&self.memory_path(kind, unit)?, text)
    }

    /// How often the unit's EEPROM was written. A file that cannot be read counts as none.
    pub fn wear(&self, unit: &UnitId) -> Wear {
        let text = self.memory_path(WEAR, unit).ok().and_then(|path| fs::read_to_string(path).ok());
        text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
    }

    /// Counts saves, or takes back those that were not carried out.
    pub fn count_saves(&self, unit: &UnitId, by: i64, today: &str) -> Result<Wear, KeepError> {
        let mut wear = self.wear(unit);
        wear.saves = wear.saves.saturating_add_signed(by);
        if wear.since.is_empty() {
            today.clone_into(&mut wear.since);
        }
        let text = serde_json::to_string_pretty(&wear).unwrap_or_default();
        self.put_memory(WEAR, unit, &text)?;
        Ok(wear)
    }

    /// The numbers that were written to the unit raw from this computer, oldest first. A file that cannot be read counts as none.
    pub fn raw_writes(&self, unit: &UnitId) -> Vec<RawWrite> {
        let text = self.memory_path(RAW, unit).ok().and_then(|path| fs::read_to_string(path).ok());
        text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
    }

    /// Notes one more.
    ///
    /// # Errors
    /// It cannot be kept.
    pub fn note_raw_write(&self, unit: &UnitId, write: RawWrite) -> Result<(), KeepError> {
        let mut writes = self.raw_writes(unit);
        writes.push(write);
        writes.drain(..writes.len().saturating_sub(MOST_RAW_WRITES));
        let text = serde_json::to_string_pretty(&writes).unwrap_or_default();
        self.put_memory(RAW, unit, &text)
    }

    /// What the unit's EEPROM held when that was proven last, with the date.
    pub fn eeprom(&self, unit: &UnitId) -> Option<Profile> {
        Profile::load(&self.memory_path(EEPROM, unit).ok()?).ok()
    }

    /// What the unit's EEPROM holds is known, or (`None`) not any more.
    pub fn note_eeprom(&self, unit: &UnitId, profile: Option<&Profile>) -> Result<(), KeepError> {
        match profile {
            Some(profile) => self.put_memory(EEPROM, unit, &profile.to_json()),
            None => self.close_journal(&self.memory_path(EEPROM, unit)?),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_warning_comes_before_the_wear() {
        let wear = |saves| Wear { saves, since: "2026-01-05".to_owned() };
        assert_eq!(wear(0).sentence(), "No save to this EEPROM was counted yet.");
        assert_eq!(wear(4999).sentence(), "4999 saves to this EEPROM were counted since 2026-01-05.");
        assert_eq!(wear(5000).level(), WearLevel::Half);
        assert!(wear(5000).sentence().to_string().contains("half worn"));
        assert!(wear(10_000).sentence().to_string().contains("worn out"));
    }
}

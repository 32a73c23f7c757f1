//! What is known of a unit's EEPROM: its content as last proven, and how often it was written from here.

use brushwork_link::Message;
use std::path::PathBuf;

use brushwork_link::settings::Profile;
use serde::{Deserialize, Serialize};

use super::store::{KeepError, Record, Store};
use super::unit::{OWNER, UnitId};
use crate::messages::WearMessage;

const EEPROM: &str = "eeprom";
const WEAR: &str = "wear";

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
    /// Whether saves were counted before that, in a file that was damaged.
    #[serde(default, skip_serializing_if = "is_false")]
    pub earlier_lost: bool,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
fn is_false(value: &bool) -> bool {
    !value
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
            saves if saves >= ENDURANCE / 2 || self.earlier_lost => WearLevel::Half,
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
            WearLevel::Half if self.earlier_lost => WearMessage::EarlierLost { count: count.into() }.into(),
            WearLevel::Half => WearMessage::Half { count: count.into(), endurance: ENDURANCE }.into(),
            WearLevel::Worn => WearMessage::Worn { count: count.into(), endurance: ENDURANCE }.into(),
        }
    }
}

impl Store {
    /// The file of what is known of a unit's memory.
    pub(super) fn memory_path(&self, kind: &str, unit: &UnitId) -> Result<PathBuf, KeepError> {
        self.path(&[kind, &format!("{}{}.json", unit.owner(), unit.file_name())])
    }

    /// Keeps something of a unit's memory, and forgets the memories of simulated units that are gone.
    pub(super) fn put_memory(
        &self,
        record: Record,
        kind: &str,
        unit: &UnitId,
        text: &str,
    ) -> Result<(), KeepError> {
        if unit.is_simulated {
            let is_gone = |path: &PathBuf| {
                let name =
                    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                name.starts_with(OWNER) && !name.starts_with(&unit.owner())
            };
            // What stays is a few bytes.
            self.list(record, &[kind])
                .unwrap_or_default()
                .iter()
                .filter(|path| is_gone(path))
                .for_each(|path| drop(self.take_away(record, path)));
        }
        self.put(record, &self.memory_path(kind, unit)?, text)
    }

    /// How often the unit's EEPROM was written.
    ///
    /// # Errors
    /// Its file is damaged or cannot be read, so that nobody knows.
    pub fn wear(&self, unit: &UnitId) -> Result<Wear, KeepError> {
        Ok(self.json(Record::Wear, &self.memory_path(WEAR, unit)?)?.unwrap_or_default())
    }

    /// Counts saves, or takes back those that were not carried out. A damaged file is put aside, and the new count says so.
    ///
    /// # Errors
    /// It cannot be kept.
    pub fn count_saves(&self, unit: &UnitId, by: i64, today: &str) -> Result<Wear, KeepError> {
        let mut wear = match self.wear(unit) {
            Err(KeepError::Damaged { record, path, .. }) => {
                self.put_aside(record, &path)?;
                Wear { earlier_lost: true, ..Wear::default() }
            }
            known => known?,
        };
        wear.saves = wear.saves.saturating_add_signed(by);
        if wear.since.is_empty() {
            today.clone_into(&mut wear.since);
        }
        let text = serde_json::to_string_pretty(&wear).unwrap_or_default();
        self.put_memory(Record::Wear, WEAR, unit, &text)?;
        Ok(wear)
    }

    /// What the unit's EEPROM held when that was proven last, with the date.
    ///
    /// # Errors
    /// The note is damaged or cannot be read.
    pub fn eeprom(&self, unit: &UnitId) -> Result<Option<Profile>, KeepError> {
        let path = self.memory_path(EEPROM, unit)?;
        let Some(text) = self.text(Record::Eeprom, &path)? else { return Ok(None) };
        Profile::parse(&text).map(Some).map_err(|error| KeepError::Damaged {
            record: Record::Eeprom,
            path,
            what: error.to_string(),
        })
    }

    /// What the unit's EEPROM holds is known, or (`None`) not any more.
    pub fn note_eeprom(&self, unit: &UnitId, profile: Option<&Profile>) -> Result<(), KeepError> {
        match profile {
            Some(profile) => self.put_memory(Record::Eeprom, EEPROM, unit, &profile.to_json()),
            None => self.take_away(Record::Eeprom, &self.memory_path(EEPROM, unit)?),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_warning_comes_before_the_wear() {
        let wear = |saves| Wear { saves, since: "2026-01-05".to_owned(), earlier_lost: false };
        assert_eq!(wear(0).sentence(), "No save to this EEPROM was counted yet.");
        assert_eq!(wear(4999).sentence(), "4999 saves to this EEPROM were counted since 2026-01-05.");
        assert_eq!(wear(5000).level(), WearLevel::Half);
        assert!(wear(5000).sentence().to_string().contains("half worn"));
        assert!(wear(10_000).sentence().to_string().contains("worn out"));
        let lost = Wear { earlier_lost: true, ..wear(3) };
        assert_eq!(lost.level(), WearLevel::Half);
        assert!(lost.sentence().to_string().contains("before is lost"), "{}", lost.sentence());
    }
}

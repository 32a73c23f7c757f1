//! What people note of a unit, beside its backups.

use super::store::{KeepError, Record, Store};
use super::unit::UnitId;

const FILE: &str = "notes.txt";

impl Store {
    /// What was noted of a unit; empty where nothing was.
    ///
    /// # Errors
    /// The file is there and cannot be read.
    pub fn notes(&self, unit: &UnitId) -> Result<String, KeepError> {
        self.notes_in(&unit.file_name())
    }

    /// The same by the unit's folder, as [`Backup::unit`](super::Backup::unit) names it.
    ///
    /// # Errors
    /// As for [`Store::notes`].
    pub fn notes_in(&self, folder: &str) -> Result<String, KeepError> {
        let path = self.path(&[super::backups::FOLDER, folder, FILE])?;
        Ok(self.text(Record::Notes, &path)?.unwrap_or_default())
    }

    /// Keeps what was noted of a unit.
    ///
    /// # Errors
    /// The file cannot be written; an older one is as it was.
    pub fn keep_notes(&self, unit: &UnitId, text: &str) -> Result<(), KeepError> {
        let path = self.path(&[super::backups::FOLDER, &unit.file_name(), FILE])?;
        if text.is_empty() {
            self.take_away(Record::Notes, &path)
        } else {
            self.put(Record::Notes, &path, text)
        }
    }
}

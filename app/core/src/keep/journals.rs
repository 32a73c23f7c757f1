//! Journals of acts that were begun and not told to have ended.

use std::path::{Path, PathBuf};

use brushwork_link::clock;
use brushwork_link::settings::{Aftermath, Journal, SettingValue, SettingsImage, SettingsTable};

use super::backups::stamp;
use super::sequence;
use super::store::{KeepError, Record, Store};
use super::unit::{OWNER, UnitId};

const FOLDER: &str = "journals";
/// More than this are left over from long ago; the oldest give way.
const MOST: usize = 200;

/// A journal whose act is not known to have ended.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenJournal {
    /// Its file.
    pub path: PathBuf,
    /// What it says.
    pub journal: Journal,
}

/// What the controller's settings say of what was cut short, oldest first.
pub fn aftermaths(journals: &[OpenJournal], table: &SettingsTable, now: &SettingsImage) -> Vec<Aftermath> {
    journals.iter().map(|open| open.journal.aftermath(table, now)).collect()
}

impl Store {
    /// Keeps a journal; it is there until it is closed.
    pub fn open_journal(&self, unit: &UnitId, journal: &Journal) -> Result<PathBuf, KeepError> {
        let mut files = self.journal_files()?;
        let number = sequence::next(files.iter().map(|path| after_owner(sequence::stem(path))));
        let dated = format!("{}-{}", stamp(clock::today()), unit.file_name());
        let name = format!("{}{}", unit.owner(), sequence::numbered(number, &dated));
        let path = self.path(&[FOLDER, &format!("{name}.json")])?;
        self.put(Record::Journal, &path, &journal.to_json())?;
        files.retain(|file| *file != path);
        for old in files.iter().take((files.len() + 1).saturating_sub(MOST)) {
            // One too many harms nothing.
            let _ = self.take_away(Record::Journal, old);
        }
        Ok(path)
    }

    /// The files of all journals, in the order in which they were made.
    fn journal_files(&self) -> Result<Vec<PathBuf>, KeepError> {
        let mut files = self.list(Record::Journal, &[FOLDER])?;
        files.sort_by_cached_key(|path| {
            let (number, rest) = sequence::split(after_owner(sequence::stem(path)));
            (number, rest.to_owned())
        });
        Ok(files)
    }

    /// Its act has ended, or was told to the user.
    pub fn close_journal(&self, path: &Path) -> Result<(), KeepError> {
        self.take_away(Record::Journal, path)
    }

    /// What was cut short is settled, or was told: all of its journals are closed, as far as that can be.
    pub fn close_journals(&self, journals: &[OpenJournal]) -> Result<(), KeepError> {
        let closed: Vec<_> = journals.iter().map(|open| self.close_journal(&open.path)).collect();
        closed.into_iter().collect()
    }

    /// The journals of a unit that were not closed, oldest first, and what is wrong with those that cannot be read.
    pub fn open_journals(&self, unit: &UnitId) -> (Vec<OpenJournal>, Vec<KeepError>) {
        let (mut journals, mut faults) = (Vec::new(), Vec::new());
        let files = self.journal_files().unwrap_or_else(|fault| {
            // A user without a home has kept nothing.
            faults.extend((!matches!(fault, KeepError::NoFolder)).then_some(fault));
            Vec::new()
        });
        for path in files.into_iter().filter(|path| is_owned(path, unit)) {
            match self.read_journal(&path) {
                Ok(Some(journal)) if concerns(&journal, unit) => journals.push(OpenJournal { path, journal }),
                Ok(_) => {}
                Err(fault) if path.to_string_lossy().contains(&unit.file_name()) => faults.push(fault),
                Err(_) => {}
            }
        }
        (journals, faults)
    }

    /// Puts journals of a unit that cannot be read where nothing reads them; what they said was told.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub fn put_damaged_journals_aside<'f>(
        &self,
        faults: impl IntoIterator<Item = &'f KeepError>,
    ) -> Result<(), KeepError> {
        for fault in faults {
            if let KeepError::Damaged { record: Record::Journal, path, .. } = fault {
                self.put_aside(Record::Journal, path)?;
            }
        }
        Ok(())
    }

    /// `None` where another program has just closed it.
    fn read_journal(&self, path: &Path) -> Result<Option<Journal>, KeepError> {
        let Some(text) = self.text(Record::Journal, path)? else { return Ok(None) };
        Journal::parse(&text).map(Some).map_err(|error| KeepError::Damaged {
            record: Record::Journal,
            path: path.to_owned(),
            what: error.to_string(),
        })
    }
}

/// A journal's name without the process that it is for.
fn after_owner(name: &str) -> &str {
    let owned = name.strip_prefix(OWNER).and_then(|rest| rest.split_once('-'));
    owned.map_or(name, |(_, rest)| rest)
}

fn is_owned(path: &Path, unit: &UnitId) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if unit.is_simulated { name.starts_with(&unit.owner()) } else { !name.starts_with(OWNER) }
}

/// Whether the journal is of this unit, under its old address or the one it was to get.
fn concerns(journal: &Journal, unit: &UnitId) -> bool {
    let wanted = journal.wanted.settings.get("unit.address");
    let is_there = journal.before.address.get() == unit.address
        || wanted == Some(SettingValue::Int(i64::from(unit.address)));
    unit.is_of(&journal.before) && is_there
}

//! The folder in which everything is kept.

use std::borrow::Cow;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::messages::CoreRemedyMessage;
use brushwork_link::files::{Disk, Files, replace};
use brushwork_link::{Failure, Message};
use brushwork_values::{Words, error_key};
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::folder;

/// What is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// The settings before an act.
    Backup,
    /// What an act is about to change.
    Journal,
    /// How often an EEPROM was written.
    Wear,
    /// What an EEPROM held when that was proven last.
    Eeprom,
    /// Numbers that were written raw.
    RawWrites,
    /// A firmware update that was begun.
    Update,
    /// What a firmware answers.
    Capabilities,
    /// What a stop may change for a while.
    Loan,
    /// What people note of a unit.
    Notes,
}

impl Record {
    /// "the backup".
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Backup => "the backup",
            Self::Journal => "the journal",
            Self::Wear => "the count of saves",
            Self::Eeprom => "the note of what EEPROM holds",
            Self::RawWrites => "the list of raw numbers",
            Self::Update => "the note of the firmware update",
            Self::Capabilities => "the list of what the firmware answers",
            Self::Loan => "the note of what a stop may change",
            Self::Notes => "your notes on the unit",
        }
    }

    /// What it means that it cannot be kept.
    #[must_use]
    pub const fn unkept(self) -> &'static str {
        match self {
            Self::Backup => "Without it nothing is changed on the controller",
            Self::Journal => {
                "Without it nothing is changed on the controller, since what a change that is cut short has left could not be told"
            }
            Self::Wear => "How often this EEPROM was written is not known for certain then",
            Self::Eeprom => "What this EEPROM holds counts as not known then",
            Self::RawWrites => {
                "Neither `settings raw --undo` nor the report of `examine` knows that number then"
            }
            Self::Update => "A controller that waits in its firmware loader would not be known for that",
            Self::Capabilities => "It is learned again at the next connection",
            Self::Loan => "If this program died within a stop, nothing would offer to give that back",
            Self::Notes => "What was typed stays in the window until it is closed",
        }
    }

    /// What it means that it cannot be read.
    #[must_use]
    pub const fn unread(self) -> &'static str {
        match self {
            Self::Backup => "It cannot be restored",
            Self::Journal => {
                "So something that was begun on this controller may have been cut short: compare its settings with the newest backup \
                 (`brushwork settings compare backup ram`). `brushwork settings unfinished --forget` puts the file aside"
            }
            Self::Wear => {
                "So how often this EEPROM was written is not known; the next save begins a new count and puts the file aside"
            }
            Self::Eeprom => "So what this EEPROM holds counts as not known",
            Self::RawWrites => "So the numbers that were written raw before are not known",
            Self::Update => {
                "So whether a firmware update was begun here and did not end is not known: a controller that does not answer may wait \
                 in its firmware loader"
            }
            Self::Capabilities => "It is learned again",
            Self::Loan => {
                "So registers of this controller may still hold what a stop has changed for a while"
            }
            Self::Notes => {
                "So what was noted is not shown, and is not replaced before something else is typed"
            }
        }
    }
}

/// Something that could not be kept or read.
#[derive(Debug, Error)]
pub enum KeepError {
    /// There is no place to keep anything.
    #[error(
        "No folder to keep backups in: the user has no home folder. Set {} to a folder that can be written.",
        folder::VARIABLE
    )]
    NoFolder,
    /// A backup would lack settings.
    #[error("Not all settings could be read, so the backup would not be whole.")]
    NotWhole,
    /// A file could not be written; an older one of that name is as it was.
    #[error(
        "Writing {}, {}, failed: {source}. {}. Check the free space and your rights there, or set {} to another folder.",
        record.name(),
        path.display(),
        record.unkept(),
        folder::VARIABLE
    )]
    Write {
        /// What it is.
        record: Record,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file could not be read.
    #[error(
        "Reading {}, {}, failed: {}. {}. Check your rights there, or set {} to another folder.",
        record.name(),
        path.display(),
        what.trim_end().trim_end_matches('.'),
        record.unread(),
        folder::VARIABLE
    )]
    Read {
        /// What it is.
        record: Record,
        /// The file.
        path: PathBuf,
        /// What the system said.
        what: String,
    },
    /// A file does not hold what it held once.
    #[error("{} is damaged: {}. That was {}. {}.", path.display(), what.trim_end().trim_end_matches('.'), record.name(), record.unread())]
    Damaged {
        /// What it was.
        record: Record,
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

impl KeepError {
    /// As a failure of an act that needed it.
    pub fn failure(self, tried: impl Into<Message>) -> Failure {
        let came_back = Clause(self);
        Failure::new(tried, "this computer", came_back, CoreRemedyMessage::ThenTryAgain)
    }
}

/// The error without its full stop.
#[derive(Debug)]
struct Clause(KeepError);

impl fmt::Display for Clause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.to_string().trim_end_matches('.'))
    }
}

impl Words for Clause {
    fn key(&self) -> Cow<'static, str> {
        error_key(&self.0).into()
    }
}

/// The folder in which everything is kept. Clones are the same folder.
#[derive(Clone, Debug)]
pub struct Store {
    root: Option<PathBuf>,
    files: Arc<dyn Files>,
}

impl Store {
    /// The user's own.
    pub fn of_user() -> Self {
        Self { root: folder::data(), files: Arc::new(Disk) }
    }

    /// A folder of choice, made when something is kept.
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self::on(Arc::new(Disk), root)
    }

    /// A folder of choice on a disk of choice.
    pub fn on(files: Arc<dyn Files>, root: impl Into<PathBuf>) -> Self {
        Self { root: Some(root.into()), files }
    }

    /// Where it is, if there is any.
    pub fn root(&self) -> Option<&Path> {
        self.root.as_deref()
    }

    pub(super) fn files(&self) -> &dyn Files {
        &*self.files
    }

    pub(super) fn path(&self, parts: &[&str]) -> Result<PathBuf, KeepError> {
        let mut path = self.root.clone().ok_or(KeepError::NoFolder)?;
        path.extend(parts);
        Ok(path)
    }

    /// Replaces a file in one step, making its folder first.
    pub(super) fn put(&self, record: Record, path: &Path, text: &str) -> Result<(), KeepError> {
        let folder = path.parent().map_or(Ok(()), |folder| self.files.make_folder(folder));
        folder
            .and_then(|()| replace(&*self.files, path, text.as_bytes()))
            .map_err(|source| KeepError::Write { record, path: path.to_owned(), source })
    }

    /// The text of a file; `None` when there is no such file.
    pub(super) fn text(&self, record: Record, path: &Path) -> Result<Option<String>, KeepError> {
        let path = path.to_owned();
        match self.files.read(&path) {
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                Err(KeepError::Damaged { record, path, what: "it is no text".to_owned() })
            }
            read => found(read).map_err(|what| KeepError::Read { record, path, what }),
        }
    }

    /// What a file holds in JSON; `None` when there is no such file.
    pub(super) fn json<T: DeserializeOwned>(
        &self,
        record: Record,
        path: &Path,
    ) -> Result<Option<T>, KeepError> {
        let Some(text) = self.text(record, path)? else { return Ok(None) };
        serde_json::from_str(&text).map(Some).map_err(|error| KeepError::Damaged {
            record,
            path: path.to_owned(),
            what: error.to_string(),
        })
    }

    /// Takes a file away; that there is none is no failure.
    pub(super) fn take_away(&self, record: Record, path: &Path) -> Result<(), KeepError> {
        match self.files.remove(path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(KeepError::Write { record, path: path.to_owned(), source })
            }
            _ => Ok(()),
        }
    }

    /// Puts a damaged file where nothing reads it and its owner may still look at it.
    pub(super) fn put_aside(&self, record: Record, path: &Path) -> Result<(), KeepError> {
        let aside = path.with_extension("json.damaged");
        self.files.rename(path, &aside).map_err(|source| KeepError::Write {
            record,
            path: path.to_owned(),
            source,
        })
    }

    /// The files of a folder whose names end in `.json`; none when there is no such folder.
    pub(super) fn list(&self, record: Record, parts: &[&str]) -> Result<Vec<PathBuf>, KeepError> {
        let folder = self.path(parts)?;
        let is_ours = |path: &PathBuf| {
            path.extension().is_some_and(|extension| extension == "json")
                && path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'))
        };
        let mut files: Vec<PathBuf> = self.entries(record, &folder)?.into_iter().filter(is_ours).collect();
        files.sort();
        Ok(files)
    }

    /// All that is in a folder; nothing when there is no such folder.
    pub(super) fn entries(&self, record: Record, folder: &Path) -> Result<Vec<PathBuf>, KeepError> {
        let listed = found(self.files.list(folder));
        let listed = listed.map_err(|what| KeepError::Read { record, path: folder.to_owned(), what })?;
        Ok(listed.unwrap_or_default())
    }
}

/// What the system gave, `None` where there is nothing, or what it said.
fn found<T>(read: io::Result<T>) -> Result<Option<T>, String> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error.to_string()),
    }
}

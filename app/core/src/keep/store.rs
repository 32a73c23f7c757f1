//! The folder in which everything is kept.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::messages::CoreRemedyMessage;
use brushwork_link::settings::replace_file;
use brushwork_link::{Failure, Message};
use thiserror::Error;

use super::folder;

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
        "Writing {} failed: {source}. Check the free space and your rights there, or set {} to another folder.",
        path.display(),
        folder::VARIABLE
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file could not be read.
    #[error("Reading {} failed: {what}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said, or what is wrong with the file.
        what: String,
    },
}

impl KeepError {
    /// As a failure of an act that needed it.
    pub fn failure(self, tried: impl Into<Message>) -> Failure {
        let came_back = Message::error(Clause(self));
        Failure::new(tried, "this computer", came_back, CoreRemedyMessage::ThenTryAgain)
    }
}

/// The error without its full stop.
#[derive(Debug, Error)]
#[error("{}", .0.to_string().trim_end_matches('.'))]
struct Clause(KeepError);

/// The folder in which everything is kept. Clones are the same folder.
#[derive(Clone, Debug)]
pub struct Store {
    root: Option<PathBuf>,
}

impl Store {
    /// The user's own.
    pub fn of_user() -> Self {
        Self { root: folder::data() }
    }

    /// A folder of choice, made when something is kept.
    pub fn at(root: impl Into<PathBuf>) -> Self {
        Self { root: Some(root.into()) }
    }

    /// Where it is, if there is any.
    pub fn root(&self) -> Option<&Path> {
        self.root.as_deref()
    }

    pub(super) fn path(&self, parts: &[&str]) -> Result<PathBuf, KeepError> {
        let mut path = self.root.clone().ok_or(KeepError::NoFolder)?;
        path.extend(parts);
        Ok(path)
    }

    /// Replaces a file in one step, making its folder first.
    pub(super) fn put(&self, path: &Path, text: &str) -> Result<(), KeepError> {
        let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
        folder
            .and_then(|()| replace_file(path, text.as_bytes()))
            .map_err(|source| KeepError::Write { path: path.to_owned(), source })
    }

    /// The files of a folder whose names end in `.json`; none when there is no such folder.
    pub(super) fn files(&self, parts: &[&str]) -> Vec<PathBuf> {
        let Ok(folder) = self.path(parts) else { return Vec::new() };
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let is_ours = |path: &PathBuf| {
            path.extension().is_some_and(|extension| extension == "json")
                && path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.'))
        };
        let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_ours).collect();
        files.sort();
        files
    }
}

//! Profiles on disk. A file is replaced in one step: after a crash there is the old one or the new one,
//! whole.

use std::io;
use std::path::Path;

use super::content::{OpenedProfile, Profile, Strictness};
use super::error::ProfileFileError;
use crate::files::{Disk, Files as _, replace_file, write_new_file};

impl Profile {
    /// The profile in a file, with what reading it changed; see [`Profile::read`].
    pub fn open(path: &Path, strictness: Strictness) -> Result<OpenedProfile, ProfileFileError> {
        let text =
            Disk.read(path).map_err(|source| ProfileFileError::Read { path: path.to_owned(), source })?;
        Self::read(&text, strictness)
            .map_err(|source| ProfileFileError::Content { path: path.to_owned(), source })
    }

    /// The profile in a file; strict, see [`Profile::parse`].
    pub fn load(path: &Path) -> Result<Self, ProfileFileError> {
        Self::open(path, Strictness::Refuse).map(|opened| opened.profile)
    }

    /// Writes the profile to a file, replacing an older one in one step.
    pub fn save(&self, path: &Path) -> Result<(), ProfileFileError> {
        self.written(path, replace_file)
    }

    /// Writes the profile to a file that is not there yet.
    ///
    /// # Errors
    /// As [`Self::save`], and where there is such a file.
    pub fn save_new(&self, path: &Path) -> Result<(), ProfileFileError> {
        self.written(path, write_new_file)
    }

    fn written(
        &self,
        path: &Path,
        write: fn(&Path, &[u8]) -> io::Result<()>,
    ) -> Result<(), ProfileFileError> {
        write(path, self.to_json().as_bytes())
            .map_err(|source| ProfileFileError::Write { path: path.to_owned(), source })
    }
}

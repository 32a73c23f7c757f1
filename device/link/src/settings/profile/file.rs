//! Profiles on disk. A file is replaced in one step: after a crash there is the old one or the new one,
//! whole.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::Profile;
use super::error::{Problem, ProfileFileError};

impl Profile {
    /// The profile in a file; strict, see [`Profile::parse`].
    pub fn load(path: &Path) -> Result<Self, ProfileFileError> {
        let text = read(path)?;
        Self::parse(&text).map_err(|source| ProfileFileError::Content { path: path.to_owned(), source })
    }

    /// The profile in a file with faults of single settings mended; see [`Profile::parse_repairing`].
    pub fn load_repairing(path: &Path) -> Result<(Self, Vec<Problem>), ProfileFileError> {
        let text = read(path)?;
        Self::parse_repairing(&text)
            .map_err(|source| ProfileFileError::Content { path: path.to_owned(), source })
    }

    /// Writes the profile to a file, replacing an older one in one step.
    pub fn save(&self, path: &Path) -> Result<(), ProfileFileError> {
        replace_file(path, self.to_json().as_bytes())
            .map_err(|source| ProfileFileError::Write { path: path.to_owned(), source })
    }
}

/// Puts `content` into the file at `path`: written beside it, flushed to the disk, then renamed over it. On
/// failure the file is as it was. A symbolic link is followed, so that the file it points to is replaced and
/// not the link.
pub fn replace_file(path: &Path, content: &[u8]) -> io::Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let beside = temporary_beside(&target)?;
    let written = write_through(&beside, content).and_then(|()| keep_permissions(&target, &beside));
    written.and_then(|()| fs::rename(&beside, &target)).inspect_err(|_| {
        // The first error is the one to tell; a left-over temporary file harms nothing.
        let _ = fs::remove_file(&beside);
    })
}

fn read(path: &Path) -> Result<String, ProfileFileError> {
    fs::read_to_string(path).map_err(|source| ProfileFileError::Read { path: path.to_owned(), source })
}

fn temporary_beside(target: &Path) -> io::Result<PathBuf> {
    let name =
        target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.tmp", std::process::id()));
    Ok(target.with_file_name(hidden))
}

fn write_through(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_all()
}

fn keep_permissions(target: &Path, beside: &Path) -> io::Result<()> {
    match fs::metadata(target) {
        Ok(metadata) => fs::set_permissions(beside, metadata.permissions()),
        Err(_) => Ok(()),
    }
}

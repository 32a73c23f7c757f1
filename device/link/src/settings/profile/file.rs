//! Profiles on disk. A file is replaced in one step: after a crash there is the old one or the new one,
//! whole.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::content::{OpenedProfile, Profile, Strictness};
use super::error::ProfileFileError;

impl Profile {
    /// The profile in a file, with what reading it changed; see [`Profile::read`].
    pub fn open(path: &Path, strictness: Strictness) -> Result<OpenedProfile, ProfileFileError> {
        let text = fs::read_to_string(path)
            .map_err(|source| ProfileFileError::Read { path: path.to_owned(), source })?;
        Self::read(&text, strictness)
            .map_err(|source| ProfileFileError::Content { path: path.to_owned(), source })
    }

    /// The profile in a file; strict, see [`Profile::parse`].
    pub fn load(path: &Path) -> Result<Self, ProfileFileError> {
        Self::open(path, Strictness::Refuse).map(|opened| opened.profile)
    }

    /// Writes the profile to a file, replacing an older one in one step.
    pub fn save(&self, path: &Path) -> Result<(), ProfileFileError> {
        replace_file(path, self.to_json().as_bytes())
            .map_err(|source| ProfileFileError::Write { path: path.to_owned(), source })
    }
}

/// Tells the temporary files of one process apart.
static SERIAL: AtomicU32 = AtomicU32::new(0);

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
    })?;
    flush_folder(&target);
    Ok(())
}

fn temporary_beside(target: &Path) -> io::Result<PathBuf> {
    let name =
        target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let serial = SERIAL.fetch_add(1, Ordering::Relaxed);
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{serial}.tmp", std::process::id()));
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

/// Makes the new name last over a power loss of the computer, where the system lets a folder be flushed.
fn flush_folder(target: &Path) {
    #[cfg(unix)]
    if let Some(folder) = target.parent() {
        // The file itself is safe; a file system that cannot flush a folder keeps the name its own way.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    #[cfg(not(unix))]
    let _ = target;
}

//! The system's own disk.

use crate::bounded;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::layer::{Files, Look};

/// The disk of this computer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<String> {
        bounded::read_text(path)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect()
    }

    fn make_folder(&self, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)
    }

    fn write(&self, path: &Path, content: &[u8]) -> io::Result<()> {
        File::create(path)?.write_all(content)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Write + Send>> {
        Ok(Box::new(File::options().write(true).create_new(true).open(path)?))
    }

    fn flush(&self, path: &Path) -> io::Result<()> {
        if path.is_dir() {
            return flush_folder(path);
        }
        // Windows flushes only what is open for writing.
        File::options().write(true).open(path)?.sync_all()
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    fn remove_folder(&self, folder: &Path) -> io::Result<()> {
        fs::remove_dir(folder)
    }

    fn open_lock(&self, path: &Path) -> io::Result<Option<File>> {
        File::options().create(true).truncate(false).write(true).open(path).map(Some)
    }

    fn resolve(&self, path: &Path) -> PathBuf {
        fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
    }

    fn copy_rights(&self, from: &Path, to: &Path) -> io::Result<()> {
        match fs::metadata(from) {
            Ok(found) => fs::set_permissions(to, found.permissions()),
            Err(_) => Ok(()),
        }
    }
}

/// Makes new names last over a power loss of the computer, where the system lets a folder be flushed.
#[cfg(unix)]
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn flush_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // A file system that cannot flush a folder, or lets it be written and not read, keeps names its own way.
        Err(error) => match error.kind() {
            io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported | io::ErrorKind::PermissionDenied => {
                Ok(())
            }
            _ => Err(error),
        },
        Ok(()) => Ok(()),
    }
}

#[cfg(not(unix))]
fn flush_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

/// What a file is like.
///
/// # Errors
/// It is not there, or the system refuses.
pub fn look(path: &Path) -> io::Result<Look> {
    let found = fs::metadata(path)?;
    Ok(Look { is_file: found.is_file(), bytes: found.len(), changed: found.modified().ok() })
}

/// Opens a file to read it.
///
/// # Errors
/// It is not there, or the system refuses.
pub fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

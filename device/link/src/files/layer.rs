//! What keeping needs of a file system, and how a file is replaced in one step.

use std::ffi::OsString;
use std::fmt;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

/// What a file is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// No folder, device or pipe.
    pub is_file: bool,
    /// Its length.
    pub bytes: u64,
    /// When it was changed, as far as the system tells.
    pub changed: Option<SystemTime>,
}

/// What keeping needs of a file system, each a call that can fail and behind which the power may go.
pub trait Files: fmt::Debug + Send + Sync {
    /// A file's text.
    ///
    /// # Errors
    /// It is not there, is no text, or the system refuses.
    fn read(&self, path: &Path) -> io::Result<String>;

    /// What is in a folder, in any order.
    ///
    /// # Errors
    /// It is not there, or the system refuses.
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>>;

    /// Makes a folder and those above it, where they are not there.
    ///
    /// # Errors
    /// The system refuses.
    fn make_folder(&self, folder: &Path) -> io::Result<()>;

    /// Makes a file with that content; one of that name is emptied first, so that a failure may leave a part.
    ///
    /// # Errors
    /// The system refuses.
    fn write(&self, path: &Path, content: &[u8]) -> io::Result<()>;

    /// Makes a file that is not there yet, to be written bit by bit.
    ///
    /// # Errors
    /// It is there already, or the system refuses.
    fn create(&self, path: &Path) -> io::Result<Box<dyn Write + Send>>;

    /// Makes a file's content, or the names in a folder, outlast a power loss.
    ///
    /// # Errors
    /// The disk reports a failure. A file system that cannot do it for a folder is none.
    fn flush(&self, path: &Path) -> io::Result<()>;

    /// Gives a file another name in one step; a file of that name is gone then.
    ///
    /// # Errors
    /// The system refuses.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Takes a file away.
    ///
    /// # Errors
    /// It is not there, or the system refuses.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Takes an empty folder away.
    ///
    /// # Errors
    /// It is not there, is not empty, or the system refuses.
    fn remove_folder(&self, folder: &Path) -> io::Result<()>;

    /// Opens a file that programs lock, making it where it is not there. `None` where nobody else can be there.
    ///
    /// # Errors
    /// The system refuses.
    fn open_lock(&self, path: &Path) -> io::Result<Option<File>>;

    /// What a path leads to by symbolic links.
    fn resolve(&self, path: &Path) -> PathBuf {
        path.to_owned()
    }

    /// Gives a file the rights of another, where that is there.
    ///
    /// # Errors
    /// The system refuses.
    fn copy_rights(&self, _from: &Path, _to: &Path) -> io::Result<()> {
        Ok(())
    }
}

/// What tells this run of the program from others. A web page has no number: the moment at which it asks first stands for one.
#[must_use]
pub fn process_id() -> u32 {
    #[cfg(not(target_family = "wasm"))]
    return std::process::id();
    #[cfg(target_family = "wasm")]
    {
        static FIRST: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
        let since = || crate::clock::today().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        *FIRST.get_or_init(|| since().as_millis() as u32)
    }
}

/// Tells the temporary files of one process apart.
static SERIAL: AtomicU32 = AtomicU32::new(0);

/// Puts `content` into the file at `path`: written beside it, flushed to the disk, then renamed over it. After a crash at any moment there is the
/// old file or the new one, whole. A symbolic link is followed, so that the file it points to is replaced and not the link.
///
/// # Errors
/// As the calls of [`Files`]. The file is as it was then, or, where only flushing its name failed, new.
pub fn replace(files: &dyn Files, path: &Path, content: &[u8]) -> io::Result<()> {
    let target = files.resolve(path);
    let beside = temporary_beside(&target)?;
    files
        .write(&beside, content)
        .and_then(|()| files.flush(&beside))
        .and_then(|()| files.copy_rights(&target, &beside))
        .and_then(|()| files.rename(&beside, &target))
        .inspect_err(|_| {
            // The first error is the one to tell; a left-over temporary file harms nothing.
            let _ = files.remove(&beside);
        })?;
    flush_name(files, &target)
}

/// Makes a file's name outlast a power loss.
///
/// # Errors
/// As [`Files::flush`].
pub fn flush_name(files: &dyn Files, path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(folder) if folder.as_os_str().is_empty() => files.flush(Path::new(".")),
        Some(folder) => files.flush(folder),
        None => Ok(()),
    }
}

fn temporary_beside(target: &Path) -> io::Result<PathBuf> {
    let name =
        target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let serial = SERIAL.fetch_add(1, Ordering::Relaxed);
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{serial}.tmp", process_id()));
    Ok(target.with_file_name(hidden))
}

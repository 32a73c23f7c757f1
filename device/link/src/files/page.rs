//! The disk of a program that is a web page: its memory, and what the browser keeps for it.

use std::fs::File;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use super::layer::{Files, Look};
use super::memory::MemoryDisk;

static PAGE: MemoryDisk = MemoryDisk::new();

/// The page's own files.
#[must_use]
pub fn page() -> &'static MemoryDisk {
    &PAGE
}

/// The disk of this page.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<String> {
        PAGE.read(path)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        PAGE.list(folder)
    }

    fn make_folder(&self, folder: &Path) -> io::Result<()> {
        PAGE.make_folder(folder)
    }

    fn write(&self, path: &Path, content: &[u8]) -> io::Result<()> {
        PAGE.write(path, content)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Write + Send>> {
        PAGE.create(path)
    }

    fn flush(&self, path: &Path) -> io::Result<()> {
        PAGE.flush(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        PAGE.rename(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        PAGE.remove(path)
    }

    fn remove_folder(&self, folder: &Path) -> io::Result<()> {
        PAGE.remove_folder(folder)
    }

    fn open_lock(&self, path: &Path) -> io::Result<Option<File>> {
        PAGE.open_lock(path)
    }
}

/// What a file is like.
///
/// # Errors
/// It is not there.
pub fn look(path: &Path) -> io::Result<Look> {
    PAGE.look(path)
}

/// Opens a file to read it.
///
/// # Errors
/// It is not there.
pub fn open(path: &Path) -> io::Result<Cursor<Vec<u8>>> {
    PAGE.bytes(path).map(Cursor::new)
}

//! Files on the program's own disk, written whole.

use std::io;
use std::path::Path;

use super::Disk;
use super::layer::replace;

/// Replaces a file of the program's disk; see [`replace`].
///
/// # Errors
/// As [`replace`].
pub fn replace_file(path: &Path, content: &[u8]) -> io::Result<()> {
    replace(&Disk, path, content)
}

/// Writes a file that is not there yet.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] where something has that name, be it a link into nothing; else as [`replace`].
pub fn write_new_file(path: &Path, content: &[u8]) -> io::Result<()> {
    // What a web page downloads gets a name of its own from the browser.
    if cfg!(not(target_family = "wasm")) && path.symlink_metadata().is_ok() {
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, "it is there already, and is not replaced"));
    }
    replace_file(path, content)
}

//! The order in which files were made: a number at the beginning of their names, so that a clock which is behind, as on a board
//! without a battery for it, does not make the newest file look old.
//!
//! Version 0.1 named files by the date alone; those come before all that have a number, by their date.

use std::fs::{File, TryLockError};
use std::path::Path;
use std::thread;
use std::time::Duration;

use brushwork_link::files::Files;

/// Digits of a number at least: more than the four of the year with which names of version 0.1 begin.
const DIGITS: usize = 6;
/// How often, and how long after each other, the lock is tried that another program may hold for the time of one file.
const TRIES: u32 = 200;
const PAUSE: Duration = Duration::from_millis(10);

/// The number in a name, 0 where there is none, and the rest of the name.
pub(super) fn split(name: &str) -> (u64, &str) {
    let numbered = name
        .split_once('-')
        .filter(|(digits, _)| digits.len() >= DIGITS && digits.bytes().all(|letter| letter.is_ascii_digit()));
    match numbered.and_then(|(digits, rest)| Some((digits.parse().ok()?, rest))) {
        Some(split) => split,
        None => (0, name),
    }
}

/// A name with a number.
pub(super) fn numbered(number: u64, rest: &str) -> String {
    format!("{number:0DIGITS$}-{rest}")
}

/// The number after all of those names.
pub(super) fn next<'n>(names: impl Iterator<Item = &'n str>) -> u64 {
    names.map(|name| split(name).0).max().unwrap_or_default().saturating_add(1)
}

/// A file's name without its extension; empty where it is no text.
pub(super) fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|name| name.to_str()).unwrap_or_default()
}

/// Keeps other programs, and other threads of this one, from taking a number until it is dropped. Where the file system has no
/// locks, or somebody holds this one too long, two files may get the same number: they are ordered by date then.
pub(super) fn lock(files: &dyn Files, path: &Path) -> Option<File> {
    files.make_folder(path.parent()?).ok()?;
    let file = files.open_lock(path).ok()??;
    for _ in 0..TRIES {
        match file.try_lock() {
            Ok(()) => return Some(file),
            Err(TryLockError::WouldBlock) => thread::sleep(PAUSE),
            Err(TryLockError::Error(_)) => return None,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_version_0_1_has_no_number_and_comes_first() {
        let old = "2026-01-05T10-00-00.000Z-before-write";
        assert_eq!(split(old), (0, old));
        let new = numbered(next([old].into_iter()), "1970-01-01T00-00-00.000Z-before-write");
        assert_eq!(split(&new), (1, "1970-01-01T00-00-00.000Z-before-write"));
        assert_eq!(next([old, new.as_str()].into_iter()), 2);
        assert_eq!(split(&numbered(12_345_678, "x")), (12_345_678, "x"));
        assert_eq!(split("999999999999999999999999-x").0, 0);
    }
}

//! Unsaved programs, kept against a crash: each window has a folder with one file per unsaved program, and a lock that the system takes
//! away when the window is gone. Folders without a living owner are offered back.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use brushwork_link::files::replace_file;
use serde::{Deserialize, Serialize};

use super::disk::Format;
use super::doc_id::DocId;
use brushwork_link::bounded;

const LOCK: &str = "lock";

/// An unsaved program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kept {
    /// 1.
    pub version: u32,
    /// What its tab read.
    pub title: String,
    /// Its file, if it has one.
    pub path: Option<PathBuf>,
    pub format: Format,
    /// When it was kept.
    pub at: String,
    pub text: String,
}

/// What an earlier window left: its folder, and the programs in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Left {
    folder: PathBuf,
    pub programs: Vec<Kept>,
}

/// The unsaved programs of this window.
#[derive(Debug)]
pub struct Journal {
    /// Where every window has its folder.
    root: PathBuf,
    own: Option<Own>,
}

#[derive(Debug)]
struct Own {
    folder: PathBuf,
    /// Held as long as the window lives.
    _lock: File,
}

impl Journal {
    /// In a folder of the user's data folder.
    pub fn at(data: &Path) -> Self {
        Self { root: data.join("unsaved-mcl"), own: None }
    }

    /// What windows that are gone have left. Their folders stay until [`Journal::forget_left`].
    pub fn left(&self) -> Vec<Left> {
        let Ok(entries) = fs::read_dir(&self.root) else { return Vec::new() };
        let own = self.own.as_ref().map(|own| own.folder.as_path());
        let mut folders: Vec<PathBuf> =
            entries.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
        folders.sort();
        folders
            .into_iter()
            .filter(|folder| own != Some(folder.as_path()) && is_abandoned(folder))
            .map(|folder| Left { programs: programs(&folder), folder })
            .filter(|left| !left.programs.is_empty())
            .collect()
    }

    /// Takes away what an earlier window left.
    pub fn forget_left(&self, left: &[Left]) {
        for left in left.iter().filter(|left| is_abandoned(&left.folder)) {
            // What cannot be taken away is offered again.
            let _ = fs::remove_dir_all(&left.folder);
        }
    }

    /// Keeps a program as it is now.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn keep(&mut self, id: DocId, kept: &Kept) -> io::Result<()> {
        let folder = self.folder()?;
        let content = serde_json::to_vec(kept).map_err(io::Error::other)?;
        replace_file(&folder.join(format!("{}.json", id.0)), &content)
    }

    /// A program was saved or closed: nothing of it needs to be kept.
    pub fn forget(&self, id: DocId) {
        if let Some(own) = &self.own {
            // It may never have been kept.
            let _ = fs::remove_file(own.folder.join(format!("{}.json", id.0)));
        }
    }

    /// Nothing was left unsaved: the folder goes.
    pub fn end(&mut self) {
        if let Some(own) = self.own.take() {
            let folder = own.folder.clone();
            drop(own);
            let _ = fs::remove_dir_all(folder);
        }
    }

    fn folder(&mut self) -> io::Result<PathBuf> {
        if let Some(own) = &self.own {
            return Ok(own.folder.clone());
        }
        fs::create_dir_all(&self.root)?;
        let names = (0..10_000).map(|count| self.root.join(format!("{}-{count}", std::process::id())));
        for folder in names {
            match fs::create_dir(&folder) {
                Ok(()) => {
                    let lock = File::create(folder.join(LOCK))?;
                    lock.try_lock().map_err(io::Error::other)?;
                    self.own = Some(Own { folder: folder.clone(), _lock: lock });
                    return Ok(folder);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("no name is left"))
    }
}

/// Whether the window that made a folder is gone.
fn is_abandoned(folder: &Path) -> bool {
    File::open(folder.join(LOCK)).is_ok_and(|lock| lock.try_lock().is_ok())
}

fn programs(folder: &Path) -> Vec<Kept> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    paths.sort();
    let read = |path: PathBuf| serde_json::from_slice(&bounded::read_file(&path).ok()?).ok();
    paths.into_iter().filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(text: &str) -> Kept {
        Kept {
            version: 1,
            title: "a.mcl".into(),
            path: None,
            format: Format::default(),
            at: "now".into(),
            text: text.into(),
        }
    }

    #[test]
    fn what_a_window_leaves_is_offered_once_it_is_gone_and_not_before() {
        let data = tempfile::tempdir().unwrap();
        let mut first = Journal::at(data.path());
        first.keep(DocId(1), &kept("one")).unwrap();
        first.keep(DocId(1), &kept("two")).unwrap();
        let second = Journal::at(data.path());
        assert!(second.left().is_empty(), "its window lives");
        drop(first);
        let left = second.left();
        assert_eq!(left.len(), 1);
        assert_eq!(left[0].programs, [kept("two")]);
        second.forget_left(&left);
        assert!(second.left().is_empty());
    }

    #[test]
    fn what_was_saved_or_closed_is_not_offered() {
        let data = tempfile::tempdir().unwrap();
        let mut journal = Journal::at(data.path());
        journal.keep(DocId(1), &kept("one")).unwrap();
        journal.forget(DocId(1));
        drop(journal);
        assert!(Journal::at(data.path()).left().is_empty());
        let mut journal = Journal::at(data.path());
        journal.keep(DocId(2), &kept("two")).unwrap();
        journal.end();
        assert!(Journal::at(data.path()).left().is_empty());
    }

    #[test]
    fn a_damaged_file_costs_only_itself() {
        let data = tempfile::tempdir().unwrap();
        let mut journal = Journal::at(data.path());
        journal.keep(DocId(1), &kept("one")).unwrap();
        let folder = journal.own.as_ref().unwrap().folder.clone();
        fs::write(folder.join("2.json"), "{").unwrap();
        drop(journal);
        assert_eq!(Journal::at(data.path()).left()[0].programs, [kept("one")]);
    }
}

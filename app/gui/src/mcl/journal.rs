//! Unsaved programs, kept against a crash: each window has a folder with one file per unsaved program, and a lock that the system takes
//! away when the window is gone. Folders without a living owner are offered back.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use brushwork_link::files::{Disk, Files, process_id, replace};
use serde::{Deserialize, Serialize};

use super::disk::Format;
use super::doc_id::DocId;

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
    files: Arc<dyn Files>,
    /// Where every window has its folder.
    root: PathBuf,
    own: Option<Own>,
}

#[derive(Debug)]
struct Own {
    folder: PathBuf,
    /// Held as long as the window lives, where the disk has locks.
    _lock: Option<File>,
}

impl Journal {
    /// In a folder of the user's data folder.
    pub fn at(data: &Path) -> Self {
        Self::on(Arc::new(Disk), data)
    }

    fn on(files: Arc<dyn Files>, data: &Path) -> Self {
        Self { files, root: data.join("unsaved-mcl"), own: None }
    }

    /// What windows that are gone have left. Their folders stay until [`Journal::forget_left`].
    pub fn left(&self) -> Vec<Left> {
        let own = self.own.as_ref().map(|own| own.folder.as_path());
        let mut folders = self.files.list(&self.root).unwrap_or_default();
        folders.sort();
        folders
            .into_iter()
            .filter(|folder| own != Some(folder.as_path()))
            .map(|folder| Left { programs: self.programs(&folder), folder })
            .filter(|left| !left.programs.is_empty() && self.is_abandoned(&left.folder))
            .collect()
    }

    /// Takes away what an earlier window left.
    pub fn forget_left(&self, left: &[Left]) {
        left.iter().filter(|left| self.is_abandoned(&left.folder)).for_each(|left| self.clear(&left.folder));
    }

    /// Keeps a program as it is now.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn keep(&mut self, id: DocId, kept: &Kept) -> io::Result<()> {
        let folder = self.folder()?;
        let content = serde_json::to_vec(kept).map_err(io::Error::other)?;
        replace(&*self.files, &folder.join(format!("{}.json", id.0)), &content)
    }

    /// A program was saved or closed: nothing of it needs to be kept.
    pub fn forget(&self, id: DocId) {
        if let Some(own) = &self.own {
            // It may never have been kept.
            let _ = self.files.remove(&own.folder.join(format!("{}.json", id.0)));
        }
    }

    /// Nothing was left unsaved: the folder goes.
    pub fn end(&mut self) {
        if let Some(Own { folder, _lock: lock }) = self.own.take() {
            drop(lock);
            self.clear(&folder);
        }
    }

    fn folder(&mut self) -> io::Result<PathBuf> {
        if let Some(own) = &self.own {
            return Ok(own.folder.clone());
        }
        for count in 0..10_000 {
            let folder = self.root.join(format!("{}-{count}", process_id()));
            // An earlier program had the same number, or another window of this one has it.
            if self.files.list(&folder).is_ok_and(|found| !found.is_empty()) {
                continue;
            }
            self.files.make_folder(&folder)?;
            let lock = self.files.open_lock(&folder.join(LOCK))?;
            if let Some(lock) = &lock {
                lock.try_lock().map_err(io::Error::other)?;
            }
            self.files.flush(&self.root)?;
            self.own = Some(Own { folder: folder.clone(), _lock: lock });
            return Ok(folder);
        }
        Err(io::Error::other("no name is left"))
    }

    /// Whether the window that made a folder is gone.
    fn is_abandoned(&self, folder: &Path) -> bool {
        let lock = self.files.open_lock(&folder.join(LOCK));
        lock.is_ok_and(|lock| lock.is_none_or(|lock| lock.try_lock().is_ok()))
    }

    /// What cannot be taken away is offered again.
    fn clear(&self, folder: &Path) {
        for path in self.files.list(folder).unwrap_or_default() {
            let _ = self.files.remove(&path);
        }
        let _ = self.files.remove_folder(folder);
    }

    fn programs(&self, folder: &Path) -> Vec<Kept> {
        let mut paths = self.files.list(folder).unwrap_or_default();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
        paths.sort();
        let read = |path: PathBuf| serde_json::from_str(&self.files.read(&path).ok()?).ok();
        paths.into_iter().filter_map(read).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::files::{DiskFault, Remains, SimulatedDisk};

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
        std::fs::write(folder.join("2.json"), "{").unwrap();
        drop(journal);
        assert_eq!(Journal::at(data.path()).left()[0].programs, [kept("one")]);
    }
    #[test]
    fn a_program_that_was_kept_outlasts_whatever_the_disk_does_to_the_next_keeping() {
        let [one, two] = ["one", "two"].map(kept);
        let mut tried = 0;
        for fault in DiskFault::ALL {
            for call in 1.. {
                let disk = SimulatedDisk::default();
                let mut journal = Journal::on(Arc::new(disk.clone()), Path::new("/data"));
                journal.keep(DocId(1), &one).unwrap();
                disk.fail_at(call, fault);
                let result = journal.keep(DocId(1), &two);
                if disk.calls() < call {
                    assert!(result.is_ok(), "{fault:?}: a call that was never made cannot fail");
                    break;
                }
                for remains in Remains::ALL {
                    let left = Journal::on(Arc::new(disk.after_crash(remains)), Path::new("/data")).left();
                    let programs: Vec<_> = left.into_iter().flat_map(|left| left.programs).collect();
                    let as_told = if result.is_ok() { &[&two][..] } else { &[&one, &two] };
                    let is_whole = matches!(&programs[..], [found] if as_told.contains(&found));
                    assert!(is_whole, "{fault:?} {call} {remains:?}: {programs:?}");
                    tried += 1;
                }
            }
        }
        assert!(tried > 100, "{tried}");
    }
}

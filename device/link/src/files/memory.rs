//! Files in memory, for a program that has no disk, such as a web page. A shelf makes them last, as far as it can.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use super::layer::{Files, Look};
use crate::clock::today;

/// Where files in memory are put so that they last.
pub trait Shelf: Send + Sync {
    /// Puts a file there in place of the one of that name.
    ///
    /// # Errors
    /// There is no room, or no shelf.
    fn put(&self, path: &Path, content: &[u8]) -> io::Result<()>;

    /// Takes a file away; that there is none is no failure.
    fn take(&self, path: &Path);
}

/// The files, and their shelf once there is one.
#[derive(Default)]
pub struct MemoryDisk(Mutex<State>);

#[derive(Default)]
struct State {
    files: BTreeMap<PathBuf, (Vec<u8>, SystemTime)>,
    shelf: Option<Box<dyn Shelf>>,
}

impl fmt::Debug for MemoryDisk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("MemoryDisk")
    }
}

impl MemoryDisk {
    /// A disk without any files and without a shelf.
    #[must_use]
    pub const fn new() -> Self {
        Self(Mutex::new(State { files: BTreeMap::new(), shelf: None }))
    }

    /// Begins with what lay on a shelf, and puts there from now on what is written.
    pub fn begin(&self, shelf: Box<dyn Shelf>, lay_there: impl IntoIterator<Item = (PathBuf, Vec<u8>)>) {
        let mut state = self.state();
        state.files.extend(lay_there.into_iter().map(|(path, content)| (path, (content, today()))));
        state.shelf = Some(shelf);
    }

    /// A file that was brought in from outside, which its owner has anyway.
    pub fn bring(&self, path: &Path, content: Vec<u8>) {
        self.state().files.insert(path.to_owned(), (content, today()));
    }

    /// A file's bytes.
    ///
    /// # Errors
    /// It is not there.
    pub fn bytes(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.state().file(path).map(|(content, _)| content.clone())
    }

    /// What a file is like.
    ///
    /// # Errors
    /// It is not there.
    pub fn look(&self, path: &Path) -> io::Result<Look> {
        let state = self.state();
        let (content, changed) = state.file(path)?;
        Ok(Look { is_file: true, bytes: content.len() as u64, changed: Some(*changed) })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn file(&self, path: &Path) -> io::Result<&(Vec<u8>, SystemTime)> {
        self.files.get(path).ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    /// What is written beside a file to replace it need not last.
    fn put(&mut self, path: &Path, content: Vec<u8>) -> io::Result<()> {
        if let Some(shelf) = self.shelf.as_ref().filter(|_| !is_temporary(path)) {
            shelf.put(path, &content)?;
        }
        self.files.insert(path.to_owned(), (content, today()));
        Ok(())
    }

    fn take(&mut self, path: &Path) -> io::Result<Vec<u8>> {
        let (content, _) = self.files.remove(path).ok_or(io::ErrorKind::NotFound)?;
        if let Some(shelf) = self.shelf.as_ref().filter(|_| !is_temporary(path)) {
            shelf.take(path);
        }
        Ok(content)
    }
}

fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    name.is_some_and(|name| name.starts_with('.') && name.ends_with(".tmp"))
}

impl Files for MemoryDisk {
    fn read(&self, path: &Path) -> io::Result<String> {
        String::from_utf8(self.bytes(path)?)
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    }

    /// A folder is there as long as something is in it.
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let state = self.state();
        let below = |path: &PathBuf| {
            let rest = path.strip_prefix(folder).ok()?;
            Some(folder.join(rest.components().next()?))
        };
        let found: BTreeSet<PathBuf> = state.files.keys().filter_map(below).collect();
        if found.is_empty() { Err(io::ErrorKind::NotFound.into()) } else { Ok(found.into_iter().collect()) }
    }

    fn make_folder(&self, _folder: &Path) -> io::Result<()> {
        Ok(())
    }

    fn write(&self, path: &Path, content: &[u8]) -> io::Result<()> {
        self.state().put(path, content.to_vec())
    }

    /// A shelf takes files whole: who has no disk writes them so.
    fn create(&self, _path: &Path) -> io::Result<Box<dyn Write + Send>> {
        Err(io::ErrorKind::Unsupported.into())
    }

    fn flush(&self, _path: &Path) -> io::Result<()> {
        Ok(())
    }

    /// The shelf has the file under its new name before it loses the old one.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let mut state = self.state();
        let content = state.file(from)?.0.clone();
        state.put(to, content)?;
        state.take(from).map(drop)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.state().take(path).map(drop)
    }

    /// It went with the last file in it.
    fn remove_folder(&self, _folder: &Path) -> io::Result<()> {
        Ok(())
    }

    fn open_lock(&self, _path: &Path) -> io::Result<Option<File>> {
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::super::replace;
    use super::*;
    use std::sync::Arc;

    /// Keeps what fits.
    #[derive(Clone, Default)]
    struct Small(Arc<Mutex<BTreeMap<PathBuf, Vec<u8>>>>);

    impl Small {
        const ROOM: usize = 20;

        fn held(&self) -> BTreeMap<PathBuf, Vec<u8>> {
            self.0.lock().unwrap().clone()
        }
    }

    impl Shelf for Small {
        fn put(&self, path: &Path, content: &[u8]) -> io::Result<()> {
            if content.len() > Self::ROOM {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.0.lock().unwrap().insert(path.to_owned(), content.to_vec());
            Ok(())
        }

        fn take(&self, path: &Path) {
            self.0.lock().unwrap().remove(path);
        }
    }

    fn path(text: &str) -> &Path {
        Path::new(text)
    }

    #[test]
    fn what_is_written_lies_on_the_shelf_and_is_found_there_by_the_next_disk() {
        let (disk, shelf) = (MemoryDisk::new(), Small::default());
        disk.begin(Box::new(shelf.clone()), []);
        replace(&disk, path("/keep/units/a.json"), b"old").unwrap();
        replace(&disk, path("/keep/units/a.json"), b"new").unwrap();
        replace(&disk, path("/keep/b.json"), b"other").unwrap();
        assert_eq!(shelf.held().len(), 2, "nothing temporary lies there: {:?}", shelf.held().keys());
        let next = MemoryDisk::new();
        next.begin(Box::new(shelf.clone()), shelf.held());
        assert_eq!(next.read(path("/keep/units/a.json")).unwrap(), "new");
        assert_eq!(next.list(path("/keep")).unwrap(), [path("/keep/b.json"), path("/keep/units")]);
        assert_eq!(next.list(path("/nowhere")).unwrap_err().kind(), io::ErrorKind::NotFound);
        next.remove(path("/keep/b.json")).unwrap();
        assert!(!shelf.held().contains_key(path("/keep/b.json")));
    }

    #[test]
    fn what_the_shelf_has_no_room_for_is_refused_and_the_old_file_stays() {
        let (disk, shelf) = (MemoryDisk::new(), Small::default());
        disk.begin(Box::new(shelf.clone()), []);
        replace(&disk, path("/keep/a.json"), b"old").unwrap();
        let refused = replace(&disk, path("/keep/a.json"), &[b'x'; Small::ROOM + 1]).unwrap_err();
        assert_eq!(refused.kind(), io::ErrorKind::StorageFull);
        assert_eq!(disk.read(path("/keep/a.json")).unwrap(), "old");
        assert_eq!(shelf.held()[path("/keep/a.json")], b"old");
        assert_eq!(disk.list(path("/keep")).unwrap(), [path("/keep/a.json")]);
    }

    #[test]
    fn a_file_from_outside_is_read_and_not_put_on_the_shelf() {
        let (disk, shelf) = (MemoryDisk::new(), Small::default());
        disk.begin(Box::new(shelf.clone()), []);
        disk.bring(path("/files/a.csv"), vec![b'1'; 100]);
        assert_eq!(disk.look(path("/files/a.csv")).unwrap().bytes, 100);
        assert_eq!(disk.bytes(path("/files/a.csv")).unwrap().len(), 100);
        assert!(shelf.held().is_empty());
    }
}

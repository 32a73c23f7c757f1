//! A disk in memory that does to its files what real ones do at the worst moment, in the manner of the disks that databases are tested with.
//!
//! What was written and not flushed may be there after a crash, in part or not at all; a name that was given and whose folder was not flushed may
//! be the old one. Clones are the same disk.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::layer::Files;

/// What goes wrong at a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiskFault {
    /// The disk is full from then on: half of what is written fits.
    Full,
    /// Nothing can be changed any more from then on.
    ReadOnly,
    /// The user has no right to that, that once.
    Refused,
    /// The disk reports a failure, that once; half of a write is done.
    Failed,
    /// The power goes: half of a write is done, and nothing more is.
    CutWithin,
    /// The power goes right after the call.
    CutAfter,
}

impl DiskFault {
    /// Each of them.
    pub const ALL: [Self; 6] =
        [Self::Full, Self::ReadOnly, Self::Refused, Self::Failed, Self::CutWithin, Self::CutAfter];
}

/// What a crash leaves of what was not flushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remains {
    /// Names that were given and not flushed are there, old ones else.
    pub names: bool,
    /// How much of a content that was not flushed is there, in halves.
    pub halves: usize,
}

impl Remains {
    /// Every mixture.
    pub const ALL: [Self; 6] = [
        Self { names: true, halves: 2 },
        Self { names: true, halves: 1 },
        Self { names: true, halves: 0 },
        Self { names: false, halves: 2 },
        Self { names: false, halves: 1 },
        Self { names: false, halves: 0 },
    ];
}

/// The disk.
#[derive(Clone, Debug, Default)]
pub struct SimulatedDisk(Arc<Mutex<State>>);

#[derive(Clone, Debug, Default)]
struct State {
    folders: BTreeSet<PathBuf>,
    /// By the number that names give.
    contents: Vec<Content>,
    /// What programs see.
    names: BTreeMap<PathBuf, usize>,
    /// What a crash leaves for certain.
    flushed_names: BTreeMap<PathBuf, usize>,
    calls: usize,
    fault: Option<(usize, DiskFault)>,
}

#[derive(Clone, Debug, Default)]
struct Content {
    now: Vec<u8>,
    /// So many bytes of it were flushed.
    flushed: usize,
}

/// What a call may do.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Call {
    Look,
    Change,
    /// A change that takes room.
    Fill,
}

impl SimulatedDisk {
    /// The call of that number from now on, counted from 1, fails so.
    pub fn fail_at(&self, call: usize, fault: DiskFault) {
        let mut state = self.state();
        state.calls = 0;
        state.fault = Some((call, fault));
    }

    /// Calls made since [`SimulatedDisk::fail_at`].
    #[must_use]
    pub fn calls(&self) -> usize {
        self.state().calls
    }

    /// The disk as another start of the computer finds it, in order again.
    #[must_use]
    pub fn after_crash(&self, remains: Remains) -> Self {
        let mut state = self.state().clone();
        if !remains.names {
            state.names = state.flushed_names.clone();
        }
        for content in &mut state.contents {
            let unflushed = content.now.len() - content.flushed;
            content.now.truncate(content.flushed + unflushed * remains.halves / 2);
            content.flushed = content.now.len();
        }
        state.flushed_names = state.names.clone();
        state.calls = 0;
        state.fault = None;
        Self(Arc::new(Mutex::new(state)))
    }

    /// A file's bytes, looked at from outside: no call that could fail.
    #[must_use]
    pub fn bytes(&self, path: &Path) -> Option<Vec<u8>> {
        let state = self.state();
        Some(state.contents[state.number(path).ok()?].now.clone())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A file that is written bit by bit.
struct Growing {
    disk: SimulatedDisk,
    number: usize,
}

impl Write for Growing {
    /// A call that fails has written nothing, but where the power goes; a disk that becomes full first takes what fits.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut state = self.disk.state();
        let fault = state.begin(Call::Fill)?;
        let half = &bytes[..bytes.len() / 2];
        let is_now = state.fault.is_some_and(|(number, _)| number == state.calls);
        let content = &mut state.contents[self.number].now;
        match fault {
            None => content.extend(bytes),
            Some(DiskFault::Full) if is_now && !half.is_empty() => {
                content.extend(half);
                return Ok(half.len());
            }
            Some(DiskFault::Full) => return Err(io::ErrorKind::StorageFull.into()),
            Some(DiskFault::CutWithin) => {
                content.extend(half);
                return Err(io::Error::other("the power is off"));
            }
            Some(_) => return Err(io::Error::other("the disk reports a failure")),
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl State {
    /// Counts a call. An error is what it fails with; a fault that it goes on with is handed back.
    fn begin(&mut self, call: Call) -> io::Result<Option<DiskFault>> {
        self.calls += 1;
        let Some((number, fault)) = self.fault.filter(|(number, _)| self.calls >= *number) else {
            return Ok(None);
        };
        let is_now = self.calls == number;
        let error = |kind: io::ErrorKind| Err(io::Error::from(kind));
        match fault {
            DiskFault::Full if call == Call::Fill => Ok(Some(fault)),
            DiskFault::ReadOnly if call != Call::Look => error(io::ErrorKind::ReadOnlyFilesystem),
            DiskFault::Refused if is_now => error(io::ErrorKind::PermissionDenied),
            DiskFault::Failed | DiskFault::CutWithin if is_now && call == Call::Fill => Ok(Some(fault)),
            DiskFault::Failed if is_now => Err(io::Error::other("the disk reports a failure")),
            DiskFault::CutAfter if is_now => Ok(None),
            DiskFault::CutWithin | DiskFault::CutAfter => Err(io::Error::other("the power is off")),
            DiskFault::Full | DiskFault::ReadOnly | DiskFault::Refused | DiskFault::Failed => Ok(None),
        }
    }

    fn number(&self, path: &Path) -> io::Result<usize> {
        self.names.get(path).copied().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

impl Files for SimulatedDisk {
    fn read(&self, path: &Path) -> io::Result<String> {
        let mut state = self.state();
        state.begin(Call::Look)?;
        let content = state.contents[state.number(path)?].now.clone();
        String::from_utf8(content).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let mut state = self.state();
        state.begin(Call::Look)?;
        if !state.folders.contains(folder) {
            return Err(io::ErrorKind::NotFound.into());
        }
        let all = state.names.keys().chain(&state.folders);
        Ok(all.filter(|path| path.parent() == Some(folder)).cloned().collect())
    }

    fn make_folder(&self, folder: &Path) -> io::Result<()> {
        let mut state = self.state();
        match state.begin(Call::Fill)? {
            Some(DiskFault::Full) if !state.folders.contains(folder) => {
                Err(io::ErrorKind::StorageFull.into())
            }
            Some(DiskFault::Failed | DiskFault::CutWithin) => {
                Err(io::Error::other("the disk reports a failure"))
            }
            Some(DiskFault::Full | DiskFault::ReadOnly | DiskFault::Refused | DiskFault::CutAfter) | None => {
                state.folders.extend(folder.ancestors().map(Path::to_owned));
                Ok(())
            }
        }
    }

    fn write(&self, path: &Path, content: &[u8]) -> io::Result<()> {
        let mut state = self.state();
        let fault = state.begin(Call::Fill)?;
        if !path.parent().is_some_and(|folder| state.folders.contains(folder)) {
            return Err(io::ErrorKind::NotFound.into());
        }
        let number = match state.number(path) {
            Ok(number) => number,
            Err(_) => {
                state.contents.push(Content::default());
                state.contents.len() - 1
            }
        };
        state.names.insert(path.to_owned(), number);
        let written = if fault.is_some() { content.len() / 2 } else { content.len() };
        state.contents[number] = Content { now: content[..written].to_vec(), flushed: 0 };
        match fault {
            None => Ok(()),
            Some(DiskFault::Full) => Err(io::ErrorKind::StorageFull.into()),
            Some(_) => Err(io::Error::other("the disk reports a failure")),
        }
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Write + Send>> {
        let mut state = self.state();
        match state.begin(Call::Fill)? {
            None => {}
            Some(DiskFault::Full) => return Err(io::ErrorKind::StorageFull.into()),
            Some(_) => return Err(io::Error::other("the disk reports a failure")),
        }
        if !path.parent().is_some_and(|folder| state.folders.contains(folder)) {
            return Err(io::ErrorKind::NotFound.into());
        }
        if state.names.contains_key(path) {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        let number = state.contents.len();
        state.contents.push(Content::default());
        state.names.insert(path.to_owned(), number);
        Ok(Box::new(Growing { disk: self.clone(), number }))
    }

    fn flush(&self, path: &Path) -> io::Result<()> {
        let mut state = self.state();
        state.begin(Call::Change)?;
        if state.folders.contains(path) {
            let is_in = |name: &PathBuf| name.parent() == Some(path);
            let now: Vec<_> = state
                .names
                .iter()
                .filter(|(name, _)| is_in(name))
                .map(|(name, number)| (name.clone(), *number))
                .collect();
            state.flushed_names.retain(|name, _| !is_in(name));
            state.flushed_names.extend(now);
            return Ok(());
        }
        let number = state.number(path)?;
        let content = &mut state.contents[number];
        content.flushed = content.now.len();
        Ok(())
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let mut state = self.state();
        state.begin(Call::Change)?;
        let number = state.number(from)?;
        state.names.remove(from);
        state.names.insert(to.to_owned(), number);
        Ok(())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        let mut state = self.state();
        state.begin(Call::Change)?;
        state.number(path)?;
        state.names.remove(path);
        Ok(())
    }

    fn remove_folder(&self, folder: &Path) -> io::Result<()> {
        let mut state = self.state();
        state.begin(Call::Change)?;
        if state.names.keys().any(|name| name.parent() == Some(folder)) {
            return Err(io::ErrorKind::DirectoryNotEmpty.into());
        }
        state.folders.remove(folder).then_some(()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn open_lock(&self, _path: &Path) -> io::Result<Option<File>> {
        self.state().begin(Call::Fill).map(|_| None)
    }
}

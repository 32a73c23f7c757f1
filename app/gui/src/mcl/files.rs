//! The thread that reads and writes programs, so that the window never waits for a disk.

use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::Message;
use brushwork_link::messages::RemedyMessage;
use std::path::{Path, PathBuf};

use brushwork_link::Failure;
use brushwork_link::work::Worker;
use crossbeam_channel::{Receiver, TrySendError, bounded};

use super::disk::{self, Loaded, Stamp};
use super::doc_id::DocId;
use super::journal::{Journal, Kept, Left};

/// Tasks that may wait; a person does not do more at once.
const QUEUE: usize = 256;

/// What is to be done.
#[derive(Debug)]
pub enum Task {
    Open(PathBuf),
    /// Reads the file of an open program again.
    Reload(DocId, PathBuf),
    /// Writes a program, unless its file is not as it was when it was read: `expected`.
    Save {
        id: DocId,
        path: PathBuf,
        bytes: Vec<u8>,
        revision: u64,
        expected: Option<Stamp>,
    },
    /// Writes any other file.
    Export {
        path: PathBuf,
        bytes: Vec<u8>,
        what: &'static str,
    },
    /// Looks whether files are as they were.
    Look(Vec<(DocId, PathBuf, Option<Stamp>)>),
    Keep(DocId, Box<Kept>),
    Forget(DocId),
    /// Looks for what earlier windows left unsaved.
    FindLeft,
    ForgetLeft(Vec<Left>),
    /// The window closes with nothing unsaved.
    End,
}

/// What became of it.
#[derive(Debug)]
pub enum Done {
    Opened(PathBuf, Result<Loaded, Failure>),
    Reloaded(DocId, Result<Loaded, Failure>),
    Saved {
        id: DocId,
        path: PathBuf,
        revision: u64,
        result: Result<Option<Stamp>, SaveError>,
    },
    Exported(PathBuf, &'static str, Result<(), Failure>),
    /// These files are not as they were; without a stamp they are gone.
    Changed(Vec<(DocId, Option<Stamp>)>),
    Left(Vec<Left>),
    /// The journal cannot be written.
    NotKept(Failure),
}

/// Why a program was not saved.
#[derive(Debug)]
pub enum SaveError {
    /// Another program has written the file since.
    Changed,
    Failed(Failure),
}

/// The thread.
pub struct Files {
    tasks: Worker<Task>,
    done: Receiver<Done>,
}

impl std::fmt::Debug for Files {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Files")
    }
}

impl Files {
    /// Starts the thread; the journal is in the folder `data`, if there is one. `tell` is called when there is news.
    pub fn start(data: Option<&Path>, tell: impl Fn() + Send + 'static) -> Self {
        let (sender, done) = bounded(QUEUE);
        let mut journal = data.map(Journal::at);
        let mut complained = false;
        let work = move |task| {
            let done = perform(task, journal.as_mut());
            let done = done.filter(|done| {
                !matches!(done, Done::NotKept(_)) || !std::mem::replace(&mut complained, true)
            });
            // A window that is gone wants no answer, but what it asked for is still done.
            if done.is_some_and(|done| sender.send(done).is_ok()) {
                tell();
            }
        };
        // Where the system gives no thread, every task is refused, which is said.
        Self { tasks: Worker::start("mcl files", QUEUE, work), done }
    }

    /// Queues a task; a failure is told.
    pub fn ask(&self, task: Task) -> Result<(), Failure> {
        self.tasks.give(task).map_err(|error| {
            let why = match error {
                TrySendError::Full(_) => WindowCauseMessage::DiskIsBusy,
                TrySendError::Disconnected(_) => WindowCauseMessage::NoThread,
            };
            Failure::new(WindowActMessage::UseDisk, "this computer", why, RemedyMessage::TryAgain)
        })
    }

    pub fn news(&self) -> Option<Done> {
        self.done.try_recv().ok()
    }
}

impl Drop for Files {
    /// Waits for what is still to be written.
    fn drop(&mut self) {
        // Nobody takes the answers any more; a full channel would hold the thread up.
        self.done = bounded(0).1;
        self.tasks.finish();
    }
}

fn perform(task: Task, journal: Option<&mut Journal>) -> Option<Done> {
    match task {
        Task::Open(path) => {
            let result = disk::read(&path);
            Some(Done::Opened(path, result))
        }
        Task::Reload(id, path) => Some(Done::Reloaded(id, disk::read(&path))),
        Task::Save { id, path, bytes, revision, expected } => {
            let result = save(&path, &bytes, expected);
            Some(Done::Saved { id, path, revision, result })
        }
        Task::Export { path, bytes, what } => {
            let result = disk::write(&path, &bytes).map(|_| ());
            Some(Done::Exported(path, what, result))
        }
        Task::Look(files) => {
            let now = |path: &Path| Stamp::of(path).ok();
            let changed: Vec<_> = files
                .into_iter()
                .map(|(id, path, before)| (id, before, now(&path)))
                .filter(|(_, before, now)| before != now)
                .map(|(id, _, now)| (id, now))
                .collect();
            (!changed.is_empty()).then_some(Done::Changed(changed))
        }
        other @ (Task::Keep(..) | Task::Forget(_) | Task::FindLeft | Task::ForgetLeft(_) | Task::End) => {
            keep(other, journal?)
        }
    }
}

fn keep(task: Task, journal: &mut Journal) -> Option<Done> {
    match task {
        Task::Keep(id, kept) => {
            let failed = journal.keep(id, &kept).err()?;
            let (failed, remedy) = (Message::error(failed), WindowRemedyMessage::SaveNowAndThen);
            return Some(Done::NotKept(Failure::new(
                WindowActMessage::KeepUnsaved,
                kept.title,
                failed,
                remedy,
            )));
        }
        Task::Forget(id) => journal.forget(id),
        Task::FindLeft => {
            let left = journal.left();
            return (!left.is_empty()).then_some(Done::Left(left));
        }
        Task::ForgetLeft(left) => journal.forget_left(&left),
        Task::End => journal.end(),
        Task::Open(_) | Task::Reload(..) | Task::Save { .. } | Task::Export { .. } | Task::Look(_) => {}
    }
    None
}

fn save(path: &Path, bytes: &[u8], expected: Option<Stamp>) -> Result<Option<Stamp>, SaveError> {
    if expected.is_some() && Stamp::of(path).ok().is_some_and(|now| Some(now) != expected) {
        return Err(SaveError::Changed);
    }
    disk::write(path, bytes).map_err(SaveError::Failed)
}

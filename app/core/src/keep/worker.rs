//! The thread that writes files while a controller is worked on.

use crate::messages::{CoreActMessage, CoreCauseMessage, CoreRemedyMessage};
use brushwork_link::messages::ActMessage;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::settings::{Act, Ending, Entry, Journal, Keeper, Profile, SettingsImage};
use brushwork_link::work;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::store::{KeepError, Store};
use super::today::today;
use super::unit::{UnitId, profile_of};

/// Tasks that may wait. An act has two, one after the other.
const QUEUE: usize = 64;
/// How long one look at whether something is kept may take.
const MOMENT: Duration = Duration::from_millis(10);

/// The store, and the thread that writes to it. Dropping the last of its clones waits for what is still to be written.
#[derive(Clone, Debug)]
pub struct Keeping {
    store: Store,
    worker: Arc<Worker>,
}

#[derive(Debug)]
struct Worker {
    tasks: work::Worker<Task>,
    /// What could not be kept at the end of acts, and was not told yet.
    faults: Arc<Mutex<Vec<KeepError>>>,
}

/// What is known of the unit besides its settings.
#[derive(Clone, Debug)]
struct Origin {
    unit: UnitId,
    firmware: String,
}

enum Task {
    Begin { origin: Origin, entry: Box<Entry>, answer: Sender<Result<Begun, Failure>> },
    End { origin: Origin, begun: Box<Begun>, ending: Ending, done: Sender<()> },
}

/// What was kept when an act began.
#[derive(Clone, Debug)]
struct Begun {
    act: Act,
    path: PathBuf,
    journal: Journal,
}

impl Keeping {
    /// Keeps in `store`.
    pub fn new(store: Store) -> Self {
        let own = store.clone();
        let faults = Arc::new(Mutex::new(Vec::new()));
        let told = faults.clone();
        // Where the system gives no thread, nothing can be kept, so nothing is begun.
        let tasks = work::Worker::start("keep", QUEUE, move |task| perform(&own, &told, task));
        Self { store, worker: Arc::new(Worker { tasks, faults }) }
    }

    /// The files.
    pub fn store(&self) -> &Store {
        &self.store
    }

    /// What could not be kept when acts ended, since the last look. Their journals stay open where that is so.
    #[must_use]
    pub fn take_faults(&self) -> Vec<KeepError> {
        std::mem::take(&mut *self.worker.faults.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Keeps what is done to one unit.
    pub fn keeper(&self, unit: UnitId, firmware: &str) -> Box<dyn Keeper> {
        Box::new(UnitKeeper {
            origin: Origin { unit, firmware: firmware.to_owned() },
            worker: self.worker.clone(),
            answer: None,
            begun: None,
            ended: None,
        })
    }
}

struct UnitKeeper {
    origin: Origin,
    worker: Arc<Worker>,
    answer: Option<Receiver<Result<Begun, Failure>>>,
    begun: Option<Begun>,
    /// Closed when what ends the act is on the disk.
    ended: Option<Receiver<()>>,
}

impl Keeper for UnitKeeper {
    fn begin(&mut self, entry: Entry) {
        let (answer, answered) = bounded(1);
        let task = Task::Begin { origin: self.origin.clone(), entry: Box::new(entry), answer };
        // A full queue drops the answer, which is told as a failure.
        let _ = self.worker.tasks.give(task);
        self.answer = Some(answered);
    }

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        let answer = work::wait(self.answer.as_ref()?, MOMENT);
        match answer {
            Ok(Ok(begun)) => {
                self.begun = Some(begun);
                Some(Ok(()))
            }
            Ok(Err(failure)) => Some(Err(failure)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(Failure::new(
                CoreActMessage::KeepBackup,
                "this computer",
                CoreCauseMessage::WriterIsGone,
                CoreRemedyMessage::StartAgain,
            ))),
        }
    }

    fn end(&mut self, ending: Ending) {
        let Some(begun) = self.begun.take() else { return };
        let (done, ended) = bounded(1);
        let task = Task::End { origin: self.origin.clone(), begun: Box::new(begun), ending, done };
        // A journal that stays open for want of room is looked at once more; nothing is lost by that.
        let _ = self.worker.tasks.give(task);
        self.ended = Some(ended);
    }

    fn ended(&mut self) -> bool {
        let Some(ended) = &self.ended else { return true };
        !matches!(work::wait(ended, MOMENT), Err(RecvTimeoutError::Timeout))
    }
}

fn perform(store: &Store, faults: &Mutex<Vec<KeepError>>, task: Task) {
    match task {
        Task::Begin { origin, entry, answer } => {
            let tried = ActMessage::KeepBackup { act: entry.act.label() };
            let begun = begin(store, &origin, &entry).map_err(|error| error.failure(tried));
            // Whoever asked may have been called off.
            let _ = answer.send(begun);
        }
        Task::End { origin, begun, ending, done } => {
            if let Err(error) = end(store, &origin, &begun, &ending) {
                faults.lock().unwrap_or_else(PoisonError::into_inner).push(error);
            }
            // Nobody may wait for it.
            let _ = done.send(());
        }
    }
}

fn begin(store: &Store, origin: &Origin, entry: &Entry) -> Result<Begun, KeepError> {
    let mut backup = profile(origin, entry, entry.ram.clone());
    backup.note = format!("before {}", entry.act.label());
    store.back_up(&origin.unit, entry.act, &backup)?;
    let before = match entry.act {
        // A note that cannot be read is named by whoever shows what EEPROM holds; here it counts as not known.
        // What a cut save leaves is a mix of what EEPROM held and of what was saved.
        Act::Save => Profile {
            date: backup.date.clone(),
            ..store
                .eeprom(&origin.unit)
                .ok()
                .flatten()
                .unwrap_or_else(|| profile(origin, entry, SettingsImage::default()))
        },
        Act::Write | Act::Defaults | Act::Reload | Act::Firmware | Act::Trial => backup,
    };
    let journal = Journal { act: entry.act, before, wanted: profile(origin, entry, entry.wanted.clone()) };
    let path = store.open_journal(&origin.unit, &journal)?;
    if entry.act == Act::Save {
        store.count_saves(&origin.unit, 1, &today())?;
        store.note_eeprom(&origin.unit, None)?;
    }
    Ok(Begun { act: entry.act, path, journal })
}

fn end(store: &Store, origin: &Origin, begun: &Begun, ending: &Ending) -> Result<(), KeepError> {
    match ending {
        Ending::Open => return Ok(()),
        Ending::Known => {}
        Ending::EepromKnown(image) => {
            let known = Profile { date: today(), settings: image.clone(), ..begun.journal.wanted.clone() };
            store.note_eeprom(&origin.unit, Some(&known))?;
        }
        Ending::NotDone if begun.act == Act::Save => {
            store.count_saves(&origin.unit, -1, &today())?;
            if !begun.journal.before.settings.is_empty() {
                store.note_eeprom(&origin.unit, Some(&begun.journal.before))?;
            }
        }
        Ending::NotDone => {}
    }
    store.close_journal(&begun.path)
}

fn profile(origin: &Origin, entry: &Entry, settings: SettingsImage) -> Profile {
    profile_of(*entry.table.subject(), entry.address, &origin.firmware, &origin.unit.place, settings)
}

//! Long work on the device thread: a settings write, a tuning run, a script download.

use crate::exchange::Interruption;
use crate::failure::Failure;
use crate::messages::{CauseMessage, RemedyMessage};
use brushwork_values::Message;
use crossbeam_channel::{Receiver, TryRecvError, bounded};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::task::Poll;
use std::time::Duration;

pub use super::job_context::{JobContext, JobHost};

/// Which job: no two of a program have the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JobId(u64);

impl JobId {
    fn next() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Long work that gives a `T`. It runs on the device thread, so it must do nothing slow but through its context.
#[derive(Debug)]
pub struct Job<T> {
    queued: QueuedJob,
    ticket: JobTicket<T>,
}

impl<T: Send + 'static> Job<T> {
    /// A job that moves no motor. `name` says what it does, as a verb phrase for sentences and progress bars: "write 12 settings".
    /// It is ended by force when `time_limit` has gone by since its start.
    ///
    /// Errors of the context should be passed on at once: after an interruption each further call of the context fails too.
    pub fn new(
        name: impl Into<Message>,
        time_limit: Duration,
        mut work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
    ) -> Self {
        let (id, name) = (JobId::next(), name.into());
        let (sender, result) = bounded(1);
        let run = move |context: &mut JobContext<'_>| {
            // Nobody waits for it once the ticket was thrown away.
            let _ = sender.try_send(work(context)?);
            Ok(())
        };
        let cancelled = Arc::new(AtomicBool::new(false));
        let ticket = JobTicket { id, name: name.clone(), cancelled: Arc::clone(&cancelled), result };
        let queued = QueuedJob { id, name, time_limit, moves_motors: false, cancelled, run: Box::new(run) };
        Self { queued, ticket }
    }

    /// A job that sets motors in motion. It is refused unless something is armed, and it ends with the motors stopped and
    /// disarmed, whatever its way out.
    pub fn moving(
        name: impl Into<Message>,
        time_limit: Duration,
        work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
    ) -> Self {
        let Self { queued, ticket } = Self::new(name, time_limit, work);
        Self { queued: QueuedJob { moves_motors: true, ..queued }, ticket }
    }

    /// When it is ended by force, counted from its start.
    #[must_use]
    pub fn time_limit(&self) -> Duration {
        self.queued.time_limit
    }

    /// What the device thread takes, and the ticket for what the job gives.
    #[must_use]
    pub fn queued(self) -> (QueuedJob, JobTicket<T>) {
        (self.queued, self.ticket)
    }
}

type Work = dyn FnMut(&mut JobContext<'_>) -> Result<(), Failure> + Send;

/// A job as the device thread runs it. What it gives goes to its ticket, so that jobs of any result are of one type here.
pub struct QueuedJob {
    pub(super) id: JobId,
    pub(super) name: Message,
    pub(super) time_limit: Duration,
    pub(super) moves_motors: bool,
    pub(super) cancelled: Arc<AtomicBool>,
    pub(super) run: Box<Work>,
}

impl QueuedJob {
    /// Which job its events speak of.
    #[must_use]
    pub fn id(&self) -> JobId {
        self.id
    }
}

impl fmt::Debug for QueuedJob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QueuedJob").field("id", &self.id).field("name", &self.name).finish_non_exhaustive()
    }
}

/// What whoever asked for a job holds of it. Throwing it away does not end the job.
#[derive(Debug)]
pub struct JobTicket<T> {
    id: JobId,
    name: Message,
    cancelled: Arc<AtomicBool>,
    result: Receiver<T>,
}

impl<T> JobTicket<T> {
    /// Which job its events speak of.
    #[must_use]
    pub fn id(&self) -> JobId {
        self.id
    }

    /// What it does, as a verb phrase.
    #[must_use]
    pub fn name(&self) -> &Message {
        &self.name
    }

    /// Ends the job at its next exchange, or at its first if it waits for its turn.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
    }

    /// What the job gave, once: also where something broke in and it gave what it had by then. `None` inside once it never
    /// will.
    pub fn poll(&self) -> Poll<Option<T>> {
        match self.result.try_recv() {
            Ok(value) => Poll::Ready(Some(value)),
            Err(TryRecvError::Empty) => Poll::Pending,
            Err(TryRecvError::Disconnected) => Poll::Ready(None),
        }
    }

    /// What the job gave, if it has, once.
    #[must_use]
    pub fn take(&self) -> Option<T> {
        self.result.try_recv().ok()
    }

    /// How the job ended, with what it gave.
    #[must_use]
    pub fn ending(&self, ending: JobEnding) -> JobEnding<T> {
        match ending {
            JobEnding::Done(()) => match self.take() {
                Some(value) => JobEnding::Done(value),
                None => JobEnding::Failed(Failure::new(
                    self.name.clone(),
                    "",
                    CauseMessage::NoResult,
                    RemedyMessage::TryAgain,
                )),
            },
            JobEnding::Interrupted(cause) => JobEnding::Interrupted(cause),
            JobEnding::Failed(failure) => JobEnding::Failed(failure),
            JobEnding::Panicked(word) => JobEnding::Panicked(word),
        }
    }
}

/// How a job ended: as its events tell, or with what it gave ([`JobTicket::ending`]).
pub enum JobEnding<T = ()> {
    /// It did its work.
    Done(T),
    /// Something more urgent ended it: Stop, Cancel, the time limit, the dead-man, closing.
    Interrupted(Interruption),
    /// It gave up.
    Failed(Failure),
    /// It had a bug. The text is its last word.
    Panicked(String),
}

impl<T> fmt::Debug for JobEnding<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done(_) => f.write_str("Done"),
            Self::Interrupted(cause) => write!(f, "Interrupted({cause:?})"),
            Self::Failed(failure) => write!(f, "Failed({failure})"),
            Self::Panicked(word) => write!(f, "Panicked({word})"),
        }
    }
}

/// The end of a job.
#[derive(Debug)]
pub struct JobReport {
    /// Which.
    pub id: JobId,
    /// Its name, for people.
    pub name: Message,
    /// How long it ran.
    pub ran_for: Duration,
    /// How it ended.
    pub ending: JobEnding,
    /// Whether motors were stopped as its last act; `None` when it had nothing to do with motors.
    pub motors_stopped: Option<bool>,
}

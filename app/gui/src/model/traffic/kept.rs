//! A command put together by hand that changes settings: it waits until a backup of them is kept.

use crate::messages::WindowCauseMessage;
use brushwork_link::messages::{ActMessage, RemedyMessage};
use std::task::Poll;
use std::time::Duration;

use brushwork_link::settings::{Ending, begin_command};
use brushwork_link::{Failure, Identity, Job, JobTicket, Keeper, QueuedJob, Request};
use brushwork_values::{Value, Values};

use brushwork_core::keep::TrialKeeper;

const JOB: ActMessage = ActMessage::KeepBackupOfCommand;
/// A serial line of 2400 bit/s takes most of it.
const LIMIT: Duration = Duration::from_secs(120);

/// The command that waits for its backup, or for its answer.
#[derive(Debug, Default)]
pub struct KeptCommand {
    waiting: Option<(Transact, JobTicket<Result<(), Failure>>)>,
    sent: Option<(u64, TrialKeeper)>,
    keeper: Option<TrialKeeper>,
}

/// A command with the number its answer will have.
#[derive(Clone, Debug, PartialEq)]
pub struct Transact {
    pub id: u64,
    pub command: u8,
    pub values: Vec<Value>,
}

impl Transact {
    /// As a request to the device thread.
    pub fn request(self) -> Request {
        Request::Transact { id: self.id, command: self.command, values: self.values }
    }
}

impl KeptCommand {
    /// The job that keeps a backup before `transact` is sent, which may save all settings.
    pub fn keep_first(
        &mut self,
        transact: Transact,
        saves: bool,
        identity: &Identity,
        keeper: Box<dyn Keeper>,
    ) -> Option<QueuedJob> {
        let subject = identity.subject()?;
        let keeper = TrialKeeper::new(keeper);
        self.keeper = Some(keeper.clone());
        let job = Job::new(JOB, LIMIT, move |context| {
            Ok(begin_command(context, subject, saves, &mut **keeper.lock()))
        });
        let (job, kept) = job.queued();
        self.waiting = Some((transact, kept));
        Some(job)
    }

    /// The job was not taken, or the link is gone.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The command whose backup is kept now, once; or, with its number, why there is none.
    pub fn ready(&mut self) -> Option<Result<Transact, (u64, Failure)>> {
        let (_, kept) = self.waiting.as_ref()?;
        let kept = match kept.poll() {
            Poll::Pending => return None,
            Poll::Ready(Some(kept)) => kept,
            Poll::Ready(None) => Err(Failure::new(
                JOB,
                "this computer",
                WindowCauseMessage::MoreUrgent,
                RemedyMessage::SendWhenReady,
            )),
        };
        let (transact, _) = self.waiting.take()?;
        self.sent = kept.is_ok().then_some(transact.id).zip(self.keeper.take());
        Some(kept.map_err(|failure| (transact.id, failure)).map(|()| transact))
    }

    /// Whether a command that changes settings was sent with that number and waits for its answer.
    pub fn is_sent(&self, id: u64) -> bool {
        self.sent.as_ref().is_some_and(|(sent, _)| *sent == id)
    }

    /// The answer has come: the journal is closed, unless nobody knows what became of a save.
    pub fn answered(&mut self, id: u64, result: &Result<Values, Failure>) {
        if let Some((_, keeper)) = self.sent.take_if(|(sent, _)| *sent == id) {
            keeper.lock().end(if result.is_ok() { Ending::Known } else { Ending::Open });
        }
    }
}

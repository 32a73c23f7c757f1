//! Work with a controller's settings that an assistant asks for itself: one act at a time on one link, of whichever of its units.

use brushwork_core::examine::RawWrite;
use brushwork_core::settings::{Act, Done};
use brushwork_link::device::JobId;
use brushwork_link::{Event, Job, QueuedJob, SettingsTable, WriteOptions};

use super::watched::Unfinished;
use super::{Gravity, Watched};
use crate::messages::JobMessage;

/// What an errand does, and on which unit.
#[derive(Debug)]
pub struct Asked {
    pub address: u8,
    pub act: Act,
    pub table: SettingsTable,
    pub options: WriteOptions,
    /// What is noted before a number goes out raw.
    pub raw: Option<RawWrite>,
}

/// What came of an errand.
pub type Came = Result<Done, Unfinished>;

/// The errand that runs, and what came of the last one.
#[derive(Debug, Default)]
pub struct Errand {
    work: Watched<Done>,
    id: Option<JobId>,
    ended: Option<(JobId, Came)>,
}

impl Errand {
    /// What to ask of the device thread. None while one runs.
    pub fn begin(&mut self, job: Job<Done>) -> Option<QueuedJob> {
        let job = self.work.begin(job)?;
        self.id = Some(job.id());
        Some(job)
    }

    /// The device thread did not take it.
    pub fn not_begun(&mut self) {
        self.work.forget();
        self.id = None;
    }

    pub fn is_running(&self) -> bool {
        self.work.is_running()
    }

    /// How far it is, 0 to 1, and what it does.
    pub fn progress(&self) -> Option<(f32, &str)> {
        self.work.progress()
    }

    /// Ends it at its next exchange.
    pub fn cancel(&self) {
        self.work.cancel();
    }

    /// Takes in an event of it.
    pub fn take(&mut self, event: Event) {
        if let Some(came) = self.work.take_result(event)
            && let Some(id) = self.id.take()
        {
            self.ended = Some((id, came));
        }
    }

    /// The link is gone, and what became of the errand is not known.
    pub fn link_ended(&mut self) {
        self.work.forget();
        if let Some(id) = self.id.take() {
            let sentence = JobMessage::LinkLost.into();
            self.ended = Some((id, Err(Unfinished { gravity: Gravity::Error, sentence })));
        }
    }

    /// What came of an errand, once.
    pub fn came(&mut self, id: JobId) -> Option<Came> {
        self.ended.take_if(|(ended, _)| *ended == id).map(|(_, came)| came)
    }
}

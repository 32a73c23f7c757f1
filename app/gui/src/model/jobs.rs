//! Whose the jobs of one link are, so that each event of a job finds the one who asked for it.

use std::collections::BTreeMap;

use brushwork_link::device::{Event, JobId};

/// Who is told how far a job is and how it ended. Whoever only looks at its ticket is not among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The settings of the units, whatever screen asked.
    Settings,
    ClampTest,
    Generator,
    Qpps,
    /// The download of a script.
    Script,
    /// Guided tuning.
    Tune,
    /// The examination of a controller.
    Examination,
    /// An assistant, whose act the link has at the moment.
    Errand,
}

/// The jobs that were asked for and have not ended.
#[derive(Debug, Default)]
pub struct Jobs(BTreeMap<JobId, Owner>);

impl Jobs {
    /// A job was taken by the device thread.
    pub fn begun(&mut self, id: JobId, owner: Owner) {
        self.0.insert(id, owner);
    }

    /// Whose job the event is about. Its end is the last that is told of a job.
    pub fn owner(&mut self, event: &Event) -> Option<Owner> {
        let ended = if let Event::JobEnded(report) = event { self.0.remove(&report.id) } else { None };
        ended.or_else(|| self.0.get(&event.job()?).copied())
    }
}

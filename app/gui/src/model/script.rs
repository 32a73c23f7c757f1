//! Scripts on their way into the controller of a link: the download that runs, and which program is in there.

use brushwork_link::device::{Event, Job, QueuedJob};

use super::link::Effect;
use super::message::Gravity;
use super::watched::Watched;
use crate::mcl::DocId;

/// Whose program is meant: its tab, and the text as it was compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    pub title: String,
    /// None for an image from a file.
    pub text: Option<(DocId, u64)>,
}

/// The scripts of one link.
#[derive(Debug, Default)]
pub struct ScriptWork {
    job: Watched<String>,
    sending: Option<Source>,
    /// What was downloaded last over this link.
    on_board: Option<Source>,
}

impl ScriptWork {
    /// What to ask of the device thread; none while a download runs.
    pub fn begin(&mut self, download: Job<String>, source: Source) -> Option<QueuedJob> {
        let job = self.job.begin(download)?;
        self.sending = Some(source);
        self.on_board = None;
        Some(job)
    }

    pub fn cancel(&self) {
        self.job.cancel();
    }

    /// The job was not taken.
    pub fn not_begun(&mut self) {
        self.forget();
    }

    /// Another unit, or none.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    pub fn progress(&self) -> Option<(f32, &str)> {
        self.job.progress()
    }

    /// Which program the controller holds, as far as this link has put it there.
    pub fn on_board(&self) -> Option<&Source> {
        self.on_board.as_ref()
    }

    /// Takes in an event of its job.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let Some(ended) = self.job.take_result(event) else { return Vec::new() };
        let source = self.sending.take();
        match ended {
            Ok(done) => {
                let title = source.as_ref().map_or("the script", |source| source.title.as_str());
                let text = format!("Downloaded {title}: {done}");
                self.on_board = source;
                vec![Effect::Say(Gravity::Note, text)]
            }
            Err(unfinished) => vec![Effect::Say(Gravity::Error, unfinished.sentence)],
        }
    }
}

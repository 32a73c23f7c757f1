//! Scripts on their way into the controller of a link: the download that runs, and which program is in there.

use brushwork_link::device::{Event, Job, QueuedJob};

use super::{Effect, Gravity, Watched};
use crate::mcl::DocId;
use crate::messages::JobMessage;

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
    pub job: Watched<String>,
    sending: Option<Source>,
    /// What was downloaded last over this link.
    pub on_board: Option<Source>,
}

impl ScriptWork {
    /// What to ask of the device thread; none while a download runs.
    pub fn begin(&mut self, download: Job<String>, source: Source) -> Option<QueuedJob> {
        let job = self.job.begin(download)?;
        self.sending = Some(source);
        self.on_board = None;
        Some(job)
    }

    /// Another unit, or none.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Takes in an event of its job.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let Some(ended) = self.job.take_result(event) else { return Vec::new() };
        let source = self.sending.take();
        match ended {
            Ok(done) => {
                let title = source.as_ref().map_or("the script", |source| source.title.as_str());
                let text = JobMessage::Downloaded { title: title.to_owned(), how: done };
                self.on_board = source;
                vec![Effect::say(Gravity::Note, text)]
            }
            Err(unfinished) => vec![Effect::say(Gravity::Error, unfinished.sentence)],
        }
    }
}

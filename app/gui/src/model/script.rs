//! Scripts on their way into the controller of a link: the download that runs, and which program is in there.

use std::time::Duration;

use brushwork_link::Wire as _;
use brushwork_link::device::{Event, Job, QueuedJob};
use brushwork_mcp_client::script::{DOWNLOAD_JOB, Downloaded, ScriptImage, Verified, download};

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
    job: Watched<Downloaded>,
    sending: Option<Source>,
    /// What was downloaded last over this link.
    on_board: Option<Source>,
}

impl ScriptWork {
    /// What to ask of the device thread; none while a download runs.
    pub fn begin(&mut self, image: ScriptImage, source: Source) -> Option<QueuedJob> {
        let blocks = u32::try_from(image.blocks().len()).unwrap_or(u32::MAX);
        // A wire of 2400 bit/s takes most of it.
        let limit = Duration::from_secs(60) + Duration::from_millis(200).saturating_mul(blocks);
        let job = self.job.begin(Job::new(DOWNLOAD_JOB, limit, move |context| {
            let is_simulated = context.is_simulated();
            download(context, &image, is_simulated)
        }))?;
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
                let text = told(title, &done);
                self.on_board = source;
                vec![Effect::Say(Gravity::Note, text)]
            }
            Err(unfinished) => vec![Effect::Say(Gravity::Error, unfinished.sentence)],
        }
    }
}

/// What was sent and how far it is known to have arrived.
fn told(title: &str, done: &Downloaded) -> String {
    let verified = match done.verified {
        Verified::Content => "verified".to_owned(),
        Verified::Status => "each block confirmed".to_owned(),
        Verified::Alike(byte) => {
            format!("each block answered with 0x{byte:02X}, whose meaning is not public")
        }
    };
    let foreign = if done.is_foreign { " A simulated controller does not run it." } else { "" };
    format!(
        "Downloaded {title}: {} bytes in {:.1} s, {verified}. Start Script runs it.{foreign}",
        done.bytes,
        done.took.as_secs_f64()
    )
}

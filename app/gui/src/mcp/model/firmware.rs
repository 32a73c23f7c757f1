//! The firmware window of one link: the file, the risks and whether they were accepted, how far an update is, and what
//! became of the settings.

use crate::mcp::messages::DownloadMessage;
use crate::messages::{FirmwareMessage, WindowActMessage};
use brushwork_link::Message;
use std::path::Path;
use std::time::Duration;

use brushwork_link::device::{Event, Identity, Job, JobTicket, QueuedJob};
use brushwork_link::settings::{ReadReport, Subject, read_all};
use brushwork_link::transport::Stream;
use brushwork_mcp_client::firmware::{
    Firmware as Loaded, Progress, RESUME_NOTE, Sent, Unsuitable, risks, suit, suit_model,
};
use brushwork_mcp_wire::loader::Image;
use brushwork_mcp_wire::models::{self, Model};
use crossbeam_channel::{Receiver, bounded};

use crate::files::{FileAction, FileAnswer, FileDialog, FileKind};
use brushwork_core::keep::{OpenUpdate, Store, UnitId};
use brushwork_core::session::firmware::{LoaderPlace, Upload, UploadEvent};
use brushwork_core::update::{self, Compared, Expected, Kept, Verdict};
use brushwork_link::bounded;
use brushwork_link::clock::Instant;

/// How long reading all settings may take.
const READ_LIMIT: Duration = Duration::from_secs(120);
/// How long a line is left alone before the controller is looked for again after its restart.
const LOOK_INTERVAL: Duration = Duration::from_secs(2);
/// How often it is looked for by itself.
const LOOKS: u32 = 15;
/// Differences from the backup that are listed.
pub const LISTED: usize = 12;

/// What is asked of the firmware window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirmwareAction {
    Browse,
    /// Starts an update of the unit that is looked at, or resumes one that broke.
    Update,
    /// Gives up before anything is erased.
    Cancel,
    /// Puts the outcome aside.
    Dismiss,
}

/// The firmware window and the update that runs.
#[derive(Debug, Default)]
pub struct Firmware {
    pub open: bool,
    /// The file, as typed or chosen.
    pub path: String,
    /// Whether the user has accepted the risks.
    pub accepted: bool,
    /// The model that waits in its loader, when an update is resumed.
    pub resumed_model: Option<&'static Model>,
    pub stage: Stage,
    dialog: Option<FileDialog>,
    after: Option<After>,
}

/// How far an update is.
#[derive(Debug, Default)]
pub enum Stage {
    #[default]
    Idle,
    /// The settings are read and kept; nothing is erased yet.
    BackingUp {
        image: Image,
        kept: Receiver<Result<Kept, Message>>,
    },
    /// The motors are stopped and the loader is entered.
    Entering {
        image: Image,
        place: LoaderPlace,
    },
    /// The image goes over.
    Sending {
        upload: Upload<Loaded>,
        progress: Progress,
    },
    Done(Sent),
    Failed(Message),
}

/// What is compared after an update.
#[derive(Debug)]
struct After {
    expected: Expected,
    /// Where the controller was connected.
    place: String,
    verdict: Option<Verdict>,
    reading: Option<JobTicket<Result<ReadReport, Message>>>,
    compared: Option<Compared>,
    /// When the last look for the controller began, and how many there were.
    looked_at: Option<Instant>,
    looks: u32,
}

impl After {
    fn new(expected: Expected, place: String) -> Self {
        Self { expected, place, verdict: None, reading: None, compared: None, looked_at: None, looks: 0 }
    }
}

/// What the window has to do next for a running update.
#[derive(Debug)]
pub enum Next {
    /// Sends this to the device thread.
    Ask(QueuedJob),
    /// Sends the unit into its loader.
    EnterLoader,
    /// Looks whether the controller is back.
    Reconnect(String),
    Nothing,
}

impl Stage {
    /// Whether an update is under way.
    pub fn is_running(&self) -> bool {
        matches!(self, Self::BackingUp { .. } | Self::Entering { .. } | Self::Sending { .. })
    }

    /// Whether it can still be given up without leaving the controller without firmware.
    pub fn can_be_cancelled(&self) -> bool {
        match self {
            Self::BackingUp { .. } => true,
            Self::Sending { progress, .. } => progress.is_harmless(),
            Self::Idle | Self::Entering { .. } | Self::Done(_) | Self::Failed(_) => false,
        }
    }

    /// What happens now, and the share that is done where it is known.
    pub fn reported(&self) -> (String, Option<f32>) {
        match self {
            Self::BackingUp { .. } => ("Backing up the settings.".to_owned(), None),
            Self::Entering { .. } => ("Stopping the motors and entering the loader.".to_owned(), None),
            Self::Sending { progress: Progress::Greeting, .. } => {
                ("Waiting for the loader.".to_owned(), None)
            }
            Self::Sending { progress: Progress::Erasing, .. } => (
                "Erasing. Do not switch anything off: without power now the controller is dead for good."
                    .to_owned(),
                None,
            ),
            Self::Sending { progress: Progress::Writing { pages, of }, .. } => (
                DownloadMessage::WritingPage { page: *pages, of: *of }.to_string(),
                Some(*pages as f32 / (*of).max(1) as f32),
            ),
            Self::Idle | Self::Done(_) | Self::Failed(_) => (String::new(), None),
        }
    }
}

impl Firmware {
    /// The risks, and what a resumed update needs.
    pub fn risks(&self, simulated: bool) -> Vec<&'static str> {
        let mut all = risks(simulated);
        all.extend(self.resumed_model.map(|_| RESUME_NOTE));
        all
    }

    /// Takes a file that was chosen elsewhere; its risks are to be accepted anew.
    pub fn choose(&mut self, file: &Path) {
        if !self.stage.is_running() {
            self.path = file.display().to_string();
            self.accepted = false;
        }
    }

    /// Opens the desktop's own dialog.
    pub fn browse(&mut self) {
        let kind = FileKind { title: "Firmware image".to_owned(), extension: "bin".to_owned() };
        self.dialog = Some(FileDialog::ask(FileAction::Open, kind));
    }

    /// Begins to update the unit that is connected: its settings are backed up first.
    pub fn begin(
        &mut self,
        identity: &Identity,
        stream: Option<Stream>,
        unit: UnitId,
        place: String,
        store: Store,
    ) -> Result<QueuedJob, Message> {
        let model = models::identify(&identity.version_text);
        let bytes = self.file()?;
        let image = suit(bytes, identity, model, stream)
            .map_err(|error| FirmwareMessage::NotSent { why: Message::error(error) })?;
        let subject = identity.subject().ok_or(FirmwareMessage::ModelUnknown)?;
        let (job, kept) = back_up(identity, subject, unit, store)?;
        let before = Some(identity.version_text.clone());
        let announced = image.simulated().map(|simulated| simulated.version);
        self.after = Some(After::new(Expected { before, announced, kept: None }, place));
        self.stage = Stage::BackingUp { image, kept };
        Ok(job)
    }

    /// Begins to send the image to a unit that waits in its loader.
    pub fn resume(
        &mut self,
        target: &str,
        place: LoaderPlace,
        simulated: bool,
        store: &Store,
    ) -> Result<(), Message> {
        let model = self.resumed_model.ok_or(FirmwareMessage::ChooseModel)?;
        let image = suit_model(self.file()?, model, simulated).map_err(|error| {
            if error == Unsuitable::OnlySimulated {
                return FirmwareMessage::ForSimulated;
            }
            FirmwareMessage::NotSent { why: Message::error(error) }
        })?;
        let announced = image.simulated().map(|simulated| simulated.version);
        self.after = Some(After::new(Expected::resumed(store, target, announced), target.to_owned()));
        self.send(image, place);
        Ok(())
    }

    /// The backup is made: the loader comes next.
    pub fn entering(&mut self, place: LoaderPlace) {
        self.stage = match std::mem::take(&mut self.stage) {
            Stage::BackingUp { image, .. } => Stage::Entering { image, place },
            other @ (Stage::Idle
            | Stage::Entering { .. }
            | Stage::Sending { .. }
            | Stage::Done(_)
            | Stage::Failed(_)) => other,
        };
    }

    /// Takes note of what the device thread tells about the way into the loader.
    pub fn note(&mut self, event: &Event) {
        if matches!(event, Event::LoaderEntered) {
            self.entered();
        }
        if let Event::Failure(failure) = event
            && matches!(self.stage, Stage::Entering { .. })
        {
            self.not_entered(failure.message());
        }
    }

    /// The unit is in its loader.
    fn entered(&mut self) {
        match std::mem::take(&mut self.stage) {
            Stage::Entering { image, place } => self.send(image, place),
            other @ (Stage::Idle
            | Stage::BackingUp { .. }
            | Stage::Sending { .. }
            | Stage::Done(_)
            | Stage::Failed(_)) => self.stage = other,
        }
    }

    /// The link has ended, or the unit refused, before the loader was entered.
    pub fn not_entered(&mut self, why: impl Into<Message>) {
        if matches!(self.stage, Stage::BackingUp { .. } | Stage::Entering { .. }) {
            self.stage = Stage::Failed(FirmwareMessage::NotBegun { why: why.into() }.into());
        }
    }

    /// Gives up, as long as that is harmless.
    pub fn cancel(&mut self) {
        match &self.stage {
            Stage::BackingUp { .. } => self.stage = Stage::Idle,
            Stage::Sending { upload, .. } => upload.cancel(),
            Stage::Idle | Stage::Entering { .. } | Stage::Done(_) | Stage::Failed(_) => {}
        }
    }

    /// Puts the outcome aside; the risks have to be accepted anew.
    pub fn dismiss(&mut self) {
        if !self.stage.is_running() {
            self.stage = Stage::Idle;
            self.accepted = false;
            self.resumed_model = None;
        }
    }

    /// Takes in what happened since the last frame; `is_closed` while no link is open or being opened.
    pub fn update(&mut self, store: &Store, is_closed: bool) -> Next {
        if let Some(dialog) = &self.dialog {
            match dialog.answer() {
                FileAnswer::Waiting => {}
                FileAnswer::None => self.dialog = None,
                FileAnswer::Chosen(path) => {
                    self.path = path.display().to_string();
                    self.dialog = None;
                }
            }
        }
        self.take_comparison();
        match &mut self.stage {
            Stage::BackingUp { kept, .. } => match kept.try_recv() {
                Ok(Ok(kept)) => {
                    if let Some(after) = &mut self.after {
                        after.expected.kept = Some(kept);
                    }
                    match self.note_begun(store) {
                        Ok(()) => Next::EnterLoader,
                        Err(why) => {
                            self.not_entered(why);
                            Next::Nothing
                        }
                    }
                }
                Ok(Err(why)) => {
                    self.not_entered(why);
                    Next::Nothing
                }
                Err(_) => Next::Nothing,
            },
            Stage::Sending { upload, progress } => {
                for event in upload.events().clone().try_iter() {
                    match event {
                        UploadEvent::Progress(now) => *progress = now,
                        UploadEvent::Ended(Ok(sent)) => {
                            self.stage = Stage::Done(sent);
                            break;
                        }
                        UploadEvent::Ended(Err(failure)) => {
                            self.stage = Stage::Failed(failure.message());
                            break;
                        }
                    }
                }
                Next::Nothing
            }
            Stage::Done(_) if is_closed => self.look_again(),
            Stage::Idle | Stage::Entering { .. } | Stage::Done(_) | Stage::Failed(_) => Next::Nothing,
        }
    }

    /// Keeps that an update was begun at this place, so that a silent controller is known for what it is.
    fn note_begun(&self, store: &Store) -> Result<(), Message> {
        let Some((after, kept)) =
            self.after.as_ref().and_then(|after| Some((after, after.expected.kept.as_ref()?)))
        else {
            return Ok(());
        };
        if after.place.starts_with("sim:") {
            return Ok(());
        }
        let begun = OpenUpdate {
            place: after.place.clone(),
            model: kept.profile.subject.model.key.to_owned(),
            before: after.expected.before.clone().unwrap_or_default().trim().to_owned(),
            file: Path::new(self.path.trim()).to_owned(),
            backup: kept.name.clone(),
        };
        store.open_update(&begun).map_err(Message::error)
    }

    /// The image was sent and nobody is connected: whether the controller is to be looked for now.
    fn look_again(&mut self) -> Next {
        let Some(after) = self.after.as_mut().filter(|after| after.verdict.is_none() && after.looks < LOOKS)
        else {
            return Next::Nothing;
        };
        let now = Instant::now();
        let since = *after.looked_at.get_or_insert(now);
        if now.saturating_duration_since(since) < LOOK_INTERVAL {
            return Next::Nothing;
        }
        after.looked_at = Some(now);
        after.looks += 1;
        Next::Reconnect(after.place.clone())
    }

    /// Whether the controller is still looked for.
    pub fn is_awaited(&self) -> bool {
        let is_done = matches!(self.stage, Stage::Done(_));
        self.after.as_ref().is_some_and(|after| is_done && after.verdict.is_none() && after.looks < LOOKS)
    }

    /// The unit is connected again: its version is compared, and its settings with the backup once.
    pub fn compare(&mut self, identity: &Identity, store: &Store) -> Next {
        let is_done = matches!(self.stage, Stage::Done(_));
        let Some(after) = self.after.as_mut().filter(|_| is_done) else { return Next::Nothing };
        if after.verdict.is_none() {
            store.close_update(&after.place);
            after.verdict = Some(after.expected.verdict(identity));
        }
        if after.reading.is_some() || after.compared.is_some() || after.expected.kept.is_none() {
            return Next::Nothing;
        }
        let Some(subject) = identity.subject() else { return Next::Nothing };
        let job = Job::new(WindowActMessage::CompareWithBackup, READ_LIMIT, move |wire| {
            Ok(read_all(wire, subject).map_err(|failure| failure.message()))
        });
        let (job, reading) = job.queued();
        after.reading = Some(reading);
        Next::Ask(job)
    }

    /// The comparison could not be begun; it is tried again.
    pub fn not_compared(&mut self) {
        if let Some(after) = &mut self.after {
            after.reading = None;
        }
    }

    /// How the settings are after the update, once they were compared.
    pub fn compared(&self) -> Option<&Compared> {
        self.after.as_ref()?.compared.as_ref()
    }

    /// What the backup is called.
    pub fn backup(&self) -> Option<&str> {
        self.after.as_ref()?.expected.kept.as_ref().map(|kept| kept.title.as_str())
    }

    /// What the controller says of itself after the update, once it is connected again.
    pub fn verdict(&self) -> Option<&Verdict> {
        self.after.as_ref()?.verdict.as_ref()
    }

    fn take_comparison(&mut self) {
        let Some(after) = &mut self.after else { return };
        let Some(read) = after.reading.as_ref().and_then(JobTicket::take) else { return };
        after.compared = match (read, &after.expected.kept) {
            (Ok(report), Some(kept)) => Some(kept.compare(&report)),
            (Ok(_), None) => None,
            (Err(why), _) => Some(Compared { differences: Vec::new(), failure: Some(why) }),
        };
    }

    fn send(&mut self, image: Image, place: LoaderPlace) {
        self.stage = match Upload::start(place, Loaded(image)) {
            Ok(upload) => Stage::Sending { upload, progress: Progress::Greeting },
            Err(why) => Stage::Failed(FirmwareMessage::CannotSend { why: why.into() }.into()),
        };
    }

    fn file(&self) -> Result<Vec<u8>, FirmwareMessage> {
        let path = Path::new(self.path.trim());
        let reported = |error: std::io::Error| FirmwareMessage::NotFound {
            path: path.display().to_string(),
            error: error.to_string(),
        };
        bounded::read_file(path).map_err(reported)
    }
}

/// Reads all settings in a job, and keeps them on a thread that may wait for the disk.
fn back_up(
    identity: &Identity,
    subject: Subject,
    unit: UnitId,
    store: Store,
) -> Result<(QueuedJob, Receiver<Result<Kept, Message>>), Message> {
    let (read, to_keep) = bounded::<Result<ReadReport, Message>>(1);
    let (sender, kept) = bounded(1);
    let identity = identity.clone();
    let keep = move || {
        let report = to_keep.recv_timeout(READ_LIMIT).map_err(|_| FirmwareMessage::NotRead.into());
        let done = report.and_then(|report| update::keep(&report?, &identity, &unit, &store));
        // Whoever closed the window does not want it any more.
        let _ = sender.send(done);
    };
    let thread = std::thread::Builder::new().name("firmware backup".to_owned());
    thread.spawn(keep).map_err(|error| FirmwareMessage::NoThread { error: error.to_string() })?;
    let job = Job::new(WindowActMessage::BackUp, READ_LIMIT, move |wire| {
        let _ = read.try_send(read_all(wire, subject).map_err(|failure| failure.message()));
        Ok(())
    });
    // What was read goes to the thread that keeps it.
    Ok((job.queued().0, kept))
}

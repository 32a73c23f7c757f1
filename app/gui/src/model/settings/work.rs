//! Work with settings on the device thread: one job each.
//!
//! A job that was cancelled has a result too: what was written and what was not.

use crate::messages::WindowActMessage;
use brushwork_link::Failure;
use brushwork_link::Message;
use brushwork_link::device::{Job, JobContext, JobTicket, QueuedJob};
use brushwork_link::settings::{
    Ending, Keeper, Known, SettingsImage, SettingsTable, WriteOptions, begin_trial, end_act, read_all,
    write_watched,
};

use super::unit_key::UnitKey;
use brushwork_core::keep::TrialKeeper;
use brushwork_core::settings::{Act, Done};

/// What can be asked of the settings' controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsAction {
    /// Reads what the controller works with.
    Read,
    /// Makes the controller load its EEPROM, then reads.
    Reload,
    /// Writes the edits to the controller's RAM and reads them back.
    Write,
    /// Saves the controller's RAM to its EEPROM and reads that back.
    Save,
    RestoreDefaults,
    /// Opens the range of the input that is to be calibrated.
    OpenInput,
    /// Puts the input back that was opened.
    CloseInput,
    /// Ends the work that runs.
    Cancel,
}

/// Opens or closes the input that is calibrated.
#[derive(Clone, Debug)]
pub struct Calibrating {
    pub unit: UnitKey,
    pub wanted: SettingsImage,
    pub keeper: TrialKeeper,
}

/// Who asked for work, and so where it is told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// General Settings, or nobody.
    Settings(SettingsAction),
    /// A screen that drives, a tuning run, an assistant: values to RAM.
    Loop,
    /// A screen that shows some settings.
    View(Vec<String>),
}

/// Work that was begun and has not ended.
#[derive(Debug)]
pub struct Running {
    pub(super) unit: UnitKey,
    pub(super) origin: Origin,
    /// The edits of what it writes, as they were when it was asked for.
    pub(super) replaced: SettingsImage,
    /// 0 to 1, where it is known.
    pub fraction: Option<f32>,
    pub text: String,
    pub is_cancelled: bool,
    /// Begun by nobody: nothing is said of it.
    pub(super) is_quiet: bool,
    pub(super) ticket: JobTicket<Done>,
}

impl Running {
    /// What it does: "read the settings".
    pub fn name(&self) -> &Message {
        self.ticket.name()
    }

    /// Whether a screen asked for some settings, which keeps nobody from anything.
    pub(super) fn is_view(&self) -> bool {
        matches!(self.origin, Origin::View(_))
    }
}

/// The job that does an act on a unit.
pub(super) fn begin(
    act: Act,
    unit: UnitKey,
    origin: Origin,
    table: SettingsTable,
    options: WriteOptions,
    keeper: Box<dyn Keeper>,
) -> (QueuedJob, Running) {
    let (name, limit) = (act.name(), act.limit());
    running(unit, origin, Job::new(name, limit, act.work(table, options, keeper)))
}

/// The job that opens or closes an input: one journal from the one to the other.
pub(super) fn calibrate(
    calibrating: Calibrating,
    opens: bool,
    table: SettingsTable,
    options: WriteOptions,
) -> (QueuedJob, Running) {
    let Calibrating { unit, wanted, keeper } = calibrating;
    let (name, action) = match opens {
        true => (WindowActMessage::OpenInput, SettingsAction::OpenInput),
        false => (WindowActMessage::PutInputBack, SettingsAction::CloseInput),
    };
    let limit = Act::Write { wanted: SettingsImage::default(), known: Known::default() }.limit();
    let job = Job::new(name, limit, move |context| {
        calibrating_done(context, &table, &wanted, options, &keeper, opens)
    });
    running(unit, Origin::Settings(action), job)
}

fn running(unit: UnitKey, origin: Origin, job: Job<Done>) -> (QueuedJob, Running) {
    let (job, ticket) = job.queued();
    let running = Running {
        unit,
        origin,
        replaced: SettingsImage::default(),
        fraction: None,
        text: String::new(),
        is_cancelled: false,
        is_quiet: false,
        ticket,
    };
    (job, running)
}

fn calibrating_done(
    context: &mut JobContext<'_>,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    keeper: &TrialKeeper,
    opens: bool,
) -> Result<Done, Failure> {
    let is_changed = |key: &str| wanted.get(key).is_some();
    let before = match opens {
        true => begin_trial(context, *table.subject(), &is_changed, &mut **keeper.lock())?,
        false => read_all(context, *table.subject())?,
    };
    // What is put back was read from the unit.
    let options = WriteOptions { as_read: !opens, ..options };
    let result = write_watched(context, table, wanted, options, &before.image);
    match &result {
        Ok(report) if !opens && report.is_complete() => {
            end_act(context, &mut **keeper.lock(), Ending::Known);
        }
        Err(_) if opens => end_act(context, &mut **keeper.lock(), Ending::NotDone),
        _ => {}
    }
    Ok(match result {
        Ok(report) => Done::Written(Box::new(report), Known::default()),
        Err(error) => Done::NotWritten(error),
    })
}

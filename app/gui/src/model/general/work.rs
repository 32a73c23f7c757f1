//! Work with settings on the device thread: one job each.
//!
//! A job that was cancelled has a result too: what was written and what was not.

use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::device::{Job, JobContext, JobTicket, QueuedJob};
use brushwork_link::settings::{
    DefaultsReport, Ending, Keeper, ReadReport, SaveReport, SettingsImage, SettingsTable, WriteError,
    WriteOptions, WriteReport, begin_trial, defaults_kept, end_act, read_all, reload_kept, save_kept, write,
    write_kept,
};
use brushwork_link::transport::Stream;

use super::summary::settings;
use super::unit::UnitSettings;
use super::unit_key::UnitKey;
use brushwork_core::keep::TrialKeeper;

/// What can be asked of the settings' controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingsWish {
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

/// Work that was begun and has not ended.
#[derive(Debug)]
pub struct Running {
    pub(super) unit: UnitKey,
    pub(super) wish: SettingsWish,
    /// 0 to 1, where it is known.
    pub fraction: Option<f32>,
    pub text: String,
    pub is_cancelled: bool,
    /// Begun by nobody: nothing is said of it.
    pub(super) is_quiet: bool,
    pub(super) ticket: JobTicket<Outcome>,
}

/// What work gave.
#[derive(Debug)]
pub(super) enum Outcome {
    Read(Box<ReadReport>),
    Reloaded(Box<ReadReport>),
    Written(Box<WriteReport>),
    NotWritten(WriteError),
    Saved(Box<SaveReport>),
    Restored(Box<DefaultsReport>),
}

impl Running {
    /// What it does: "read the settings".
    pub fn name(&self) -> &str {
        self.ticket.name()
    }
}

/// Longest time for reading: a serial line of 2400 bit/s takes most of it.
const READING_LIMIT: Duration = Duration::from_secs(120);
/// Longest time for anything that writes, reading before and after included.
const WRITING_LIMIT: Duration = Duration::from_secs(400);

/// The job for a wish. `input` is what opens or closes an input.
pub(super) fn begin(
    wish: SettingsWish,
    key: UnitKey,
    unit: &UnitSettings,
    input: Option<(SettingsImage, TrialKeeper)>,
    own_stream: Option<Stream>,
    mut keeper: Box<dyn Keeper>,
) -> Option<(QueuedJob, Running)> {
    let table = unit.table().clone();
    let subject = *table.subject();
    let options = unit.options(own_stream);
    let begun = match wish {
        SettingsWish::Cancel => return None,
        SettingsWish::Read => job(key, "read the settings".to_owned(), READING_LIMIT, move |context| {
            read_all(context, subject).map(|report| Outcome::Read(Box::new(report)))
        }),
        SettingsWish::Reload => {
            job(key, "load the settings from EEPROM".to_owned(), WRITING_LIMIT, move |context| {
                reload_kept(context, &table, &mut *keeper).map(|report| Outcome::Reloaded(Box::new(report)))
            })
        }
        SettingsWish::Write => {
            let name = format!("write {}", settings(unit.edits().len()));
            writing(key, name, unit, unit.edits().clone(), options, keeper)
        }
        SettingsWish::OpenInput | SettingsWish::CloseInput => {
            let (wanted, keeper) = input?;
            let opens = wish == SettingsWish::OpenInput;
            let name = if opens { "open the input" } else { "put the input back" };
            job(key, name.to_owned(), WRITING_LIMIT, move |context| {
                calibrating(context, &table, &wanted, options, &keeper, opens)
            })
        }
        SettingsWish::Save => {
            job(key, "save the settings to EEPROM".to_owned(), WRITING_LIMIT, move |context| {
                save_kept(context, &table, options, &mut *keeper)
                    .map(|report| Outcome::Saved(Box::new(report)))
            })
        }
        SettingsWish::RestoreDefaults => {
            job(key, "restore the default settings".to_owned(), WRITING_LIMIT, move |context| {
                defaults_kept(context, subject, &mut *keeper)
                    .map(|report| Outcome::Restored(Box::new(report)))
            })
        }
    };
    let (job, running) = begun;
    Some((job, Running { wish, ..running }))
}

/// Opens or closes an input: one journal from the one to the other.
fn calibrating(
    context: &mut JobContext<'_>,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    keeper: &TrialKeeper,
    opens: bool,
) -> Result<Outcome, Failure> {
    if opens {
        let is_changed = |key: &str| wanted.get(key).is_some();
        begin_trial(context, *table.subject(), &is_changed, &mut **keeper.lock())?;
    }
    // What is put back was read from the unit.
    let options = WriteOptions { as_read: !opens, ..options };
    let result = write(context, table, wanted, options);
    match &result {
        Ok(report) if !opens && report.is_complete() => {
            end_act(context, &mut **keeper.lock(), Ending::Known);
        }
        Err(_) if opens => end_act(context, &mut **keeper.lock(), Ending::NotDone),
        _ => {}
    }
    Ok(match result {
        Ok(report) => Outcome::Written(Box::new(report)),
        Err(error) => Outcome::NotWritten(error),
    })
}

fn writing(
    key: UnitKey,
    name: String,
    unit: &UnitSettings,
    wanted: SettingsImage,
    options: WriteOptions,
    mut keeper: Box<dyn Keeper>,
) -> (QueuedJob, Running) {
    let table = unit.table().clone();
    job(key, name, WRITING_LIMIT, move |context| {
        Ok(match write_kept(context, &table, &wanted, options, &mut *keeper) {
            Ok(report) => Outcome::Written(Box::new(report)),
            Err(error) => Outcome::NotWritten(error),
        })
    })
}

fn job(
    unit: UnitKey,
    name: String,
    limit: Duration,
    work: impl FnMut(&mut JobContext<'_>) -> Result<Outcome, Failure> + Send + 'static,
) -> (QueuedJob, Running) {
    let (job, ticket) = Job::new(name, limit, work).queued();
    let running = Running {
        unit,
        wish: SettingsWish::Read,
        fraction: None,
        text: String::new(),
        is_cancelled: false,
        is_quiet: false,
        ticket,
    };
    (job, running)
}

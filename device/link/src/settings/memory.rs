//! The controller's own memory: saving RAM to EEPROM, loading it back, restoring defaults.
//!
//! A unit may restart after a save (public clients wait three seconds), and a reload sent right after it may
//! go unanswered although the save was done. So each act waits until the unit answers again, and reads every
//! row to see what became of it.

use std::time::Duration;

use super::difference::{Difference, diff};
use super::read::{ReadReport, is_final, is_there, read_all};
use super::save_report::SaveReport;
use super::step::WriteOptions;
use super::subject::Subject;
use super::table::SettingsTable;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::messages::{CauseMessage, RemedyMessage};
use crate::unit::UnitAddress;
use crate::wire::Wire;
use brushwork_values::Message;

/// How long a unit may take to answer again after it wrote its memory. Public clients wait 3 s.
const RESTART_LIMIT: Duration = Duration::from_secs(6);
/// How long nothing is asked after such a command.
const SETTLE_TIME: Duration = Duration::from_millis(300);
/// Time between two questions whether the unit answers again.
const ASK_AGAIN: Duration = Duration::from_millis(200);

/// Saves RAM to EEPROM, loads it back and compares. An error means that nothing was saved.
pub fn save_eeprom(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    options: WriteOptions,
) -> Result<SaveReport, Failure> {
    let before = read_all(wire, *table.subject())?;
    save_eeprom_of(wire, &before, options)
}

/// As [`save_eeprom`], when the settings have just been read.
pub(super) fn save_eeprom_of(
    wire: &mut dyn Wire,
    before: &ReadReport,
    options: WriteOptions,
) -> Result<SaveReport, Failure> {
    wire.set_quiet(true);
    let report = before.table.subject().family().settings().save(wire, before, options);
    wire.set_quiet(false);
    report
}

/// Loads EEPROM into RAM and reads every setting. What was in RAM and not saved is lost.
pub fn reload(wire: &mut dyn Wire, table: &SettingsTable) -> Result<ReadReport, Failure> {
    wire.set_quiet(true);
    let done = table.subject().family().settings().reload(wire);
    wire.set_quiet(false);
    done?;
    read_all(wire, *table.subject())
}

/// What became of restoring defaults.
#[derive(Clone, Debug)]
pub struct DefaultsReport {
    /// The settings afterwards. They are in RAM; save them to keep them.
    pub read: ReadReport,
    /// Rows whose value is not the default that the table gives: the table's, then the controller's.
    pub differences: Vec<Difference>,
    /// Where the controller answers now.
    pub address: UnitAddress,
}

/// Restores the factory settings and reads them. The unit may come back at the factory address.
///
/// Assumed: command 80 changes RAM alone, and a save makes it last; the manual does not say. RESTORE of a Motion Mind changes RAM and
/// EEPROM.
pub fn restore_defaults(wire: &mut dyn Wire, subject: Subject) -> Result<DefaultsReport, Failure> {
    wire.set_quiet(true);
    let done = subject.family().settings().restore(wire);
    wire.set_quiet(false);
    done?;
    let read = read_all(wire, subject)?;
    let differences = diff(&read.table, &read.table.default_image(), &read.image)
        .into_iter()
        .filter(|difference| difference.right.is_some())
        .collect();
    Ok(DefaultsReport { read, differences, address: wire.address() })
}

/// Waits until the unit answers again.
pub fn await_unit(wire: &mut dyn Wire, tried: impl Into<Message>) -> Result<(), Failure> {
    let tried = tried.into();
    let describe = |error: &ExchangeError, wire: &dyn Wire| error.failure(tried.clone(), wire.describe());
    let end = wire.now() + RESTART_LIMIT;
    wire.sleep(SETTLE_TIME).map_err(|error| describe(&error, wire))?;
    loop {
        if answers(wire).map_err(|error| describe(&error, wire))? {
            return Ok(());
        }
        if wire.now() >= end {
            let waited = CauseMessage::NoAnswerAfterwards { seconds: RESTART_LIMIT.as_secs() };
            return Err(Failure::new(tried, wire.describe(), waited, RemedyMessage::CheckPowerAndAddress));
        }
        wire.sleep(ASK_AGAIN).map_err(|error| describe(&error, wire))?;
    }
}

/// Whether the unit answers. An error only when nothing further can be asked.
pub fn answers(wire: &mut dyn Wire) -> Result<bool, ExchangeError> {
    match is_there(wire) {
        Ok(_) => Ok(true),
        Err(error) if is_final(&error) => Err(error),
        Err(_) => Ok(false),
    }
}

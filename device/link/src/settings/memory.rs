//! The controller's own memory: saving RAM to EEPROM, loading it back, restoring defaults.
//!
//! A unit may restart after a save (public clients wait three seconds), and a reload sent right after it may
//! go unanswered although the save was done. So each act waits until the unit answers again, and reads every
//! row to see what became of it.

use std::time::Duration;

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::number;

use super::difference::{Difference, diff};
use super::motion_mind::memory as motion_mind;
use super::plan::WriteOptions;
use super::read::{ReadReport, is_final, is_there, read_all, went_out};
use super::save_report::{SaveReport, SaveVerdict, unknown};
use super::subject::Subject;
use super::table::SettingsTable;
use super::write::{WriteReport, write};
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::unit::UnitAddress;
use crate::wire::Wire;

/// How long a unit may take to answer again after it wrote its memory. Public clients wait 3 s.
const RESTART_LIMIT: Duration = Duration::from_secs(6);
/// How long nothing is asked after such a command.
const SETTLE_TIME: Duration = Duration::from_millis(300);
/// Time between two questions whether the unit answers again.
const ASK_AGAIN: Duration = Duration::from_millis(200);
/// Reloads tried after a save; the first one after a restart may go unanswered.
const RELOAD_TRIES: usize = 3;

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
    let report = if before.table.is_motion_mind() {
        motion_mind::save(wire, before)
    } else {
        save_and_compare(wire, before, options)
    };
    wire.set_quiet(false);
    report
}

fn save_and_compare(
    wire: &mut dyn Wire,
    before: &ReadReport,
    options: WriteOptions,
) -> Result<SaveReport, Failure> {
    wire.report_progress(0, 3, "save to EEPROM");
    let tried = "save the settings (94)";
    if let Err(error) = wire.transact(number::SAVE_SETTINGS, &[]) {
        // Refused before it went out: nothing was saved. Anything else may have been carried out.
        return if went_out(&error) {
            Ok(unknown(error.failure(tried, wire.describe())))
        } else {
            Err(error.failure(tried, wire.describe()))
        };
    }
    if let Err(failure) = await_unit(wire, "save the settings (94)") {
        return Ok(unknown(failure));
    }
    wire.report_progress(1, 3, "load from EEPROM");
    let reloaded = match reload_with_patience(wire) {
        Ok(reloaded) => reloaded,
        Err(failure) => return Ok(unknown(failure)),
    };
    wire.report_progress(2, 3, "read the settings again");
    match read_all(wire, *before.table.subject()) {
        Ok(after) => Ok(judge_save(wire, before, &after, reloaded, options)),
        Err(failure) => Ok(unknown(failure)),
    }
}

fn judge_save(
    wire: &mut dyn Wire,
    before: &ReadReport,
    after: &ReadReport,
    reloaded: bool,
    options: WriteOptions,
) -> SaveReport {
    // Only what was read both times can be compared.
    let known = |difference: &Difference| difference.left.is_some() && difference.right.is_some();
    let differences: Vec<Difference> =
        diff(&before.table, &before.image, &after.image).into_iter().filter(known).collect();
    let verdict = match (differences.is_empty(), reloaded) {
        (false, _) => SaveVerdict::NotSaved,
        (true, true) => SaveVerdict::Verified,
        (true, false) => SaveVerdict::Acknowledged,
    };
    let put_back = (!differences.is_empty()).then(|| put_back(wire, before, &differences, options)).flatten();
    let eeprom = (reloaded || verdict == SaveVerdict::NotSaved).then(|| after.image.clone());
    SaveReport { verdict, differences, eeprom, put_back, failure: None }
}

/// Writes to RAM again what loading the EEPROM has changed.
fn put_back(
    wire: &mut dyn Wire,
    before: &ReadReport,
    differences: &[Difference],
    options: WriteOptions,
) -> Option<WriteReport> {
    let wanted = differences.iter().filter_map(|difference| Some((difference.key.clone(), difference.left?)));
    write(wire, &before.table, &wanted.collect(), WriteOptions { as_read: true, ..options }).ok()
}

/// Loads EEPROM into RAM and reads every setting. What was in RAM and not saved is lost. A Motion Mind starts anew for it, which stops
/// its motor and forgets its position unless POSPWRUP is set.
pub fn reload(wire: &mut dyn Wire, table: &SettingsTable) -> Result<ReadReport, Failure> {
    wire.set_quiet(true);
    let done = if table.is_motion_mind() { restart(wire) } else { reload_with_patience(wire) };
    wire.set_quiet(false);
    if done? {
        read_all(wire, *table.subject())
    } else {
        Err(Failure::new(
            "load the settings from EEPROM (95)",
            wire.describe(),
            format!("no acknowledgement in {RELOAD_TRIES} tries"),
            "Read the settings to see what the controller works with",
        ))
    }
}

/// Starts a Motion Mind anew and waits until it answers.
fn restart(wire: &mut dyn Wire) -> Result<bool, Failure> {
    motion_mind::reset(wire)?;
    await_unit(wire, "load the settings from EEPROM (RESET)").map(|()| true)
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
    let done = match subject.model.family {
        Family::MotionMind => motion_mind::restore(wire),
        Family::Mcp | Family::RoboClaw => restore(wire),
    };
    wire.set_quiet(false);
    done?;
    let read = read_all(wire, subject)?;
    let differences = diff(&read.table, &read.table.default_image(), &read.image)
        .into_iter()
        .filter(|difference| difference.right.is_some())
        .collect();
    Ok(DefaultsReport { read, differences, address: wire.address() })
}

fn restore(wire: &mut dyn Wire) -> Result<(), Failure> {
    let tried = "restore the defaults (80)";
    match wire.transact(number::RESTORE_DEFAULTS, &[]) {
        Ok(_) => {}
        // Without an acknowledgement only the settings themselves can tell whether it was done.
        Err(error) if went_out(&error) && !is_final(&error) => {}
        Err(error) => return Err(error.failure(tried, wire.describe())),
    }
    let old = wire.address();
    await_unit(wire, tried).or_else(|failure| {
        if wire.set_address(UnitAddress::DEFAULT) && answers(wire).unwrap_or(false) {
            return Ok(());
        }
        wire.set_address(old);
        Err(failure)
    })
}

/// Whether 95 was acknowledged, asked up to [`RELOAD_TRIES`] times. An error only when nothing further can be
/// asked.
fn reload_with_patience(wire: &mut dyn Wire) -> Result<bool, Failure> {
    let tried = "load the settings from EEPROM (95)";
    for _ in 0..RELOAD_TRIES {
        match wire.transact(number::RELOAD_SETTINGS, &[]) {
            Ok(_) => {
                await_unit(wire, tried)?;
                return Ok(true);
            }
            Err(error) if is_final(&error) || !went_out(&error) => {
                return Err(error.failure(tried, wire.describe()));
            }
            Err(_) => await_unit(wire, tried)?,
        }
    }
    Ok(false)
}

/// Waits until the unit answers again.
fn await_unit(wire: &mut dyn Wire, tried: &str) -> Result<(), Failure> {
    let describe = |error: &ExchangeError, wire: &dyn Wire| error.failure(tried, wire.describe());
    let end = wire.now() + RESTART_LIMIT;
    wire.sleep(SETTLE_TIME).map_err(|error| describe(&error, wire))?;
    loop {
        if answers(wire).map_err(|error| describe(&error, wire))? {
            return Ok(());
        }
        if wire.now() >= end {
            let waited = format!("no answer for {} s afterwards", RESTART_LIMIT.as_secs());
            return Err(Failure::new(
                tried,
                wire.describe(),
                waited,
                "Check its power; if it was given another address and that was not saved, look for it at \
                 the old one",
            ));
        }
        wire.sleep(ASK_AGAIN).map_err(|error| describe(&error, wire))?;
    }
}

/// Whether the unit answers. An error only when nothing further can be asked.
fn answers(wire: &mut dyn Wire) -> Result<bool, ExchangeError> {
    match is_there(wire) {
        Ok(_) => Ok(true),
        Err(error) if is_final(&error) => Err(error),
        Err(_) => Ok(false),
    }
}

//! The EEPROM of an MCP or RoboClaw: saved as a whole, and proven by loading it again.

use crate::messages::{McpActMessage, McpCauseMessage, McpRemedyMessage};
use brushwork_link::Failure;
use brushwork_link::settings::{
    Difference, ReadReport, SaveReport, SaveVerdict, WriteOptions, WriteReport, answers, await_unit, diff,
    is_final, read_all, unknown, went_out, write,
};
use brushwork_link::unit::UnitAddress;
use brushwork_link::wire::Wire;
use brushwork_mcp_wire::packet_serial::number;

/// Reloads tried after a save; the first one after a restart may go unanswered.
const RELOAD_TRIES: usize = 3;

pub fn save(wire: &mut dyn Wire, before: &ReadReport, options: WriteOptions) -> Result<SaveReport, Failure> {
    wire.report_progress(0, 3, "save to EEPROM");
    if let Err(error) = wire.transact(number::SAVE_SETTINGS, &[]) {
        // Refused before it went out: nothing was saved. Anything else may have been carried out.
        return if went_out(&error) {
            Ok(unknown(error.failure(McpActMessage::Save, wire.describe())))
        } else {
            Err(error.failure(McpActMessage::Save, wire.describe()))
        };
    }
    if let Err(failure) = await_unit(wire, McpActMessage::Save) {
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

pub fn restore(wire: &mut dyn Wire) -> Result<(), Failure> {
    match wire.transact(number::RESTORE_DEFAULTS, &[]) {
        Ok(_) => {}
        // Without an acknowledgement only the settings themselves can tell whether it was done.
        Err(error) if went_out(&error) && !is_final(&error) => {}
        Err(error) => return Err(error.failure(McpActMessage::Restore, wire.describe())),
    }
    let old = wire.address();
    await_unit(wire, McpActMessage::Restore).or_else(|failure| {
        if wire.set_address(UnitAddress::factory(old.family())) && answers(wire).unwrap_or(false) {
            return Ok(());
        }
        wire.set_address(old);
        Err(failure)
    })
}

/// Whether 95 was acknowledged, asked up to [`RELOAD_TRIES`] times. An error only when nothing further can be
/// asked.
fn reload_with_patience(wire: &mut dyn Wire) -> Result<bool, Failure> {
    for _ in 0..RELOAD_TRIES {
        match wire.transact(number::RELOAD_SETTINGS, &[]) {
            Ok(_) => {
                await_unit(wire, McpActMessage::Reload)?;
                return Ok(true);
            }
            Err(error) if is_final(&error) || !went_out(&error) => {
                return Err(error.failure(McpActMessage::Reload, wire.describe()));
            }
            Err(_) => await_unit(wire, McpActMessage::Reload)?,
        }
    }
    Ok(false)
}

/// Loads EEPROM into RAM.
pub fn reload(wire: &mut dyn Wire) -> Result<(), Failure> {
    if reload_with_patience(wire)? {
        return Ok(());
    }
    Err(Failure::new(
        McpActMessage::Reload,
        wire.describe(),
        McpCauseMessage::NoAcknowledgement { tries: RELOAD_TRIES },
        McpRemedyMessage::ReadSettings,
    ))
}

//! Write, save and restore, each between the beginning and the end of a journal.

use super::super::difference::{Difference, diff};
use super::super::image::SettingsImage;
use super::super::memory::{DefaultsReport, reload, restore_defaults, save_eeprom_of};
use super::super::plan::rows_involved;
use super::super::read::{ReadReport, read_all, read_rows};
use super::super::save_report::{SaveReport, SaveVerdict};
use super::super::step::WriteOptions;
use super::super::subject::Subject;
use super::super::table::SettingsTable;
use super::super::write::{WriteError, write};
use super::super::write_report::{RowOutcome, RowState, WriteReport};
use super::journal::Act;
use super::keeper::{Ending, Entry, Keeper};
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage, WriteMessage};
use crate::wire::Wire;
use std::time::Duration;

/// How often a keeper is asked whether it has kept everything before it counts as stuck: each time it may wait
/// for ten milliseconds, so this is about a minute: a disk under load has taken longer than ten seconds.
const PATIENCE: usize = 6000;

/// As [`write()`], with a backup and a journal. Nothing is written when those cannot be kept.
pub fn write_kept(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    keeper: &mut dyn Keeper,
) -> Result<WriteReport, WriteError> {
    let before = read_all(wire, *table.subject()).map_err(|failure| WriteError::NotRead { failure })?;
    write_over(&before, wire, table, wanted, options, keeper)
}

/// Everything that is known of a controller's settings from one write of a series to the next, so that not each of
/// them has to read everything for its backup.
#[derive(Clone, Debug, Default)]
pub struct Known(Option<ReadReport>);

impl Known {
    /// Somebody else may have changed something.
    pub fn forget(&mut self) {
        self.0 = None;
    }

    /// What is known, if the rows concerned still are as they are known to be; else everything, read anew.
    fn before(
        &mut self,
        wire: &mut dyn Wire,
        table: &SettingsTable,
        wanted: &SettingsImage,
    ) -> Result<ReadReport, WriteError> {
        let keys: Vec<&str> = wanted.iter().map(|(key, _)| key).collect();
        if let Some(known) = self.0.take() {
            let now = read_rows(wire, &rows_involved(table, &keys)).map_err(|error| WriteError::NotRead {
                failure: error.failure(ActMessage::ReadSettingsFirst, wire.describe()),
            })?;
            let is_as_known = |(key, value): (&str, _)| known.image.get(key) == Some(value);
            if now.failures.iter().all(|failure| failure.is_absent) && now.image.iter().all(is_as_known) {
                return Ok(known);
            }
        }
        read_all(wire, *table.subject()).map_err(|failure| WriteError::NotRead { failure })
    }
}

/// As [`write_kept`], for one of a series of small writes: each has its backup and its journal, but only the first
/// reads everything. `known` goes from one to the next.
pub fn write_kept_knowing(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    keeper: &mut dyn Keeper,
    known: &mut Known,
) -> Result<WriteReport, WriteError> {
    let mut before = known.before(wire, table, wanted)?;
    let result = write_over(&before, wire, table, wanted, options, keeper);
    if let Ok(report) = &result
        && report.is_complete()
    {
        report.merge_into(&mut before.image);
        known.0 = Some(before);
    }
    result
}

/// Keeps what is there before some settings are changed for a while, as by a tuning run or a calibration: a backup, and a
/// journal which says that those settings are to be again as they are now. Whoever changes them ends it with
/// [`Keeper::end`] once they are, or are to stay.
pub fn begin_trial(
    wire: &mut dyn Wire,
    subject: Subject,
    is_changed: &dyn Fn(&str) -> bool,
    keeper: &mut dyn Keeper,
) -> Result<ReadReport, Failure> {
    let before = read_all(wire, subject)?;
    let changed = before.image.iter().filter(|(key, _)| is_changed(key));
    let wanted = changed.map(|(key, value)| (key.to_owned(), value)).collect();
    begin(wire, Act::Trial, &before, wanted, keeper)?;
    Ok(before)
}

/// Keeps what is there before one command that was put together by hand and changes settings; `saves` when it writes
/// EEPROM. Whoever sends it ends it with [`Keeper::end`].
pub fn begin_command(
    wire: &mut dyn Wire,
    subject: Subject,
    saves: bool,
    keeper: &mut dyn Keeper,
) -> Result<(), Failure> {
    let before = read_all(wire, subject)?;
    match saves {
        true => begin(wire, Act::Save, &before, before.image.clone(), keeper),
        false => begin(wire, Act::Write, &before, SettingsImage::default(), keeper),
    }
}

/// Writes between the beginning and the end of a journal. `before` is what is there.
fn write_over(
    before: &ReadReport,
    wire: &mut dyn Wire,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    keeper: &mut dyn Keeper,
) -> Result<WriteReport, WriteError> {
    begin(wire, Act::Write, before, wanted.clone(), keeper)
        .map_err(|failure| WriteError::NotKept { failure })?;
    let result = write_watched(wire, table, wanted, options, &before.image);
    let ending = match &result {
        Ok(report) if is_conclusive(report) => Ending::Known,
        Ok(_) => Ending::Open,
        Err(_) => Ending::NotDone,
    };
    end_act(wire, keeper, ending);
    result
}

/// As [`write()`], with a look at everything afterwards, by which a unit that restarted in the middle is found out. `before` is what it held.
/// For whoever keeps backup and journal himself.
pub fn write_watched(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
    before: &SettingsImage,
) -> Result<WriteReport, WriteError> {
    let mut report = write(wire, table, wanted, options)?;
    // What was read before a restart is stale: only a look that finds nothing new ends it.
    for _ in 0..LOOKS {
        let is_known = !look_again(wire, table, before, &mut report);
        if report.ended_early.is_some() || is_known && is_canary_alive(wire, table, &mut report) {
            break;
        }
    }
    Ok(report)
}

/// Whether one value that the write has changed still stands once all has been read: a restart late in the last look, when only values that did not
/// change were left to read, is seen by nothing else.
fn is_canary_alive(wire: &mut dyn Wire, table: &SettingsTable, report: &mut WriteReport) -> bool {
    let is_changed = |row: &&RowOutcome| row.state == RowState::Taken && row.before != Some(row.wanted);
    let canary = report.rows.iter().find(is_changed).and_then(|row| Some((table.row(&row.key)?, row.wanted)));
    let Some((row, wanted)) = canary.filter(|(row, _)| row.has_wire_form()) else { return true };
    report.transactions += 1;
    read_rows(wire, &[row]).is_ok_and(|reading| reading.image.get(&row.key) == Some(wanted))
}

/// A unit that restarted in the middle, while it was read for the backup too, has lost more than what came back otherwise: what had been read
/// back before, and everything else that was not in its EEPROM. No firmware tells that it restarted, so all is read once more, whatever the
/// write itself found: a restart takes 50 ms, reading back takes longer.
///
/// Whether something was found that was not known.
fn look_again(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    before: &SettingsImage,
    report: &mut WriteReport,
) -> bool {
    let after = match read_all(wire, *table.subject()) {
        Ok(after) => after,
        Err(failure) => {
            report.ended_early = Some(failure);
            return false;
        }
    };
    let known = report.clone();
    report.transactions += after.transactions;
    for row in report.rows.iter_mut().filter(|row| row.state == RowState::Taken) {
        if let Some(now) = after.image.get(&row.key).filter(|now| *now != row.wanted) {
            row.found = Some(now);
            row.state = RowState::DidNotTake { why: WriteMessage::LostAgain.into() };
        }
    }
    let is_ours = |key: &str| report.rows.iter().any(|row| row.key == key);
    let disturbed = diff(table, before, &after.image).into_iter().filter(|difference| {
        difference.left.is_some() && difference.right.is_some() && !is_ours(&difference.key)
    });
    let sentence = |difference: Difference| {
        let row = table.row(&difference.key)?;
        Some(WriteMessage::DisturbedByRestart { difference: difference.describe(row) }.into())
    };
    for sentence in disturbed.filter_map(sentence) {
        if !report.warnings.contains(&sentence) {
            report.warnings.push(sentence);
        }
    }
    (&known.rows, &known.warnings) != (&report.rows, &report.warnings)
}

/// A unit that restarts more often than this while it is looked at is not waited for.
const LOOKS: usize = 4;

/// As `save_eeprom`, with a backup and a journal. Nothing is saved when those cannot be kept.
pub fn save_kept(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    options: WriteOptions,
    keeper: &mut dyn Keeper,
) -> Result<SaveReport, Failure> {
    let before = read_all(wire, *table.subject())?;
    begin(wire, Act::Save, &before, before.image.clone(), keeper)?;
    let result = save_eeprom_of(wire, &before, options);
    let ending = match &result {
        Ok(report) => save_ending(report),
        Err(_) => Ending::NotDone,
    };
    end_act(wire, keeper, ending);
    result
}

/// As [`restore_defaults`], with a backup and a journal. Nothing is restored when those cannot be kept.
pub fn defaults_kept(
    wire: &mut dyn Wire,
    subject: Subject,
    keeper: &mut dyn Keeper,
) -> Result<DefaultsReport, Failure> {
    let before = read_all(wire, subject)?;
    let wanted = before.table.default_image();
    let readable = wanted.iter().filter(|(key, _)| before.image.get(key).is_some());
    let wanted = readable.map(|(key, value)| (key.to_owned(), value)).collect();
    begin(wire, Act::Defaults, &before, wanted, keeper)?;
    let result = restore_defaults(wire, subject);
    let ending = match &result {
        Ok(report) if report.read.is_whole() => Ending::Known,
        _ => Ending::Open,
    };
    end_act(wire, keeper, ending);
    result
}

/// As [`reload`], with a backup of what RAM held. Nothing is loaded when that cannot be kept.
pub fn reload_kept(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    keeper: &mut dyn Keeper,
) -> Result<ReadReport, Failure> {
    let before = read_all(wire, *table.subject())?;
    begin(wire, Act::Reload, &before, SettingsImage::default(), keeper)?;
    let result = reload(wire, table);
    let ending = match &result {
        Ok(report) => Ending::EepromKnown(report.image.clone()),
        Err(_) => Ending::Open,
    };
    end_act(wire, keeper, ending);
    result
}

/// Has backup and journal kept, and waits for that in small steps between which Stop is looked at.
fn begin(
    wire: &mut dyn Wire,
    act: Act,
    before: &ReadReport,
    wanted: SettingsImage,
    keeper: &mut dyn Keeper,
) -> Result<(), Failure> {
    let tried = ActMessage::KeepBackup { act: act.label() };
    wire.report_progress(0, 1, &tried.to_string());
    keeper.begin(Entry {
        act,
        table: before.table.clone(),
        address: wire.address(),
        ram: before.image.clone(),
        wanted,
    });
    for _ in 0..PATIENCE {
        if let Some(kept) = keeper.begun() {
            return kept;
        }
        wire.sleep(Duration::ZERO).map_err(|error| error.failure(tried.clone(), wire.describe()))?;
    }
    Err(Failure::new(tried, "this computer", CauseMessage::DiskIsLate, RemedyMessage::CheckDisk))
}

/// Has the journal closed, or left, and waits until the disk shows it: whoever looks after the act finds what became of it. Stop
/// does not wait for that.
pub fn end_act(wire: &mut dyn Wire, keeper: &mut dyn Keeper, ending: Ending) {
    keeper.end(ending);
    for _ in 0..PATIENCE {
        if keeper.ended() || wire.sleep(Duration::ZERO).is_err() {
            return;
        }
    }
}

/// Whether every row was read back, or never sent.
fn is_conclusive(report: &WriteReport) -> bool {
    report.rows.iter().all(|row| !matches!(row.state, RowState::Unverified { .. }))
}

fn save_ending(report: &SaveReport) -> Ending {
    match (report.verdict, &report.eeprom) {
        (SaveVerdict::Verified | SaveVerdict::Stored, Some(eeprom)) => Ending::EepromKnown(eeprom.clone()),
        (SaveVerdict::NotSaved, Some(eeprom)) => match &report.put_back {
            Some(put_back) if is_conclusive(put_back) => Ending::EepromKnown(eeprom.clone()),
            _ => Ending::Open,
        },
        (SaveVerdict::Acknowledged, _) => Ending::Known,
        _ => Ending::Open,
    }
}

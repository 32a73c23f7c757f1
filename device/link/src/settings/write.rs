//! Writing changes: read what shares a command, plan, send, read back, and name what did not take.
//!
//! Until the first command is sent everything that is wrong refuses the whole. From then on there is always a
//! report that says of each row what is known.

use thiserror::Error;

use super::difference::changes;
use super::image::SettingsImage;
use super::plan::{Plan, plan, rows_involved};
use super::read::{ReadFailure, is_final, is_there, read_rows, went_out};
use super::row::Row;
use super::step::{Refusal, Stage, Step, WriteOptions};
use super::table::SettingsTable;
use super::value::SettingValue;
use super::write_report::{RowOutcome, RowState, WriteReport};
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::messages::{ActMessage, WriteMessage};
use crate::unit::UnitAddress;
use crate::wire::Wire;
use brushwork_values::Message;

/// Why nothing was written.
#[derive(Clone, Debug, Error)]
pub enum WriteError {
    /// Some values cannot be written.
    #[error("Nothing was written:{}", sentences(refusals))]
    Refused {
        /// Each of them, with the reason.
        refusals: Vec<Refusal>,
    },
    /// The values that share a command with the changes could not be read first.
    #[error("Nothing was written. {failure}")]
    NotRead {
        /// What was tried and what came back.
        failure: Failure,
    },
    /// What was there could not be kept on this computer first.
    #[error("Nothing was written. {failure}")]
    NotKept {
        /// What was tried and what came of it.
        failure: Failure,
    },
}

fn sentences(refusals: &[Refusal]) -> String {
    refusals.iter().map(|refusal| format!("\n{}", refusal.sentence)).collect()
}

/// Writes `wanted` values; those that the controller holds already are not sent. See the module's own words.
pub fn write(
    wire: &mut dyn Wire,
    table: &SettingsTable,
    wanted: &SettingsImage,
    options: WriteOptions,
) -> Result<WriteReport, WriteError> {
    let options = WriteOptions { simulated: options.simulated && wire.is_simulated(), ..options };
    let keys: Vec<&str> = wanted.iter().map(|(key, _)| key).collect();
    let involved = rows_involved(table, &keys);
    let before = read_rows(wire, &involved).map_err(|error| WriteError::NotRead {
        failure: error.failure(ActMessage::ReadSettingsFirst, wire.describe()),
    })?;
    let settled: SettingsImage =
        wanted.iter().map(|(key, value)| (key.to_owned(), settle(table, key, value))).collect();
    let changes = changes_of(table, &before.image, &settled);
    let plan = plan(table, &before.image, &changes, options)
        .map_err(|refusals| WriteError::Refused { refusals: with_causes(refusals, &before.failures) })?;
    let mut writer = Writer {
        wire,
        table,
        options,
        before: before.image,
        wanted: settled,
        changes,
        involved,
        faults: Vec::new(),
        sent: Vec::new(),
        ended: None,
        transactions: before.transactions,
    };
    writer.run(&plan);
    Ok(writer.report(plan))
}

/// The refusals, and what could not be read, which may be why.
fn with_causes(mut refusals: Vec<Refusal>, failures: &[ReadFailure]) -> Vec<Refusal> {
    refusals.extend(failures.iter().map(|unread| Refusal {
        key: unread.keys.first().cloned().unwrap_or_default(),
        sentence: unread.failure.message(),
    }));
    refusals
}

fn settle(table: &SettingsTable, key: &str, value: SettingValue) -> SettingValue {
    table.row(key).map_or(value, |row| row.settle(value))
}

/// What differs, unknown keys included so that the plan refuses them.
fn changes_of(table: &SettingsTable, before: &SettingsImage, wanted: &SettingsImage) -> SettingsImage {
    let mut changed = changes(table, before, wanted);
    for (key, value) in wanted.iter().filter(|(key, _)| table.row(key).is_none()) {
        changed.set(key, value);
    }
    changed
}

struct Writer<'w> {
    wire: &'w mut dyn Wire,
    table: &'w SettingsTable,
    options: WriteOptions,
    before: SettingsImage,
    wanted: SettingsImage,
    changes: SettingsImage,
    involved: Vec<&'w Row>,
    /// Rows whose command was answered by something other than an acknowledgement, with the sentence.
    faults: Vec<(String, Message)>,
    /// Rows whose command was sent.
    sent: Vec<String>,
    /// Why no further command is sent.
    ended: Option<Failure>,
    transactions: usize,
}

/// What was found when reading back.
#[derive(Default)]
struct ReadBack {
    image: SettingsImage,
    /// Why rows are missing from the image.
    why: Option<Message>,
}

impl Writer<'_> {
    fn run(&mut self, plan: &Plan) {
        let of = plan.steps.len();
        for (done, step) in plan.steps.iter().enumerate().filter(|(_, step)| step.stage < Stage::Address) {
            self.wire.report_progress(done, of, &step.title());
            self.send(step);
        }
        // After the pins: a pin type that is sent ends a digital mode.
        for (key, raw) in &plan.hidden {
            self.set_hidden(key, *raw);
        }
    }

    fn set_hidden(&mut self, key: &str, raw: i64) {
        if self.ended.is_some() {
            return;
        }
        let address = self.wire.address();
        let done = match self.wire.hidden_settings() {
            Some(hidden) => {
                hidden.set(address, key, raw).map_err(|sentence| WriteMessage::HiddenRefused { sentence })
            }
            None => Err(WriteMessage::NoHiddenSettings),
        };
        self.sent.push(key.to_owned());
        if let Err(why) = done {
            self.faults.push((key.to_owned(), why.into()));
        }
    }

    fn send(&mut self, step: &Step) {
        if self.ended.is_some() {
            return;
        }
        self.transactions += 1;
        let reply = self.wire.transact(step.command, &step.values());
        if reply.as_ref().err().is_none_or(went_out) {
            self.sent.extend(step.keys.iter().cloned());
        }
        if let Err(error) = reply {
            self.note_fault(step, &error);
        }
    }

    /// A command that failed: its rows are told; the rest goes on only if the controller still answers.
    fn note_fault(&mut self, step: &Step, error: &ExchangeError) {
        let failure = error.failure(ActMessage::Write { what: step.title() }, self.wire.describe());
        self.faults.extend(step.keys.iter().map(|key| (key.clone(), failure.message())));
        if is_final(error) || (step.stage < Stage::Address && !self.still_answers()) {
            self.ended = Some(failure);
        }
    }

    fn still_answers(&mut self) -> bool {
        self.transactions += 1;
        is_there(self.wire).is_ok()
    }

    fn report(mut self, plan: Plan) -> WriteReport {
        let mut found = self.read_back();
        if self.send_registers(&found.image) {
            found = self.read_back();
        }
        let mut warnings = plan.warnings;
        warnings.extend(self.disturbed_neighbours(&found.image));
        for step in plan.steps.iter().filter(|step| step.stage >= Stage::Address) {
            self.send_departing(step, &mut found, &mut warnings);
        }
        let rows = self.table.rows().iter().filter_map(|row| self.outcome(row, &found)).collect();
        WriteReport {
            rows,
            warnings,
            ended_early: self.ended,
            address: self.wire.address(),
            transactions: self.transactions,
        }
    }

    /// Sends the registers of values that came back with the right meaning and another number, of those that share a command with a
    /// change too: the usual form goes out first, since which sign a firmware takes is not public, and what was read from a unit once
    /// only where that form did not bring it back. Whether anything was sent.
    fn send_registers(&mut self, found: &SettingsImage) -> bool {
        let odd_one = |row: &&Row| -> Option<(String, SettingValue)> {
            let right = self.changes.get(&row.key).or_else(|| self.before.get(&row.key))?;
            let now = found.get(&row.key)?;
            let is_odd = right != now && row.encode(right) == row.encode(now) && row.sink().is_some();
            is_odd.then(|| (row.key.clone(), right))
        };
        let odd: SettingsImage = self.involved.iter().filter_map(odd_one).collect();
        if odd.is_empty() || self.ended.is_some() {
            return false;
        }
        // What nobody chose may be out of range.
        let options = WriteOptions { as_read: true, ..self.options };
        let Ok(plan) = plan(self.table, found, &odd, options) else { return false };
        plan.steps.iter().for_each(|step| self.send(step));
        true
    }

    /// Rows that nobody wanted changed and that came back changed.
    fn disturbed_neighbours(&self, found: &SettingsImage) -> Vec<Message> {
        let disturbed = |row: &&Row| {
            let (before, now) = (self.before.get(&row.key)?, found.get(&row.key)?);
            (self.wanted.get(&row.key).is_none() && now != before).then(|| {
                let (before, now) = (row.format(before), row.format(now));
                WriteMessage::Disturbed { title: row.title(), before, now }.into()
            })
        };
        self.involved.iter().filter_map(disturbed).collect()
    }

    /// Reads every row of the commands again, wanted or not.
    fn read_back(&mut self) -> ReadBack {
        if let Some(failure) = &self.ended
            && self.sent.is_empty()
        {
            return ReadBack { image: SettingsImage::default(), why: Some(failure.message()) };
        }
        match read_rows(self.wire, &self.involved) {
            Ok(reading) => {
                self.transactions += reading.transactions;
                let why = reading.failures.first().map(|failure| failure.failure.message());
                ReadBack { image: reading.image, why }
            }
            Err(error) => {
                let failure = error.failure(ActMessage::ReadSettingsBack, self.wire.describe());
                let why = Some(failure.message());
                self.ended.get_or_insert(failure);
                ReadBack { image: SettingsImage::default(), why }
            }
        }
    }

    /// A step that changes the way to the controller: sent, followed if the wire can follow, and read back
    /// where it leads.
    fn send_departing(&mut self, step: &Step, found: &mut ReadBack, warnings: &mut Vec<Message>) {
        if self.ended.is_some() {
            return;
        }
        self.send(step);
        for key in &step.keys {
            found.image.remove(key);
        }
        if step.stage == Stage::Address && self.sent_any(step) && !self.follow(step, warnings) {
            found.why = Some(WriteMessage::AnswersNowhere.into());
            return;
        }
        let rows: Vec<&Row> = step.keys.iter().filter_map(|key| self.table.row(key)).collect();
        match read_rows(self.wire, &rows) {
            Ok(reading) => {
                self.transactions += reading.transactions;
                found.image.merge(&reading.image);
                let why = reading.failures.first().map(|failure| failure.failure.message());
                found.why = found.why.take().or(why);
            }
            Err(error) => {
                let failure = error.failure(ActMessage::ReadSettingsBack, self.wire.describe());
                found.why.get_or_insert(failure.message());
                self.ended.get_or_insert(failure);
            }
        }
    }

    /// Speaks to the unit's new address, or to the old one if it does not answer there. `false` if it answers
    /// to neither.
    fn follow(&mut self, step: &Step, warnings: &mut Vec<Message>) -> bool {
        let old = self.wire.address();
        let number = step.family.settings().new_address(step);
        let Some(new) = number.and_then(|number| UnitAddress::new(step.family, number)) else { return true };
        if !self.wire.set_address(new) {
            warnings.push(WriteMessage::Moved { address: new }.into());
            return false;
        }
        self.still_answers() || (self.wire.set_address(old) && self.still_answers())
    }

    fn sent_any(&self, step: &Step) -> bool {
        step.keys.iter().any(|key| self.sent.contains(key))
    }

    fn outcome(&self, row: &Row, found: &ReadBack) -> Option<RowOutcome> {
        let wanted = self.wanted.get(&row.key)?;
        let before = self.before.get(&row.key);
        let was_sent = self.sent.contains(&row.key);
        let to_change = self.changes.get(&row.key).is_some();
        let read = found.image.get(&row.key);
        let state = match read {
            _ if !to_change => RowState::Taken,
            Some(read) if read == wanted => RowState::Taken,
            _ if !was_sent => RowState::NotSent { why: self.why_not_sent(&row.key) },
            Some(_) => RowState::DidNotTake { why: self.fault_of(&row.key) },
            None => RowState::Unverified { why: found.why.clone().unwrap_or_default() },
        };
        let found = if to_change { read } else { before };
        Some(RowOutcome { key: row.key.clone(), before, wanted, found, state })
    }

    fn fault_of(&self, key: &str) -> Message {
        self.faults.iter().find(|(faulty, _)| faulty == key).map(|(_, why)| why.clone()).unwrap_or_default()
    }

    fn why_not_sent(&self, key: &str) -> Message {
        match (self.fault_of(key), &self.ended) {
            (fault, _) if !fault.is_empty() => fault,
            (_, Some(failure)) => failure.message(),
            _ => Message::default(),
        }
    }
}

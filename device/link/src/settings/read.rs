//! Reading settings from a controller: each command once, whatever fails told and kept apart.

use std::collections::BTreeMap;

use brushwork_values::Values;
use serde::Serialize;

use super::image::SettingsImage;
use super::row::{Carrier, Place, Row, Source};
use super::subject::Subject;
use super::table::SettingsTable;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::family::FamilyRef;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use crate::wire::Wire;

/// After this many commands in a row without any answer, and none answered before, the controller counts as
/// not there.
const SILENT_COMMANDS: usize = 3;

/// What reading gave.
#[derive(Clone, Debug)]
pub struct ReadReport {
    /// The table of the controller, with as many pins, streams and outputs as it says it has.
    pub table: SettingsTable,
    /// The values read.
    pub image: SettingsImage,
    /// What could not be read.
    pub failures: Vec<ReadFailure>,
    /// Commands sent.
    pub transactions: usize,
}

/// A command that gave nothing, or not all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReadFailure {
    /// The command.
    pub command: u8,
    /// The rows that have no value for it.
    pub keys: Vec<String>,
    /// What was tried and what came back.
    pub failure: Failure,
    /// Whether the firmware lacks it, so that there is nothing to read.
    pub is_absent: bool,
}

impl ReadReport {
    /// What this firmware has and could not be read all the same.
    pub fn unread(&self) -> impl Iterator<Item = &ReadFailure> {
        self.failures.iter().filter(|failure| !failure.is_absent)
    }

    /// Whether all that this firmware has was read.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.unread().next().is_none()
    }
}

/// Reads every setting of a controller with as few commands as there are replies to read. What one command
/// fails to give is in the report; an error means that there is no controller to read from, or that something
/// more urgent came.
pub fn read_all(wire: &mut dyn Wire, subject: Subject) -> Result<ReadReport, Failure> {
    let mut reader = Reader::new(wire);
    let subject = reader.count(subject).map_err(|error| reader.gave_up(&error))?;
    let table = SettingsTable::new(subject);
    let commands = read_commands(table.rows());
    reader.read_commands(&commands).map_err(|error| reader.gave_up(&error))?;
    let (image, failures) = reader.collect(table.rows());
    Ok(ReadReport { image, failures, transactions: reader.transactions, table })
}

/// Reads some rows of a controller whose table is known. Keys that the table does not have are left out.
pub fn read_some(wire: &mut dyn Wire, table: &SettingsTable, keys: &[String]) -> Result<ReadReport, Failure> {
    let rows: Vec<&Row> = keys.iter().filter_map(|key| table.row(key)).collect();
    let reading =
        read_rows(wire, &rows).map_err(|error| error.failure(ActMessage::ReadSettings, wire.describe()))?;
    let Reading { image, failures, transactions } = reading;
    Ok(ReadReport { table: table.clone(), image, failures, transactions })
}

/// The values of some rows, read anew, and what failed.
pub(super) struct Reading {
    pub(super) image: SettingsImage,
    pub(super) failures: Vec<ReadFailure>,
    pub(super) transactions: usize,
}

/// Reads the given rows.
pub(super) fn read_rows(wire: &mut dyn Wire, rows: &[&Row]) -> Result<Reading, ExchangeError> {
    let mut reader = Reader::new(wire);
    reader.read_commands(&read_commands(rows.iter().copied()))?;
    let (image, failures) = reader.collect(rows.iter().copied());
    Ok(Reading { image, failures, transactions: reader.transactions })
}

/// The commands that read these rows, each once, in the order of the rows.
pub(super) fn read_commands<'r>(rows: impl IntoIterator<Item = &'r Row>) -> Vec<u8> {
    let mut commands = Vec::new();
    for row in rows {
        if let Carrier::Wire { read: Source::Reply { command, .. }, .. } = row.carrier
            && !commands.contains(&command)
        {
            commands.push(command);
        }
    }
    commands
}

/// Whether nothing further can be asked on this wire.
pub fn is_final(error: &ExchangeError) -> bool {
    error.is_link_lost() || error.interruption().is_some()
}

/// Asks the unit for something that every unit of its family tells, to see whether it answers.
pub fn is_there(wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
    wire.address().family().settings().is_there(wire)
}

/// Whether a command that failed may have reached the unit. An interruption may come after it went out, so it
/// counts.
pub fn went_out(error: &ExchangeError) -> bool {
    !matches!(
        error,
        ExchangeError::NotArmed { .. }
            | ExchangeError::Unproven { .. }
            | ExchangeError::Unsupported { .. }
            | ExchangeError::Absent { .. }
            | ExchangeError::Untold { .. }
            | ExchangeError::Encode { .. }
    )
}

/// Replies by command, each read once.
struct Reader<'w> {
    wire: &'w mut dyn Wire,
    replies: BTreeMap<u8, Result<Values, ExchangeError>>,
    transactions: usize,
    /// Whether there is a controller, though it did not answer what was asked.
    someone_answers: bool,
}

impl<'w> Reader<'w> {
    fn new(wire: &'w mut dyn Wire) -> Self {
        Self { wire, replies: BTreeMap::new(), transactions: 0, someone_answers: false }
    }

    /// The subject with the numbers of pins, streams and outputs that the unit returns; where it does not
    /// answer, those of its model stay.
    fn count(&mut self, mut subject: Subject) -> Result<Subject, ExchangeError> {
        if let Some(lists) = subject.family().settings().lists(&subject) {
            self.read_commands(&[lists.pins, lists.streams, lists.douts])?;
            let count = |command: u8, listed: usize| match self.replies.get(&command) {
                Some(Ok(values)) => values.records().count(),
                _ => listed,
            };
            subject.pins = count(lists.pins, subject.pins);
            subject.streams = count(lists.streams, subject.streams);
            subject.douts = count(lists.douts, subject.douts);
        }
        Ok(subject)
    }

    fn read_commands(&mut self, commands: &[u8]) -> Result<(), ExchangeError> {
        for (index, command) in commands.iter().enumerate() {
            if !self.replies.contains_key(command) {
                let title = self.wire.address().family().settings().read_title(*command);
                self.wire.report_progress(index, commands.len(), title);
                self.read_command(*command)?;
            }
        }
        Ok(())
    }

    fn read_command(&mut self, command: u8) -> Result<(), ExchangeError> {
        self.transactions += 1;
        let reply = self.wire.transact(command, &[]);
        if let Err(error) = &reply
            && (is_final(error) || self.nobody_there(error) && !self.is_there())
        {
            return Err(error.clone());
        }
        self.replies.insert(command, reply);
        Ok(())
    }

    /// Whether there is a controller that does not know what it was asked so far.
    fn is_there(&mut self) -> bool {
        self.someone_answers = is_there(self.wire).is_ok();
        self.someone_answers
    }

    /// Whether this is one silence too many.
    fn nobody_there(&self, error: &ExchangeError) -> bool {
        let silent = self.replies.values().all(|reply| matches!(reply, Err(error) if error.is_no_answer()));
        error.is_no_answer() && silent && !self.someone_answers && self.replies.len() + 1 >= SILENT_COMMANDS
    }

    /// The values of the rows, and what has none.
    fn collect<'r>(&self, rows: impl IntoIterator<Item = &'r Row>) -> (SettingsImage, Vec<ReadFailure>) {
        let mut image = SettingsImage::default();
        let mut failures =
            Failures { on: self.wire.describe(), family: self.wire.address().family(), list: Vec::new() };
        for row in rows {
            match row.carrier {
                Carrier::Wire { read: Source::LinkAddress, .. } => {
                    image.set(&row.key, row.decode(i64::from(self.wire.address().get())));
                }
                Carrier::Wire { read: Source::Reply { command, place, record }, .. } => {
                    match self.replies.get(&command) {
                        Some(Ok(values)) => match raw_of(values, place, record) {
                            Some(raw) => image.set(&row.key, row.decode(raw)),
                            None => match self.lacking(command, place) {
                                Some(error) => failures.no_reply(command, row, &error),
                                None => failures.incomplete(command, row),
                            },
                        },
                        Some(Err(error)) => failures.no_reply(command, row, error),
                        None => failures.incomplete(command, row),
                    }
                }
                Carrier::NoWireForm { .. } => {
                    let hidden = self.wire.hidden_settings();
                    if let Some(raw) = hidden.and_then(|hidden| hidden.get(self.wire.address(), &row.key)) {
                        image.set(&row.key, row.decode(raw));
                    }
                }
            }
        }
        (image, failures.list)
    }

    /// Why a field is missing in a reply that others are in: the firmware has it not.
    fn lacking(&self, command: u8, place: Place) -> Option<ExchangeError> {
        let settings = self.wire.address().family().settings();
        let number = settings.learned_number(command, place.field)?;
        let command = settings.learned_phrase(number);
        self.wire.lacks(number).then_some(ExchangeError::Absent { command })
    }

    fn gave_up(&self, error: &ExchangeError) -> Failure {
        error.failure(ActMessage::ReadSettings, self.wire.describe())
    }
}

/// The failures so far, one for each command.
struct Failures {
    on: String,
    family: FamilyRef,
    list: Vec<ReadFailure>,
}

impl Failures {
    fn no_reply(&mut self, command: u8, row: &Row, error: &ExchangeError) {
        let is_absent = matches!(error, ExchangeError::Absent { .. } | ExchangeError::Untold { .. });
        let failure = error.failure(self.read(command), &self.on);
        self.add(row, ReadFailure { command, keys: Vec::new(), failure, is_absent });
    }

    fn incomplete(&mut self, command: u8, row: &Row) {
        let (read, cause) = (self.read(command), CauseMessage::ReplyTooShort);
        let failure = Failure::new(read, &self.on, cause, RemedyMessage::CheckFirmware);
        self.add(row, ReadFailure { command, keys: Vec::new(), failure, is_absent: false });
    }

    fn read(&self, command: u8) -> ActMessage {
        ActMessage::Read { phrase: self.family.settings().read_phrase(command) }
    }

    /// Counts a row to the failure of its command, of which one is told.
    fn add(&mut self, row: &Row, failure: ReadFailure) {
        let is_same = |known: &&mut ReadFailure| {
            (known.command, known.is_absent) == (failure.command, failure.is_absent)
        };
        match self.list.iter_mut().find(is_same) {
            Some(known) => known.keys.push(row.key.clone()),
            None => self.list.push(ReadFailure { keys: vec![row.key.clone()], ..failure }),
        }
    }
}

/// The raw number of a field, or of its bits, in a reply.
fn raw_of(values: &Values, place: Place, record: Option<usize>) -> Option<i64> {
    let word = match record {
        Some(index) => values.records().nth(index)?.try_int(place.field)?,
        None => values.try_int(place.field)?,
    };
    Some(place.bits.map_or(word, |bits| bits.extract(word)))
}

//! From wanted values to the fewest commands that write them, in an order in which nothing dangerous happens
//! in between.
//!
//! A plan is all or nothing: one value that cannot be written refuses the whole. No command is sent here.

use std::collections::BTreeMap;

use serde::Serialize;

use super::family::{Argument, PlanContext, Planned, refuse};
use super::image::SettingsImage;
use super::row::{Carrier, Place, Row, Sink, Source};
use super::step::{Refusal, Step, WriteOptions};
use super::table::SettingsTable;
use super::value::SettingValue;
use crate::messages::PlanMessage;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::Message;

/// The commands that bring about some changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Settings that are set past the wire of a simulated controller: key and raw value.
    pub hidden: Vec<(String, i64)>,
    /// The commands, in the order in which they are sent.
    pub steps: Vec<Step>,
    /// What the user should know before it is done, a sentence each.
    pub warnings: Vec<Message>,
}

impl Step {
    /// The bytes as they would be sent.
    pub fn bytes(&self, address: UnitAddress, generation: FirmwareGeneration) -> Result<Vec<u8>, Message> {
        self.family.settings().step_bytes(self, address, generation)
    }

    /// The raw arguments in wire order.
    pub fn values(&self) -> Vec<i64> {
        self.arguments.iter().map(|(_, raw)| *raw).collect()
    }

    /// Whether the controller's command has room for the values; an error is a clause.
    fn fits(&self, generation: FirmwareGeneration) -> Result<(), Message> {
        self.bytes(UnitAddress::factory(self.family), generation).map(drop)
    }

    /// The step in words.
    pub fn words(&self, address: UnitAddress, generation: FirmwareGeneration) -> String {
        self.family.settings().step_words(self, address, generation)
    }

    /// What it does, for sentences.
    pub fn title(&self) -> String {
        self.family.settings().step_title(self)
    }
}

/// The commands that turn `ram` into `ram` with `changes`. Fields that share a command with a change keep the
/// value they have in `ram`. Refuses, with every reason, when one change cannot be written.
pub fn plan(
    table: &SettingsTable,
    ram: &SettingsImage,
    changes: &SettingsImage,
    options: WriteOptions,
) -> Result<Plan, Vec<Refusal>> {
    let mut refusals: Vec<Refusal> =
        changes.iter().filter_map(|(key, value)| refusal(table, key, value, options)).collect();
    let mut after = ram.clone();
    after.merge(changes);
    let pairs = wrong_pairs(table, &after, changes);
    let context = PlanContext { table, ram, changes, options };
    let family = table.subject().family().settings();
    let (steps, missing) = context.steps();
    refusals.extend(missing);
    let mut warnings = context.unusual();
    match options.as_read {
        true => {
            let as_read = |pair: Refusal| PlanMessage::BothAsRead { why: pair.sentence }.into();
            warnings.extend(pairs.into_iter().map(as_read));
        }
        false => refusals.extend(pairs),
    }
    if !refusals.is_empty() {
        return Err(refusals);
    }
    warnings.extend(family.warnings(&context, &steps));
    warnings.extend(family.dangers(table, &after, changes));
    warnings.extend(family.conflicts(table, &after, changes));
    Ok(Plan { hidden: context.hidden(), steps, warnings })
}

/// The rows whose values a change of `keys` needs: those themselves, and those that share a command with
/// them.
pub(super) fn rows_involved<'t>(table: &'t SettingsTable, keys: &[&str]) -> Vec<&'t Row> {
    let sinks: Vec<Sink> = keys.iter().filter_map(|key| table.row(key)?.sink()).collect();
    let shares = |row: &Row| {
        row.sink().is_some_and(|own| {
            sinks.iter().any(|sink| (sink.command, sink.index) == (own.command, own.index))
        }) || whole_word_of(row).is_some_and(|place| sinks.iter().any(|sink| sink.place.field == place))
    };
    table.rows().iter().filter(|row| keys.contains(&row.key.as_str()) || shares(row)).collect()
}

/// The field that a read-only row shows whole while other rows write its bits.
fn whole_word_of(row: &Row) -> Option<&'static str> {
    match row.carrier {
        Carrier::Wire { read: Source::Reply { place, .. }, write: None } => Some(place.field),
        Carrier::Wire { .. } | Carrier::NoWireForm { .. } => None,
    }
}

fn refusal(table: &SettingsTable, key: &str, value: SettingValue, options: WriteOptions) -> Option<Refusal> {
    let sentence = match table.row(key) {
        None => {
            let (model, generation) = (table.subject().model.name, table.subject().generation);
            Some(PlanMessage::NoSuchSetting { model, generation, key: key.to_owned() }.into())
        }
        Some(row) => match row.locked(options.simulated) {
            Some(reason) => Some(PlanMessage::Locked { title: row.title(), reason }.into()),
            None if options.as_read => row.check_as_read(value).err(),
            None => row.check(value).err(),
        },
    };
    sentence.map(|sentence| Refusal { key: key.to_owned(), sentence })
}

/// How numbers are written that mean the same with either sign.
#[derive(Clone, Copy)]
enum Sign {
    /// As the controller's generation has it.
    Usual,
    /// As it stood in the register.
    AsRead,
}

impl PlanContext<'_> {
    /// One step for each command and index that carries a change, in stage order.
    fn steps(&self) -> (Vec<Step>, Vec<Refusal>) {
        let family = self.table.subject().family();
        let mut groups: BTreeMap<(u8, Option<u8>), Vec<&Row>> = BTreeMap::new();
        for row in self.table.rows().iter().filter(|row| self.changes.get(&row.key).is_some()) {
            if let Some(sink) = row.sink() {
                groups.entry((sink.command, sink.index)).or_default().push(row);
            }
        }
        let mut steps = Vec::new();
        let mut refusals = Vec::new();
        for ((command, index), changed) in groups {
            let planned = Planned { context: self, command, index, changed: &changed };
            // One number has no usual form: the lowest of its field, where the usual form is without the sign.
            match self.step(&planned, Sign::Usual).or_else(|_| self.step(&planned, Sign::AsRead)) {
                Ok(step) => steps.push(step),
                Err(refusal) => refusals.push(refusal),
            }
        }
        steps.sort_by_key(|step| step.stage);
        family.settings().order(&mut steps, self.ram);
        (steps, refusals)
    }

    fn step(&self, planned: &Planned<'_>, sign: Sign) -> Result<Step, Refusal> {
        let family = self.table.subject().family();
        let step = Step {
            family,
            command: planned.command,
            arguments: self.arguments(planned, sign)?,
            keys: planned.changed.iter().map(|row| row.key.clone()).collect(),
            stage: family.settings().stage(planned),
        };
        match step.fits(self.table.subject().generation) {
            Ok(()) => Ok(step),
            Err(why) => Err(no_room(planned.changed, why)),
        }
    }

    fn arguments(&self, planned: &Planned<'_>, sign: Sign) -> Result<Vec<(&'static str, i64)>, Refusal> {
        let (command, index, changed) = (planned.command, planned.index, planned.changed);
        let settings = self.table.subject().family().settings();
        let wanted = settings.arguments(planned).map_err(|why| refuse(changed, why))?;
        let value = |argument| match argument {
            Argument::Given(name, value) => Ok((name, value)),
            Argument::Field(field) => {
                let place = Place { field, bits: None };
                Ok((field, self.field_value(Sink { command, index, place }, changed, sign)?))
            }
        };
        wanted.into_iter().map(value).collect()
    }

    /// The raw number of one field of a command: the changed value, or what the controller holds, bits put
    /// together.
    fn field_value(&self, field: Sink, changed: &[&Row], sign: Sign) -> Result<i64, Refusal> {
        let of_field = |row: &&Row| {
            row.sink().is_some_and(|sink| {
                (sink.command, sink.index, sink.place.field)
                    == (field.command, field.index, field.place.field)
            })
        };
        let base = self.whole_word(field);
        let mut word = base.unwrap_or(0);
        for row in self.table.rows().iter().filter(of_field) {
            let change = self.changes.get(&row.key);
            // With the whole word known, only the bits that change are touched; the rest of it is kept as it
            // is.
            if base.is_some() && change.is_none() {
                continue;
            }
            let now = self.ram.get(&row.key);
            let raw = match (change, now) {
                // They mean the same, so the number itself is what is wanted.
                (Some(change), Some(now)) if row.encode(change) == row.encode(now) => row.register_of(change),
                _ => change.or(now).and_then(|value| match sign {
                    Sign::Usual => row.encode(value),
                    Sign::AsRead => row.register_of(value),
                }),
            };
            let raw = raw.ok_or_else(|| unknown_neighbour(row, changed))?;
            word = match row.sink().and_then(|sink| sink.place.bits) {
                Some(bits) if bits.extract(bits.insert(0, raw)) != raw => {
                    let why = PlanMessage::TooManyBits { raw, width: bits.width };
                    return Err(no_room(&[row], why.into()));
                }
                Some(bits) => bits.insert(word, raw),
                None => raw,
            };
        }
        Ok(word)
    }

    /// What the controller holds of a field whose bits are rows of their own, if a row shows it whole.
    fn whole_word(&self, field: Sink) -> Option<i64> {
        let row = self.table.rows().iter().find(|row| whole_word_of(row) == Some(field.place.field))?;
        row.encode(self.ram.get(&row.key)?)
    }

    fn hidden(&self) -> Vec<(String, i64)> {
        let hidden = self.table.rows().iter().filter(|row| !row.has_wire_form());
        hidden.filter_map(|row| Some((row.key.clone(), row.encode(self.changes.get(&row.key)?)?))).collect()
    }

    /// Values that nobody may choose and that are written as they were read.
    fn unusual(&self) -> Vec<Message> {
        let changed = self.table.rows().iter().filter_map(|row| Some((row, self.changes.get(&row.key)?)));
        changed.filter_map(|(row, value)| row.check_as_read(value).ok()?).collect()
    }
}

/// A value that the fields of its command cannot hold: no unit has ever had it.
fn no_room(changed: &[&Row], why: Message) -> Refusal {
    let titles: Vec<String> = changed.iter().map(|row| row.title()).collect();
    refuse(changed, PlanMessage::NoRoom { titles: titles.join(", "), why })
}

fn unknown_neighbour(row: &Row, changed: &[&Row]) -> Refusal {
    let wanted = changed.first().map_or_else(String::new, |row| row.title());
    refuse(changed, PlanMessage::UnknownNeighbour { wanted, neighbour: row.title() })
}

/// Pairs that `after` holds the wrong way round, if `changes` touches them.
fn wrong_pairs(table: &SettingsTable, after: &SettingsImage, changes: &SettingsImage) -> Vec<Refusal> {
    let refusal = |(low, high): &(&str, &str)| {
        let touched = [low, high].into_iter().find(|key| changes.get(key).is_some())?;
        let (low_row, high_row) = (table.row(low)?, table.row(high)?);
        let (low, high) = (after.get(low)?, after.get(high)?);
        is_above(low, high).then(|| Refusal {
            key: (*touched).to_owned(),
            sentence: PlanMessage::WrongOrder {
                low: low_row.title(),
                low_value: low_row.format(low),
                high: high_row.title(),
                high_value: high_row.format(high),
            }
            .into(),
        })
    };
    table.subject().family().settings().ordered_pairs().iter().filter_map(refusal).collect()
}

fn is_above(low: SettingValue, high: SettingValue) -> bool {
    match (low, high) {
        (SettingValue::Int(low), SettingValue::Int(high)) => low > high,
        _ => low.number().zip(high.number()).is_some_and(|(low, high)| low > high),
    }
}

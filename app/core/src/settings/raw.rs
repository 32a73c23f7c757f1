//! One number in one register, at its owner's word, where what it means is not public.

use brushwork_link::settings::Row;
use brushwork_link::{Message, SettingsImage, SettingsTable};

use crate::examine::RawWrite;
use crate::keep::{KeepError, Store, UnitId, today};
use crate::messages::RawMessage;

/// A number that is to be written.
#[derive(Clone, Debug)]
pub struct Raw {
    /// The table in which its register may be written.
    pub table: SettingsTable,
    /// The number as the setting's value.
    pub changes: SettingsImage,
    /// What is noted of it.
    pub write: RawWrite,
}

impl Raw {
    /// A number for the register of a setting; `ram` is what the unit holds.
    ///
    /// # Errors
    /// A sentence: there is no such setting, or no command that writes it.
    pub fn new(table: &SettingsTable, ram: &SettingsImage, key: &str, raw: i64) -> Result<Self, Message> {
        let table = table.clone().at_owners_word(key)?;
        let row = table.row(key);
        let sink = row.and_then(Row::sink);
        let write = RawWrite {
            date: today(),
            key: key.to_owned(),
            command: sink.map_or(0, |sink| sink.command),
            index: sink.and_then(|sink| sink.index),
            field: sink.map_or("", |sink| sink.place.field).to_owned(),
            before: row.and_then(|row| held(row, ram)),
            wanted: raw,
            found: None,
            is_open: false,
        };
        let changes = row.map(|row| (row.key.clone(), row.decode(raw))).into_iter().collect();
        Ok(Self { table, changes, write })
    }

    /// Whether the register holds the number already.
    #[must_use]
    pub fn is_there(&self) -> bool {
        self.write.before == Some(self.write.wanted)
    }
}

/// What a setting's register holds, as far as it was read.
#[must_use]
pub fn held(row: &Row, image: &SettingsImage) -> Option<i64> {
    image.get(&row.key).and_then(|value| row.register_of(value))
}

/// The setting and the number that undo the newest raw write.
#[must_use]
pub fn undoing(writes: &[RawWrite]) -> Option<(String, i64)> {
    let newest = writes.last()?;
    Some((newest.key.clone(), newest.before?))
}

/// Ends what was written raw and cut off before it was read back, by what the registers hold now; a sentence for each.
///
/// # Errors
/// The list of raw numbers cannot be read or kept.
pub fn told_of_cut_off(
    store: &Store,
    unit: &UnitId,
    table: &SettingsTable,
    ram: &SettingsImage,
) -> Result<Vec<Message>, KeepError> {
    let ended = store.end_raw_writes(unit, |write| held(table.row(&write.key)?, ram))?;
    Ok(ended.iter().map(cut_off).collect())
}

fn cut_off(write: &RawWrite) -> Message {
    let RawWrite { key, date, command, wanted, .. } = write.clone();
    let number = |raw: Option<i64>| raw.map_or_else(|| "?".to_owned(), |raw| raw.to_string());
    let (before, now) = (number(write.before), number(write.found));
    match (write.found == Some(wanted), write.found == write.before) {
        (true, _) => RawMessage::CutOffTaken { key, date, command, wanted, before }.into(),
        (false, true) => RawMessage::CutOffNotTaken { key, date, command, wanted, before }.into(),
        (false, false) => RawMessage::CutOffOther { key, date, command, wanted, before, now }.into(),
    }
}

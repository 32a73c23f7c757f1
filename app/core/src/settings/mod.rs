//! Acts on settings that window and command line share: what may be written as it was read, a profile made to fit, what
//! settles an act that was cut short, and each act with its backup, its journal, its name and its time limit.

mod act;
pub mod for_all;
pub mod raw;

pub use act::{Act, Done, counted};

use brushwork_link::settings::{Journal, OpenedProfile, Refusal, plan};
use brushwork_link::{Message, Profile, SettingValue, SettingsImage, SettingsTable, WriteOptions};

/// How values are written of which some were read from a unit once (`is_taken`) and others typed. What was read may be out of range
/// and is written as it was; what somebody types has to be right beside it.
///
/// # Errors
/// Every reason why something that was typed cannot be written.
pub fn write_options(
    table: &SettingsTable,
    ram: &SettingsImage,
    wanted: &SettingsImage,
    is_taken: impl Fn(&str, SettingValue) -> bool,
    options: WriteOptions,
) -> Result<WriteOptions, Vec<Refusal>> {
    let owned = wanted.iter().map(|(key, value)| (key.to_owned(), value));
    let (taken, typed): (Vec<_>, Vec<_>) = owned.partition(|(key, value)| is_taken(key, *value));
    if taken.is_empty() {
        return Ok(options);
    }
    let (taken, typed) = (taken.into_iter().collect(), typed.into_iter().collect());
    plan(table, &merged(ram, &taken), &typed, options)?;
    Ok(WriteOptions { as_read: true, ..options })
}

/// `image` with `changes`.
#[must_use]
pub fn merged(image: &SettingsImage, changes: &SettingsImage) -> SettingsImage {
    let mut after = image.clone();
    after.merge(changes);
    after
}

/// A profile as it is for a controller, and what had to be changed of it, a sentence each; as it was read where that is nothing.
#[must_use]
pub fn fitted(opened: OpenedProfile, table: &SettingsTable) -> (Profile, Vec<Message>) {
    let fitted = opened.profile.fitted_to(table);
    let sentences: Vec<Message> = opened.upgraded.into_iter().chain(fitted.changes).collect();
    (if sentences.is_empty() { opened.profile } else { fitted.profile }, sentences)
}

/// The default of every setting whose value was read: what is not readable cannot be compared either.
#[must_use]
pub fn known_defaults(table: &SettingsTable, image: &SettingsImage) -> SettingsImage {
    let known = table.rows().iter().filter(|row| image.get(&row.key).is_some());
    known.map(|row| (row.key.clone(), row.default)).collect()
}

/// What EEPROM as it was proven last is called.
#[must_use]
pub fn eeprom_title(known: &Profile) -> String {
    format!("EEPROM as known since {}", known.date_text())
}

/// What finishes an act that was cut short, or undoes it, as far as this controller lets it be written.
#[must_use]
pub fn remedy(
    journal: &Journal,
    table: &SettingsTable,
    ram: &SettingsImage,
    undo: bool,
    is_simulated: bool,
) -> SettingsImage {
    let is_writable = |key: &str| table.row(key).is_some_and(|row| row.locked(is_simulated).is_none());
    let remedy = journal.remedy(ram, undo);
    let writable = remedy.iter().filter(|(key, _)| is_writable(key));
    writable.map(|(key, value)| (key.to_owned(), value)).collect()
}

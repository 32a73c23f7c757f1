//! The settings of one unit: what it holds as far as known, what the user wants instead, and what was typed.
//!
//! Every screen that shows a setting shows this state, and whatever changes RAM or an edit raises its revision.

use std::collections::{BTreeMap, BTreeSet};

use brushwork_core::keep;
use brushwork_core::settings::write_options;
use brushwork_link::device::Identity;
use brushwork_link::settings::{
    Copies, Difference, Group, Kind, Known, Plan, Profile, ReadReport, Refusal, Row, RowState, SaveReport,
    SaveVerdict, SettingValue, SettingsImage, SettingsTable, WriteOptions, WriteReport, diff, plan,
};
use brushwork_link::transport::Stream;
use brushwork_link::{Message, UnitAddress};

use super::applicable;
use super::steps::{Steps, Wishes};
use crate::family;
use crate::family::recipe::Looked;

/// The settings of one unit.
#[derive(Debug)]
pub struct UnitSettings {
    table: SettingsTable,
    pub is_simulated: bool,
    pub unit_address: UnitAddress,
    firmware: String,
    copies: Copies,
    /// Wanted values that differ from the controller's.
    edits: SettingsImage,
    /// Those edits that were read from a unit once and not typed: they may be out of range.
    taken: BTreeSet<String>,
    /// What stands in fields and is no value yet, by key.
    typed: BTreeMap<String, Typed>,
    /// What went wrong with a row last, by key.
    troubles: BTreeMap<String, Message>,
    /// Rows written since EEPROM was last known.
    written: BTreeSet<String>,
    /// How far the controller was asked for each setting.
    asked: BTreeMap<String, Asked>,
    /// Whether all settings were asked for since RAM was last in doubt.
    pub(super) was_asked: bool,
    /// Whether all settings were read since the controller was last out of reach.
    is_read: bool,
    /// What the backup of the next of a series of small writes is made from.
    pub(super) known: Known,
    steps: Steps,
    revision: u64,
}

/// How far the controller was asked for a setting; one that it was never asked for has none of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Waiting,
    /// It has told, or cannot.
    Answered,
    /// It has told, and may hold something else by now.
    InDoubt,
}

/// What a calibration must not disturb: edits, and what is known of EEPROM.
#[derive(Clone, Debug)]
pub struct Before {
    edits: SettingsImage,
    taken: BTreeSet<String>,
    written: BTreeSet<String>,
}

#[derive(Debug)]
struct Typed {
    text: String,
    /// Why it is no value; empty while it is being typed.
    refusal: Message,
}

/// Whether the controller would work with the same settings after a power cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Saved {
    /// EEPROM holds the same.
    Yes,
    /// So many settings differ.
    Differs(usize),
    /// EEPROM is not known; so many settings were written since the screen was opened.
    NotKnown { written: usize },
}

impl UnitSettings {
    pub fn new(identity: &Identity) -> Self {
        // Whatever answers and is not known by name has the settings that all of the family have.
        let subject = family::of(identity.family).subject(identity);
        Self {
            table: SettingsTable::new(subject),
            is_simulated: identity.simulated,
            unit_address: identity.unit_address(),
            firmware: identity.version_text.trim_end().to_owned(),
            copies: Copies::default(),
            edits: SettingsImage::default(),
            taken: BTreeSet::new(),
            typed: BTreeMap::new(),
            troubles: BTreeMap::new(),
            written: BTreeSet::new(),
            asked: BTreeMap::new(),
            was_asked: false,
            is_read: false,
            known: Known::default(),
            steps: Steps::default(),
            revision: 0,
        }
    }

    /// Goes up with every change of RAM, as far as it is known, and of edits.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    fn changed(&mut self) {
        self.revision += 1;
    }

    fn wishes(&self) -> Wishes {
        Wishes { edits: self.edits.clone(), taken: self.taken.clone() }
    }

    /// Looks once a frame whether the edits were changed: whatever changed them since the last look is one step.
    pub fn note_step(&mut self) {
        if self.steps.looked_at != self.revision {
            self.steps.note(self.revision, self.wishes());
        }
    }

    pub fn can_undo(&self) -> bool {
        self.steps.can_undo()
    }

    pub fn can_redo(&self) -> bool {
        self.steps.can_redo()
    }

    /// Takes the last step of the edits back, or does the last one that was taken back again.
    pub fn step_back(&mut self, again: bool) {
        self.note_step();
        if let Some(wishes) = self.steps.go(again) {
            (self.edits, self.taken) = (wishes.edits, wishes.taken);
            self.typed.clear();
            self.changed();
            self.steps.looked_at = self.revision;
        }
    }

    pub fn table(&self) -> &SettingsTable {
        &self.table
    }

    pub fn edits(&self) -> &SettingsImage {
        &self.edits
    }

    /// What the controller works with, if all of it was read.
    pub fn ram(&self) -> Option<&SettingsImage> {
        self.copies.ram().filter(|_| self.is_read)
    }

    /// What is known of RAM, if each of these keys was asked for and told at least once.
    pub fn ram_with(&self, keys: &[String]) -> Option<&SettingsImage> {
        let is_reported = |key: &String| self.asked.get(key).is_some_and(|asked| *asked != Asked::Waiting);
        self.copies.ram().filter(|_| keys.iter().all(is_reported))
    }

    /// What its EEPROM holds, if that was proven in this session.
    pub fn eeprom(&self) -> Option<&SettingsImage> {
        self.copies.eeprom()
    }

    /// What the unit says of itself.
    pub fn firmware(&self) -> &str {
        &self.firmware
    }

    /// The same unit at another address.
    pub(super) fn at(self, address: u8) -> Self {
        let unit_address = UnitAddress::new(self.unit_address.family(), address).unwrap_or(self.unit_address);
        Self { unit_address, ..self }
    }

    /// Lets a recipe look at the settings.
    pub fn look<R>(&self, look: impl FnOnce(&Looked<'_>) -> R) -> R {
        let (held, wanted) = (|key: &str| self.on_controller(key), |key: &str| self.wanted(key));
        look(&Looked { table: &self.table, held: &held, wanted: &wanted, is_simulated: self.is_simulated })
    }

    /// Whether the controller's settings were read.
    pub fn is_read(&self) -> bool {
        self.is_read
    }

    pub fn was_asked(&self) -> bool {
        self.was_asked
    }

    /// Which of these keys the controller has to be asked for: those that are not known, and those in doubt.
    pub fn unasked(&self, keys: &[String]) -> Vec<String> {
        let is_unasked = |key: &&String| self.asked.get(*key).is_none_or(|asked| *asked == Asked::InDoubt);
        keys.iter().filter(is_unasked).cloned().collect()
    }

    pub(super) fn note_keys_asked(&mut self, keys: &[String]) {
        self.asked.extend(keys.iter().map(|key| (key.clone(), Asked::Waiting)));
    }

    /// No answer came: whoever wants them asks again.
    pub(super) fn forget_keys_asked(&mut self, keys: &[String]) {
        for key in keys {
            let was_reported = self.on_controller(key).is_some();
            match was_reported {
                true => self.asked.insert(key.clone(), Asked::InDoubt),
                false => self.asked.remove(key),
            };
        }
    }

    /// These are to be read anew by whoever shows them.
    pub fn doubt_keys(&mut self, keys: &[String]) {
        for key in keys {
            self.asked.entry(key.clone()).and_modify(|asked| *asked = Asked::InDoubt);
        }
        self.known.forget();
    }

    /// Something else than a write from here may have changed RAM: what is known of it is read anew.
    pub(super) fn doubt(&mut self) {
        self.asked.values_mut().for_each(|asked| *asked = Asked::InDoubt);
        self.was_asked = false;
        self.known.forget();
        self.changed();
    }

    /// What the controller works with, unless something may have changed it since it was read.
    pub fn confirmed(&self, key: &str) -> Option<SettingValue> {
        self.on_controller(key).filter(|_| self.asked.get(key) == Some(&Asked::Answered))
    }

    /// What the controller works with, as last read.
    pub fn on_controller(&self, key: &str) -> Option<SettingValue> {
        self.copies.ram()?.get(key)
    }

    /// What is wanted: the edit, or else what the controller has.
    pub fn wanted(&self, key: &str) -> Option<SettingValue> {
        self.edits.get(key).or_else(|| self.on_controller(key))
    }

    pub fn is_edited(&self, key: &str) -> bool {
        self.edits.get(key).is_some() || self.typed.contains_key(key)
    }

    /// What a row's field shows: what was typed, or the value without its unit.
    pub fn text(&self, row: &Row) -> String {
        match self.typed.get(&row.key) {
            Some(typed) => typed.text.clone(),
            None => self.wanted(&row.key).map_or_else(String::new, |value| row.format_bare(value)),
        }
    }

    /// Why what was typed is not taken, or what went wrong with the row last.
    pub fn trouble(&self, key: &str) -> Option<&Message> {
        let refusal = self.typed.get(key).map(|typed| &typed.refusal);
        refusal.filter(|why| !why.is_empty()).or_else(|| self.troubles.get(key))
    }

    /// Why the row cannot be changed: not at all, or not as the other settings are.
    pub fn locked(&self, row: &Row) -> Option<&'static str> {
        row.locked(self.is_simulated).or_else(|| applicable::why_not(row, |key| self.wanted(key)))
    }

    /// Whether the controller lets the row be written at all.
    pub fn is_writable(&self, row: &Row) -> bool {
        row.locked(self.is_simulated).is_none()
    }

    /// Wants a value.
    pub fn set(&mut self, key: &str, value: SettingValue) {
        self.changed();
        self.typed.remove(key);
        self.troubles.remove(key);
        self.taken.remove(key);
        if self.on_controller(key) == Some(value) {
            self.edits.remove(key);
        } else {
            self.edits.set(key, value);
        }
    }

    /// Wants a value of a profile, a backup or a journal: it was read from a unit once and may be written as it was.
    pub fn take(&mut self, key: &str, value: SettingValue) {
        self.set(key, value);
        if self.edits.get(key).is_some() {
            self.taken.insert(key.to_owned());
        }
    }

    /// What stands in the row's field while it is being typed.
    pub fn type_in(&mut self, key: &str, text: String) {
        self.changed();
        self.typed.insert(key.to_owned(), Typed { text, refusal: Message::default() });
    }

    /// Takes what was typed as the row's value. What is no value stays in the field, with the reason.
    pub fn finish_typing(&mut self, key: &str) {
        let Some(typed) = self.typed.remove(key) else { return };
        self.changed();
        let Some(row) = self.table.row(key) else { return };
        if typed.text.trim().is_empty() {
            return self.revert(key);
        }
        match row.parse(&typed.text) {
            Ok(value) => self.set(key, value),
            Err(refusal) => {
                self.typed.insert(key.to_owned(), Typed { refusal, ..typed });
            }
        }
    }

    /// The same for every field, as where a sheet takes the place of the list and no field is left any more.
    pub fn finish_all_typing(&mut self) {
        for key in self.typed.keys().cloned().collect::<Vec<_>>() {
            self.finish_typing(&key);
        }
    }

    /// Forgets what was typed and not taken.
    pub fn drop_typing(&mut self, key: &str) {
        self.changed();
        self.typed.remove(key);
    }

    /// Back to what the controller has.
    pub fn revert(&mut self, key: &str) {
        self.changed();
        self.edits.remove(key);
        self.taken.remove(key);
        self.typed.remove(key);
        self.troubles.remove(key);
    }

    pub fn revert_all(&mut self) {
        for key in self.changes().into_iter().map(|change| change.key).collect::<Vec<_>>() {
            self.revert(&key);
        }
        self.edits = SettingsImage::default();
        self.taken.clear();
        self.typed.clear();
    }

    /// Every edit in screen order: what the controller has, and what is wanted.
    pub fn changes(&self) -> Vec<Difference> {
        let change = |row: &Row| {
            let right = Some(self.edits.get(&row.key)?);
            Some(Difference { key: row.key.clone(), left: self.on_controller(&row.key), right })
        };
        self.table.rows().iter().filter_map(change).collect()
    }

    /// What the defaults would change.
    pub fn changes_to_defaults(&self) -> Vec<Difference> {
        let Some(ram) = self.ram() else { return Vec::new() };
        let known = |difference: &Difference| difference.left.is_some();
        diff(&self.table, ram, &self.table.default_image()).into_iter().filter(known).collect()
    }

    /// Whether a field holds what is no value, or not yet.
    pub fn has_typed(&self) -> bool {
        !self.typed.is_empty()
    }

    /// What was typed and refused, a sentence each.
    pub fn refused(&self) -> Vec<&Message> {
        self.typed.values().map(|typed| &typed.refusal).filter(|why| !why.is_empty()).collect()
    }

    /// The commands that the edits need, or why they cannot be written.
    pub fn plan(&self, own_stream: Option<Stream>) -> Result<Plan, Vec<Refusal>> {
        plan(&self.table, &self.held_image(), &self.edits, self.options(&self.edits, own_stream))
    }

    fn held_image(&self) -> SettingsImage {
        self.copies.ram().cloned().unwrap_or_default()
    }

    /// How values are written: those that were taken over from a profile, a backup or a journal as they are.
    pub(super) fn options(&self, wanted: &SettingsImage, own_stream: Option<Stream>) -> WriteOptions {
        let options = WriteOptions { own_stream, simulated: self.is_simulated, as_read: false };
        let is_taken = |key: &str, value| self.taken.contains(key) && self.edits.get(key) == Some(value);
        // What cannot be written is refused by the plan, which tells every reason.
        write_options(&self.table, &self.held_image(), wanted, is_taken, options).unwrap_or(options)
    }

    pub fn saved(&self) -> Saved {
        if self.ram().is_none() || self.copies.eeprom().is_none() {
            return Saved::NotKnown { written: self.written.len() };
        }
        match self.unsaved().len() {
            0 => Saved::Yes,
            count => Saved::Differs(count),
        }
    }

    /// What a power cycle would change, as far as both copies are known: in EEPROM, then in RAM.
    pub fn unsaved(&self) -> Vec<Difference> {
        let (Some(eeprom), Some(ram)) = (self.copies.eeprom(), self.ram()) else { return Vec::new() };
        let known = |difference: &Difference| difference.left.is_some() && difference.right.is_some();
        diff(&self.table, eeprom, ram).into_iter().filter(known).collect()
    }

    /// The edits and what was written, as they are.
    pub fn keep(&self) -> Before {
        Before { edits: self.edits.clone(), taken: self.taken.clone(), written: self.written.clone() }
    }

    /// Edits and what was written as they were.
    pub fn put_back(&mut self, kept: Before) {
        self.changed();
        self.edits = kept.edits;
        self.taken = kept.taken;
        self.written = kept.written;
        self.drop_fulfilled();
    }

    /// The link is gone. What was read may no longer be true; the edits stay.
    pub(super) fn forget(&mut self) {
        self.copies.forget_ram();
        self.copies.forget_eeprom();
        self.written.clear();
        self.troubles.clear();
        self.asked.clear();
        self.known.forget();
        (self.was_asked, self.is_read) = (false, false);
        self.changed();
    }

    /// All settings were read.
    pub(super) fn note_read(&mut self, report: ReadReport, from_eeprom: bool) {
        let each = |failure: &brushwork_link::settings::ReadFailure| {
            let why = failure.failure.message();
            failure.keys.iter().map(move |key| (key.clone(), why.clone())).collect::<Vec<_>>()
        };
        self.troubles = report.failures.iter().flat_map(each).collect();
        self.table = report.table;
        if from_eeprom {
            self.copies.note_reloaded(report.image);
            self.written.clear();
        } else {
            self.copies.note_ram(report.image);
        }
        self.asked = self.table.rows().iter().map(|row| (row.key.clone(), Asked::Answered)).collect();
        (self.was_asked, self.is_read) = (true, true);
        self.known.forget();
        self.drop_fulfilled();
    }

    /// Some settings were read.
    pub(super) fn note_keys(&mut self, keys: &[String], image: &SettingsImage) {
        let mut ram = self.held_image();
        for key in keys {
            match image.get(key) {
                Some(value) => ram.set(key, value),
                None => ram.remove(key),
            }
            self.asked.insert(key.clone(), Asked::Answered);
        }
        self.copies.note_ram(ram);
        self.drop_fulfilled();
    }

    /// Values were written. `replaced` are the edits of them that there were when that was asked for.
    pub(super) fn note_written(&mut self, report: &WriteReport, replaced: &SettingsImage, known: Known) {
        let mut ram = self.held_image();
        report.merge_into(&mut ram);
        self.copies.note_ram(ram);
        self.known = known;
        let sentences = report.sentences(&self.table);
        for (row, sentence) in report.did_not_take().zip(sentences) {
            self.troubles.insert(row.key.clone(), sentence);
        }
        for row in &report.rows {
            if row.state == RowState::Taken && self.edits.get(&row.key) == replaced.get(&row.key) {
                self.edits.remove(&row.key);
                self.taken.remove(&row.key);
            }
            if row.found.is_some() {
                self.asked.insert(row.key.clone(), Asked::Answered);
                self.written.insert(row.key.clone());
            }
        }
        self.drop_fulfilled();
    }

    pub(super) fn note_saved(&mut self, report: &SaveReport) {
        match &report.eeprom {
            Some(eeprom) => self.copies.note_eeprom(eeprom.clone()),
            None => self.copies.forget_eeprom(),
        }
        match report.verdict {
            SaveVerdict::Verified | SaveVerdict::Stored => {
                if let Some(eeprom) = &report.eeprom {
                    self.copies.note_ram(eeprom.clone());
                }
                self.written.clear();
            }
            SaveVerdict::Acknowledged => self.written.clear(),
            // Loading what EEPROM held may have changed RAM: it is read again.
            SaveVerdict::NotSaved | SaveVerdict::Unknown => self.doubt(),
        }
        self.drop_fulfilled();
    }

    /// An edit that the controller has come to hold is none any more. What the controller does is no step of a person's, and nothing
    /// before it is gone back to.
    fn drop_fulfilled(&mut self) {
        let before = self.edits.len();
        self.drop_held();
        if self.edits.len() != before || self.steps.differs(&self.wishes()) {
            self.steps = Steps::new(self.revision, self.wishes());
        }
    }

    fn drop_held(&mut self) {
        self.changed();
        let fulfilled: Vec<String> = self
            .edits
            .iter()
            .filter(|(key, value)| self.on_controller(key) == Some(*value) || self.table.row(key).is_none())
            .map(|(key, _)| key.to_owned())
            .collect();
        for key in fulfilled {
            self.edits.remove(&key);
            self.taken.remove(&key);
        }
    }
    /// What a file can keep of the controller: what it has, or what is wanted of it.
    pub fn profile(&self, with_edits: bool) -> Option<Profile> {
        let mut settings = self.ram()?.clone();
        if with_edits {
            settings.merge(self.edits());
        }
        Some(self.profile_of(settings))
    }

    /// Wants a number, moved into the row's range.
    pub fn set_number(&mut self, key: &str, number: f64) {
        let Some(row) = self.table().row(key) else { return };
        let number = number.clamp(row.range.min, row.range.max);
        let value = match row.kind {
            Kind::Int => SettingValue::Int(number.round() as i64),
            Kind::Bool | Kind::Fixed { .. } | Kind::Choice(_) => row.settle(SettingValue::Number(number)),
        };
        self.set(key, value);
    }

    /// What a port, pin or output is wanted to do, in a few words.
    pub fn function(&self, group: Group, number: usize) -> Option<String> {
        let family = family::of(self.table().subject().family());
        family.function(self.table(), &|key| self.wanted(key), (group, number))
    }

    pub fn set_all(&mut self, values: &SettingsImage) {
        for (key, value) in values.iter() {
            self.set(key, value);
        }
    }

    /// Values as a profile of this controller.
    pub(super) fn profile_of(&self, settings: SettingsImage) -> Profile {
        keep::profile_of(*self.table.subject(), self.unit_address, &self.firmware, "", settings)
    }
}

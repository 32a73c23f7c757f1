//! The settings of one unit: what it holds as far as known, what the user wants instead, and what was typed.

use brushwork_link::UnitAddress;
use brushwork_mcp_client::{layout_of, subject};
use std::collections::{BTreeMap, BTreeSet};

use brushwork_link::device::Identity;
use brushwork_link::settings::{
    Copies, Difference, Plan, ReadReport, Refusal, Row, SaveReport, SaveVerdict, SettingValue, SettingsImage,
    SettingsTable, WriteOptions, WriteReport, diff, plan,
};
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::models;

use super::applicable;

/// The settings of one unit.
#[derive(Debug)]
pub struct UnitSettings {
    table: SettingsTable,
    is_simulated: bool,
    address: u8,
    unit_address: UnitAddress,
    firmware: String,
    copies: Copies,
    /// Wanted values that differ from the controller's.
    edits: SettingsImage,
    /// Those edits that were read from a unit once and not typed: they may be out of range.
    taken: BTreeSet<String>,
    /// What stands in fields and is no value yet, by key.
    typed: BTreeMap<String, Typed>,
    /// What went wrong with a row last, by key.
    troubles: BTreeMap<String, String>,
    /// Rows written since EEPROM was last known.
    written: BTreeSet<String>,
    was_asked: bool,
}

/// What a calibration must not disturb: edits, and what is known of EEPROM.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    edits: SettingsImage,
    taken: BTreeSet<String>,
    written: BTreeSet<String>,
}

#[derive(Debug)]
struct Typed {
    text: String,
    /// Why it is no value; empty while it is being typed.
    refusal: String,
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
        let subject = identity
            .subject()
            .unwrap_or_else(|| subject(&models::UNLISTED[0], layout_of(identity.generation)));
        Self {
            table: SettingsTable::new(subject),
            is_simulated: identity.simulated,
            address: identity.address,
            unit_address: identity.unit_address(),
            firmware: identity.version_text.trim_end().to_owned(),
            copies: Copies::default(),
            edits: SettingsImage::default(),
            taken: BTreeSet::new(),
            typed: BTreeMap::new(),
            troubles: BTreeMap::new(),
            written: BTreeSet::new(),
            was_asked: false,
        }
    }

    pub fn table(&self) -> &SettingsTable {
        &self.table
    }

    pub fn edits(&self) -> &SettingsImage {
        &self.edits
    }

    /// What the controller works with, if it was read.
    pub fn ram(&self) -> Option<&SettingsImage> {
        self.copies.ram()
    }

    /// What its EEPROM holds, if that was proven in this session.
    pub fn eeprom(&self) -> Option<&SettingsImage> {
        self.copies.eeprom()
    }

    pub fn is_simulated(&self) -> bool {
        self.is_simulated
    }

    pub fn address(&self) -> u8 {
        self.address
    }

    /// Its address as profiles carry it.
    pub fn unit_address(&self) -> UnitAddress {
        self.unit_address
    }

    /// What the unit says of itself.
    pub fn firmware(&self) -> &str {
        &self.firmware
    }

    /// The same unit at another address.
    pub(super) fn at(self, address: u8) -> Self {
        let unit_address = UnitAddress::new(self.unit_address.family(), address).unwrap_or(self.unit_address);
        Self { address, unit_address, ..self }
    }

    /// Whether the controller's settings were read.
    pub fn is_read(&self) -> bool {
        self.copies.ram().is_some()
    }

    pub fn was_asked(&self) -> bool {
        self.was_asked
    }

    pub fn note_asked(&mut self) {
        self.was_asked = true;
    }

    /// What was asked for gave way to something more urgent.
    pub(super) fn forget_asked(&mut self) {
        self.was_asked = false;
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
    pub fn trouble(&self, key: &str) -> Option<&str> {
        let refusal = self.typed.get(key).map(|typed| typed.refusal.as_str());
        refusal.filter(|text| !text.is_empty()).or_else(|| self.troubles.get(key).map(String::as_str))
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
        self.typed.insert(key.to_owned(), Typed { text, refusal: String::new() });
    }

    /// Takes what was typed as the row's value. What is no value stays in the field, with the reason.
    pub fn finish_typing(&mut self, key: &str) {
        let Some(typed) = self.typed.remove(key) else { return };
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

    /// Forgets what was typed and not taken.
    pub fn drop_typing(&mut self, key: &str) {
        self.typed.remove(key);
    }

    /// Back to what the controller has.
    pub fn revert(&mut self, key: &str) {
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
        let Some(ram) = self.copies.ram() else { return Vec::new() };
        let known = |difference: &Difference| difference.left.is_some();
        diff(&self.table, ram, &self.table.default_image()).into_iter().filter(known).collect()
    }

    /// Whether a field holds what is no value, or not yet.
    pub fn has_typed(&self) -> bool {
        !self.typed.is_empty()
    }

    /// What was typed and refused, a sentence each.
    pub fn refused(&self) -> Vec<&str> {
        self.typed.values().map(|typed| typed.refusal.as_str()).filter(|text| !text.is_empty()).collect()
    }

    /// The commands that the edits need, or why they cannot be written.
    pub fn plan(&self, own_stream: Option<Stream>) -> Result<Plan, Vec<Refusal>> {
        let nothing = SettingsImage::default();
        let ram = self.copies.ram().unwrap_or(&nothing);
        plan(&self.table, ram, &self.edits, self.options(own_stream))
    }

    /// How the edits are written. Those that were typed have to be right for those that were taken over to be written as they are.
    pub fn options(&self, own_stream: Option<Stream>) -> WriteOptions {
        let options = WriteOptions { own_stream, simulated: self.is_simulated, as_read: false };
        if self.taken.is_empty() {
            return options;
        }
        let (mut beside, mut typed) =
            (self.copies.ram().cloned().unwrap_or_default(), SettingsImage::default());
        for (key, value) in self.edits.iter() {
            if self.taken.contains(key) { &mut beside } else { &mut typed }.set(key, value);
        }
        WriteOptions { as_read: plan(&self.table, &beside, &typed, options).is_ok(), ..options }
    }

    pub fn saved(&self) -> Saved {
        if self.copies.ram().is_none() || self.copies.eeprom().is_none() {
            return Saved::NotKnown { written: self.written.len() };
        }
        match self.unsaved().len() {
            0 => Saved::Yes,
            count => Saved::Differs(count),
        }
    }

    /// What a power cycle would change, as far as both copies are known: in EEPROM, then in RAM.
    pub fn unsaved(&self) -> Vec<Difference> {
        let (Some(eeprom), Some(ram)) = (self.copies.eeprom(), self.copies.ram()) else { return Vec::new() };
        let known = |difference: &Difference| difference.left.is_some() && difference.right.is_some();
        diff(&self.table, eeprom, ram).into_iter().filter(known).collect()
    }

    /// The edits and what was written, as they are.
    pub(super) fn keep(&self) -> Kept {
        Kept { edits: self.edits.clone(), taken: self.taken.clone(), written: self.written.clone() }
    }

    /// Edits and what was written as they were.
    pub(super) fn put_back(&mut self, kept: Kept) {
        self.edits = kept.edits;
        self.taken = kept.taken;
        self.written = kept.written;
        self.drop_fulfilled();
    }

    /// The link is gone. What was read may no longer be true; the edits stay.
    pub(super) fn forget_ram(&mut self) {
        self.copies.forget_ram();
        self.was_asked = false;
    }

    pub(super) fn forget(&mut self) {
        self.copies.forget_ram();
        self.copies.forget_eeprom();
        self.written.clear();
        self.troubles.clear();
        self.was_asked = false;
    }

    pub(super) fn note_read(&mut self, report: ReadReport, from_eeprom: bool) {
        let each = |failure: &brushwork_link::settings::ReadFailure| {
            let why = failure.failure.to_string();
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
        self.drop_fulfilled();
    }

    pub(super) fn note_written(&mut self, report: &WriteReport) {
        let mut ram = self.copies.ram().cloned().unwrap_or_default();
        report.merge_into(&mut ram);
        self.copies.note_ram(ram);
        let sentences = report.sentences(&self.table);
        for (row, sentence) in report.did_not_take().zip(sentences) {
            self.troubles.insert(row.key.clone(), sentence);
        }
        self.written.extend(report.rows.iter().filter(|row| row.found.is_some()).map(|row| row.key.clone()));
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
            SaveVerdict::NotSaved | SaveVerdict::Unknown => self.was_asked = false,
        }
        self.drop_fulfilled();
    }

    /// An edit that the controller has come to hold is none any more.
    fn drop_fulfilled(&mut self) {
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
}

//! What the settings engine asks of a family: which rows a unit has, and how they are carried, ordered, kept and judged together.

use super::image::SettingsImage;
use super::profile::Profile;
use super::read::ReadReport;
use super::row::Row;
use super::save_report::SaveReport;
use super::step::{Refusal, Stage, Step, WriteOptions};
use super::subject::Subject;
use super::table::SettingsTable;
use super::value::SettingValue;
use crate::exchange::ExchangeError;
use crate::failure::Failure;
use crate::unit::{FirmwareGeneration, UnitAddress};
use crate::wire::Wire;
use brushwork_values::{Message, Values};

/// The settings of a family. What has a default here need not be thought of where it does not apply.
pub trait FamilySettings: Send + Sync {
    /// The rows of one controller, in screen order.
    fn rows(&self, subject: &Subject) -> Vec<Row>;

    /// What a value means beyond its own words, such as the pin that a number stands for.
    fn note(&self, _table: &SettingsTable, _row: &Row, _value: SettingValue) -> Option<Message> {
        None
    }

    /// The commands whose records tell how many inputs, streams and outputs a unit has, where it tells.
    fn lists(&self, _subject: &Subject) -> Option<Lists> {
        None
    }

    /// Asks the unit for something that every unit of the family tells, to see whether it answers.
    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError>;

    /// What a command reads, for progress: "read M1 velocity PID".
    fn read_title(&self, command: u8) -> &'static str;

    /// The same for sentences, with the command's number where people know it by that.
    fn read_phrase(&self, command: u8) -> String {
        format!("{} ({command})", self.read_title(command))
    }

    /// What an entry of a capability map stands for: by default the command of that number.
    fn learned_title(&self, number: u8) -> &'static str {
        self.read_title(number)
    }

    /// The same for sentences.
    fn learned_phrase(&self, number: u8) -> String {
        format!("{} ({number})", self.learned_title(number))
    }

    /// Under which number a capability map has what brings a field of a command's reply, where it may lack in a reply to others.
    fn learned_number(&self, _command: u8, _field: &str) -> Option<u8> {
        None
    }

    /// What the command that writes these rows takes, in wire order.
    fn arguments(&self, planned: &Planned<'_>) -> Result<Vec<Argument>, Message>;

    /// When it is sent.
    fn stage(&self, planned: &Planned<'_>) -> Stage;

    /// Puts steps of one stage in the order in which nothing is dangerous in between.
    fn order(&self, _steps: &mut [Step], _ram: &SettingsImage) {}

    /// What the user should know of the steps besides their values.
    fn warnings(&self, context: &PlanContext<'_>, steps: &[Step]) -> Vec<Message>;

    /// Pairs of settings of which the first must not be above the second.
    fn ordered_pairs(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Changes that can set a motor in motion or do damage, a sentence each.
    fn dangers(
        &self,
        _table: &SettingsTable,
        _after: &SettingsImage,
        _changes: &SettingsImage,
    ) -> Vec<Message> {
        Vec::new()
    }

    /// Contradictions that the changes take part in, a sentence each.
    fn conflicts(
        &self,
        _table: &SettingsTable,
        _after: &SettingsImage,
        _changes: &SettingsImage,
    ) -> Vec<Message> {
        Vec::new()
    }

    /// The bytes of a step.
    fn step_bytes(
        &self,
        step: &Step,
        address: UnitAddress,
        generation: FirmwareGeneration,
    ) -> Result<Vec<u8>, Message>;

    /// A step in words.
    fn step_words(&self, step: &Step, address: UnitAddress, generation: FirmwareGeneration) -> String;

    /// What a step does, for sentences.
    fn step_title(&self, step: &Step) -> String;

    /// The settings by which a unit has its address: no two units of a line can be given the same.
    fn address_keys(&self) -> &'static [&'static str] {
        &[]
    }

    /// The address that a step gives to the unit.
    fn new_address(&self, step: &Step) -> Option<u8>;

    /// Saves RAM to EEPROM and says what is known of that. An error means that nothing was saved.
    fn save(
        &self,
        wire: &mut dyn Wire,
        before: &ReadReport,
        options: WriteOptions,
    ) -> Result<SaveReport, Failure>;

    /// Loads EEPROM into RAM.
    fn reload(&self, wire: &mut dyn Wire) -> Result<(), Failure>;

    /// Restores the factory settings and follows the unit to where it answers then.
    fn restore(&self, wire: &mut dyn Wire) -> Result<(), Failure>;

    /// Whether restoring the factory settings changes EEPROM at once.
    fn restores_eeprom(&self) -> bool {
        false
    }

    /// The key over there of a row of a profile; `None` where its thing does not exist there.
    fn key_there(&self, _fit: &Fit<'_>, row: &Row) -> Option<String> {
        Some(row.key.clone())
    }

    /// The value in the words of the other controller; `None` when it means nothing there.
    fn value_there(&self, _fit: &Fit<'_>, _row: &Row, value: SettingValue) -> Option<SettingValue> {
        Some(value)
    }

    /// Why a row over there cannot have the value, as a sentence, and what it gets instead.
    fn impossible_there(
        &self,
        _fit: &Fit<'_>,
        _there: &Row,
        _value: SettingValue,
    ) -> Option<(SettingValue, Message)> {
        None
    }

    /// Settings over there that follow from others of the profile, since the two controllers divide things otherwise.
    fn conversions(&self, _fit: &Fit<'_>) -> Vec<Conversion> {
        Vec::new()
    }

    /// What changes in the motion where a setting of a profile has no place over there, as a sentence; `None` for one that moves, stops and
    /// limits nothing by itself.
    fn without(&self, _row: &Row) -> Option<Message> {
        None
    }
}

/// A setting over there that takes its value from another one of the profile.
#[derive(Clone, Debug)]
pub struct Conversion {
    /// The key in the profile.
    pub from: &'static str,
    /// The key over there.
    pub to: &'static str,
    /// What the user should know of it; empty where nothing changes.
    pub told: Message,
    /// A further key of the profile that the setting stands for.
    pub absorbed: Option<&'static str>,
}

/// The commands whose replies have a record for each thing.
#[derive(Clone, Copy, Debug)]
pub struct Lists {
    /// For each configurable input.
    pub pins: u8,
    /// For each serial stream.
    pub streams: u8,
    /// For each digital output.
    pub douts: u8,
}

/// What a plan is made of.
#[derive(Clone, Copy, Debug)]
pub struct PlanContext<'p> {
    /// The unit's rows.
    pub table: &'p SettingsTable,
    /// What it works with now.
    pub ram: &'p SettingsImage,
    /// What is to change.
    pub changes: &'p SettingsImage,
    /// How it is to be written.
    pub options: WriteOptions,
}

/// One command of a plan in the making, and the changed rows that it carries.
#[derive(Clone, Copy, Debug)]
pub struct Planned<'p> {
    /// The plan.
    pub context: &'p PlanContext<'p>,
    /// The command's number.
    pub command: u8,
    /// The thing of several that it is for.
    pub index: Option<u8>,
    /// The changed rows.
    pub changed: &'p [&'p Row],
}

/// One value of a command that writes settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Known already.
    Given(&'static str, i64),
    /// The rows that this field carries, changed or as they are.
    Field(&'static str),
}

/// A profile, and the table of the controller that it is fitted to.
#[derive(Clone, Copy, Debug)]
pub struct Fit<'f> {
    /// The profile.
    pub profile: &'f Profile,
    /// The rows of its own controller.
    pub from: &'f SettingsTable,
    /// The other controller.
    pub to: &'f SettingsTable,
}

impl Fit<'_> {
    /// The controller of the profile, and the other one.
    #[must_use]
    pub fn subjects(&self) -> (&Subject, &Subject) {
        (&self.profile.subject, self.to.subject())
    }
}

/// Why rows cannot be written.
pub(super) fn refuse(changed: &[&Row], sentence: impl Into<Message>) -> Refusal {
    let key = changed.first().map_or_else(String::new, |row| row.key.clone());
    Refusal { key, sentence: sentence.into() }
}

//! The values of a controller's settings at one moment, the copies of them that exist, and their differences.

use std::collections::BTreeMap;

use serde::Serialize;

use super::row::Row;
use super::table::SettingsTable;
use super::value::SettingValue;

/// Values by key. A key that is missing has not been read, or does not exist there.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct SettingsImage {
    values: BTreeMap<String, SettingValue>,
}

impl SettingsImage {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<SettingValue> {
        self.values.get(key).copied()
    }

    /// Sets the value of a key.
    pub fn set(&mut self, key: &str, value: SettingValue) {
        self.values.insert(key.to_owned(), value);
    }

    /// Forgets a key.
    pub fn remove(&mut self, key: &str) {
        self.values.remove(key);
    }

    /// Takes over every value of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.values.extend(other.values.iter().map(|(key, value)| (key.clone(), *value)));
    }

    /// Keys and values, by key.
    pub fn iter(&self) -> impl Iterator<Item = (&str, SettingValue)> {
        self.values.iter().map(|(key, value)| (key.as_str(), *value))
    }

    /// The number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

impl FromIterator<(String, SettingValue)> for SettingsImage {
    fn from_iter<I: IntoIterator<Item = (String, SettingValue)>>(pairs: I) -> Self {
        Self { values: pairs.into_iter().collect() }
    }
}

/// One setting that two images do not agree on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The row's key.
    pub key: String,
    /// The value in the first image, if it has one.
    pub left: Option<SettingValue>,
    /// The value in the second image, if it has one.
    pub right: Option<SettingValue>,
}

impl Difference {
    /// "Main battery maximum: 34.0 V -> 24.0 V", with "-" for a value that is not there.
    pub fn describe(&self, row: &Row) -> String {
        let text =
            |value: Option<SettingValue>| value.map_or_else(|| "-".to_owned(), |value| row.format(value));
        format!("{}: {} -> {}", row.title(), text(self.left), text(self.right))
    }
}

/// Every setting of the table that differs, in screen order. Keys the table does not have are left out; so
/// are keys that neither image has.
pub fn diff(table: &SettingsTable, left: &SettingsImage, right: &SettingsImage) -> Vec<Difference> {
    let difference = |row: &Row| {
        let (left, right) = (left.get(&row.key), right.get(&row.key));
        (left != right).then(|| Difference { key: row.key.clone(), left, right })
    };
    table.rows().iter().filter_map(difference).collect()
}

/// The changes that turn `from` into `to`: what `to` has and `from` has not, or has otherwise.
pub fn changes(table: &SettingsTable, from: &SettingsImage, to: &SettingsImage) -> SettingsImage {
    let wanted = diff(table, from, to).into_iter();
    wanted.filter_map(|difference| difference.right.map(|value| (difference.key, value))).collect()
}

/// One of the copies of a controller's settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Copy {
    /// What the controller works with now, as last read.
    Ram,
    /// What the controller will work with after a power cycle, as last known.
    Eeprom,
    /// What the open profile holds.
    Profile,
    /// What "restore defaults" would give.
    Default,
}

impl Copy {
    /// Every copy.
    pub const ALL: [Self; 4] = [Self::Ram, Self::Eeprom, Self::Profile, Self::Default];

    /// The copy's name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Ram => "controller (RAM)",
            Self::Eeprom => "controller (EEPROM as last known)",
            Self::Profile => "profile",
            Self::Default => "defaults",
        }
    }
}

/// The copies of one controller's settings, told apart. What is not known stays `None`; nothing is guessed:
/// EEPROM is known only after a reload or a save that were confirmed.
#[derive(Clone, Debug, Default)]
pub struct Copies {
    ram: Option<SettingsImage>,
    eeprom: Option<SettingsImage>,
    profile: Option<SettingsImage>,
}

impl Copies {
    /// A copy, if known. The defaults come from the table.
    pub fn get(&self, copy: Copy, table: &SettingsTable) -> Option<SettingsImage> {
        match copy {
            Copy::Ram => self.ram.clone(),
            Copy::Eeprom => self.eeprom.clone(),
            Copy::Profile => self.profile.clone(),
            Copy::Default => Some(table.default_image()),
        }
    }

    /// The controller's RAM as last read, if it was.
    pub fn ram(&self) -> Option<&SettingsImage> {
        self.ram.as_ref()
    }

    /// The controller's EEPROM as last known, if it is.
    pub fn eeprom(&self) -> Option<&SettingsImage> {
        self.eeprom.as_ref()
    }

    /// The controller's EEPROM was read in a way that leaves open what RAM holds.
    pub fn note_eeprom(&mut self, image: SettingsImage) {
        self.eeprom = Some(image);
    }

    /// The controller may work with anything: it was out of reach.
    pub fn forget_ram(&mut self) {
        self.ram = None;
    }

    /// The controller's RAM was read.
    pub fn note_ram(&mut self, image: SettingsImage) {
        self.ram = Some(image);
    }

    /// The controller's RAM was loaded from its EEPROM and then read: both are known.
    pub fn note_reloaded(&mut self, image: SettingsImage) {
        self.eeprom = Some(image.clone());
        self.ram = Some(image);
    }

    /// The controller's EEPROM may hold anything: a save was not confirmed, or another unit is connected.
    pub fn forget_eeprom(&mut self) {
        self.eeprom = None;
    }

    /// A profile was opened (`None`: closed).
    pub fn note_profile(&mut self, image: Option<SettingsImage>) {
        self.profile = image;
    }

    /// What differs between two copies; `None` when one of them is not known.
    pub fn diff(&self, table: &SettingsTable, left: Copy, right: Copy) -> Option<Vec<Difference>> {
        Some(diff(table, &self.get(left, table)?, &self.get(right, table)?))
    }
}

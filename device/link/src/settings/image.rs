//! The values of a controller's settings at one moment.

use std::collections::BTreeMap;

use serde::Serialize;

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

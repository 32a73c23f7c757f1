//! The value of one setting, in the unit of its row.

use serde::Serialize;

/// The value of one setting, in the unit of its row.
///
/// Numbers that came from a controller are exact images of the wire number, so two readings of the same
/// setting compare equal. In JSON a choice stands by its key.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SettingValue {
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number with a fixed step.
    Number(f64),
    /// The key of a named value.
    Choice(&'static str),
    /// A number that is neither yes nor no, or has no name in the row's list: kept and shown, and written only where it was
    /// read from a unit.
    UnknownCode(i64),
}

impl SettingValue {
    /// The whole number, where it is one.
    pub fn int(self) -> Option<i64> {
        if let Self::Int(number) = self { Some(number) } else { None }
    }

    /// The number with decimals, where it is one.
    pub fn number(self) -> Option<f64> {
        if let Self::Number(number) = self { Some(number) } else { None }
    }

    /// The key of the choice, where it is one.
    pub fn choice(self) -> Option<&'static str> {
        if let Self::Choice(key) = self { Some(key) } else { None }
    }
}

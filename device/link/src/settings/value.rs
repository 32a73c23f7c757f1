//! The value of one setting, in the unit of its row.

use serde::{Serialize, Serializer};

/// The value of one setting, in the unit of its row.
///
/// Numbers that came from a controller are exact images of the wire number, so two readings of the same
/// setting compare equal. In JSON a choice stands by its key.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum SettingValue {
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number with a fixed step.
    Number(f64),
    /// A number whose register may hold it with either sign, with what stood there.
    Signed(Signed),
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
        match self {
            Self::Number(number) | Self::Signed(Signed { number, .. }) => Some(number),
            Self::Bool(_) | Self::Int(_) | Self::Choice(_) | Self::UnknownCode(_) => None,
        }
    }

    /// The key of the choice, where it is one.
    pub fn choice(self) -> Option<&'static str> {
        if let Self::Choice(key) = self { Some(key) } else { None }
    }
}

/// A number that means the same with either sign in its register, so that a unit's own is not lost. One that was typed has none.
#[derive(Clone, Copy, Debug)]
pub struct Signed {
    /// What it means.
    pub number: f64,
    /// What stood in the register.
    pub raw: i64,
}

impl Serialize for Signed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.number)
    }
}

/// A number that was typed agrees with either sign of its register; two registers agree when they hold the same.
impl PartialEq for SettingValue {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Bool(left), Self::Bool(right)) => left == right,
            (Self::Int(left), Self::Int(right)) | (Self::UnknownCode(left), Self::UnknownCode(right)) => {
                left == right
            }
            (Self::Choice(left), Self::Choice(right)) => left == right,
            (Self::Signed(left), Self::Signed(right)) => left.raw == right.raw,
            (Self::Number(left), Self::Number(right))
            | (Self::Signed(Signed { number: left, .. }), Self::Number(right))
            | (Self::Number(left), Self::Signed(Signed { number: right, .. })) => left == right,
            (
                Self::Bool(_)
                | Self::Int(_)
                | Self::Number(_)
                | Self::Signed(_)
                | Self::Choice(_)
                | Self::UnknownCode(_),
                _,
            ) => false,
        }
    }
}

//! What kind of value a setting holds and how units may be written.
//!
//! The only place where the number on the wire becomes a physical value and back: [`Coding`].

use brushwork_values::Code;
use brushwork_values::Unit;

use super::value::{SettingValue, Signed};

/// What a setting's value looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Yes or no.
    Bool,
    /// A whole number of the row's unit.
    Int,
    /// A number of the row's unit with a fixed step, shown with at least `decimals` decimals.
    Fixed {
        /// Decimals shown at least.
        decimals: usize,
    },
    /// One of a list of named values. Other numbers are kept as they are read; nobody may choose them but where the row has a range
    /// of them.
    Choice(&'static [Code]),
}

impl Kind {
    /// The kind's name in reference pages and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "yes or no",
            Self::Int => "whole number",
            Self::Fixed { .. } => "number",
            Self::Choice(_) => "choice",
        }
    }
}

/// How the logical value of a setting stands in its wire field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coding {
    /// The wire holds the number itself.
    Plain,
    /// The wire holds the value times this many steps per unit.
    PerUnit(f64),
    /// As [`Coding::PerUnit`] for a value that is never positive. Controllers report it with either sign, so
    /// the sign is ignored when reading.
    NegativePerUnit {
        /// Steps per unit.
        steps: f64,
        /// Whether the wire takes the magnitude; if not, the negative number itself.
        magnitude: bool,
    },
}

impl Coding {
    /// The physical value of a wire number. Exact for every number of up to 32 bits: the nearest double of
    /// the quotient, which [`Coding::to_raw`] turns back into the same number.
    pub fn to_physical(self, raw: i64) -> f64 {
        let physical = match self {
            Self::Plain => raw as f64,
            Self::PerUnit(steps) => raw as f64 / steps,
            Self::NegativePerUnit { steps, .. } => -(raw.unsigned_abs() as f64 / steps),
        };
        // No negative zero: it would be printed with its sign.
        if physical == 0.0 { 0.0 } else { physical }
    }

    /// The wire number nearest to a physical value. Values outside the range of `i64` stop at its ends.
    pub fn to_raw(self, physical: f64) -> i64 {
        let steps = match self {
            Self::Plain => 1.0,
            Self::PerUnit(steps) | Self::NegativePerUnit { steps, magnitude: false } => steps,
            Self::NegativePerUnit { steps, magnitude: true } => -steps,
        };
        (physical * steps).round() as i64
    }

    /// The logical value of a wire number of a setting of `kind`.
    pub fn decode(self, kind: Kind, raw: i64) -> SettingValue {
        match kind {
            Kind::Bool => match raw {
                0 => SettingValue::Bool(false),
                1 => SettingValue::Bool(true),
                _ => SettingValue::UnknownCode(raw),
            },
            Kind::Int => SettingValue::Int(raw),
            Kind::Fixed { .. } => SettingValue::Number(self.to_physical(raw)),
            Kind::Choice(codes) => match codes.iter().find(|code| code.raw == raw) {
                Some(code) => SettingValue::Choice(code.key),
                None => SettingValue::UnknownCode(raw),
            },
        }
    }

    /// What stands in a register, no bit of it lost: where either sign means the same, with its own.
    pub fn decode_register(self, kind: Kind, raw: i64) -> SettingValue {
        match (self, self.decode(kind, raw)) {
            (Self::NegativePerUnit { .. }, SettingValue::Number(number)) => {
                SettingValue::Signed(Signed { number, raw })
            }
            (_, value) => value,
        }
    }

    /// The wire number of a logical value, in the sign that is usual there; `None` when the value is of another kind or names no code
    /// of the list.
    pub fn encode(self, kind: Kind, value: SettingValue) -> Option<i64> {
        match (kind, value) {
            (Kind::Bool, SettingValue::Bool(on)) => Some(i64::from(on)),
            (Kind::Int, SettingValue::Int(number)) => Some(number),
            (
                Kind::Fixed { .. },
                SettingValue::Number(number) | SettingValue::Signed(Signed { number, .. }),
            ) if number.is_finite() => Some(self.to_raw(number)),
            (Kind::Choice(codes), SettingValue::Choice(key)) => {
                codes.iter().find(|code| code.key == key).map(|code| code.raw)
            }
            (Kind::Bool | Kind::Choice(_), SettingValue::UnknownCode(raw)) => Some(raw),
            _ => None,
        }
    }
}

/// Ways to write a unit and the factor from each to the unit itself; the unit's own symbol always counts too.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub(super) fn unit_forms(unit: Unit) -> &'static [(&'static str, f64)] {
    match unit {
        Unit::Volts => &[("volts", 1.0), ("volt", 1.0), ("mV", 1e-3)],
        Unit::Amps => &[("amps", 1.0), ("amp", 1.0), ("mA", 1e-3)],
        Unit::Seconds => &[("ms", 1e-3)],
        Unit::Milliseconds => &[("s", 1e3)],
        Unit::Counts => &[("count", 1.0)],
        Unit::CountsPerSecond => &[("qpps", 1.0), ("cps", 1.0)],
        Unit::Percent => &[("percent", 1.0)],
        Unit::Henries => &[("mH", 1e-3), ("uH", 1e-6), ("µH", 1e-6)],
        Unit::Ohms => &[("ohms", 1.0), ("ohm", 1.0), ("mohm", 1e-3), ("mΩ", 1e-3)],
        Unit::BitsPerSecond => &[("bps", 1.0), ("baud", 1.0), ("kbps", 1e3), ("kbit/s", 1e3)],
        _ => &[],
    }
}

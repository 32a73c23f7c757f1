//! The text form of a setting's value: what a person types and reads.

use brushwork_values::{Message, Unit};

use super::kind::{Coding, Kind, unit_forms};
use super::value::{SettingValue, Signed};
use crate::messages::ValueMessage;

/// Text, unit and step together: all that turning a value into text and back needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Notation {
    pub(super) kind: Kind,
    pub(super) coding: Coding,
    pub(super) unit: Unit,
    /// Whether a choice takes numbers without a name.
    pub(super) is_open: bool,
}

impl Notation {
    /// The value as text with its unit: "24.0 V", "Locked antiphase", "yes".
    pub(super) fn format(self, value: SettingValue) -> String {
        let bare = self.format_bare(value);
        match (value, self.unit.symbol()) {
            (SettingValue::Int(_) | SettingValue::Number(_) | SettingValue::Signed(_), symbol)
                if !symbol.is_empty() =>
            {
                format!("{bare} {symbol}")
            }
            _ => bare,
        }
    }

    /// The value as text without its unit.
    pub(super) fn format_bare(self, value: SettingValue) -> String {
        match value {
            SettingValue::Bool(true) => "yes".to_owned(),
            SettingValue::Bool(false) => "no".to_owned(),
            SettingValue::Int(number) => number.to_string(),
            SettingValue::Number(number) | SettingValue::Signed(Signed { number, .. }) => {
                self.shortest(number)
            }
            SettingValue::Choice(key) => self.label(key).to_owned(),
            SettingValue::UnknownCode(raw) if self.is_open => raw.to_string(),
            SettingValue::UnknownCode(raw) => format!("unknown ({raw})"),
        }
    }

    /// The value that `text` stands for, rounded to the row's step; an error is a sentence.
    pub(super) fn parse(self, text: &str) -> Result<SettingValue, Message> {
        let text = text.trim();
        match self.kind {
            Kind::Bool => parse_bool(text).map(SettingValue::Bool),
            Kind::Choice(_) => self.parse_choice(text),
            Kind::Int => self.parse_int(text).map(SettingValue::Int),
            Kind::Fixed { .. } => {
                let number = self.parse_number(text)?;
                Ok(SettingValue::Number(self.coding.to_physical(self.coding.to_raw(number))))
            }
        }
    }

    /// The fewest decimals, not below the row's own, that read back as the same step.
    pub(super) fn shortest(self, number: f64) -> String {
        let Kind::Fixed { decimals } = self.kind else { return number.to_string() };
        let raw = self.coding.to_raw(number);
        (decimals..12)
            .map(|decimals| format!("{number:.decimals$}"))
            .find(|text| text.parse().is_ok_and(|read| self.coding.to_raw(read) == raw))
            .unwrap_or_else(|| number.to_string())
    }

    fn label(self, key: &'static str) -> &'static str {
        let Kind::Choice(codes) = self.kind else { return key };
        codes.iter().find(|code| code.key == key).map_or(key, |code| code.label)
    }

    fn parse_choice(self, text: &str) -> Result<SettingValue, Message> {
        let Kind::Choice(codes) = self.kind else {
            return Err(ValueMessage::NoChoice { text: text.to_owned() }.into());
        };
        let wanted = text.to_lowercase();
        let named = codes.iter().find(|code| code.key == wanted || code.label.to_lowercase() == wanted);
        let numbered = || {
            let raw = parse_whole(text)?;
            codes.iter().find(|code| code.raw == raw)
        };
        if let Some(code) = named.or_else(numbered) {
            return Ok(SettingValue::Choice(code.key));
        }
        if let Some(raw) = parse_whole(text).filter(|_| self.is_open) {
            return Ok(SettingValue::UnknownCode(raw));
        }
        let (text, keys) =
            (text.to_owned(), codes.iter().map(|code| code.key).collect::<Vec<_>>().join(", "));
        Err(if self.is_open {
            ValueMessage::NoneOfNorNumber { text, keys }.into()
        } else {
            ValueMessage::NoneOf { text, keys }.into()
        })
    }

    fn parse_int(self, text: &str) -> Result<i64, Message> {
        if let Some(whole) = parse_whole(text) {
            return Ok(whole);
        }
        let number = self.parse_number(text)?;
        if number.fract() != 0.0 || number.abs() > 9e15 {
            let text = text.to_owned();
            return Err(match self.unit.symbol() {
                "" => ValueMessage::NoWholeNumber { text }.into(),
                unit => ValueMessage::NoWholeNumberOf { text, unit }.into(),
            });
        }
        Ok(number as i64)
    }

    fn parse_number(self, text: &str) -> Result<f64, Message> {
        let (number, factor) = self.split_unit(text);
        let text = || text.to_owned();
        match number.trim_end().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value * factor),
            _ => Err(match self.unit.symbol() {
                "" => ValueMessage::NoNumber { text: text() }.into(),
                unit => ValueMessage::NoNumberOf { text: text(), unit }.into(),
            }),
        }
    }

    /// Splits the unit off; the longest written form wins, so that "mA" is not read as "A".
    fn split_unit(self, text: &str) -> (&str, f64) {
        let own = (!self.unit.symbol().is_empty()).then_some((self.unit.symbol(), 1.0));
        let forms = own.into_iter().chain(unit_forms(self.unit).iter().copied());
        let cut = |(form, factor)| strip_suffix_ignoring_case(text, form).map(|number| (number, factor));
        forms.filter_map(cut).min_by_key(|(number, _)| number.len()).unwrap_or((text, 1.0))
    }
}

fn strip_suffix_ignoring_case<'t>(text: &'t str, suffix: &str) -> Option<&'t str> {
    let cut = text.len().checked_sub(suffix.len())?;
    let (head, tail) = (text.get(..cut)?, text.get(cut..)?);
    (tail.to_lowercase() == suffix.to_lowercase()).then_some(head)
}

fn parse_bool(text: &str) -> Result<bool, Message> {
    match text.to_lowercase().as_str() {
        "yes" | "true" | "on" | "1" | "enabled" => Ok(true),
        "no" | "false" | "off" | "0" | "disabled" => Ok(false),
        _ => Err(ValueMessage::NeitherYesNorNo { text: text.to_owned() }.into()),
    }
}

fn parse_whole(text: &str) -> Option<i64> {
    match text.strip_prefix("0x").or(text.strip_prefix("0X")) {
        Some(hex) => i64::from_str_radix(hex, 16).ok(),
        None => text.parse().ok(),
    }
}

//! The text of a profile: writing it, and the tree it is read as.

use std::fmt::{self, Write as _};

use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::super::row::Row;
use super::super::value::SettingValue;
use super::content::{FORMAT, Profile, SCHEMA};

/// The profile as text, one line per setting, so that two files compare line by line.
pub(super) fn write(profile: &Profile) -> String {
    let subject = &profile.subject;
    let mut text = String::from("{\n");
    let mut member = |name: &str, value: String| {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "  {}: {value},", quote(name));
    };
    member("format", quote(FORMAT));
    member("schema", SCHEMA.to_string());
    member("model", quote(subject.model.key));
    member("firmware", quote(&profile.firmware));
    member("generation", subject.generation.number().to_string());
    member("address", quote(&profile.address.to_string()));
    member("date", quote(&profile.date));
    member("unit", quote(&profile.unit));
    member("note", quote(&profile.note));
    member("pins", subject.pins.to_string());
    member("streams", subject.streams.to_string());
    member("douts", subject.douts.to_string());
    text.push_str("  \"settings\": {");
    let table = profile.table();
    let held = table.rows().iter().filter_map(|row| Some((row, profile.settings.get(&row.key)?)));
    for (index, (row, value)) in held.enumerate() {
        text.push_str(if index == 0 { "\n" } else { ",\n" });
        let _ = write!(text, "    {}: {}", quote(&row.key), entry(row, value));
    }
    text.push_str("\n  }\n}\n");
    text
}

/// What a value means, and the register that it stands for.
fn entry(row: &Row, value: SettingValue) -> String {
    let shown = match value {
        SettingValue::Bool(on) => Some(on.to_string()),
        SettingValue::Int(_) | SettingValue::Number(_) | SettingValue::Signed(_) => {
            Some(row.format_bare(value))
        }
        SettingValue::Choice(key) => Some(quote(key)),
        SettingValue::UnknownCode(_) => None,
    };
    let unit = Some(row.unit.symbol()).filter(|unit| !unit.is_empty() && shown.is_some()).map(quote);
    // A value of another kind than its row has no register; it is shown all the same.
    let raw = row.register_of(value).map(|raw| raw.to_string());
    let members = [("value", shown), ("unit", unit), ("raw", raw)];
    let members = members.into_iter().filter_map(|(name, text)| Some(format!("\"{name}\": {}", text?)));
    format!("{{ {} }}", members.collect::<Vec<_>>().join(", "))
}

/// `text` as a JSON string.
pub(super) fn quote(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A JSON value whose objects keep the order of their members, and members that stand twice.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Node {
    Null,
    Bool(bool),
    Int(i64),
    Float(f64),
    Text(String),
    List,
    Object(Vec<(String, Node)>),
}

impl Node {
    /// What it is, for "expected a number, got ...".
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool(_) => "true or false",
            Self::Int(_) | Self::Float(_) => "a number",
            Self::Text(_) => "a text",
            Self::List => "a list",
            Self::Object(_) => "an object",
        }
    }
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodeVisitor)
    }
}

struct NodeVisitor;

impl<'de> Visitor<'de> for NodeVisitor {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E: de::Error>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }

    fn visit_bool<E: de::Error>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Bool(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Int(value))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Node, E> {
        Ok(i64::try_from(value).map_or(Node::Float(value as f64), Node::Int))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Float(value))
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Node, A::Error> {
        while items.next_element::<Node>()?.is_some() {}
        Ok(Node::List)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node, A::Error> {
        let mut members = Vec::new();
        while let Some(member) = map.next_entry()? {
            members.push(member);
        }
        Ok(Node::Object(members))
    }
}

//! Reading the text of a profile: first the file as a whole, then each setting against the table it was made
//! with.

use std::collections::HashSet;

use crate::family::{FamilyRef, Model, families, model_named};
use crate::messages::ProfileMessage;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::Message;

use super::super::image::SettingsImage;
use super::super::kind::Kind;
use super::super::row::Row;
use super::super::subject::Subject;
use super::super::table::SettingsTable;
use super::super::value::SettingValue;
use super::content::{FORMAT, OpenedProfile, Profile, SCHEMA, Strictness};
use super::error::{Problem, ProfileError};
use super::json::{Node, quote};
use super::schema;

/// More pins, streams or outputs than any controller has; a larger number is a fault of the file.
const MOST_PINS: i64 = 32;

/// The profile in `text`, and what was changed on the way.
pub(super) fn parse(text: &str, strictness: Strictness) -> Result<OpenedProfile, ProfileError> {
    let root: Node = serde_json::from_str(text).map_err(|error| not_json(&error))?;
    let Node::Object(members) = root else {
        return Err(whole(ProfileMessage::NoObject));
    };
    let mut reader = Reader { text, problems: Vec::new(), warnings: Vec::new(), strictness };
    let found = reader.check_format(&members)?;
    let (members, upgraded) = schema::upgrade(members, found);
    reader.check_members(&members);
    let profile = reader.profile(&members);
    match profile {
        Some(profile) if reader.problems.is_empty() => {
            Ok(OpenedProfile { profile, upgraded, corrected: reader.warnings })
        }
        _ => Err(ProfileError { problems: reader.problems }),
    }
}

const MEMBERS: [&str; 13] = [
    "format",
    "schema",
    "model",
    "firmware",
    "generation",
    "address",
    "date",
    "unit",
    "note",
    "pins",
    "streams",
    "douts",
    "settings",
];

struct Reader<'t> {
    text: &'t str,
    problems: Vec<Problem>,
    warnings: Vec<Problem>,
    strictness: Strictness,
}

type Members = [(String, Node)];

impl Reader<'_> {
    /// Whether this is a profile at all, and one whose schema we know: nothing else is worth saying
    /// otherwise. Gives the schema.
    fn check_format(&mut self, members: &Members) -> Result<u64, ProfileError> {
        match find(members, "format") {
            Some(Node::Text(format)) if format == FORMAT => {}
            _ => return Err(whole(ProfileMessage::NoProfile { format: FORMAT })),
        }
        match find(members, "schema") {
            Some(Node::Int(schema)) if *schema > 0 => match u64::try_from(*schema) {
                Ok(schema) if schema <= SCHEMA => Ok(schema),
                _ => {
                    let told = ProfileMessage::NewerSchema { schema: *schema, known: SCHEMA };
                    Err(self.refusal("schema", told))
                }
            },
            other => Err(self.refusal("schema", expected("a schema number from 1", other))),
        }
    }

    fn check_members(&mut self, members: &Members) {
        let mut seen = HashSet::new();
        for (name, _) in members {
            if !MEMBERS.contains(&name.as_str()) {
                self.problem(name, ProfileMessage::NoSuchMember);
            }
            if !seen.insert(name) {
                self.problem(name, ProfileMessage::MemberTwice);
            }
        }
    }

    fn profile(&mut self, members: &Members) -> Option<Profile> {
        let model = self.model(members);
        // Where the model is not known, the first family's numbers are those that most files have.
        let family = model.map(|model| model.family).or(families().first().copied())?;
        let generation = self.generation(members, family);
        let address = self.address(members, family);
        let firmware = self.string(members, "firmware");
        let date = self.string(members, "date");
        let (unit, note) = (self.string(members, "unit"), self.string(members, "note"));
        let [pins, streams, douts] = ["pins", "streams", "douts"].map(|name| self.count(members, name));
        let subject =
            Subject { model: model?, generation: generation?, pins: pins?, streams: streams?, douts: douts? };
        let settings = self.settings(members, &SettingsTable::new(subject))?;
        Some(Profile {
            subject,
            firmware: firmware?,
            address: address?,
            date: date?,
            unit: unit?,
            note: note?,
            settings,
        })
    }

    fn model(&mut self, members: &Members) -> Option<&'static Model> {
        let key = self.string(members, "model")?;
        let model = model_named(&key);
        if model.is_none() {
            let known = families().iter().flat_map(|family| family.models()).map(|model| model.key);
            let known: Vec<&str> = known.collect();
            let told = ProfileMessage::UnknownModel { model: quote(&key), known: known.join(", ") };
            self.problem("model", told);
        }
        model
    }

    fn generation(&mut self, members: &Members, family: FamilyRef) -> Option<FirmwareGeneration> {
        let number = self.int(members, "generation")?;
        match family.check_generation(number) {
            Ok(number) => Some(FirmwareGeneration::new(family, number)),
            Err(why) => {
                self.problem("generation", ProfileMessage::BadGeneration { number, why });
                None
            }
        }
    }

    fn address(&mut self, members: &Members, family: FamilyRef) -> Option<UnitAddress> {
        let text = self.string(members, "address")?;
        let address = UnitAddress::parse(family, &text);
        if address.is_none() {
            let told = ProfileMessage::NoAddress { text: quote(&text), addresses: family.addresses() };
            self.problem("address", told);
        }
        address
    }

    fn count(&mut self, members: &Members, name: &str) -> Option<usize> {
        let number = self.int(members, name)?;
        if !(0..=MOST_PINS).contains(&number) {
            self.problem(name, ProfileMessage::CountOutOfRange { number, most: MOST_PINS });
            return None;
        }
        usize::try_from(number).ok()
    }

    fn string(&mut self, members: &Members, name: &str) -> Option<String> {
        match find(members, name) {
            Some(Node::Text(text)) => Some(text.clone()),
            other => {
                self.problem(name, expected("a text", other));
                None
            }
        }
    }

    fn int(&mut self, members: &Members, name: &str) -> Option<i64> {
        match find(members, name) {
            Some(Node::Int(number)) => Some(*number),
            other => {
                self.problem(name, expected("a whole number", other));
                None
            }
        }
    }

    fn settings(&mut self, members: &Members, table: &SettingsTable) -> Option<SettingsImage> {
        let Some(Node::Object(entries)) = find(members, "settings") else {
            self.problem("settings", expected("an object", find(members, "settings")));
            return None;
        };
        let mut image = SettingsImage::default();
        for (key, node) in entries {
            if image.get(key).is_some() {
                self.problem(&setting_path(key), ProfileMessage::SettingTwice);
                continue;
            }
            match table.row(key) {
                Some(row) => {
                    if let Some(value) = self.setting(row, node) {
                        image.set(key, value);
                    }
                }
                None => self.minor(&setting_path(key), unknown_setting(table.subject())),
            }
        }
        Some(image)
    }

    /// One setting: its form, its unit, its kind.
    fn setting(&mut self, row: &Row, node: &Node) -> Option<SettingValue> {
        let path = setting_path(&row.key);
        let value = match read_entry(row, node) {
            Ok((value, edited)) => {
                self.warnings.extend(edited.map(|sentence| self.located(&path, sentence)));
                value
            }
            Err((register, why)) => {
                self.minor(&path, why);
                row.decode(register?)
            }
        };
        // What may stand in a controller, out of range or without a name, may stand in a profile too.
        match row.check_as_read(value) {
            Ok(_) => Some(row.settle(value)),
            Err(why) => {
                self.minor(&path, why);
                None
            }
        }
    }

    /// A fault of one setting: a refusal, or a warning when faults are corrected.
    fn minor(&mut self, path: &str, sentence: impl Into<Message>) {
        let problem = self.located(path, sentence);
        match self.strictness {
            Strictness::Refuse => self.problems.push(problem),
            Strictness::Repair => self.warnings.push(problem),
        }
    }

    fn problem(&mut self, path: &str, sentence: impl Into<Message>) {
        let problem = self.located(path, sentence);
        self.problems.push(problem);
    }

    fn refusal(&self, path: &str, sentence: impl Into<Message>) -> ProfileError {
        ProfileError { problems: vec![self.located(path, sentence)] }
    }

    /// A problem with the line and column where the member's name first stands as a name.
    fn located(&self, path: &str, sentence: impl Into<Message>) -> Problem {
        let name = quote(path.strip_prefix(SETTING_PREFIX).unwrap_or(path));
        let is_name = |at: &usize| self.text[at + name.len()..].trim_start().starts_with(':');
        let offset = self.text.match_indices(&name).map(|(at, _)| at).find(is_name);
        let position = offset.map(|at| position(self.text, at));
        Problem { path: path.to_owned(), position, sentence: sentence.into() }
    }
}

const SETTING_PREFIX: &str = "settings.";

fn setting_path(key: &str) -> String {
    format!("{SETTING_PREFIX}{key}")
}

fn unknown_setting(subject: &Subject) -> ProfileMessage {
    ProfileMessage::NoSuchSetting { model: subject.model.name, generation: subject.generation }
}

/// A value and what is to be said of it, or a fault and the register beside it.
type Entry = Result<(SettingValue, Option<ProfileMessage>), (Option<i64>, ProfileMessage)>;

/// The value of `{ "value": ..., "unit": ..., "raw": ... }`, not yet checked against the range: what its register means, unless somebody
/// changed the value beside it, which a sentence says then. An error comes with the register, which counts where faults are corrected.
fn read_entry(row: &Row, node: &Node) -> Entry {
    let Node::Object(members) = node else {
        return Err((None, expected("an object with a \"value\"", Some(node))));
    };
    if let Some((name, _)) =
        members.iter().find(|(name, _)| !matches!(name.as_str(), "value" | "unit" | "raw"))
    {
        return Err((None, ProfileMessage::NoSuchSettingMember { name: quote(name) }));
    }
    let register = match find(members, "raw") {
        None => None,
        Some(Node::Int(raw)) => Some(*raw),
        Some(other) => return Err((None, expected("a whole number as \"raw\"", Some(other)))),
    };
    let (value, unit) = (find(members, "value"), find(members, "unit"));
    let Some(raw) = register else {
        let value = check_unit(row, unit).and_then(|()| read_value(row, value));
        return value.map(|value| (value, None)).map_err(|why| (None, why));
    };
    let held = row.decode(raw);
    // Without a name there is the number alone. A program that had no names for the row wrote it twice.
    let is_named = matches!(row.kind, Kind::Bool | Kind::Choice(_));
    let is_twice = is_named && matches!(value, Some(Node::Int(value)) if *value == raw);
    if is_twice || value.is_none() && unit.is_none() {
        return Ok((held, None));
    }
    let value = check_unit(row, unit).and_then(|()| read_value(row, value));
    let value = value.map_err(|why| (register, why))?;
    if row.encode(value) == row.encode(held) {
        return Ok((held, None));
    }
    let (said, held) = (row.format(value), row.format(held));
    Ok((value, Some(ProfileMessage::ValueChanged { said, raw, held })))
}

fn check_unit(row: &Row, unit: Option<&Node>) -> Result<(), ProfileMessage> {
    let wanted = row.unit.symbol();
    match unit {
        None if wanted.is_empty() => Ok(()),
        Some(Node::Text(unit)) if unit == wanted => Ok(()),
        None => Err(ProfileMessage::NoUnit { wanted: quote(wanted) }),
        Some(Node::Text(unit)) if wanted.is_empty() => Err(ProfileMessage::UnitTooMany { unit: quote(unit) }),
        Some(Node::Text(unit)) => Err(ProfileMessage::OtherUnit { unit: quote(unit), wanted: quote(wanted) }),
        Some(other) => Err(expected("a text as unit", Some(other))),
    }
}

fn read_value(row: &Row, value: Option<&Node>) -> Result<SettingValue, ProfileMessage> {
    match (row.kind, value) {
        (Kind::Bool, Some(Node::Bool(on))) => Ok(SettingValue::Bool(*on)),
        (Kind::Int, Some(Node::Int(number))) => Ok(SettingValue::Int(*number)),
        (Kind::Fixed { .. }, Some(Node::Int(number))) => Ok(SettingValue::Number(*number as f64)),
        (Kind::Fixed { .. }, Some(Node::Float(number))) => Ok(SettingValue::Number(*number)),
        (Kind::Choice(codes), Some(Node::Text(key))) => match codes.iter().find(|code| code.key == key) {
            Some(code) => Ok(SettingValue::Choice(code.key)),
            None => {
                let keys: Vec<&str> = codes.iter().map(|code| code.key).collect();
                Err(ProfileMessage::NoneOf { text: quote(key), keys: keys.join(", ") })
            }
        },
        // What had no names when the profile was written.
        (Kind::Choice(_), Some(Node::Int(raw))) => Ok(row.decode(*raw)),
        (Kind::Bool, other) => Err(expected("true or false", other)),
        (Kind::Int, other) => Err(expected("a whole number", other)),
        (Kind::Fixed { .. }, other) => Err(expected("a number", other)),
        (Kind::Choice(_), other) => Err(expected("a text", other)),
    }
}

fn find<'m>(members: &'m Members, name: &str) -> Option<&'m Node> {
    members.iter().find(|(member, _)| member == name).map(|(_, node)| node)
}

fn expected(wanted: &'static str, got: Option<&Node>) -> ProfileMessage {
    match got {
        Some(node) => ProfileMessage::Expected { wanted, got: node.kind() },
        None => ProfileMessage::ExpectedAny { wanted },
    }
}

fn whole(sentence: ProfileMessage) -> ProfileError {
    ProfileError { problems: vec![Problem::at_key("", sentence)] }
}

fn not_json(error: &serde_json::Error) -> ProfileError {
    let full = error.to_string();
    let what = full.split(" at line ").next().unwrap_or(&full);
    let position = (error.line() > 0).then(|| (error.line(), error.column()));
    let sentence = ProfileMessage::NotJson { what: what.to_owned() }.into();
    ProfileError { problems: vec![Problem { path: String::new(), position, sentence }] }
}

/// Line and column, both from 1, of a byte of `text`.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, text[line_start..at].chars().count() + 1)
}

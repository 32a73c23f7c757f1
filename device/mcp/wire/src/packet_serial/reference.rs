//! The reference page: the command table for people to read, and as rows to serialise.
//!
//! Both read [`COMMANDS`] and nothing else, so that the page cannot differ from what is encoded and decoded.

mod text;
mod words;

use serde::Serialize;

use super::command::{ClientUse, Command, Direction, Effect, Form, Reply, Simulated};
use super::identity::Generation;
use super::status::{CONDITIONS, StatusIndicator};
use super::table::COMMANDS;
use brushwork_values::{Field, Kind, Severity, Unit};

pub use text::{page, section};
use words::kind;

/// The whole reference.
#[derive(Debug, Clone, Serialize)]
pub struct Reference {
    /// Every command in number order.
    pub commands: Vec<CommandEntry>,
    /// Every condition of a status word.
    pub status: Vec<StatusEntry>,
}

/// A command.
#[derive(Debug, Clone, Serialize)]
pub struct CommandEntry {
    /// The command byte.
    pub number: u8,
    /// Stable name.
    pub key: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// What goes over the wire, by generation.
    pub forms: Vec<FormEntry>,
    /// Further payload widths, in bytes, that a controller takes in a write.
    pub also_accepted_bytes: Vec<usize>,
    /// What the simulated controller makes of it.
    pub simulated: Standing,
    /// What our client does with it.
    pub client: Standing,
    /// Where it is described.
    pub source: &'static str,
    /// Contradictions and traps.
    pub note: &'static str,
}

/// A word that sums up how something stands, and why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Standing {
    /// One word: "acts", "stored_only", "inert", "silent"; "sends", "superseded", "never".
    pub state: &'static str,
    /// The reason; `None` where there is nothing to explain.
    pub why: Option<&'static str>,
}

/// What goes over the wire in a run of generations.
#[derive(Debug, Clone, Serialize)]
pub struct FormEntry {
    /// The first generation that has it.
    pub first_generation: Generation,
    /// The last generation that has it.
    pub last_generation: Generation,
    /// Name for people, where the meaning changed between generations.
    pub title: Option<&'static str>,
    /// Read or write.
    pub direction: Direction,
    /// What it does.
    pub effect: Effect,
    /// Whether the same request may be sent again when the first one may have been executed.
    pub may_be_repeated: bool,
    /// Arguments in wire order.
    pub request: Vec<FieldEntry>,
    /// Bytes of the arguments.
    pub request_bytes: usize,
    /// What frames the reply: "ack", "data", "ack_then_status" or "ack_then_data".
    pub reply_shape: &'static str,
    /// What comes back, in wire order.
    pub reply: Vec<FieldEntry>,
    /// Bytes of the whole reply, acknowledgement and CRC included; `None` if they depend on the content.
    pub reply_bytes: Option<usize>,
    /// Why it is a guess, if it is one.
    pub assumed: Option<&'static str>,
}

/// A field.
#[derive(Debug, Clone, Serialize)]
pub struct FieldEntry {
    /// Name.
    pub name: &'static str,
    /// How it lies on the wire: "u16", "i32", "text", "8 bytes", "u8 count + records".
    pub kind: String,
    /// Unit of the physical value.
    pub unit: Unit,
    /// Symbol of that unit.
    pub symbol: &'static str,
    /// Physical value of one raw count.
    pub scale: f64,
    /// Raw range that the manual gives.
    pub raw_range: Option<(i64, i64)>,
    /// The constant it always carries.
    pub fixed: Option<i64>,
    /// Named raw values.
    pub codes: Vec<CodeEntry>,
    /// The fields of one record, for a counted field.
    pub record: Vec<FieldEntry>,
    /// What it means.
    pub doc: &'static str,
}

/// A named raw value.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct CodeEntry {
    /// The number on the wire.
    pub raw: i64,
    /// Stable name.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
}

/// A condition of a status word.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct StatusEntry {
    /// What people call it.
    pub title: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// The indicator that shows it.
    #[serde(rename = "lamp")]
    pub indicator: Option<&'static str>,
    /// Its mask in generations 1 to 4; 0 where there is none.
    pub masks: [u32; 4],
}

/// The whole reference as rows.
pub fn reference() -> Reference {
    let status = CONDITIONS.iter().map(|row| StatusEntry {
        title: row.title,
        severity: row.severity,
        indicator: row.indicator.map(StatusIndicator::abbreviation),
        masks: row.masks,
    });
    Reference { commands: COMMANDS.iter().map(CommandEntry::of).collect(), status: status.collect() }
}

impl CommandEntry {
    /// The row of `command`.
    pub fn of(command: &Command) -> Self {
        let mut also: Vec<usize> =
            command.also_accepted.iter().map(|fields| super::command::request_width(fields)).collect();
        also.sort_unstable();
        Self {
            number: command.number,
            key: command.key,
            title: command.title,
            forms: command.forms.iter().map(FormEntry::of).collect(),
            also_accepted_bytes: also,
            simulated: Standing::of_simulated(command.simulated),
            client: Standing::of_client(command.client),
            source: command.source,
            note: command.note,
        }
    }
}

impl Standing {
    const fn of_simulated(simulated: Simulated) -> Self {
        match simulated {
            Simulated::Acts => Self { state: "acts", why: None },
            Simulated::StoredOnly(why) => Self { state: "stored_only", why: Some(why) },
            Simulated::Inert(why) => Self { state: "inert", why: Some(why) },
            Simulated::Silent(why) => Self { state: "silent", why: Some(why) },
        }
    }

    const fn of_client(client: ClientUse) -> Self {
        match client {
            ClientUse::Sends => Self { state: "sends", why: None },
            ClientUse::Superseded(why) => Self { state: "superseded", why: Some(why) },
            ClientUse::Never(why) => Self { state: "never", why: Some(why) },
        }
    }
}

impl FormEntry {
    fn of(form: &Form) -> Self {
        let entries = |fields: &[Field]| fields.iter().map(FieldEntry::of).collect();
        Self {
            first_generation: form.first,
            last_generation: form.last,
            title: form.title,
            direction: form.direction,
            effect: form.effect,
            may_be_repeated: form.effect.may_be_repeated(),
            request: entries(form.request),
            request_bytes: form.payload_width(),
            reply_shape: shape(&form.reply),
            reply: entries(form.reply.fields()),
            reply_bytes: form.reply.width(),
            assumed: form.assumed,
        }
    }
}

impl FieldEntry {
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn of(field: &Field) -> Self {
        let record = match field.kind {
            Kind::Counted(fields) => fields.iter().map(Self::of).collect(),
            _ => Vec::new(),
        };
        let codes =
            field.codes.iter().map(|code| CodeEntry { raw: code.raw, key: code.key, label: code.label });
        Self {
            name: field.name,
            kind: kind(&field.kind),
            unit: field.unit,
            symbol: field.unit.symbol(),
            scale: field.scale,
            raw_range: field.raw_range,
            fixed: field.fixed,
            codes: codes.collect(),
            record,
            doc: field.doc,
        }
    }
}

const fn shape(reply: &Reply) -> &'static str {
    match reply {
        Reply::Ack => "ack",
        Reply::Data(_) => "data",
        Reply::AckThenStatus(_) => "ack_then_status",
        Reply::AckThenData(_) => "ack_then_data",
    }
}

#[cfg(test)]
mod tests;

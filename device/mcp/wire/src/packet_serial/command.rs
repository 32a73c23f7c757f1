//! A row of the command table: what a command number means in each generation.

use serde::Serialize;

use super::identity::Generation;
use super::number;
use crate::models::{Family, most_records};
use brushwork_values::{Field, Kind, width_of};

/// A command of packet serial: one row of [`COMMANDS`](super::COMMANDS).
#[derive(Debug, Clone, Copy)]
pub struct Command {
    /// The command byte.
    pub number: u8,
    /// Stable name in snake_case; [`number`](super::number) has a constant of the same name.
    pub key: &'static str,
    /// Name for people. A form may have its own.
    pub title: &'static str,
    /// What goes over the wire, by generation; no generation is named twice. Empty if no layout is public.
    pub forms: &'static [Form],
    /// Payloads that a controller takes besides those of `forms` (facts from the manual and old clients).
    pub also_accepted: &'static [&'static [Field]],
    /// What the simulated controller makes of it.
    pub simulated: Simulated,
    /// What our own client does with it.
    pub client: ClientUse,
    /// The product line that has it, where the other one does not: to that one it is an unknown command.
    pub only: Option<Family>,
    /// Where it is described.
    pub source: &'static str,
    /// Contradictions and traps; empty if there are none.
    pub note: &'static str,
}

/// What goes over the wire for a command in a run of generations.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// The first generation that has it.
    pub first: Generation,
    /// The last generation that has it.
    pub last: Generation,
    /// Whether the request carries a CRC of its own.
    pub direction: Direction,
    /// What it does to the controller.
    pub effect: Effect,
    /// The arguments of the request.
    pub request: &'static [Field],
    /// What comes back.
    pub reply: Reply,
    /// Name for people where the meaning of the number changed between generations.
    pub title: Option<&'static str>,
    /// Why this form is a guess: it is never sent to a controller that is not simulated. `None` if it is documented.
    pub assumed: Option<&'static str>,
}

/// Reads and writes differ in who carries a CRC.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// The request has no CRC (one that is appended is ignored); the reply has data and a CRC.
    Read,
    /// The request ends with a CRC; the reply starts with 0xFF.
    Write,
}

/// What comes back.
#[derive(Debug, Clone, Copy)]
pub enum Reply {
    /// One byte 0xFF, no CRC (MCP manual 2.2.5).
    Ack,
    /// These fields, then a CRC over address, command, arguments and data (MCP manual 2.2.7).
    Data(&'static [Field]),
    /// 0xFF at once, then one more byte when the work is done, no CRC (script commands, public clients 2015-2020).
    AckThenStatus(&'static [Field]),
    /// 0xFF, these fields, then a CRC that starts anew and covers the fields alone (command 190, Python client 2025).
    AckThenData(&'static [Field]),
}

/// What a command does. The retry rule and the arming rule both read it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// Reads only.
    Query,
    /// Sets something to a given value.
    Setting,
    /// Sets an encoder count. Sent twice, counts made in between are lost.
    Encoder,
    /// Drives a motor to a given duty or speed.
    Motion,
    /// Moves by an amount, or starts an experiment that moves: sent twice, it moves twice.
    RelativeMotion,
    /// Carries a buffer byte: sent twice, it may be queued twice.
    Buffered,
    /// Stops something.
    Stop,
    /// Works on the memory that keeps settings or scripts.
    Memory,
    /// Starts a script, which may then move motors.
    Script,
    /// Puts a message on the CAN bus, or takes one from it.
    Bus,
    /// Leaves normal operation for the firmware loader.
    Loader,
}

/// What the simulated controller makes of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simulated {
    /// It acts as described.
    Acts,
    /// Its values are stored and returned and change nothing else; why.
    StoredOnly(&'static str),
    /// It is accepted and does nothing, or answers with constants; why.
    Inert(&'static str),
    /// It is not answered; why.
    Silent(&'static str),
}

/// What our client does with a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClientUse {
    /// It may send it.
    Sends,
    /// It has a better one; which.
    Superseded(&'static str),
    /// It never sends it; why.
    Never(&'static str),
}

impl Effect {
    /// Whether the same request may go out again when the first one may have been executed.
    pub const fn may_be_repeated(self) -> bool {
        matches!(self, Self::Query | Self::Setting | Self::Motion | Self::Stop)
    }

    /// Whether it can set a motor in motion, so that it needs arming. Going to standstill counts too: the caller knows
    /// the values, this does not.
    pub const fn may_move(self) -> bool {
        matches!(self, Self::Motion | Self::RelativeMotion | Self::Buffered | Self::Script)
    }
}

impl Reply {
    /// The fields that come back; none for a plain acknowledgement.
    pub const fn fields(&self) -> &'static [Field] {
        match self {
            Self::Ack => &[],
            Self::Data(fields) | Self::AckThenStatus(fields) | Self::AckThenData(fields) => fields,
        }
    }

    /// Bytes of the whole reply, acknowledgement and CRC included; `None` if that depends on the content.
    pub const fn width(&self) -> Option<usize> {
        match width_of(self.fields()) {
            Some(width) => Some(self.around() + width),
            None => None,
        }
    }

    /// Bytes of the reply, of the longest where its length goes by its content: a text as long as it may be, and as many records as any model has.
    pub fn most_bytes(&self) -> usize {
        let most_of = |field: &Field| {
            if let Kind::Text { max } = field.kind {
                return max;
            }
            if let Kind::Counted(record) = field.kind {
                return 1 + most_records() * width_of(record).unwrap_or_default();
            }
            field.kind.width().unwrap_or_default()
        };
        self.around() + self.fields().iter().map(most_of).sum::<usize>()
    }

    /// Bytes beside the fields: an acknowledgement, a checksum.
    const fn around(&self) -> usize {
        match self {
            Self::Ack | Self::AckThenStatus(_) => 1,
            Self::Data(_) => 2,
            Self::AckThenData(_) => 3,
        }
    }
}

impl Form {
    /// Whether this generation uses it.
    pub fn covers(&self, generation: Generation) -> bool {
        self.first <= generation && generation <= self.last
    }

    /// Bytes of the arguments, without address, command and CRC.
    pub const fn payload_width(&self) -> usize {
        request_width(self.request)
    }

    pub(super) const fn titled(mut self, title: &'static str) -> Self {
        self.title = Some(title);
        self
    }

    pub(super) const fn assumed(mut self, why: &'static str) -> Self {
        self.assumed = Some(why);
        self
    }
}

/// Bytes of a request's arguments. Requests have no field whose width depends on its content (a test keeps that).
pub(super) const fn request_width(fields: &[Field]) -> usize {
    match width_of(fields) {
        Some(width) => width,
        None => 0,
    }
}

impl Command {
    pub(super) const fn new(
        number: u8,
        title: &'static str,
        source: &'static str,
        forms: &'static [Form],
    ) -> Self {
        Self {
            number,
            key: number::key(number),
            title,
            forms,
            also_accepted: &[],
            simulated: Simulated::Acts,
            client: ClientUse::Sends,
            only: None,
            source,
            note: "",
        }
    }

    pub(super) const fn accepts(mut self, payloads: &'static [&'static [Field]]) -> Self {
        self.also_accepted = payloads;
        self
    }

    pub(super) const fn simulated(mut self, simulated: Simulated) -> Self {
        self.simulated = simulated;
        self
    }

    pub(super) const fn client(mut self, client: ClientUse) -> Self {
        self.client = client;
        self
    }

    pub(super) const fn only(mut self, family: Family) -> Self {
        self.only = Some(family);
        self
    }

    pub(super) const fn note(mut self, note: &'static str) -> Self {
        self.note = note;
        self
    }

    /// What goes over the wire in this generation; `None` if the generation does not have the command.
    pub fn form(&self, generation: Generation) -> Option<&'static Form> {
        self.forms.iter().find(|form| form.covers(generation))
    }

    /// Whether controllers of this product line have it.
    pub fn is_known_to(&self, family: Family) -> bool {
        self.only.is_none_or(|only| only == family)
    }

    /// What it does in this generation; a query where the generation does not have it.
    pub fn effect(&self, generation: Generation) -> Effect {
        self.form(generation).map_or(Effect::Query, |form| form.effect)
    }

    /// What people call it in this generation.
    pub fn title(&self, generation: Generation) -> &'static str {
        self.form(generation).and_then(|form| form.title).unwrap_or(self.title)
    }

    /// Every layout of arguments that a controller may meet after this command byte in a request of `direction`, those
    /// of other generations too.
    pub(super) fn payloads(&self, direction: Direction) -> impl Iterator<Item = &'static [Field]> + use<> {
        let also = if direction == Direction::Write { self.also_accepted } else { &[] };
        let forms = self.forms.iter().filter(move |form| form.direction == direction);
        forms.map(|form| form.request).chain(also.iter().copied())
    }
}

//! Finding requests in the stream of bytes that a controller receives.
//!
//! The rules are those of MCP manual 2.2.4 and 2.2.5 and of what public clients, 2015-2025, need to be understood:
//!
//! 1. A byte outside 0x80 to 0x87 where a packet should start is dropped.
//! 2. A read is whole as soon as its arguments are there. If the CRC that some clients append follows within 10 ms it
//!    is swallowed, also when the reply has gone out in between.
//! 3. A write is tried at each payload width that any generation knows for it, shortest first, and taken where its CRC
//!    fits.
//! 4. Anything else is not answered: an unknown command, a CRC that fits nowhere, a packet that stops half way. It and
//!    what follows it are dropped until nothing has come for more than 10 ms.
//!
//! 5. Assumed: a write whose address comes twice is taken. The published Rust crate `roboclaw` 0.1.0 sends all its writes so,
//!    and its author drove a RoboClaw 2x15A with it.
//!
//! Packets of all eight addresses are framed: a unit on a bus must follow the traffic of its neighbours to find its own.
//! Two ambiguities are left. By rule 3 a long write is cut short when its first bytes happen to have the CRC of a shorter
//! one: one in 65536. By rule 2 a packet of a neighbour is swallowed when its header equals the CRC that is waited for
//! (83 4D after a read 86 12, for example), and answered when it is repeated; no CRC equals a header of its own address.

use std::fmt;
use std::ops::Deref;
use std::time::Duration;

use super::command::{Command, Direction, request_width};
use super::identity::{Address, Generation};
use super::parse::{packet_crc, parse_payload};
use super::request::Request;
use super::table::lookup;
use crate::crc::crc16_xmodem;
use crate::models::Family;
use brushwork_values::Field;
use brushwork_values::Values;

/// A longer pause between two bytes discards the packet they are in (MCP manual 2.2.4).
pub const PACKET_GAP: Duration = Duration::from_millis(10);

/// Bytes of the longest request: address, command, 53 bytes of signal properties, CRC.
pub const LONGEST_REQUEST: usize = 57;

/// Address and command, in front of each payload.
const HEAD: usize = 2;
/// The checksum behind a write.
const CRC: usize = 2;

/// Finds requests in a stream of bytes. It allocates only for the values of a whole request.
#[derive(Debug, Clone)]
pub struct RequestFramer {
    generation: Generation,
    /// Whose commands it knows; those of both product lines if `None`.
    family: Option<Family>,
    state: State,
    bytes: RawBytes,
    appended: Option<AppendedCrc>,
    last_byte_at: Duration,
}

/// What the framer found.
#[derive(Debug, Clone)]
pub enum FramerEvent {
    /// A whole request, of whatever address.
    Request(Framed),
    /// Bytes that were no request.
    Discarded(Discarded),
}

/// A request as it came.
#[derive(Debug, Clone)]
pub struct Framed {
    /// The unit it is for.
    pub address: Address,
    /// Its row in the table.
    pub command: &'static Command,
    /// Its arguments.
    pub values: Values,
    /// Whether the arguments have the layout of the framer's own generation. If not, they have that of another one.
    pub native: bool,
    /// All its bytes, without a CRC appended to a read.
    pub raw: RawBytes,
}

/// Bytes that were no request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Discarded {
    /// The bytes, or the first of them if they are very many.
    pub bytes: RawBytes,
    /// Why they were dropped.
    pub why: DiscardReason,
}

/// Why bytes were dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DiscardReason {
    /// No packet starts with such a byte.
    NotAnAddress,
    /// The packet stopped half way for more than 10 ms.
    Gap,
    /// No generation has the command, or its layout is not public.
    UnknownCommand,
    /// Another generation has the command, this one does not.
    NotInGeneration,
    /// The CRC fits at none of the known lengths.
    BadCrc,
}

impl fmt::Display for DiscardReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotAnAddress => "no packet starts so",
            Self::Gap => "the packet stopped half way",
            Self::UnknownCommand => "unknown command",
            Self::NotInGeneration => "not a command of this generation",
            Self::BadCrc => "bad CRC",
        })
    }
}

impl Framed {
    /// The request without its layout, to be answered by [`encode_reply`](super::encode_reply).
    pub fn request(&self) -> Request {
        let values = self.values.values().to_vec();
        Request { address: self.address, command: self.command.number, values }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Between packets; the bytes at hand are none, or a run of such that start no packet.
    Idle,
    /// In a packet that may become whole.
    Packet,
    /// In something that cannot become whole, until the line is silent.
    Skipping(DiscardReason),
}

/// The CRC that a client may append to the read that has just been framed.
#[derive(Debug, Clone, Copy)]
struct AppendedCrc {
    crc: [u8; 2],
    first_seen: bool,
    until: Duration,
}

enum Verdict {
    Unfinished,
    Request(Framed),
    /// Whole, but of another generation.
    Foreign(&'static Command),
    /// It cannot become whole.
    Skip(DiscardReason),
}

impl RequestFramer {
    /// A framer for a controller whose firmware is of `generation`.
    pub const fn new(generation: Generation) -> Self {
        Self {
            generation,
            family: None,
            state: State::Idle,
            bytes: RawBytes::EMPTY,
            appended: None,
            last_byte_at: Duration::ZERO,
        }
    }

    /// The same for a controller of one product line, to which the commands of the other are unknown.
    pub const fn for_family(generation: Generation, family: Family) -> Self {
        let mut framer = Self::new(generation);
        framer.family = Some(family);
        framer
    }

    /// The generation whose commands it knows.
    pub const fn generation(&self) -> Generation {
        self.generation
    }

    /// Takes the next byte, received at `now`, counted from any fixed instant. Time must not run backwards; a step back
    /// counts as none.
    pub fn feed(&mut self, byte: u8, now: Duration) -> Option<FramerEvent> {
        let after_silence = self.silence(now);
        self.last_byte_at = now;
        // After a silence a single byte completes nothing, so at most one event is due.
        after_silence.or(self.take(byte, now))
    }

    /// Tells the framer the time without a byte, so that it can report what a silence has cut off.
    pub fn silence(&mut self, now: Duration) -> Option<FramerEvent> {
        if now.saturating_sub(self.last_byte_at) <= PACKET_GAP {
            return None;
        }
        if let Some(AppendedCrc { crc: [first, _], first_seen: true, .. }) = self.appended.take() {
            self.bytes.push(first);
            return self.discard(DiscardReason::Gap);
        }
        match self.state {
            State::Idle => self.discard(DiscardReason::NotAnAddress),
            State::Packet => self.discard(DiscardReason::Gap),
            State::Skipping(why) => self.discard(why),
        }
    }

    /// Forgets everything that has come so far, as at power on.
    pub fn reset(&mut self) {
        *self = Self { family: self.family, ..Self::new(self.generation) };
    }

    fn take(&mut self, byte: u8, now: Duration) -> Option<FramerEvent> {
        match self.state {
            State::Skipping(_) => {
                self.bytes.push(byte);
                None
            }
            State::Packet => {
                self.bytes.push(byte);
                self.judge(now)
            }
            State::Idle => self.take_idle(byte, now),
        }
    }

    fn take_idle(&mut self, byte: u8, now: Duration) -> Option<FramerEvent> {
        match self.appended {
            Some(AppendedCrc { crc: [first, _], first_seen: false, until })
                if byte == first && now <= until =>
            {
                self.appended = self.appended.map(|appended| AppendedCrc { first_seen: true, ..appended });
                None
            }
            Some(AppendedCrc { crc: [_, second], first_seen: true, .. }) if byte == second => {
                self.appended = None;
                None
            }
            Some(AppendedCrc { crc: [first, _], first_seen: true, .. }) => {
                self.appended = None;
                let event = self.start(first);
                event.or(self.take(byte, now))
            }
            Some(_) | None => {
                self.appended = None;
                self.start(byte)
            }
        }
    }

    fn start(&mut self, byte: u8) -> Option<FramerEvent> {
        if Address::new(byte).is_none() {
            self.bytes.push(byte);
            return None;
        }
        let junk = self.discard(DiscardReason::NotAnAddress);
        self.bytes.push(byte);
        self.state = State::Packet;
        junk
    }

    fn judge(&mut self, now: Duration) -> Option<FramerEvent> {
        match self.verdict(self.bytes) {
            Verdict::Unfinished => None,
            Verdict::Request(framed) => {
                self.finish(framed.command, now);
                Some(FramerEvent::Request(framed))
            }
            Verdict::Foreign(command) => {
                let discarded = Discarded { bytes: self.bytes, why: DiscardReason::NotInGeneration };
                self.finish(command, now);
                Some(FramerEvent::Discarded(discarded))
            }
            Verdict::Skip(why) => {
                self.state = State::Skipping(why);
                None
            }
        }
    }

    /// Ready for the next packet; after a read, also for a CRC that the client has appended.
    fn finish(&mut self, command: &Command, now: Duration) {
        if direction(command, self.generation) == Some(Direction::Read) {
            let crc = crc16_xmodem(&self.bytes).to_be_bytes();
            self.appended =
                Some(AppendedCrc { crc, first_seen: false, until: now.saturating_add(PACKET_GAP) });
        }
        self.bytes = RawBytes::EMPTY;
        self.state = State::Idle;
    }

    fn discard(&mut self, why: DiscardReason) -> Option<FramerEvent> {
        let bytes = std::mem::take(&mut self.bytes);
        self.state = State::Idle;
        (!bytes.is_empty()).then_some(FramerEvent::Discarded(Discarded { bytes, why }))
    }

    fn verdict(&self, packet: RawBytes) -> Verdict {
        let &[address, number, ..] = &*packet else {
            return Verdict::Unfinished;
        };
        let known = |command: &&Command| self.family.is_none_or(|family| command.is_known_to(family));
        let (Some(address), Some(command)) = (Address::new(address), lookup(number).filter(known)) else {
            return Verdict::Skip(DiscardReason::UnknownCommand);
        };
        match direction(command, self.generation) {
            None => Verdict::Skip(DiscardReason::UnknownCommand),
            Some(Direction::Read) => self.judge_read(address, command, packet),
            Some(Direction::Write) if number == address.get() => self.judge_doubled(address, command, packet),
            Some(Direction::Write) => self.judge_write(address, command, packet),
        }
    }

    /// Judges a packet that is either a write whose number equals its address or a write whose address came twice.
    fn judge_doubled(&self, address: Address, command: &'static Command, packet: RawBytes) -> Verdict {
        let verdict = self.judge_write(address, command, packet);
        let inner = packet.without_first();
        let is_write = inner.get(1).is_none_or(|number| {
            *number != address.get()
                && lookup(*number).and_then(|command| direction(command, self.generation))
                    == Some(Direction::Write)
        });
        match (verdict, is_write.then(|| self.verdict(inner))) {
            (
                Verdict::Unfinished | Verdict::Skip(_),
                Some(inner @ (Verdict::Request(_) | Verdict::Foreign(_))),
            ) => inner,
            (Verdict::Skip(_), Some(Verdict::Unfinished)) => Verdict::Unfinished,
            (verdict, _) => verdict,
        }
    }

    fn judge_read(&self, address: Address, command: &'static Command, packet: RawBytes) -> Verdict {
        let width = packet.len().saturating_sub(HEAD);
        match self.layout(command, Direction::Read, width) {
            Some(fields) => self.whole(address, command, fields, packet, width),
            None => Verdict::Unfinished,
        }
    }

    fn judge_write(&self, address: Address, command: &'static Command, packet: RawBytes) -> Verdict {
        let Some(width) = packet.len().checked_sub(HEAD + CRC) else {
            return Verdict::Unfinished;
        };
        if let Some(fields) = self.layout(command, Direction::Write, width)
            && packet_crc(&packet).is_some_and(|(got, expected)| got == expected)
        {
            return self.whole(address, command, fields, packet, width);
        }
        let longest = command.payloads(Direction::Write).map(request_width).max();
        if longest.is_none_or(|longest| width >= longest) {
            return Verdict::Skip(DiscardReason::BadCrc);
        }
        Verdict::Unfinished
    }

    /// The layout of a payload of this width: this generation's if it has one, else that of another.
    fn layout(&self, command: &Command, direction: Direction, width: usize) -> Option<&'static [Field]> {
        let own = command.form(self.generation).map(|form| form.request);
        let known = own.into_iter().chain(command.payloads(direction));
        known.into_iter().find(|fields| request_width(fields) == width)
    }

    fn whole(
        &self,
        address: Address,
        command: &'static Command,
        fields: &'static [Field],
        packet: RawBytes,
        width: usize,
    ) -> Verdict {
        let Some(form) = command.form(self.generation) else {
            return Verdict::Foreign(command);
        };
        let payload = packet.get(HEAD..HEAD + width).unwrap_or_default();
        match parse_payload(fields, payload) {
            Some(values) => {
                let native = std::ptr::eq(form.request, fields);
                Verdict::Request(Framed { address, command, values, native, raw: packet })
            }
            None => Verdict::Skip(DiscardReason::BadCrc),
        }
    }
}

/// Whether the command is a read or a write here; where this generation lacks it, in the latest that has it.
fn direction(command: &Command, generation: Generation) -> Option<Direction> {
    command.form(generation).or(command.forms.last()).map(|form| form.direction)
}

/// The bytes of a packet, kept in place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct RawBytes {
    bytes: [u8; Self::CAPACITY],
    length: u8,
}

impl RawBytes {
    /// How many it can hold; further ones are dropped.
    pub const CAPACITY: usize = 64;

    const EMPTY: Self = Self { bytes: [0; Self::CAPACITY], length: 0 };

    fn without_first(&self) -> Self {
        let mut rest = Self::EMPTY;
        for byte in self.iter().skip(1) {
            rest.push(*byte);
        }
        rest
    }

    fn push(&mut self, byte: u8) {
        if let Some(slot) = self.bytes.get_mut(usize::from(self.length)) {
            *slot = byte;
            self.length += 1;
        }
    }
}

impl Default for RawBytes {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Deref for RawBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.length)).unwrap_or_default()
    }
}

impl fmt::Debug for RawBytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02X?}", &**self)
    }
}

#[cfg(test)]
mod tests;

//! Packet serial over an exchange: a command and its values out, named values back.
//!
//! Two gates stand here, since every packet passes: what can move a motor needs arming, and what is a guess about the
//! wire goes to simulated controllers only.

use crate::messages::McpCauseMessage;
use crate::{firmware_of, packet_address, unit_address};
use brushwork_link::exchange::{
    Exchange, ExchangeError, Fault, Judgement, Outgoing, Permit, RETRIES, Reply, Unwatched, Watch,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::wire::{HiddenSettings, Wire};
use brushwork_mcp_wire::packet_serial::{
    Address, ClientUse, Command, Direction, Effect, EncodeError, Form, Generation, Read, Reply as ReplyForm,
    ReplyProgress, Request, Typed, parse_reply,
};
use brushwork_values::{Value, Values};
use std::sync::Arc;
use std::time::Duration;

/// Extra time for commands that write or restore memory before they answer. Assumed: the time of a save is not public;
/// the vendor's libraries wait for 94 no longer than for others, and 95 after it went unanswered on a real unit.
const MEMORY_PATIENCE: Duration = Duration::from_millis(500);
/// Extra time for the second byte of the script commands (public clients, 2015-2019: the library waits 2 to 5 s).
const STATUS_PATIENCE: Duration = Duration::from_secs(6);

/// One packet to send.
#[derive(Clone, Copy, Debug)]
pub struct Ask<'a> {
    /// Address, command and values.
    pub request: &'a Request,
    /// The generation that decides the widths.
    pub generation: Generation,
    /// What may go out at all.
    pub permit: Permit,
    /// How often to try again; commands that must not be repeated are not, whatever this says.
    pub retries: u32,
}

/// A reply as that to a command whose fields the compiler knows.
pub fn typed_reply<const LAYOUT: u8>(
    reply: Reply,
    command: Typed<LAYOUT>,
) -> Result<Reply<Read<LAYOUT>>, ExchangeError> {
    Ok(Reply { values: typed(command, reply.values)?, span: reply.span })
}

/// Values as those of the reply to `command`.
pub fn typed<const LAYOUT: u8>(
    command: Typed<LAYOUT>,
    values: Values,
) -> Result<Read<LAYOUT>, ExchangeError> {
    command
        .reply(values)
        .ok_or_else(|| ExchangeError::impossible(McpCauseMessage::OtherValues { command: command.number() }))
}

/// Commands of packet serial whose fields the compiler knows, on every [`Wire`].
pub trait TypedWire: Wire {
    /// As [`Wire::transact`].
    fn ask<const LAYOUT: u8>(
        &mut self,
        command: Typed<LAYOUT>,
        values: &[i64],
    ) -> Result<Read<LAYOUT>, ExchangeError> {
        typed(command, self.transact(command.number(), values)?)
    }
}

impl<W: Wire + ?Sized> TypedWire for W {}

/// Whether a packet may go out, and what it does. Asked before anything is written.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn gate(ask: &Ask<'_>) -> Result<&'static Form, ExchangeError> {
    let command = ask.request.command;
    let unsupported =
        |name: String| ExchangeError::Unsupported { command: name, generation: firmware_of(ask.generation) };
    let row = ask.request.row().ok_or_else(|| unsupported(command.to_string()))?;
    let form = row.form(ask.generation).ok_or_else(|| unsupported(format!("{command} ({})", row.title)))?;
    let title = || row.title(ask.generation).to_owned();
    if let Some(why) = guess(row, form).filter(|_| !ask.permit.guesses) {
        return Err(ExchangeError::Unproven { command: title(), why });
    }
    if form.effect == Effect::Loader && !ask.permit.loader {
        return Err(ExchangeError::impossible(McpCauseMessage::LoaderByUpdate));
    }
    let permitted = match form.effect {
        Effect::Script => ask.permit.script,
        effect => !effect.may_move() || ask.permit.motion,
    };
    if permitted { Ok(form) } else { Err(ExchangeError::NotArmed { command: title() }) }
}

/// Sends a packet and decodes its reply.
pub fn transact(exchange: &mut Exchange, watch: &dyn Watch, ask: &Ask<'_>) -> Result<Reply, ExchangeError> {
    let form = gate(ask)?;
    let bytes = ask.request.encode(ask.generation).map_err(|source| encode_error(&source))?;
    let outgoing = Outgoing {
        bytes: &bytes,
        reply_length: form.reply.most_bytes(),
        patience: patience(form),
        retries: ask.retries,
        once: !form.effect.may_be_repeated(),
    };
    let mut values = Values::default();
    let span = exchange.exchange(&outgoing, watch, &mut |bytes| {
        judge(parse_reply(ask.request, ask.generation, bytes), bytes.len(), &mut values)
    })?;
    if matches!(form.reply, ReplyForm::Data(_)) {
        exchange.is_in_step(&bytes);
    }
    Ok(Reply { values, span })
}

/// Packet serial to one unit with nothing else on the line: for tests and for tools that need no device thread. It never
/// moves a motor.
pub struct PacketWire {
    exchange: Exchange,
    address: Address,
    generation: Generation,
    simulated: bool,
    hidden: Option<Arc<dyn HiddenSettings>>,
}

impl PacketWire {
    /// Speaks to the unit at `address`, whose firmware is of `generation`.
    #[must_use]
    pub fn new(exchange: Exchange, address: Address, generation: Generation, simulated: bool) -> Self {
        Self { exchange, address, generation, simulated, hidden: None }
    }

    /// The same with the settings that a simulated controller has past the wire.
    #[must_use]
    pub fn with_hidden(mut self, hidden: Arc<dyn HiddenSettings>) -> Self {
        self.hidden = Some(hidden);
        self
    }

    /// The exchange underneath, for its statistics.
    pub fn exchange(&mut self) -> &mut Exchange {
        &mut self.exchange
    }
}

impl Wire for PacketWire {
    fn transact_values(&mut self, command: u8, values: Vec<Value>) -> Result<Values, ExchangeError> {
        let request = Request { address: self.address, command, values };
        let permit = Permit { guesses: self.simulated, ..Permit::default() };
        let ask = Ask { request: &request, generation: self.generation, permit, retries: RETRIES };
        transact(&mut self.exchange, &Unwatched, &ask).map(|reply| reply.values)
    }

    fn address(&self) -> UnitAddress {
        unit_address(self.address)
    }

    fn generation(&self) -> FirmwareGeneration {
        firmware_of(self.generation)
    }

    fn is_simulated(&self) -> bool {
        self.simulated
    }

    fn now(&self) -> Duration {
        self.exchange.clock().now()
    }

    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError> {
        self.exchange.wait(time, &Unwatched)
    }

    fn port(&self) -> String {
        self.exchange.port()
    }

    fn set_address(&mut self, address: UnitAddress) -> bool {
        let Some(address) = packet_address(address) else { return false };
        self.address = address;
        true
    }

    fn hidden_settings(&self) -> Option<&dyn HiddenSettings> {
        self.hidden.as_deref()
    }
}

/// Why a form is a guess, if it is one.
fn guess(row: &Command, form: &Form) -> Option<String> {
    match row.client {
        ClientUse::Never(why) => Some(why.to_owned()),
        ClientUse::Sends | ClientUse::Superseded(_) => form.assumed.map(str::to_owned),
    }
}

fn patience(form: &Form) -> Duration {
    match (form.reply, form.effect) {
        (ReplyForm::AckThenStatus(_), _) => STATUS_PATIENCE,
        (_, Effect::Memory) if form.direction == Direction::Write => MEMORY_PATIENCE,
        _ => Duration::ZERO,
    }
}

/// Values that do not fit a command.
pub(crate) fn encode_error(source: &EncodeError) -> ExchangeError {
    ExchangeError::Encode { why: source.to_string() }
}

fn judge(progress: ReplyProgress, received: usize, values: &mut Values) -> Judgement {
    match progress {
        ReplyProgress::NeedMore { at_least } => Judgement::More(at_least.saturating_sub(received).max(1)),
        ReplyProgress::Done { values: done, used } => {
            *values = done;
            Judgement::Good(used)
        }
        ReplyProgress::BadCrc { expected, got, .. } => Judgement::Bad(Fault::Crc { expected, got }),
        ReplyProgress::BadAck { got } => Judgement::Bad(Fault::Acknowledgement(got)),
        ReplyProgress::Malformed { what } => Judgement::Bad(Fault::Malformed(what.to_owned())),
    }
}

//! A packet serial command as accesses to its object.

use crate::can::access::{read, run, write};
use crate::can::place::Place;
use crate::packet::{Ask, encode_error, gate};
use brushwork_canopen::sdo::Transfer;
use brushwork_link::device::controller::Line;
use brushwork_link::exchange::Reply;
use brushwork_link::exchange::{ExchangeError, Span};
use brushwork_mcp_wire::canopen::objects::{
    LIST_CONTROL, Shape, TEXT, TRIGGER, index_of, raw_of, record_subindex_of, shape, subindex_of,
};
use brushwork_mcp_wire::packet_serial::{Direction, Effect, Form};
use brushwork_values::{Field, Value, Values};
use std::time::Duration;

/// Extra time for what works on the memory that keeps settings.
const MEMORY_PATIENCE: Duration = Duration::from_millis(500);
/// Bytes in front of a packet's arguments, and those of its CRC.
const PACKET_HEAD: usize = 2;

/// Carries a command out and gives back what it returns.
pub fn carry_out(line: &mut Line<'_>, place: Place, ask: &Ask<'_>) -> Result<Reply, ExchangeError> {
    let form = gate(ask)?;
    let Some(shape) = shape(form) else {
        let what = "the command has no object on the CAN bus".to_owned();
        return Err(ExchangeError::Refused { what, is_absent: true });
    };
    let index = index_of(ask.request.command);
    if form.direction == Direction::Read {
        return Reader { line, place, index, span: None }.read(shape, form);
    }
    // The packet's own encoder checks the values and fills in keys.
    let packet = ask.request.encode(ask.generation).map_err(|source| encode_error(&source))?;
    let arguments = packet.get(PACKET_HEAD..).unwrap_or_default();
    let span = act(line, place, index, shape, form, arguments)?;
    Ok(Reply { values: Values::default(), span })
}

/// Whether a node has an object's part, and how wide its value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probe {
    /// It has a value of this many bytes.
    Wide(usize),
    /// It has the object but not this part of it, or not even that.
    Absent,
}

/// Looks at one part of a command's object.
pub fn probe(line: &mut Line<'_>, place: Place, command: u8, subindex: u8) -> Result<Probe, ExchangeError> {
    match read(line, place, index_of(command), subindex) {
        Ok((value, _)) => Ok(Probe::Wide(value.len())),
        Err(ExchangeError::Refused { .. }) => Ok(Probe::Absent),
        Err(error) => Err(error),
    }
}

/// Writes the arguments, the last of which carries the command out.
fn act(
    line: &mut Line<'_>,
    place: Place,
    index: u16,
    shape: Shape,
    form: &Form,
    arguments: &[u8],
) -> Result<Span, ExchangeError> {
    let once = !form.effect.may_be_repeated();
    let patience = if form.effect == Effect::Memory { MEMORY_PATIENCE } else { Duration::ZERO };
    let fields: &[Field] = match shape {
        Shape::Several(fields) => fields,
        Shape::Single(field) => std::slice::from_ref(field),
        Shape::Trigger | Shape::Text | Shape::List(_) => &[],
    };
    let [before @ .., last] = fields else {
        let transfer = Transfer::download(index, 0, &TRIGGER);
        return run(line, place, &transfer, once, patience).map(|(_, span)| span);
    };
    let mut rest = arguments;
    let mut begun_at = None;
    for (at, field) in before.iter().enumerate() {
        let span = write(line, place, index, subindex_of(at), &little_endian(field, &mut rest))?;
        begun_at.get_or_insert(span.requested_at);
    }
    let subindex = if before.is_empty() { 0 } else { subindex_of(before.len()) };
    let transfer = Transfer::download(index, subindex, &little_endian(last, &mut rest));
    let (_, span) = run(line, place, &transfer, once, patience)?;
    Ok(Span { requested_at: begun_at.unwrap_or(span.requested_at), ..span })
}

/// Takes a field off the front of a packet's arguments and turns its bytes round.
fn little_endian(field: &Field, arguments: &mut &[u8]) -> Vec<u8> {
    let width = field.kind.width().unwrap_or(0).min(arguments.len());
    let (mine, rest) = arguments.split_at(width);
    *arguments = rest;
    mine.iter().rev().copied().collect()
}

/// Reads an object part by part.
struct Reader<'a, 'l> {
    line: &'a mut Line<'l>,
    place: Place,
    index: u16,
    span: Option<Span>,
}

impl Reader<'_, '_> {
    fn read(mut self, shape: Shape, form: &Form) -> Result<Reply, ExchangeError> {
        let values = match shape {
            Shape::Single(field) => vec![Value::Int(self.number(field, 0)?)],
            Shape::Several(fields) => {
                let numbers =
                    fields.iter().enumerate().map(|(at, field)| self.number(field, subindex_of(at)));
                numbers.map(|number| number.map(Value::Int)).collect::<Result<_, _>>()?
            }
            Shape::Text => {
                let bytes = self.bytes(TEXT)?;
                vec![Value::Text(String::from_utf8_lossy(&bytes).trim_end().to_owned())]
            }
            Shape::List(fields) => vec![Value::Records(self.records(fields)?)],
            Shape::Trigger => Vec::new(),
        };
        let now = self.line.exchange().clock().now();
        let span = self.span.unwrap_or(Span { requested_at: now, replied_at: now });
        Ok(Reply { values: Values::new(form.reply.fields(), values), span })
    }

    fn records(&mut self, fields: &'static [Field]) -> Result<Vec<Vec<i64>>, ExchangeError> {
        let count = self.bytes(LIST_CONTROL)?.first().copied().unwrap_or(0);
        let mut records = Vec::new();
        for record in 0..count {
            let span = write(self.line, self.place, self.index, LIST_CONTROL, &[record])?;
            self.note(span);
            let numbers =
                fields.iter().enumerate().map(|(at, field)| self.number(field, record_subindex_of(at)));
            records.push(numbers.collect::<Result<_, _>>()?);
        }
        Ok(records)
    }

    fn number(&mut self, field: &Field, subindex: u8) -> Result<i64, ExchangeError> {
        let bytes = self.bytes(subindex)?;
        raw_of(field, &bytes).ok_or_else(|| ExchangeError::Malformed {
            what: format!("{} bytes came for \"{}\"", bytes.len(), field.name),
            tries: brushwork_link::exchange::Tries(1),
        })
    }

    fn bytes(&mut self, subindex: u8) -> Result<Vec<u8>, ExchangeError> {
        let (bytes, span) = read(self.line, self.place, self.index, subindex)?;
        self.note(span);
        Ok(bytes)
    }

    fn note(&mut self, span: Span) {
        let requested_at = self.span.map_or(span.requested_at, |earlier| earlier.requested_at);
        self.span = Some(Span { requested_at, ..span });
    }
}

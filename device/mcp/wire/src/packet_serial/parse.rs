//! Bytes into values, for both ends of the wire. Nothing here panics, whatever comes.

use super::command::Reply;
use super::encode::{ACK, reply_crc};
use super::identity::Generation;
use super::request::{Request, form_of};
use crate::crc::{Crc16, crc16_xmodem};
use brushwork_values::{Field, Kind, SERIAL_BYTES};
use brushwork_values::{Value, Values};

/// What the bytes that have come so far make of a reply.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplyProgress {
    /// Not whole yet.
    NeedMore {
        /// Bytes, counted from the start of the reply, without which nothing more can be said.
        at_least: usize,
    },
    /// Whole and right.
    Done {
        /// What it says; none for an acknowledgement.
        values: Values,
        /// Bytes it took. Any beyond are not part of it.
        used: usize,
    },
    /// Whole, with a CRC that does not fit: damaged, from another unit, or of another generation.
    BadCrc {
        /// The CRC of what came.
        expected: u16,
        /// The CRC that came.
        got: u16,
        /// Bytes it took.
        used: usize,
    },
    /// A write was answered with another byte than 0xFF.
    BadAck {
        /// The byte.
        got: u8,
    },
    /// It cannot be a reply to this request.
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
}

/// Reads the reply of a controller of `generation` to `request` from the bytes that have come since it was sent.
pub fn parse_reply(request: &Request, generation: Generation, bytes: &[u8]) -> ReplyProgress {
    let Ok(form) = form_of(request.command, generation) else {
        return ReplyProgress::Malformed { what: "the generation does not have this command" };
    };
    match form.reply {
        Reply::Data(fields) => match reply_crc(request, form) {
            Ok(crc) => parse_data(fields, bytes, 0, crc),
            Err(_) => ReplyProgress::Malformed { what: "the request itself cannot be encoded" },
        },
        Reply::Ack => after_ack(bytes, || ReplyProgress::Done { values: Values::default(), used: 1 }),
        Reply::AckThenStatus(fields) => after_ack(bytes, || match take_all(fields, bytes, 1) {
            Taken::Values(values, used) => ReplyProgress::Done { values: Values::new(fields, values), used },
            Taken::NeedMore(at_least) => ReplyProgress::NeedMore { at_least },
            Taken::Malformed(what) => ReplyProgress::Malformed { what },
        }),
        Reply::AckThenData(fields) => after_ack(bytes, || parse_data(fields, bytes, 1, Crc16::new())),
    }
}

/// The values of a payload that has the layout `fields`, whose width is fixed; `None` if it is shorter.
pub(super) fn parse_payload(fields: &'static [Field], payload: &[u8]) -> Option<Values> {
    match take_all(fields, payload, 0) {
        Taken::Values(values, _) => Some(Values::new(fields, values)),
        Taken::NeedMore(_) | Taken::Malformed(_) => None,
    }
}

fn after_ack(bytes: &[u8], then: impl FnOnce() -> ReplyProgress) -> ReplyProgress {
    match bytes.first() {
        None => ReplyProgress::NeedMore { at_least: 1 },
        Some(&ACK) => then(),
        Some(&got) => ReplyProgress::BadAck { got },
    }
}

/// Fields from `start` on, then a CRC that continues `crc` over them.
fn parse_data(fields: &'static [Field], bytes: &[u8], start: usize, mut crc: Crc16) -> ReplyProgress {
    let (values, end) = match take_all(fields, bytes, start) {
        Taken::Values(values, end) => (values, end),
        Taken::NeedMore(at_least) => return ReplyProgress::NeedMore { at_least: at_least + 2 },
        Taken::Malformed(what) => return ReplyProgress::Malformed { what },
    };
    let used = end + 2;
    let (Some(data), Some(&[high, low])) = (bytes.get(start..end), bytes.get(end..used)) else {
        return ReplyProgress::NeedMore { at_least: used };
    };
    crc.update(data);
    let got = u16::from_be_bytes([high, low]);
    if crc.value() == got {
        ReplyProgress::Done { values: Values::new(fields, values), used }
    } else {
        ReplyProgress::BadCrc { expected: crc.value(), got, used }
    }
}

enum Taken {
    Values(Vec<Value>, usize),
    /// Bytes needed, counted from the start of `bytes`.
    NeedMore(usize),
    Malformed(&'static str),
}

fn take_all(fields: &[Field], bytes: &[u8], start: usize) -> Taken {
    let mut values = Vec::with_capacity(fields.len());
    let mut at = start;
    for (index, field) in fields.iter().enumerate() {
        // What follows a field of open width has at least the width of its fixed fields.
        match take(&field.kind, bytes, at) {
            Ok((value, next)) => {
                values.push(value);
                at = next;
            }
            Err(Stop::NeedMore(at_least)) => {
                return Taken::NeedMore(at_least + fixed_width(&fields[index + 1..]));
            }
            Err(Stop::Malformed(what)) => return Taken::Malformed(what),
        }
    }
    Taken::Values(values, at)
}

fn fixed_width(fields: &[Field]) -> usize {
    fields.iter().filter_map(|field| field.kind.width()).sum()
}

enum Stop {
    NeedMore(usize),
    Malformed(&'static str),
}

fn take(kind: &Kind, bytes: &[u8], at: usize) -> Result<(Value, usize), Stop> {
    let run = |width: usize| bytes.get(at..at + width).ok_or(Stop::NeedMore(at + width));
    match kind {
        Kind::Text { max } => take_text(bytes, at, *max),
        Kind::Counted(fields) => take_records(fields, bytes, at),
        Kind::Bytes(count) => Ok((Value::Bytes(run(*count)?.to_vec()), at + count)),
        Kind::Ascii36 => Ok((Value::Text(ascii(run(1 + SERIAL_BYTES)?)), at + 1 + SERIAL_BYTES)),
        Kind::Utf16Le36 => Ok((Value::Text(utf16(run(1 + SERIAL_BYTES)?)), at + 1 + SERIAL_BYTES)),
        Kind::U8 | Kind::I8 | Kind::U16 | Kind::I16 | Kind::U24 | Kind::U32 | Kind::I32 => {
            let width = kind.width().unwrap_or(0);
            Ok((Value::Int(int(run(width)?, kind.is_signed())), at + width))
        }
    }
}

fn take_text(bytes: &[u8], at: usize, max: usize) -> Result<(Value, usize), Stop> {
    let rest = bytes.get(at..).unwrap_or_default();
    let Some(length) = rest.iter().take(max).position(|&byte| byte == 0) else {
        return if rest.len() >= max {
            Err(Stop::Malformed("the text has no end mark"))
        } else {
            Err(Stop::NeedMore(bytes.len() + 1))
        };
    };
    let text = &rest[..length];
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    Ok((Value::Text(String::from_utf8_lossy(text).into_owned()), at + length + 1))
}

fn take_records(fields: &[Field], bytes: &[u8], at: usize) -> Result<(Value, usize), Stop> {
    let count = usize::from(*bytes.get(at).ok_or(Stop::NeedMore(at + 1))?);
    let width = fixed_width(fields);
    let end = at + 1 + count * width;
    let body = bytes.get(at + 1..end).ok_or(Stop::NeedMore(end))?;
    let records = body.chunks_exact(width.max(1)).map(|record| record_ints(fields, record)).collect();
    Ok((Value::Records(records), end))
}

fn record_ints(fields: &[Field], mut record: &[u8]) -> Vec<i64> {
    let ints = fields.iter().map(|field| {
        let (head, tail) = record.split_at_checked(field.kind.width().unwrap_or(0)).unwrap_or((record, &[]));
        record = tail;
        int(head, field.kind.is_signed())
    });
    ints.collect()
}

fn int(bytes: &[u8], signed: bool) -> i64 {
    let start = if signed && bytes.first().is_some_and(|byte| byte & 0x80 != 0) { -1 } else { 0 };
    bytes.iter().fold(start, |value, &byte| (value << 8) | i64::from(byte))
}

/// The text behind a length byte. A length beyond the field counts as the whole field.
fn ascii(run: &[u8]) -> String {
    let content = content(run);
    let end = content.iter().position(|&byte| byte == 0).unwrap_or(content.len());
    String::from_utf8_lossy(&content[..end]).into_owned()
}

fn utf16(run: &[u8]) -> String {
    let units = content(run).chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    let units: Vec<u16> = units.take_while(|&unit| unit != 0).collect();
    String::from_utf16_lossy(&units)
}

fn content(run: &[u8]) -> &[u8] {
    let (length, content) =
        run.split_first().map_or((0, run), |(length, content)| (usize::from(*length), content));
    content.get(..length).unwrap_or(content)
}

/// The CRC at the end of a packet and the one that its bytes have; `None` if it is shorter than a CRC.
pub(super) fn packet_crc(packet: &[u8]) -> Option<(u16, u16)> {
    let (body, crc) = packet.split_last_chunk::<2>()?;
    Some((u16::from_be_bytes(*crc), crc16_xmodem(body)))
}

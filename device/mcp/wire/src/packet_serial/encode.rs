//! Values into bytes, for both ends of the wire.

use super::command::{Direction, Form, Reply};
use super::encode_error::EncodeError;
use super::identity::Generation;
use super::request::{Request, form_of};
use crate::crc::Crc16;
use brushwork_values::{Field, Kind, SERIAL_BYTES, Value, Values};

/// The answer to a write (MCP manual 2.2.5).
pub const ACK: u8 = 0xFF;

/// The one byte that answers a write.
pub const fn encode_ack() -> [u8; 1] {
    [ACK]
}

/// The whole reply of a controller of `generation` to `request`: acknowledgement, data and CRC as its form has them.
/// For [`Reply::Ack`] no values are taken; [`Reply::AckThenStatus`] gives both bytes at once, and a controller that
/// needs time between them splits the two.
///
/// # Errors
/// If the generation does not have the command, or the values do not fit its layout.
pub fn encode_reply(
    request: &Request,
    generation: Generation,
    values: &[Value],
) -> Result<Vec<u8>, EncodeError> {
    let form = form_of(request.command, generation)?;
    let fields = form.reply.fields();
    if values.len() != fields.len() {
        return Err(EncodeError::WrongCount {
            command: request.command,
            expected: fields.len(),
            got: values.len(),
        });
    }
    let mut data = Vec::with_capacity(32);
    for (field, value) in fields.iter().zip(values) {
        put(&mut data, request.command, field, value)?;
    }
    match form.reply {
        Reply::Ack => Ok(vec![ACK]),
        Reply::AckThenStatus(_) => Ok(with_ack(&data)),
        Reply::AckThenData(_) => {
            let mut crc = Crc16::new();
            crc.update(&data);
            data.extend(crc.value().to_be_bytes());
            Ok(with_ack(&data))
        }
        Reply::Data(_) => {
            let mut crc = reply_crc(request, form)?;
            crc.update(&data);
            data.extend(crc.value().to_be_bytes());
            Ok(data)
        }
    }
}

/// As [`encode_reply`], with each value asked for by the name of its field, so that one source of values serves the
/// layouts of all generations.
///
/// # Errors
/// As [`encode_reply`], and if `value_of` has no value for a field of the layout.
pub fn encode_reply_named(
    request: &Request,
    generation: Generation,
    mut value_of: impl FnMut(&'static str) -> Option<Value>,
) -> Result<Vec<u8>, EncodeError> {
    let form = form_of(request.command, generation)?;
    let values = form
        .reply
        .fields()
        .iter()
        .map(|field| {
            value_of(field.name)
                .ok_or(EncodeError::MissingValue { command: request.command, field: field.name })
        })
        .collect::<Result<Vec<_>, _>>()?;
    encode_reply(request, generation, &values)
}

impl Request {
    /// The arguments with their names, keys filled in.
    ///
    /// # Errors
    /// As [`Request::encode`].
    pub fn arguments(&self, generation: Generation) -> Result<Values, EncodeError> {
        let form = form_of(self.command, generation)?;
        Ok(Values::new(form.request, request_values(self, form)?))
    }

    /// The bytes on the wire: with CRC for a write, without for a read.
    ///
    /// # Errors
    /// If the generation does not have the command, or the values do not fit its layout.
    pub fn encode(&self, generation: Generation) -> Result<Vec<u8>, EncodeError> {
        encode_request(self, form_of(self.command, generation)?)
    }
}

/// The CRC that a reply's data continues: over address, command and arguments.
pub(super) fn reply_crc(request: &Request, form: &Form) -> Result<Crc16, EncodeError> {
    let mut crc = Crc16::new();
    crc.update(&header_and_arguments(request, form)?);
    Ok(crc)
}

/// The bytes of a request in the layout of `form`.
pub(super) fn encode_request(request: &Request, form: &Form) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = header_and_arguments(request, form)?;
    if form.direction == Direction::Write {
        let mut crc = Crc16::new();
        crc.update(&bytes);
        bytes.extend(crc.value().to_be_bytes());
    }
    Ok(bytes)
}

/// The request's values in the layout of `form`, with constants that were left out filled in.
pub(super) fn request_values(request: &Request, form: &Form) -> Result<Vec<Value>, EncodeError> {
    let fields = form.request;
    let free = fields.iter().filter(|field| field.fixed.is_none()).count();
    let given = request.values.len();
    if given == fields.len() {
        return Ok(request.values.clone());
    }
    if given != free {
        return Err(EncodeError::WrongCount { command: request.command, expected: free, got: given });
    }
    let mut given = request.values.iter().cloned();
    let filled = fields.iter().map(|field| field.fixed.map(Value::Int).or_else(|| given.next()));
    Ok(filled.flatten().collect())
}

fn header_and_arguments(request: &Request, form: &Form) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::with_capacity(form.payload_width() + 4);
    bytes.extend([request.address.get(), request.command]);
    for (field, value) in form.request.iter().zip(&request_values(request, form)?) {
        put(&mut bytes, request.command, field, value)?;
    }
    Ok(bytes)
}

fn with_ack(data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(data.len() + 1);
    bytes.push(ACK);
    bytes.extend(data);
    bytes
}

fn put(bytes: &mut Vec<u8>, command: u8, field: &Field, value: &Value) -> Result<(), EncodeError> {
    let wrong = |what| EncodeError::WrongKind { command, field: field.name, what };
    match (&field.kind, value) {
        (Kind::Text { max }, Value::Text(text)) => put_text(bytes, text, *max).map_err(wrong),
        (Kind::Ascii36, Value::Text(text)) => put_ascii36(bytes, text).map_err(wrong),
        (Kind::Utf16Le36, Value::Text(text)) => put_utf16(bytes, text).map_err(wrong),
        (Kind::Bytes(count), Value::Bytes(given)) if given.len() == *count => {
            bytes.extend(given);
            Ok(())
        }
        (Kind::Bytes(_), Value::Bytes(_)) => Err(wrong("another number of bytes")),
        (Kind::Counted(fields), Value::Records(records)) => {
            put_records(bytes, command, field, fields, records)
        }
        (_, Value::Int(value)) => put_int(bytes, command, field, *value),
        _ => Err(wrong("a value of another kind")),
    }
}

fn put_int(bytes: &mut Vec<u8>, command: u8, field: &Field, value: i64) -> Result<(), EncodeError> {
    let what = "a number where the field takes none";
    let (Some((low, high)), Some(width)) = (field.kind.limits(), field.kind.width()) else {
        return Err(EncodeError::WrongKind { command, field: field.name, what });
    };
    if value < low || value > high {
        return Err(EncodeError::OutOfRange { command, field: field.name, value, low, high });
    }
    bytes.extend(value.to_be_bytes().iter().skip(8 - width));
    Ok(())
}

fn put_records(
    bytes: &mut Vec<u8>,
    command: u8,
    field: &Field,
    fields: &[Field],
    records: &[Vec<i64>],
) -> Result<(), EncodeError> {
    let wrong = |what| EncodeError::WrongKind { command, field: field.name, what };
    let count = u8::try_from(records.len()).map_err(|_| wrong("more than 255 records"))?;
    bytes.push(count);
    for record in records {
        if record.len() != fields.len() {
            return Err(wrong("a record with another number of values"));
        }
        for (field, value) in fields.iter().zip(record) {
            put_int(bytes, command, field, *value)?;
        }
    }
    Ok(())
}

fn put_text(bytes: &mut Vec<u8>, text: &str, max: usize) -> Result<(), &'static str> {
    if text.len() + 2 > max {
        return Err("longer than the field");
    }
    if text.contains('\0') {
        return Err("text that holds its own end mark");
    }
    bytes.extend(text.as_bytes());
    bytes.extend([0x0A, 0x00]);
    Ok(())
}

fn put_ascii36(bytes: &mut Vec<u8>, text: &str) -> Result<(), &'static str> {
    if !text.is_ascii() {
        return Err("only ASCII fits");
    }
    put_padded(bytes, text.as_bytes())
}

fn put_utf16(bytes: &mut Vec<u8>, text: &str) -> Result<(), &'static str> {
    let encoded: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    put_padded(bytes, &encoded)
}

fn put_padded(bytes: &mut Vec<u8>, content: &[u8]) -> Result<(), &'static str> {
    let padding = SERIAL_BYTES.checked_sub(content.len()).ok_or("longer than 36 bytes")?;
    bytes.push(content.len() as u8);
    bytes.extend(content);
    bytes.extend(std::iter::repeat_n(0, padding));
    Ok(())
}

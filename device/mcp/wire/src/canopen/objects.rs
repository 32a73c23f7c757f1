//! The objects under which the controllers of the MCP family offer their packet serial commands (public clients, 2015-2020).
//!
//! Index 0x2000 + command. One argument or one value lies at subindex 0, several lie at subindexes 1 and up; a command without
//! arguments is carried out by writing a byte 0 to subindex 0. Lists have their count at subindex 1; a record is chosen by writing its
//! number there, and its fields are read from subindex 2 on. The version (0x2015) is a string at subindex 1.
//!
//! Assumed: each object is as wide as the field is in packet serial, low byte first; a command with several arguments is carried
//! out when the last of them is written; several values belong together when subindex 1 is read first; records count from 0.
//! Scripts cannot be loaded and the loader cannot be entered this way.

use crate::packet_serial::{Direction, Effect, Form, Reply};
use brushwork_values::{Field, Kind};

/// Index of the object that stands for packet serial command 0.
pub const COMMAND_OBJECTS: u16 = 0x2000;
/// The byte that carries out a command without arguments.
pub const TRIGGER: [u8; 1] = [0];
/// Subindex of a list's count and of the number of the record that is chosen.
pub const LIST_CONTROL: u8 = 1;
/// Subindex of a text.
pub const TEXT: u8 = 1;

/// How the values of a command lie in its object.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Nothing but the act itself.
    Trigger,
    /// One value at subindex 0.
    Single(&'static Field),
    /// Several values from subindex 1 on.
    Several(&'static [Field]),
    /// A text at subindex 1.
    Text,
    /// A count and a chosen record at subindex 1, the record's fields from subindex 2 on.
    List(&'static [Field]),
}

/// The object of a command.
#[must_use]
pub const fn index_of(command: u8) -> u16 {
    COMMAND_OBJECTS + command as u16
}

/// The command of an object.
#[must_use]
pub fn command_of(index: u16) -> Option<u8> {
    u8::try_from(index.checked_sub(COMMAND_OBJECTS)?).ok()
}

/// Where a field of a shape of several lies, counted from 0.
#[must_use]
pub fn subindex_of(field: usize) -> u8 {
    u8::try_from(field + 1).unwrap_or(u8::MAX)
}

/// Where a field of a list's record lies, counted from 0.
#[must_use]
pub fn record_subindex_of(field: usize) -> u8 {
    u8::try_from(field + 2).unwrap_or(u8::MAX)
}

/// How a command's object is used; `None` where it has none: what needs arguments to be read, long blocks of bytes, script download, the
/// loader, and the bus itself.
#[must_use]
pub fn shape(form: &Form) -> Option<Shape> {
    if matches!(form.effect, Effect::Loader | Effect::Bus) {
        return None;
    }
    match (form.direction, &form.reply) {
        (Direction::Write, Reply::Ack) => match form.request {
            [] => Some(Shape::Trigger),
            [field] => is_number(field).then_some(Shape::Single(field)),
            fields => fields.iter().all(is_number).then_some(Shape::Several(fields)),
        },
        (Direction::Read, Reply::Data(fields)) if form.request.is_empty() => read_shape(fields),
        _ => None,
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn read_shape(fields: &'static [Field]) -> Option<Shape> {
    match fields {
        [field] => match field.kind {
            Kind::Text { .. } => Some(Shape::Text),
            Kind::Counted(record) => Some(Shape::List(record)),
            _ => is_number(field).then_some(Shape::Single(field)),
        },
        [] => None,
        fields => fields.iter().all(is_number).then_some(Shape::Several(fields)),
    }
}

/// A raw value as an object holds it; `None` for a field that is no number.
#[must_use]
pub fn bytes_of(field: &Field, raw: i64) -> Option<Vec<u8>> {
    let width = number_width(field)?;
    raw.to_le_bytes().get(..width).map(<[u8]>::to_vec)
}

/// The raw value in an object's bytes; `None` when their number is not that of the field.
#[must_use]
pub fn raw_of(field: &Field, bytes: &[u8]) -> Option<i64> {
    let width = number_width(field)?;
    if bytes.len() != width {
        return None;
    }
    let mut wide = [0; 8];
    wide[..width].copy_from_slice(bytes);
    let raw = i64::from_le_bytes(wide);
    let unused = 64 - 8 * width;
    Some(if field.kind.is_signed() { raw << unused >> unused } else { raw })
}

fn number_width(field: &Field) -> Option<usize> {
    if is_number(field) { field.kind.width() } else { None }
}

/// Whether it is a plain number of a fixed width.
fn is_number(field: &Field) -> bool {
    field.kind.limits().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet_serial::{COMMANDS, Generation, lookup, number};

    fn form(command: u8) -> &'static Form {
        lookup(command).unwrap().form(Generation::Gen4).unwrap()
    }

    #[test]
    fn the_map_is_that_of_the_vendors_library() {
        assert_eq!(index_of(number::READ_VERSION), 0x2015);
        assert!(matches!(shape(form(number::READ_VERSION)), Some(Shape::Text)));
        assert_eq!(index_of(number::READ_MAIN_BATTERY), 0x2018);
        assert!(matches!(shape(form(number::READ_MAIN_BATTERY)), Some(Shape::Single(_))));
        assert!(matches!(shape(form(number::RESET_ENCODERS)), Some(Shape::Trigger)));
        assert!(
            matches!(shape(form(number::DUTY_ACCEL_BOTH)), Some(Shape::Several(fields)) if fields.len() == 4)
        );
        assert!(matches!(shape(form(number::READ_STREAMS)), Some(Shape::List(_))));
        assert_eq!(command_of(0x2015), Some(21));
        assert_eq!((command_of(0x1018), command_of(0x2100)), (None, None));
    }

    #[test]
    fn script_download_the_loader_and_the_bus_have_no_object() {
        for command in
            [number::ERASE_SCRIPT, number::WRITE_SCRIPT, number::ENTER_LOADER, number::PUT_CAN_PACKET]
        {
            assert!(shape(form(command)).is_none(), "{command}");
        }
    }

    #[test]
    fn numbers_lie_low_byte_first_and_keep_their_sign() {
        // Command 32, duty -2: FE FF.
        let duty = &form(number::DUTY_M1).request[0];
        assert_eq!(bytes_of(duty, -2), Some(vec![0xFE, 0xFF]));
        assert_eq!(raw_of(duty, &[0xFE, 0xFF]), Some(-2));
        assert_eq!(raw_of(duty, &[0xFE]), None);
        // Command 54, acceleration 655359: FF FF 09 00.
        let accel = &form(number::DUTY_ACCEL_BOTH).request[1];
        assert_eq!(bytes_of(accel, 655_359), Some(vec![0xFF, 0xFF, 0x09, 0x00]));
        assert_eq!(raw_of(accel, &[0xFF, 0xFF, 0xFF, 0xFF]), Some(0xFFFF_FFFF));
    }

    #[test]
    fn no_object_needs_a_subindex_beyond_254() {
        for form in COMMANDS.iter().flat_map(|row| row.forms) {
            if let Some(Shape::Several(fields) | Shape::List(fields)) = shape(form) {
                assert!(fields.len() < 250);
            }
        }
    }
}

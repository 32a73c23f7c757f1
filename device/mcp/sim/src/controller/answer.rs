//! What a command handler answers, and the tables that find a handler.

use super::firmware::Firmware;
use brushwork_values::{Value, Values};
use std::time::Duration;

/// One field of an answer by the name it has in the command table.
pub(super) type Named = (&'static str, Value);

/// What 248 answers in place of 0xFF when no script that the unit can run is stored. Assumed: no source tells what a real one says;
/// a client takes anything but 0xFF for a refusal.
pub(super) const REFUSED: u8 = 0;

/// What a handler answers. Widths and order are the command table's business.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Answer {
    /// 0xFF, or whatever the form needs without data.
    Ack,
    /// Data by name; names that the generation's layout lacks are left out.
    Data(Vec<Named>),
    /// 0xFF, and this byte when the work is done.
    AckThenStatus {
        /// The byte.
        status: u8,
        /// How long the work takes.
        after: Duration,
    },
    /// [`REFUSED`] where 0xFF is expected.
    Refused,
    /// Nothing.
    Silence,
}

/// Acts on one command.
pub(super) type Handler = fn(&mut Firmware, &Arguments<'_>) -> Answer;

/// Handlers of one theme by command number.
pub(super) type Handlers = &'static [(u8, Handler)];

/// The arguments of one command.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arguments<'a> {
    /// Values with the layout they came in, which may be another generation's.
    pub values: &'a Values,
}

impl Arguments<'_> {
    /// A number, or `current` where the layout at hand does not carry it.
    pub fn int_or(&self, name: &str, current: i64) -> i64 {
        self.values.try_int(name).unwrap_or(current)
    }

    /// The low byte of a number, 0 if there is none.
    pub fn u8(&self, name: &str) -> u8 {
        self.int_or(name, 0) as u8
    }

    /// The low 16 bits of a number.
    pub fn u16(&self, name: &str) -> u16 {
        self.int_or(name, 0) as u16
    }

    /// The low 16 bits of a number as a signed one.
    pub fn i16(&self, name: &str) -> i16 {
        self.int_or(name, 0) as i16
    }

    /// The low 32 bits of a number.
    pub fn u32(&self, name: &str) -> u32 {
        self.int_or(name, 0) as u32
    }

    /// The low 32 bits of a number as a signed one.
    pub fn i32(&self, name: &str) -> i32 {
        self.int_or(name, 0) as i32
    }
}

impl Answer {
    /// Numbers by name.
    pub fn ints<const N: usize>(fields: [(&'static str, i64); N]) -> Self {
        Self::Data(fields.into_iter().map(|(name, value)| (name, Value::Int(value))).collect())
    }
}

/// The value of `name` among the fields of an answer.
pub(super) fn find(fields: &[Named], name: &str) -> Option<Value> {
    fields.iter().find(|(known, _)| *known == name).map(|(_, value)| value.clone())
}

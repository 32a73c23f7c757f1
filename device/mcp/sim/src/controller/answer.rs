//! What a command handler answers, and the tables that find a handler.

use super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::name::Name;
use brushwork_mcp_wire::packet_serial::{Part, Typed, always_has, has};
use brushwork_values::{Value, Values};
use std::time::Duration;

/// One field of an answer by the name it has in the command table.
pub(super) type Named = (&'static str, Value);

/// What 248 answers in place of 0xFF when no script that the unit can run is stored. Assumed: no source tells what a real one says;
/// a client takes anything but 0xFF for a refusal.
pub(super) const REFUSED: u8 = 0;

/// What a handler answers to a command of this layout. Widths and order are the command table's business.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Answer<const LAYOUT: u8> {
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

/// A field of the answer to a command of this layout.
pub(super) struct Reported<const LAYOUT: u8>(Named);

/// A command, and what acts on it.
pub(super) struct On<const LAYOUT: u8>(
    pub Typed<LAYOUT>,
    pub fn(&mut Firmware, &Arguments<'_, LAYOUT>) -> Answer<LAYOUT>,
);

/// [`On`] a command of any layout.
pub(super) trait Handler: Sync {
    /// The command byte.
    fn number(&self) -> u8;
    /// Acts on the command.
    fn act(&self, unit: &mut Firmware, arguments: &Values) -> AnyAnswer;
}

/// Handlers of one theme.
pub(super) type Handlers = &'static [&'static dyn Handler];

/// An answer whose command is known elsewhere.
pub(super) type AnyAnswer = Answer<0>;

/// The arguments of a command of this layout.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arguments<'a, const LAYOUT: u8> {
    /// Values with the layout they came in, which may be another generation's.
    values: &'a Values,
}

impl<const LAYOUT: u8> Handler for On<LAYOUT> {
    fn number(&self) -> u8 {
        self.0.number()
    }

    fn act(&self, unit: &mut Firmware, arguments: &Values) -> AnyAnswer {
        match (self.1)(unit, &Arguments { values: arguments }) {
            Answer::Ack => Answer::Ack,
            Answer::Data(fields) => Answer::Data(fields),
            Answer::AckThenStatus { status, after } => Answer::AckThenStatus { status, after },
            Answer::Refused => Answer::Refused,
            Answer::Silence => Answer::Silence,
        }
    }
}

impl<'a, const LAYOUT: u8> Arguments<'a, LAYOUT> {
    /// A number; `None` where the layout at hand does not carry it.
    pub fn get<N: Name>(&self, _name: N) -> Option<i64> {
        const { assert!(has(LAYOUT, Part::Request, N::TEXT), "the command takes no such field") }
        self.values.try_int(N::TEXT)
    }

    /// A number, or `current` where the layout at hand does not carry it.
    pub fn int_or<N: Name>(&self, name: N, current: i64) -> i64 {
        self.get(name).unwrap_or(current)
    }

    /// A number that every layout carries.
    pub fn int<N: Name>(&self, name: N) -> i64 {
        const { assert!(always_has(LAYOUT, Part::Request, N::TEXT), "not every generation sends this number") }
        self.get(name).unwrap_or_else(|| unreachable!("{} stands in every form", N::TEXT))
    }

    /// The low byte of a number.
    pub fn u8<N: Name>(&self, name: N) -> u8 {
        self.int(name) as u8
    }

    /// The low 16 bits of a number.
    pub fn u16<N: Name>(&self, name: N) -> u16 {
        self.int(name) as u16
    }

    /// The low 16 bits of a number as a signed one.
    pub fn i16<N: Name>(&self, name: N) -> i16 {
        self.int(name) as i16
    }

    /// The low 32 bits of a number.
    pub fn u32<N: Name>(&self, name: N) -> u32 {
        self.int(name) as u32
    }

    /// The low 32 bits of a number as a signed one.
    pub fn i32<N: Name>(&self, name: N) -> i32 {
        self.int(name) as i32
    }

    /// A text.
    pub fn text<N: Name>(&self, _name: N) -> &'a str {
        const { assert!(has(LAYOUT, Part::Request, N::TEXT), "the command takes no such field") }
        self.values.text(N::TEXT).unwrap_or_default()
    }

    /// Bytes as they are; none where they are not as many.
    pub fn bytes<const COUNT: usize, N: Name>(&self, _name: N) -> Option<[u8; COUNT]> {
        const { assert!(has(LAYOUT, Part::Request, N::TEXT), "the command takes no such field") }
        self.values.bytes(N::TEXT)?.try_into().ok()
    }
}

impl<const LAYOUT: u8> Answer<LAYOUT> {
    /// Fields by name.
    pub fn of<const N: usize>(fields: [Reported<LAYOUT>; N]) -> Self {
        Self::Data(fields.into_iter().map(|Reported(field)| field).collect())
    }
}

/// A number of an answer.
pub(super) fn tell<N: Name, const LAYOUT: u8>(name: N, raw: i64) -> Reported<LAYOUT> {
    tell_value(name, Value::Int(raw))
}

/// A field of an answer that need not be a number.
pub(super) fn tell_value<N: Name, const LAYOUT: u8>(_name: N, value: Value) -> Reported<LAYOUT> {
    const { assert!(has(LAYOUT, Part::Reply, N::TEXT), "the command returns no such field") }
    Reported((N::TEXT, value))
}

/// The value of `name` among the fields of an answer.
pub(super) fn find(fields: &[Named], name: &str) -> Option<Value> {
    fields.iter().find(|(known, _)| *known == name).map(|(_, value)| value.clone())
}

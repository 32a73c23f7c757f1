//! Commands and what they carry, with the layout as a type: a field that the command does not have does not compile.
//!
//! Nothing is written twice. A layout is told by the table: it is the number of the first command whose forms have the same
//! fields, so that the commands of motor 1 and motor 2 share theirs, and whether a layout has a field is looked up in the table
//! while the program is compiled.
//!
//! ```
//! use brushwork_mcp_wire::packet_serial::name::{SPEED, STATUS};
//! use brushwork_mcp_wire::packet_serial::{Address, Generation, ReplyProgress, Request, commands, parse_reply};
//!
//! let request = Request::typed(Address::DEFAULT, commands::READ_SPEED_M1, Generation::Gen1, &[])?;
//! let bytes = [0, 0, 0, 100, 1, 0xED, 0xF2];
//! let ReplyProgress::Done { values, .. } = parse_reply(&request, Generation::Gen1, &bytes) else { panic!("it is whole") };
//! let reply = commands::READ_SPEED_M1.reply(values).expect("it is one");
//! assert_eq!((reply.int(SPEED), reply.int(STATUS)), (100, 1));
//! # Ok::<(), brushwork_mcp_wire::packet_serial::EncodeError>(())
//! ```
//!
//! A name that no layout has is not there:
//!
//! ```compile_fail,E0425
//! # use brushwork_mcp_wire::packet_serial::{commands, name};
//! # let reply = commands::READ_SPEED_M1.reply(Default::default()).unwrap();
//! reply.int(name::SPED);
//! ```
//!
//! and a field of another command is not this one's:
//!
//! ```compile_fail,E0080
//! # use brushwork_mcp_wire::packet_serial::{commands, name};
//! # let reply = commands::READ_SPEED_M1.reply(Default::default()).unwrap();
//! reply.int(name::MAIN_BATTERY);
//! ```

use super::command::{Command, Form};
use super::name::Name;
use super::table::lookup;
use brushwork_values::{Field, Kind, Record as RawRecord, Values};

/// A command of the table with its layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Typed<const LAYOUT: u8> {
    number: u8,
}

/// An argument by name, for a command of this layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Given<const LAYOUT: u8> {
    pub(super) name: &'static str,
    pub(super) raw: i64,
}

/// The values of a reply to a command of this layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Read<const LAYOUT: u8> {
    values: Values,
}

/// One record of a counted reply to a command of this layout.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a, const LAYOUT: u8> {
    raw: RawRecord<'a>,
}

/// Where in a command a field stands.
#[derive(Clone, Copy)]
pub enum Part {
    /// In its arguments.
    Request,
    /// In its reply.
    Reply,
    /// In each record of its reply.
    Record,
}

impl<const LAYOUT: u8> Typed<LAYOUT> {
    pub(super) const fn new(number: u8) -> Self {
        Self { number }
    }

    /// The command byte.
    pub const fn number(self) -> u8 {
        self.number
    }

    /// The reply with its layout; `None` if the values are not what the command returns in any generation.
    pub fn reply(self, values: Values) -> Option<Read<LAYOUT>> {
        let is_it = |form: &Form| {
            let fields = form.reply.fields();
            fields.len() == values.values().len()
                && fields.iter().zip(values.fields()).all(|(a, b)| a.name == b.name)
        };
        lookup(self.number)?.forms.iter().any(is_it).then_some(Read { values })
    }
}

/// An argument of a request.
pub const fn give<N: Name, const LAYOUT: u8>(_name: N, raw: i64) -> Given<LAYOUT> {
    const { assert!(has_number(LAYOUT, Part::Request, N::TEXT), "the command takes no such number") }
    Given { name: N::TEXT, raw }
}

impl<const LAYOUT: u8> Read<LAYOUT> {
    /// The raw number of a field that every generation returns.
    pub fn int<N: Name>(&self, name: N) -> i64 {
        const { assert!(always_has(LAYOUT, Part::Reply, N::TEXT), "not every generation returns this number") }
        sure(name, self.values.try_int(N::TEXT))
    }

    /// The raw number of a field; `None` where the generation does not return it.
    pub fn try_int<N: Name>(&self, _name: N) -> Option<i64> {
        const { assert!(has_number(LAYOUT, Part::Reply, N::TEXT), "the command returns no such number") }
        self.values.try_int(N::TEXT)
    }

    /// The physical value of a field that every generation returns, in its unit.
    pub fn physical<N: Name>(&self, name: N) -> f64 {
        const { assert!(always_has(LAYOUT, Part::Reply, N::TEXT), "not every generation returns this number") }
        sure(name, self.values.physical(N::TEXT))
    }

    /// The text of a field; `None` where the generation does not return it.
    pub fn text<N: Name>(&self, _name: N) -> Option<&str> {
        const { assert!(has(LAYOUT, Part::Reply, N::TEXT), "the command returns no such field") }
        self.values.text(N::TEXT)
    }

    /// The bytes of a field; `None` where the generation does not return it.
    pub fn bytes<N: Name>(&self, _name: N) -> Option<&[u8]> {
        const { assert!(has(LAYOUT, Part::Reply, N::TEXT), "the command returns no such field") }
        self.values.bytes(N::TEXT)
    }

    /// The raw numbers of all fields that are numbers, in wire order.
    pub fn ints(&self) -> impl Iterator<Item = i64> {
        self.values.ints()
    }

    /// The records of a counted reply.
    pub fn records(&self) -> impl Iterator<Item = Record<'_, LAYOUT>> {
        self.values.records().map(|raw| Record { raw })
    }
}

impl<const LAYOUT: u8> Record<'_, LAYOUT> {
    /// The raw number of a field that the records of every generation have.
    pub fn int<N: Name>(&self, name: N) -> i64 {
        const { assert!(always_has(LAYOUT, Part::Record, N::TEXT), "not every generation returns this number") }
        sure(name, self.try_int(name))
    }

    /// The raw number of a field; `None` where the generation's records do not have it.
    pub fn try_int<N: Name>(&self, _name: N) -> Option<i64> {
        const { assert!(has_number(LAYOUT, Part::Record, N::TEXT), "the records have no such number") }
        self.raw.try_int(N::TEXT)
    }

    /// The key of a field's code, in whichever numbering the generation has; `None` for a number without a name.
    pub fn key<N: Name>(&self, name: N) -> Option<&'static str> {
        let field = self.raw.fields().iter().find(|field| field.name == N::TEXT)?;
        brushwork_values::by_raw(field.codes, self.try_int(name)?).map(|code| code.key)
    }
}

/// What the compiler has found in every form, and what a reply of any of them was found to have.
fn sure<N: Name, V>(_name: N, value: Option<V>) -> V {
    value.unwrap_or_else(|| unreachable!("{} stands in every form", N::TEXT))
}

/// The number of the first command that has the same fields in the same generations.
pub(super) const fn layout_of(number: u8) -> u8 {
    let Some(own) = lookup(number) else { panic!("no row of the table has this number") };
    let mut first = 0;
    while first < number {
        if let Some(other) = lookup(first)
            && are_alike(own, other)
        {
            return first;
        }
        first += 1;
    }
    number
}

const fn are_alike(one: &Command, other: &Command) -> bool {
    if one.forms.len() != other.forms.len() || one.also_accepted.len() + other.also_accepted.len() > 0 {
        return false;
    }
    let mut at = 0;
    while at < one.forms.len() {
        let (a, b) = (&one.forms[at], &other.forms[at]);
        let alike = a.first as u8 == b.first as u8
            && a.last as u8 == b.last as u8
            && same_names(a.request, b.request)
            && same_names(a.reply.fields(), b.reply.fields());
        if !alike {
            return false;
        }
        at += 1;
    }
    true
}

const fn same_names(one: &[Field], other: &[Field]) -> bool {
    let mut at = 0;
    while at < one.len() && at < other.len() && same(one[at].name, other[at].name) {
        at += 1;
    }
    at == one.len() && at == other.len()
}

const fn same(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut at = 0;
    while at < one.len() && at < other.len() && one[at] == other[at] {
        at += 1;
    }
    at == one.len() && at == other.len()
}

/// Whether a command has a field in some form.
pub const fn has(command: u8, part: Part, name: &str) -> bool {
    count(command, part, name, false).0 > 0
}

/// Whether a command has a number of this name in some form.
pub const fn has_number(command: u8, part: Part, name: &str) -> bool {
    count(command, part, name, true).0 > 0
}

/// Whether a command has a number of this name in each of its forms, in a request also in those that a controller takes besides.
pub const fn always_has(command: u8, part: Part, name: &str) -> bool {
    let (with, of) = count(command, part, name, true);
    with == of
}

/// In how many layouts of a command the field stands, and how many layouts there are.
const fn count(command: u8, part: Part, name: &str, numbers: bool) -> (usize, usize) {
    let Some(row) = lookup(command) else { return (0, 1) };
    let also = match part {
        Part::Request => row.also_accepted,
        Part::Reply | Part::Record => &[],
    };
    let mut with = 0;
    let mut at = 0;
    while at < row.forms.len() + also.len() {
        let fields =
            if at < row.forms.len() { fields_of(&row.forms[at], part) } else { also[at - row.forms.len()] };
        with += stands_in(fields, name, numbers) as usize;
        at += 1;
    }
    (with, at)
}

const fn fields_of(form: &'static Form, part: Part) -> &'static [Field] {
    match (part, form.reply.fields()) {
        (Part::Request, _) => form.request,
        (Part::Reply, fields) => fields,
        (Part::Record, [Field { kind: Kind::Counted(fields), .. }]) => fields,
        (Part::Record, _) => &[],
    }
}

const fn stands_in(fields: &[Field], name: &str, numbers: bool) -> bool {
    let mut at = 0;
    while at < fields.len() {
        if same(fields[at].name, name) {
            return !numbers || fields[at].kind.limits().is_some();
        }
        at += 1;
    }
    false
}

//! A request: what a client sends and a controller takes.

use super::command::{Command, Form};
use super::encode_error::EncodeError;
use super::identity::{Address, Generation};
use super::table::lookup;
use super::typed::{Given, Typed};
use brushwork_values::{Field, Value};

/// A request to one unit. It names no generation: [`Request::encode`] takes the one of the receiver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// The unit.
    pub address: Address,
    /// The command byte.
    pub command: u8,
    /// The arguments in wire order. Constants such as keys may be left out.
    pub values: Vec<Value>,
}

impl Request {
    /// A request whose arguments are the raw numbers `values`, in wire order.
    pub fn new(address: Address, command: u8, values: &[i64]) -> Self {
        Self { address, command, values: values.iter().map(|&value| Value::Int(value)).collect() }
    }

    /// A request whose arguments are put in the order that `generation` has them. Those that its layout lacks are left out, so
    /// that one call serves all widths.
    ///
    /// # Errors
    /// If the generation does not have the command, or an argument of its layout is not among `given`.
    pub fn typed<const LAYOUT: u8>(
        address: Address,
        command: Typed<LAYOUT>,
        generation: Generation,
        given: &[Given<LAYOUT>],
    ) -> Result<Self, EncodeError> {
        let command = command.number();
        let raw_of =
            |field: &Field| given.iter().find(|given| given.name == field.name).map(|given| given.raw);
        let value_of = |field: &Field| {
            let raw = raw_of(field).or(field.fixed);
            raw.map(Value::Int).ok_or(EncodeError::MissingValue { command, field: field.name })
        };
        let values = form_of(command, generation)?.request.iter().map(value_of).collect::<Result<_, _>>()?;
        Ok(Self { address, command, values })
    }

    /// Its row in the table; `None` for a number that the table does not have.
    pub fn row(&self) -> Option<&'static Command> {
        lookup(self.command)
    }
}

/// What goes over the wire for `command` in `generation`.
pub(super) fn form_of(command: u8, generation: Generation) -> Result<&'static Form, EncodeError> {
    let row = lookup(command).ok_or(EncodeError::UnknownCommand { command })?;
    row.form(generation).ok_or(EncodeError::NotInGeneration { command, generation })
}

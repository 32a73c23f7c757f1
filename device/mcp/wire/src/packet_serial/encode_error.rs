//! Why values cannot be put on the wire.

use super::identity::Generation;
use thiserror::Error;

/// What does not fit, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The number stands for no command.
    #[error("there is no packet serial command {command}")]
    UnknownCommand {
        /// The number.
        command: u8,
    },
    /// This firmware does not have the command.
    #[error("firmware of {generation} has no command {command}")]
    NotInGeneration {
        /// The number.
        command: u8,
        /// The generation asked for.
        generation: Generation,
    },
    /// Too few or too many values.
    #[error("wrong number of values for command {command}: {got} given, {expected} expected")]
    WrongCount {
        /// The number.
        command: u8,
        /// Fields in the layout.
        expected: usize,
        /// Values given.
        got: usize,
    },
    /// A value that the layout needs was not given.
    #[error("command {command} needs a value for {field}")]
    MissingValue {
        /// The number.
        command: u8,
        /// Name of the field.
        field: &'static str,
    },
    /// A number does not fit the bytes of its field.
    #[error("{value} does not fit the field {field} of command {command}, which holds {low} to {high}")]
    OutOfRange {
        /// The number.
        command: u8,
        /// Name of the field.
        field: &'static str,
        /// The value given.
        value: i64,
        /// The least that fits.
        low: i64,
        /// The greatest that fits.
        high: i64,
    },
    /// A value is of another kind than its field, or too long for it.
    #[error("the value for the field {field} of command {command} does not fit: {what}")]
    WrongKind {
        /// The number.
        command: u8,
        /// Name of the field.
        field: &'static str,
        /// What is wrong.
        what: &'static str,
    },
}

//! How a value of any controller is described: its field, unit and named codes, and which motor it is of.
//!
//! Client, simulator and settings table of every family speak in these words. Numbers as they lie on the wire are *raw*;
//! [`Field::physical`] and [`Field::raw`] lead to physical ones and back.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod code;
mod field;
mod hex;
mod listed;
mod message;
mod motor;
mod severity;
mod value;

pub use code::{Code, by_key, by_raw};
pub use field::{Field, Kind, SERIAL_BYTES, Unit, width_of};
pub use hex::{hex, parse_byte};
pub use message::{Listed, Message, Sentences, Words, error_key};
pub use motor::Motor;
pub use severity::Severity;
pub use value::{Record, Value, Values};

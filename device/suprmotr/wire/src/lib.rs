//! The serial protocol of the SuprMotr V9 (SuprMotr manual, "Communications", "Command Reference" and "Command Short Form").
//!
//! Everything is text. What a controller receives is three things: selections ([`Selection`]: Ctrl-A and an address), commands of
//! one character ([`Single`]) and lines ([`Line`]) of [`Command`]s, ended by a carriage return. What it says back is a [`Report`].
//! The commands are data: [`COMMANDS`] has what each takes, reports and does.
//!
//! Who drives a controller writes [`Selection::bytes`], [`Single::character`] and [`Line::encode`], and reads with [`parse_report`].
//! Who is one feeds each byte to a [`Reader`], reads its lines with [`parse_line`], whose [`LineError`] is what TS reports, and
//! answers with [`encode_report`]. Neither has to know what the other assumes:
//!
//! | | writes | reads |
//! | --- | --- | --- |
//! | selection | [`Selection::bytes`] | [`Reader`]: [`Received::Selection`] |
//! | one character | [`Single::character`] | [`Reader`]: [`Received::Single`] |
//! | line | [`Line::encode`] | [`Reader`]: [`Received::Line`], then [`parse_line`] |
//! | carriage return alone | never | [`Reader`]: [`Received::Repeat`] |
//! | report | [`encode_report`] | [`parse_report`] |
//! | status | [`Status::bytes`] | [`Status::from_bytes`] |
//! | macro listing | [`Line::listing`] | [`parse_listing`] |
//!
//! A carriage return alone repeats the last line, so nothing here writes one: an empty line is refused ([`EncodeError::Empty`]).
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

mod address;
mod characters;
mod contradictions;
mod describe;
mod line;
mod number;
mod reader;
mod reference;
mod report;
mod single;
mod status;
mod table;
#[cfg(test)]
mod tests;

pub use address::{Address, InvalidAddress, Selection};
pub use characters::{END_OF_REPORT, EXECUTE, SELECT};
pub use contradictions::{CONTRADICTIONS, Contradiction};
pub use describe::{describe_command, describe_line, describe_report, describe_single, describe_status};
pub use line::{
    Command, EncodeError, LINE_BUFFER, Line, LineError, Parsed, help_lines, parse_line, parse_listing,
};
pub use number::Radix;
pub use reader::{Reader, Received};
pub use reference::{
    BitEntry, CommandEntry, ErrorEntry, Reference, reference, reference_entry, reference_page,
};
pub use report::{
    BadReport, Progress, Report, ReportForm, ReportLine, echo_length, encode_report, parse_report,
};
pub use single::Single;
pub use status::{
    Bit, ErrorCode, INPUT_BITS, LIMIT_BITS, MOTION_BITS, OPERATION_BITS, Status, inputs, limits, motion,
    operation,
};
pub use table::{
    Absent, CHANNELS, COMMANDS, CommandRow, Effect, FURTHEST_COUNTS, LAST_MACRO, MOST_COMMANDS, MOST_GAIN,
    Mnemonic, Parameter, Reports, Source,
};

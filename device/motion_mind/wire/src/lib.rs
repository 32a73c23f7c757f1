//! The two serial protocols of the Motion Mind 3 (Motion Mind manual, chapters 5 to 7).
//!
//! The same [`Command`]s travel in binary frames ([`encode_frame`], [`FrameReader`]) or in lines of text ([`encode_line`],
//! [`LineReader`]); a switch on the board selects which. What a controller says back is one [`Reply`] in either form.
//! Registers, their widths and their bits are data: [`REGISTERS`], [`FUNCTION_BITS`], [`FUNCTION2_BITS`], [`STATUS_BITS`].
//!
//! The self-test line `Z` can be read, by a simulated controller, but not written: a unit needs a power cycle after it.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

mod address;
mod bits;
mod buffer;
mod command;
mod contradictions;
mod describe;
mod frame;
mod frame_reader;
mod line;
mod line_reader;
mod parts;
mod reference;
mod register;
mod reply;
mod switches;
#[cfg(test)]
mod tests;

pub use address::{Address, InvalidAddress};
pub use bits::{Bit, FUNCTION_BITS, FUNCTION2_BITS, STATUS_BITS, function, function2, status};
pub use buffer::RECEIVE_BUFFER;
pub use command::{Command, Effect, Part};
pub use contradictions::{CONTRADICTIONS, Contradiction};
pub use describe::{describe_command, describe_reply};
pub use frame::{ACK, EncodeError, checksum, encode_frame, encode_frame_reply, parse_frame_reply};
pub use frame_reader::{BYTE_GAP, FrameEvent, FrameReader};
pub use line::{encode_line, encode_line_reply, parse_all_loosely, parse_line_reply};
pub use line_reader::{LineEvent, LineReader};
pub use parts::{COMMANDS, CommandRow, command_row, fields, numbers};
pub use reference::{
    BitEntry, CommandEntry, Reference, RegisterEntry, reference, reference_entry, reference_page,
};
pub use register::{Access, Kind, REGISTERS, Register, register, register_named, register_number};
pub use reply::{BadReply, Progress, Reply, Returned, Returns};
pub use switches::{Mode, Protocol};

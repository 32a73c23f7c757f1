//! Packet serial, the binary protocol of the MCP and RoboClaw controllers (MCP manual 2.2 to 2.4).
//!
//! A packet is an address byte (0x80 to 0x87), a command byte, arguments and, for writes, a CRC. A write is answered
//! with one byte 0xFF; a read with its data and a CRC over address, command, arguments and data; anything wrong with
//! silence. Replies have no length field: what a reply holds follows from the command and from the [`Generation`] of
//! the firmware. All of that is data, in the one table [`COMMANDS`]; encoding, decoding, the simulator's acceptance,
//! the traffic decoder and the reference page read it.
//!
//! Start at [`Command`] and [`Form`], then [`Request`] and [`parse_reply`] (a client) or [`RequestFramer`] and
//! [`encode_reply`] (a controller).

mod command;
pub mod commands;
mod describe;
mod encode;
mod encode_error;
mod field;
mod framer;
mod identity;
pub mod known;
pub mod led;
pub mod name;
pub mod number;
mod parse;
pub mod reference;
mod request;
pub mod scale;
pub mod status;
mod table;
mod typed;

pub use command::{ClientUse, Command, Direction, Effect, Form, Reply, Simulated};
pub use describe::{
    describe_discarded, describe_event, describe_framed, describe_reply, describe_request, describe_value,
    describe_values, label,
};
pub use encode::{ACK, encode_ack, encode_reply, encode_reply_named};
pub use encode_error::EncodeError;
pub use framer::{
    DiscardReason, Discarded, Framed, FramerEvent, LONGEST_REQUEST, PACKET_GAP, RawBytes, RequestFramer,
};
pub use identity::{Address, Generation, InvalidAddress, InvalidGeneration};
pub use parse::{ReplyProgress, parse_reply};
pub use request::Request;
pub use table::{COMMANDS, lookup, lookup_key};
pub use typed::{Given, Part, Read, Record, Typed, always_has, give, has, has_number};

//! SuprMotr controllers as the device thread sees them: how they are found, read, driven, stopped and armed.
//!
//! [`SuprMotrs`] finds units, [`SuprMotr`] is one of them. What it reads, how it drives, stops and is armed stand in a file each.
//!
//! A carriage return with nothing before it repeats the last line, and any line ends a running macro. So polls are commands of one character
//! alone; a line goes out whole or not at all, and not while a macro runs unless it is to end it; a distance goes out as a position, so that
//! a line that is carried out twice moves once; and nothing is settled by a line end. A line that reports nothing is followed by `%`, whose
//! report says what became of it.
//!
//! Commands by number ([`Controller::transact`](brushwork_link::device::controller::Controller::transact)) are places in the wire's table
//! of commands; behind them stand [the switches](values::SWITCHES), which are two commands each.

mod acts;
mod arming;
pub mod channels;
mod discover;
mod driving;
mod facts;
pub mod indicators;
mod polling;
mod raw;
mod speaker;
mod stopping;
mod traffic;
mod unit;
pub(crate) mod values;

pub use channels::{COMPUTED_TARGET, COMPUTED_VELOCITY};
pub use discover::SuprMotrs;
pub use facts::SuprMotrFacts;
pub use indicators::status_of_word;
pub use traffic::{describe_received, describe_sent};
pub use unit::SuprMotr;

//! MotorVator boards as the device thread sees them: how they are found, read, driven, stopped and armed.
//!
//! [`Boards`] finds a board, [`Board`] is half of one. What it reads, how it drives, stops and is armed stand in a file each.
//!
//! The board answers nothing by itself but its version. All else goes through the host library, a program that runs on it. A board is
//! looked for by the library's own frames and by `H`: data for a program that may be another one is never sent by itself, since nobody
//! knows what that makes of it.
//!
//! Commands by number ([`Controller::transact`](brushwork_link::device::controller::Controller::transact)) are the letters of the
//! library's orders.

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

pub use discover::Boards;
pub use facts::MotorvatorFacts;
pub use traffic::{describe_received, describe_sent};
pub use unit::Board;

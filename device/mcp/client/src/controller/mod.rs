//! MCP and RoboClaw controllers over packet serial, and MCP controllers as nodes of a CAN bus ([`crate::can`] carries the commands).
//!
//! [`PacketSerial`] finds units, [`Mcp`](unit::Mcp) is one of them. What it reads, how it drives, stops and is armed stand in a file
//! each. Nothing outside this folder knows a command of packet serial.

mod arming;
pub mod channels;
mod discover;
mod driving;
mod generation;
pub mod indicators;
mod inquiry;
mod polling;
mod speaker;
mod stopping;
mod traffic;
mod unit;

pub use discover::{PacketSerial, identify_node};
pub use driving::preview;
pub use inquiry::leave_for;
pub use polling::sweep_of;
pub use traffic::describe_sent;

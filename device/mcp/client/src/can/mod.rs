//! MCP controllers as nodes of a CANopen bus, through an adapter on a serial port.
//!
//! [`CanOpen`] finds nodes. Each is driven by the same code as over packet serial (module `mcp`): only how a command and its values
//! reach the unit differs, and that is here. Commands are objects (`brushwork_mcp_wire::canopen::objects`), read and written by
//! SDO; heartbeats are listened for on the way.

mod access;
mod command;
mod discover;
mod master;
mod monitor;
mod place;
mod traffic;

pub use command::{Probe, carry_out, probe};
pub use discover::CanOpen;
pub use master::{MASTER, MASTER_LIMIT};
pub use monitor::BusTransport;
pub use place::Place;
pub use traffic::describe;

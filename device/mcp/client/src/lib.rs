//! MCP and RoboClaw controllers as the device thread and the settings engine speak to them: over packet serial, and MCP controllers as nodes of a
//! CAN bus.
//!
//! [`McpDriver`] is the family as shared code knows it, and [`MCP`] its name. Everything else here is for those who know that they have such a controller in front of them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod can;
mod controller;
pub mod diagnosis;
mod driver;
mod facts;
mod family;
pub mod firmware;
pub mod messages;
pub mod packet;
mod readings;
pub mod script;
pub mod settings;
#[cfg(test)]
mod tests;

pub use controller::{PacketSerial, channels, describe_sent, indicators, leave_for, preview, sweep_of};
pub use driver::McpDriver;
pub use facts::McpFacts;
pub use family::{
    MCP, firmware_of, is_mcp, layout_of, model_of, packet_address, packet_generation, subject, unit_address,
};
pub use packet::TypedWire;

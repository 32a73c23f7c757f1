//! A simulated Motion Mind 3: bytes and time in, bytes out (Motion Mind manual, chapters 3 to 7).
//!
//! [`MotionMind`] is one unit with its motor, [`MotionMindBus`] several on one wire. The world is the one that the MCP has:
//! motor 1 is the unit's motor, motor 2 is not connected, and the input pins are those of [`pin`].
//!
//! What the manual leaves open stands in [`assumed`].
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

pub mod assumed;
mod bus;
mod config;
mod drive;
mod inputs;
mod loops;
mod store;
mod unit;
mod wire;

pub use brushwork_motion_mind_wire::{Mode, Protocol};
pub use bus::MotionMindBus;
pub use config::{EncoderDecode, MotionMindConfig, pin};
pub use unit::MotionMind;

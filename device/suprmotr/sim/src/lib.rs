//! A simulated SuprMotr V9: bytes and time in, bytes out (SuprMotr manual).
//!
//! [`SuprMotr`] is one board with its motor, [`SuprMotrBus`] several on one wire. The world is the one that other controllers have:
//! motor 1 is the board's motor, motor 2 is not connected, and the input pins are those of [`pin`]. If nothing else is said the motor moves the
//! [`slide`].
//!
//! What the manual leaves open stands in [`assumed`], and in a line that says so where a rule and not a figure is open.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

pub mod assumed;
mod axis;
mod bus;
mod channels;
mod commands;
mod config;
mod outbox;
mod program;
mod servo;
mod store;
#[cfg(test)]
mod tests;
mod trajectory;
mod unit;

pub use bus::SuprMotrBus;
pub use config::{CHANNELS, SuprMotrConfig, pin, place, slide, world_of};
pub use program::Step;
pub use store::{Eeprom, ImageError, Parameters};
pub use unit::SuprMotr;

//! MotorVator boards as the device thread and the settings engine speak to them.
//!
//! [`MotorvatorDriver`] is the family as shared code knows it, and [`MOTORVATOR`] its name. Everything else here is for those who know that
//! they have such a board in front of them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod controller;
mod driver;
mod family;
pub mod messages;
mod settings;

pub use controller::{Board, MotorvatorFacts, channels, describe_received, describe_sent, indicators};
pub use driver::MotorvatorDriver;
pub use family::{Half, MOTORVATOR, is_motorvator, subject, unit_address};
pub use settings::STEPPER_KEYS;

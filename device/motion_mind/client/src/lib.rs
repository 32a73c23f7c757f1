//! Motion Mind 3 controllers as the device thread and the settings engine speak to them, in both of their protocols.
//!
//! [`MotionMindDriver`] is the family as shared code knows it, and [`MOTION_MIND`] its name. Everything else here is for those who know that they have such a controller in front of
//! them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod controller;
mod driver;
mod family;
pub mod messages;
mod settings;

pub use controller::{
    COUNTS_PER_S_PER_STEP, MotionMind, MotionMindFacts, MotionMinds, channels, describe_received,
    describe_sent, indicators, objection, preview, taken,
};
pub use driver::MotionMindDriver;
pub use family::{MOTION_MIND, firmware_of, is_motion_mind, subject, unit_address};

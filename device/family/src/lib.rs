//! What a program asks of a whole family of controllers beyond its driver: simulated units, and the tuning of its loops.
//!
//! A family's own crate puts its client, simulator and axis together behind these traits. Nothing here knows which families there are.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod examine;
pub mod messages;
pub mod simulator;
pub mod spec;
pub mod tuned;

pub use examine::{Examination, Examiner};
pub use simulator::{Simulator, SimulatorError, Started};
pub use tuned::{Restored, Target, Tuned};

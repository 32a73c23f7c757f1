//! Motion Mind 3 controllers whole: their driver, their simulated units and the tuning of their loop, as a program lists them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod examine;
mod like;
pub mod sim_spec;
mod simulator;
mod tuned;

pub use examine::MotionMindExaminer;
pub use sim_spec::MotionMindSpec;
pub use simulator::MotionMindSimulator;
pub use tuned::MotionMindTuned;

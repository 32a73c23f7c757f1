//! MotorVator V3 put together for the program: client and simulator, and the programs that simulated boards run.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod sim_spec;
mod simulator;

pub use sim_spec::{MODEL, MotorvatorSpec};
pub use simulator::MotorvatorSimulator;

//! MCP and RoboClaw controllers whole: their driver, their simulated units and the tuning of their loops, as a program lists them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod config;
mod encoder;
pub mod examine;
mod like;
pub mod sim_spec;
mod simulator;
mod tuned;

pub use config::config_of;
pub use examine::McpExaminer;
pub use like::config_like;
pub use sim_spec::{SimSpec, SimSpecError};
pub use simulator::{McpSimulator, bus_of};
pub use tuned::McpTuned;

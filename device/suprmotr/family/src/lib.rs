//! SuprMotr V9 controllers whole: their driver and their simulated units, as a program lists them, and macros that are tried on one.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod rehearsal;
pub mod sim_spec;
mod simulator;
pub mod transfer;
mod tuned;

pub use sim_spec::SuprMotrSpec;
pub use simulator::SuprMotrSimulator;
pub use tuned::SuprMotrTuned;

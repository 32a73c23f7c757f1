//! Faults on the wire and in the machine, from a script: bytes lost, changed, doubled or late, silence, a pulled cable, a locked
//! shaft, and so on.
//!
//! A script is plain data with times; [`Faulty`] plays it on any machine. Both are free of clocks, so a test in virtual time
//! sees the same faults at the same bytes as the real-time server does with the same seed and the same traffic.

mod fault;
mod player;
mod text;

pub use fault::{Direction, Fault, FaultEffect};
pub use player::Faulty;
pub use text::{FAULT_SYNTAX, FaultProblem, FaultTextError};

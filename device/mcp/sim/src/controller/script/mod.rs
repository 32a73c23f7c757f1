//! The script of a unit: its flash memory, the machine that runs it, and all that a running script can reach.
//!
//! [`ScriptState`] is what starts and stops; `run` lets time pass for it; `host`, `calls` and `registers` bind it to the firmware and to the
//! world. What is assumed of the firmware stands with the constant or function it concerns.

mod calls;
mod host;
mod i2c;
mod memory;
mod motion;
mod registers;
mod run;
mod sending;
mod state;
mod streams;

pub use host::ScriptHost;
pub use memory::{BLOCK_WRITE_TIME, ERASE_TIME, STATUS_DONE, STATUS_NOT_DONE, ScriptMemory};
pub use run::INSTRUCTION_TIME;
pub use state::ScriptState;

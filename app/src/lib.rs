//! The program: a window and a command line over device threads and simulated controllers. See `ARCHITECTURE.md`.

pub mod cli;
pub mod gui;
pub mod keep;
pub mod motion;
pub mod recording;
pub mod session;
pub mod tune;

#[cfg(test)]
#[path = "../tests/gui/support/wait.rs"]
#[allow(dead_code, reason = "shared with the tests of the program")]
mod wait;

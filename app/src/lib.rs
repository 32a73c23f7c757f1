//! See `ARCHITECTURE.md`.

pub mod cli;
pub mod gui;
pub mod recording;
pub mod keep;
pub mod session;

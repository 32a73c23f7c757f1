//! See `ARCHITECTURE.md`.

pub mod cli;
pub mod gui;
pub mod keep;
pub mod motion;
pub mod recording;
pub mod session;
pub mod tune;

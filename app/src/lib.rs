//! See `ARCHITECTURE.md`.

pub mod cli;
pub mod gui;
pub mod keep;
pub mod recording;
pub mod motion;
pub mod session;

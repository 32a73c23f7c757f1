//! See `ARCHITECTURE.md`.

pub mod gui;
pub mod session;

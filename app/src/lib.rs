//! See `ARCHITECTURE.md`.

pub mod gui;

//! See `ARCHITECTURE.md`.

pub mod bridge;
pub mod motion;
pub mod settings;
pub mod signals;

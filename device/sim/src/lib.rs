//! See `ARCHITECTURE.md`.

pub mod bridge;
pub mod motion;
pub mod priority;
pub mod settings;
pub mod signals;
pub mod supervision;

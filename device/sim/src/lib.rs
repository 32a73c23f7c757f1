//! See `ARCHITECTURE.md`.

pub mod bridge;
pub mod motion;

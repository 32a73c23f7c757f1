//! See `ARCHITECTURE.md`.

pub mod codes;
pub mod models;

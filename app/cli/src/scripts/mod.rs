//! Scripts in whichever language: read with their encoding, checked and formatted. Each language has its own commands beside these.

mod check;
mod fmt;
mod language;
mod source;

pub use check::check;
pub use fmt::fmt;
pub use language::Language;
pub use source::{Source, is_standard, read_bytes};

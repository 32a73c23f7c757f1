//! The language of macro files of the SuprMotr V9: a file in, macros and what is to be said about them out.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

mod check;
pub mod codes;
mod format;
mod lexer;
mod parser;
mod written;

pub use check::{Checked, Macro, check};
pub use format::format;
pub use written::written;

/// A text of more bytes is refused: far more than 15 macros with all their comments need.
pub const LONGEST_TEXT: usize = 256 * 1024;

//! The language of macro files of the SuprMotr V9: a file in, macros and what is to be said about them out.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

mod check;
pub mod codes;
mod format;
mod index;
mod lexer;
mod parser;
#[cfg(test)]
mod tests;
mod written;

pub use check::{Checked, LONGEST_TEXT, Macro, check};
pub use format::format;
pub use index::MACROS;
pub use written::written;

//! What an editor asks about a program: what is wrong, which names there are and where, which words belong together, what can be
//! folded, what a word means, what could be typed next.
//!
//! All of it is worked out of the text alone, without a clock and without IO. [`check`] and [`Index::of`] read the whole text (meant for
//! a thread of their own); [`classes`], [`help`] and [`syntax_at`] read a line or a word and may be called while painting.

mod blocks;
mod classes;
mod complete;
mod help;
mod rename;
mod whole;

pub(super) use blocks::blocks;
pub use blocks::{Block, BlockKind, Fold};
pub use classes::{Class, classes};
pub use complete::{Completions, Entry, EntryKind, SyntaxHint, syntax_at};
pub use help::{Help, help};
pub use rename::RenameError;
pub use whole::Index;

use super::lower::compile;
use crate::diagnostic::Diagnostic;

/// What is wrong with a program, in the order of the text.
#[must_use]
pub fn check(text: &str) -> Vec<Diagnostic> {
    compile(text).diagnostics
}

#[cfg(test)]
mod tests;

//! MeccCode, the language of the board whose programs are run by events: text in, a program for the virtual machine out.
//!
//! The manual of the board is a summary of what was new; [`words::Source`] says of each form whether it stands there, on the maker's other
//! pages, or is assumed. What else is assumed stands in [`assumed`].

pub mod assumed;
pub mod ast;
mod board;
pub mod codes;
pub mod events;
pub mod format;
pub mod index;
pub mod lexer;
mod lower;
mod parser;
pub mod reference;
mod watch;
pub mod words;

pub use board::{DIRECTIONS, FRAME_BYTES, TICKS_PER_SECOND};
pub use lower::{Compiled, compile};
pub use parser::{Parsed, parse};
pub use watch::Names;

//! MCL, the script language of the MCP controllers (MCP manual chapter 3): text in, a program for the virtual machine out.
//!
//! [`compile`] is the way in. The manual contradicts itself in places; what was decided stands at the tables and rules it concerns
//! and is warned of by codes of its own ([`codes`]).

pub mod ast;
pub mod codes;
pub mod constant;
pub mod contradictions;
pub mod format;
pub mod index;
pub mod lexer;
mod lower;
pub mod operators;
mod parser;
pub mod reference;
pub mod registers;
pub mod types;
pub mod words;

pub use lower::watch::Names;
pub use lower::{Compiled, LONGEST_TEXT, Symbol, SymbolKind, compile, too_long};
pub use parser::{Parsed, parse};

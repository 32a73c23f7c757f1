//! What a program declares, by name.

use crate::mcl::types::VarType;
use crate::mecc::ast::{Kind, Name};
use crate::op::{Array, Cell};
use crate::text::Span;
use std::collections::HashMap;
use std::sync::Arc;

/// A function, as those who call it know it.
#[derive(Clone, Debug, PartialEq)]
pub struct Function {
    /// Its number among routines.
    pub routine: usize,
    /// Types of its parameters.
    pub parameters: Arc<[Kind]>,
    /// Type of its value.
    pub returns: Option<Kind>,
}

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// A variable and its first byte.
    Variable(Kind, u32),
    /// A table: first byte, how many.
    Table(u32, u32),
    /// A function.
    Function(Function),
    /// An event handler: its number among routines.
    Handler(usize),
}

/// A name with what it stands for.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// What it stands for.
    pub meaning: Meaning,
    /// Where it is declared.
    pub declared: Span,
    /// Whether anything reads or calls it.
    pub is_used: bool,
    /// Whether its declaration has been passed; locals are known from there on.
    pub is_known: bool,
}

/// Names of a program, or of one routine of it.
pub type Symbols = HashMap<Arc<str>, Symbol>;

impl Meaning {
    /// "a variable", for messages.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Variable(Kind::Pointer, _) => "a DataPointer",
            Self::Variable(Kind::Byte | Kind::Word, _) => "a variable",
            Self::Table(..) => "a DataTable",
            Self::Function(_) => "a function",
            Self::Handler(_) => "an event handler",
        }
    }

    /// Where it lies in memory, for the debugger, and whether it is a table.
    pub fn memory(&self) -> Option<(Array, bool)> {
        let array = |kind: VarType, at: u32, length| Array {
            first: Cell { kind, at: at * 8 },
            stride: kind.bits(),
            length,
        };
        match self {
            Self::Variable(kind, at) => Some((array(kind.stored(), *at, 1), false)),
            Self::Table(at, length) => Some((array(VarType::Byte, *at, *length), true)),
            Self::Function(_) | Self::Handler(_) => None,
        }
    }
}

impl Kind {
    /// How it lies in memory.
    pub fn stored(self) -> VarType {
        match self {
            Self::Byte => VarType::Byte,
            Self::Word | Self::Pointer => VarType::Word,
        }
    }

    /// How many bytes it takes.
    pub fn bytes(self) -> u32 {
        self.stored().bits() / 8
    }

    /// Its name.
    pub fn title(self) -> &'static str {
        match self {
            Self::Byte => "Byte",
            Self::Word => "Word",
            Self::Pointer => "DataPointer",
        }
    }
}

impl Symbol {
    /// A name that was just declared.
    pub fn new(meaning: Meaning, name: &Name) -> Self {
        Self { meaning, declared: name.span, is_used: false, is_known: true }
    }
}

//! A compiled program as the machine runs it and the debugger reads it.

use crate::mcl::types::VarType;
use crate::op::{Array, Op};
use serde::Serialize;

/// A compiled program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// Its instructions.
    pub ops: Vec<Op>,
    /// The line of the text (from 1) that each instruction came from.
    pub lines: Vec<u32>,
    /// Tables and texts.
    pub data: Vec<u8>,
    /// Memory for variables, in bytes.
    pub ram_bytes: u32,
    /// How many FOR loops it has.
    pub loops: u32,
    /// Its variables, for the debugger.
    pub variables: Vec<Variable>,
    /// Its labels, for the debugger: name and instruction.
    pub labels: Vec<(String, u32)>,
}

/// A variable as the debugger shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// As it was defined.
    pub name: String,
    /// Where it is; one that is no array has length 1.
    pub memory: Array,
    /// Whether it was defined with a size.
    pub is_array: bool,
}

/// What a program takes of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Size {
    /// Instructions.
    pub instructions: usize,
    /// Bytes of code in the image.
    pub code_bytes: usize,
    /// Bytes of tables and texts.
    pub data_bytes: usize,
    /// Bytes of variables.
    pub ram_bytes: u32,
}

/// The largest program that the machine takes. Assumed: what the controllers hold is not public.
pub mod limits {
    /// Bytes of variables.
    pub const RAM_BYTES: u32 = 32 * 1024;
    /// Instructions.
    pub const INSTRUCTIONS: usize = 256 * 1024;
    /// Bytes of tables and texts.
    pub const DATA_BYTES: usize = 256 * 1024;
    /// Cells of the stack.
    pub const STACK_CELLS: usize = 1024;
    /// Calls within calls.
    pub const CALLS: usize = 256;
}

impl Variable {
    /// Type of each element.
    #[must_use]
    pub fn kind(&self) -> VarType {
        self.memory.first.kind
    }
}

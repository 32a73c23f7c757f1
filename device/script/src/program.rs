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
    /// Bytes of the image, names and lines included.
    pub image_bytes: usize,
}

/// A controller and what it holds of a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Room {
    /// The model, as printed on the board.
    pub model: &'static str,
    /// Bytes for variables.
    pub ram_bytes: u32,
    /// Bytes for an image.
    pub image_bytes: usize,
}

/// What each model of the manual holds. Assumed: the manual says that the amount of RAM "varies for each MCP model" (3.1.1) and gives no
/// figure.
pub const ROOMS: [Room; 7] = [
    small("MCP233"),
    small("MCP236"),
    small("MCP263"),
    small("MCP266"),
    large("MCP2163"),
    large("MCP2166"),
    large("MCP2168"),
];

const fn small(model: &'static str) -> Room {
    Room { model, ram_bytes: 16 * 1024, image_bytes: 128 * 1024 }
}

const fn large(model: &'static str) -> Room {
    Room { model, ram_bytes: limits::RAM_BYTES, image_bytes: 256 * 1024 }
}

impl Room {
    /// Whether a program fits.
    #[must_use]
    pub fn takes(&self, size: &Size) -> bool {
        size.ram_bytes <= self.ram_bytes && size.image_bytes <= self.image_bytes
    }
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
    /// FOR loops.
    pub const LOOPS: u32 = 4096;
    /// Variables, and labels.
    pub const NAMES: usize = 64 * 1024;
    /// Calls within calls.
    pub const CALLS: usize = 256;
    /// Events, each of which may have a handler.
    pub const EVENTS: u32 = 32;
    /// Bytes that are sent or received at once.
    pub const FRAME_BYTES: u32 = 256;
    /// Bytes of memory that all subroutines together keep until they return.
    pub const KEPT_BYTES: usize = 64 * 1024;
}

impl Variable {
    /// Type of each element.
    #[must_use]
    pub fn kind(&self) -> VarType {
        self.memory.first.kind
    }
}

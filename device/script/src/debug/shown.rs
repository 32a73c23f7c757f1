//! What a debugger shows: one value that can be handed to another thread.

use super::breakpoint::BreakpointState;
use super::reason::Reason;
use super::terminal::Chunk;
use super::value::Value;
use super::watch::Watch;
use crate::mcl::registers::RegisterId;
use crate::op::Cell;
use std::sync::Arc;
use std::time::Duration;

/// What is to be shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Expressions. They are worked out only if the program is the one they were made for.
    pub watches: Arc<Vec<Result<Watch, String>>>,
    /// The code that the watches were made for ([`super::code_id`]).
    pub code: u64,
    /// Registers.
    pub registers: Arc<Vec<RegisterId>>,
    /// Output from this byte on.
    pub output_from: u64,
}

/// A register with its elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Which.
    pub id: RegisterId,
    /// Each element as a cell.
    pub cells: Vec<u32>,
}

/// An argument of a subroutine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Argument {
    /// The variable it was stored in, where that can be told.
    pub cell: Option<Cell>,
    /// What it was as the subroutine was called.
    pub value: u32,
}

/// A subroutine that has not returned, or the main program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The line it stands on.
    pub line: u32,
    /// Its first instruction.
    pub entered_at: u32,
    /// What it was given; none where it was called before anybody looked.
    pub arguments: Option<Vec<Argument>>,
}

/// A script as it is now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Which code the script is of; 0 without one.
    pub code: u64,
    /// Time since power-up.
    pub now: Duration,
    /// Why it is where it is.
    pub reason: Reason,
    /// Whether it stands because of the debugger.
    pub is_paused: bool,
    /// Whether it runs or waits.
    pub is_running: bool,
    /// The line that comes next; 0 without a script.
    pub line: u32,
    /// Instructions run so far.
    pub executed: u64,
    /// The call stack, the innermost first; the main program is the last.
    pub frames: Vec<Frame>,
    /// The variables.
    pub memory: Vec<u8>,
    /// The registers that were wanted.
    pub registers: Vec<Readings>,
    /// The expressions that were wanted, in their order.
    pub watches: Vec<Result<Value, String>>,
    /// The breakpoints.
    pub breakpoints: Vec<BreakpointState>,
    /// How often each line was begun, by its number.
    pub counts: Vec<u64>,
    /// Output since the byte that was wanted.
    pub output: Vec<Chunk>,
    /// Bytes of output so far.
    pub output_count: u64,
    /// Given bytes that wait to be read.
    pub typed_waiting: usize,
    /// What became of the last thing that was set.
    pub answer: Option<(u64, Result<String, String>)>,
    /// Whether the world stands still now.
    pub world_frozen: bool,
}

impl View {
    /// Why the script is where it is.
    #[must_use]
    pub fn sentence(&self) -> String {
        self.reason.sentence(self.line, self.now)
    }
}

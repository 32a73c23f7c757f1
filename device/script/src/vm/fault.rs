//! What can go wrong in a running program, and where it did.

use crate::program::limits;

/// What went wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct Fault {
    /// The line of the program's text.
    pub line: u32,
    /// What went wrong.
    pub kind: FaultKind,
}

/// What can go wrong in a running program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FaultKind {
    /// An index outside its array.
    #[error("index {index} is outside the array, which has elements 0 to {last}", last = length.saturating_sub(1))]
    IndexOutside {
        /// The index, as a signed number.
        index: i32,
        /// Elements of the array.
        length: u32,
    },
    /// A whole number divided by zero.
    #[error("a division by zero")]
    DivisionByZero,
    /// RETURN outside a subroutine.
    #[error("RETURN without GOSUB")]
    NoCall,
    /// Too many calls within calls.
    #[error("more than {} GOSUBs without RETURN", limits::CALLS)]
    CallsTooDeep,
    /// The stack is full.
    #[error("the stack is full")]
    StackFull,
    /// The stack is empty where a value is wanted: a subroutine was entered without GOSUB.
    #[error("the stack is empty: was the subroutine entered without GOSUB?")]
    StackEmpty,
    /// A pointer that leads out of the memory.
    #[error("the pointer is at byte {address}; the variables have {bytes} bytes")]
    OutsideMemory {
        /// The byte that was asked for, the first of those outside.
        address: u32,
        /// Bytes of memory.
        bytes: u32,
    },
    /// A jump out of the program; only a damaged image has one.
    #[error("a jump out of the program")]
    BadJump,
}

pub(super) fn outside(index: u32, length: u32) -> FaultKind {
    FaultKind::IndexOutside { index: index as i32, length }
}

//! The system registers (MCP manual 3.1.15 and the pages of each): one table for compiler, machine, editor and reference.
//!
//! Where table and pages differ, the pages' spelling counts. SIGNALTICK, SIGNALITER and I2CERROR stand outside the table;
//! the size of SIGNALITER is assumed. The table gives SIGNALMINACTION and SIGNALMAXACTION a byte, but their values go to 0x8000,
//! so they are words here; it gives SIGNALPERCENT an unsigned word, but a signal goes both ways.

mod table;
mod values;

pub use table::{MISSPELT, REGISTERS, Register, RegisterId};
pub use values::{dispute, values};

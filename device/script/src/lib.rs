//! Script languages of motor controllers: front ends, one byte code, one virtual machine.
//!
//! Nothing here has a clock or does IO: text goes in, a program comes out; the machine takes steps when it is told to.

pub mod arithmetic;
pub mod debug;
pub mod diagnostic;
pub mod disassembly;
pub mod image;
pub mod mcl;
pub mod op;
pub mod program;
pub mod text;
pub mod vm;

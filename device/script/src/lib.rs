//! Script languages of motor controllers: front ends, one byte code, one virtual machine.
//!
#![doc = include_str!("../README.md")]

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

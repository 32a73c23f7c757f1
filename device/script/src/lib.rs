//! Script languages of motor controllers: front ends, one byte code, one virtual machine.
//!
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![doc = include_str!("../README.md")]

pub mod arithmetic;
pub mod board;
pub mod debug;
pub mod diagnostic;
pub mod disassembly;
pub mod image;
pub mod language;
mod lexing;
mod listed;
pub mod mcl;
pub mod mecc;
pub mod names;
pub mod op;
pub mod program;
pub mod text;
pub mod vm;

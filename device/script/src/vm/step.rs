//! A step of a region and all that it works on: each holds the other by its type.

use super::counter::Loop;
use super::fault::FaultKind;
use super::memory::SPAN;
use crate::arithmetic::Type;
use crate::mcl::ast::{Binary, Unary};
use crate::op::{Array, Cell, TableRef};
use crate::program::Program;

/// Cells for values in between.
pub const TEMPS: u32 = 24;
/// The most instructions that a region stands for.
pub const LONGEST_REGION: u32 = 60;
/// No region begins here.
pub const NONE: u32 = u32::MAX;

/// The regions of a program.
#[derive(Debug, Default)]
pub struct Regions {
    pub steps: Vec<Step>,
    /// The instruction that each step comes from, where a fault is.
    pub at: Vec<u32>,
    /// The first instruction of each step's region.
    pub first: Vec<u32>,
    /// The step that begins at each instruction, or [`NONE`].
    pub entry: Vec<u32>,
    pub constants: Vec<u32>,
    pub binaries: Vec<(Binary, Type)>,
    pub unaries: Vec<(Unary, Type)>,
    pub converts: Vec<(Type, Type)>,
    pub cells: Vec<Cell>,
    pub arrays: Vec<Array>,
    pub tables: Vec<TableRef>,
}

/// With less left of a budget, instructions are run one by one, so that a budget is kept exactly. A step stands for three regions at
/// most, and a turned loop counts two.
pub const MARGIN: u32 = 3 * 2 * LONGEST_REGION + 2;

/// What rarer steps work on besides memory.
pub struct Around<'a> {
    pub regions: &'a Regions,
    pub program: &'a Program,
    pub loops: &'a mut [Loop],
    pub fault: (u32, FaultKind),
}

/// Where a step at fault leads.
pub const FAULT: u32 = u32::MAX;

/// Does the step of a number with what is left of a budget; where it goes on, and what is left then.
///
/// What follows a step are the steps of its other parts, which run where a jump leads into their middle, and then the one it goes on with.
/// So a step knows its way on without having to look it up.
pub type Run = for<'a, 'b> fn(&mut [u8; SPAN], &mut Around<'a>, &'b Step, u32, u32) -> (u32, u32);

/// A step, or several in one. Places are bytes of memory.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// What it does.
    pub run: Run,
    /// Instructions done with it; 0 if its region goes on.
    pub count: u16,
    /// Row of a table, or number of a loop.
    pub row: u16,
    /// Whether its jump leads back to itself.
    pub spins: bool,
    /// Left operands of its parts.
    pub a: [u16; 3],
    /// Right operands.
    pub b: [u16; 3],
    /// Where results go.
    pub d: [u16; 3],
    /// Where a jump leads: a step, or with [`Regions::OUT`] an instruction.
    pub to: u32,
}

//! Statements of plain arithmetic, translated when a program is loaded: from the stack's instructions to steps that work on memory in
//! place, several instructions in one.
//!
//! A region is what lies between two moments with nothing of its own on the stack: an assignment, a condition with its jump, the end of a
//! FOR. It has one way in, its first instruction, and is done as a whole or up to its fault, so that lines, faults and counts are those
//! of the instructions. Whatever has no region is run instruction by instruction.

use super::Memory;
use crate::arithmetic::Type;
use crate::mcl::ast::{Binary, Unary};
use crate::mcl::types::VarType;
use crate::op::{Array, Cell, Op, TableRef};
use crate::program::Program;
use std::collections::HashMap;

/// Cells for values in between.
const TEMPS: u32 = 24;
/// The most instructions that a region stands for.
pub const LONGEST_REGION: u32 = 60;
/// Constants that get a place in memory; programs with more run the rest plainly.
const MOST_CONSTANTS: usize = 1 << 16;
/// No region begins here.
pub const NONE: u32 = u32::MAX;

/// What a step does with the cells at its places `a` and `b`, for that at `d`. Places are bytes of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Does {
    Copy,
    Add,
    Subtract,
    Multiply,
    DivideUnsigned,
    DivideSigned,
    RemainderUnsigned,
    RemainderSigned,
    And,
    Or,
    Xor,
    ShiftLeft,
    ShiftRight,
    /// Any other operator: row `b2` of [`Regions::binaries`].
    Binary,
    /// Row `b` of [`Regions::unaries`].
    Unary,
    /// Row `b` of [`Regions::converts`].
    Convert,
    /// A variable of less than 32 bits: row `a` of [`Regions::cells`].
    Load,
    Store,
    /// An element: index at `a`, row `b` of [`Regions::arrays`].
    LoadAt,
    /// An element: index at `a`, value at `d`.
    StoreAt,
    /// An entry of a table: index at `a`, row `b` of [`Regions::tables`].
    LoadTable,
    Jump,
    JumpIfZero,
    JumpIfNotZero,
    JumpIfLessUnsigned,
    JumpIfLessSigned,
    JumpUnlessLessUnsigned,
    JumpUnlessLessSigned,
    JumpIfEqual,
    JumpUnlessEqual,
    /// Loop `b` with its last value at `a` and its counter at `d`, which is a Long.
    NextUnsigned,
    /// The same for an SLong.
    NextSigned,
}

/// One step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub does: Does,
    /// Instructions done with it; 0 if the region goes on.
    pub count: u8,
    /// Row of a table for [`Does::Binary`].
    pub row: u16,
    pub a: u32,
    pub b: u32,
    pub d: u32,
    /// Where a jump leads: a step, or an instruction without one (see [`Regions::OUT`]).
    pub to: u32,
    /// Where it goes on otherwise, if the region ends with it.
    pub fall: u32,
}

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

impl Regions {
    /// A target with this bit is an instruction and no step.
    pub const OUT: u32 = 1 << 31;

    /// The regions of a program.
    pub fn of(program: &Program) -> Self {
        let mut translation = Translation {
            program,
            starts: starts(program),
            base: program.ram_bytes,
            regions: Self { entry: vec![NONE; program.ops.len() + 1], ..Self::default() },
            places: HashMap::new(),
        };
        let mut at = 0;
        while at < program.ops.len() {
            at = translation.region(at).unwrap_or(at + 1);
        }
        translation.resolve();
        translation.regions
    }

    /// Whether this is memory as [`Self::memory`] makes it, and not some that was lent.
    pub fn fits(&self, memory: &Memory) -> bool {
        memory.hidden() == (TEMPS as usize + self.constants.len()) * 4
    }

    /// Memory for the program, with cells behind its variables for constants and values in between.
    pub fn memory(&self, program: &Program) -> Memory {
        let zeros = std::iter::repeat_n(0, TEMPS as usize);
        Memory::with_hidden(program.ram_bytes, zeros.chain(self.constants.iter().copied()))
    }
}

/// Where instructions jump to: a region may begin there and cannot go over it.
fn starts(program: &Program) -> Vec<bool> {
    let mut starts = vec![false; program.ops.len() + 1];
    let mut mark = |to: u32| {
        if let Some(start) = starts.get_mut(to as usize) {
            *start = true;
        }
    };
    for (at, op) in (0u32..).zip(&program.ops) {
        match op {
            Op::Jump(to)
            | Op::JumpIfZero(to)
            | Op::JumpIfNotZero(to)
            | Op::Gosub(to, _)
            | Op::ForNext(_, _, to) => mark(*to),
            Op::I2cOut(_, _, Some(to)) | Op::I2cIn(_, Some(to)) => mark(*to),
            Op::Branch(count) => {
                (0..=*count).take(program.ops.len()).for_each(|skipped| mark(at.saturating_add(1 + skipped)));
            }
            _ => {}
        }
    }
    starts
}

/// A value on the stack of a region.
#[derive(Clone, Copy)]
enum Value {
    Known(u32),
    /// A cell of memory, by its byte.
    Place(u32),
}

struct Translation<'a> {
    program: &'a Program,
    starts: Vec<bool>,
    /// The first byte behind the variables.
    base: u32,
    regions: Regions,
    /// Places of constants.
    places: HashMap<u32, u32>,
}

/// What a region has so far.
struct Draft {
    stack: Vec<Value>,
    steps: Vec<(Step, u32)>,
    /// Cells in use for values in between.
    temps: u32,
}

impl Draft {
    fn pop(&mut self) -> Option<Value> {
        self.stack.pop()
    }

    fn step(&mut self, does: Does, a: u32, b: u32, d: u32, at: usize) {
        let step = Step { does, count: 0, row: 0, a, b, d, to: NONE, fall: NONE };
        self.steps.push((step, at as u32));
    }
}

fn is_cell(cell: Cell) -> bool {
    matches!(cell.kind, VarType::Long | VarType::SLong | VarType::Float)
}

fn row<T: PartialEq>(rows: &mut Vec<T>, value: T) -> u32 {
    let found = rows.iter().position(|row| *row == value).unwrap_or_else(|| {
        rows.push(value);
        rows.len() - 1
    });
    found as u32
}

impl Translation<'_> {
    /// Translates the region that begins at an instruction; the instruction after it, or `None` if there is none.
    fn region(&mut self, first: usize) -> Option<usize> {
        let mut draft = Draft { stack: Vec::new(), steps: Vec::new(), temps: 0 };
        let line = self.program.lines.get(first);
        let mut at = first;
        loop {
            let op = *self.program.ops.get(at)?;
            let crosses = at > first && (self.starts[at] || self.program.lines.get(at) != line);
            if crosses || at - first >= LONGEST_REGION as usize {
                return None;
            }
            let ends = self.instruction(op, at, &mut draft)?;
            at += 1;
            if ends {
                break;
            }
        }
        if !draft.stack.is_empty() {
            return None;
        }
        self.take(draft, first, at);
        Some(at)
    }

    fn take(&mut self, mut draft: Draft, first: usize, end: usize) {
        let Some((last, _)) = draft.steps.last_mut() else { return };
        last.count = (end - first) as u8;
        last.fall = end as u32;
        self.regions.entry[first] = self.regions.steps.len() as u32;
        for (step, at) in draft.steps {
            self.regions.steps.push(step);
            self.regions.at.push(at);
            self.regions.first.push(first as u32);
        }
    }

    /// Translates one instruction; whether the region ends with it. `None` if it has no step.
    fn instruction(&mut self, op: Op, at: usize, draft: &mut Draft) -> Option<bool> {
        match op {
            Op::Push(value) => draft.stack.push(Value::Known(value)),
            Op::Load(cell) if is_cell(cell) => draft.stack.push(Value::Place(cell.at / 8)),
            Op::Load(cell) => {
                let (d, a) = (self.temp(draft)?, row(&mut self.regions.cells, cell));
                draft.step(Does::Load, a, 0, d, at);
                draft.stack.push(Value::Place(d));
            }
            Op::LoadAt(array) => {
                self.take_one(draft, |regions| (Does::LoadAt, row(&mut regions.arrays, array)), at)?;
            }
            Op::LoadTable(table) => {
                self.take_one(draft, |regions| (Does::LoadTable, row(&mut regions.tables, table)), at)?;
            }
            Op::Unary(operator, kind) => {
                self.take_one(
                    draft,
                    |regions| (Does::Unary, row(&mut regions.unaries, (operator, kind))),
                    at,
                )?;
            }
            Op::Convert(from, to) => {
                self.take_one(draft, |regions| (Does::Convert, row(&mut regions.converts, (from, to))), at)?;
            }
            Op::Binary(operator, kind) => self.binary(operator, kind, at, draft)?,
            Op::Store(cell) => {
                self.store(cell, at, draft)?;
                return Some(true);
            }
            Op::StoreAt(array) => {
                let index = draft.pop()?;
                let value = draft.pop()?;
                let (a, d) = (self.place(index)?, self.place(value)?);
                draft.step(Does::StoreAt, a, row(&mut self.regions.arrays, array), d, at);
                return Some(true);
            }
            Op::Jump(_) | Op::JumpIfZero(_) | Op::JumpIfNotZero(_) | Op::ForNext(..) => {
                self.jump(op, at, draft)?;
                return Some(true);
            }
            _ => return None,
        }
        Some(false)
    }

    /// A step that takes one value and gives one.
    fn take_one(
        &mut self,
        draft: &mut Draft,
        what: impl FnOnce(&mut Regions) -> (Does, u32),
        at: usize,
    ) -> Option<()> {
        let value = draft.pop()?;
        let a = self.place(value)?;
        let (does, b) = what(&mut self.regions);
        let d = self.temp(draft)?;
        draft.step(does, a, b, d, at);
        draft.stack.push(Value::Place(d));
        Some(())
    }

    fn binary(&mut self, operator: Binary, kind: Type, at: usize, draft: &mut Draft) -> Option<()> {
        let (right, left) = (draft.pop()?, draft.pop()?);
        let (a, b) = (self.place(left)?, self.place(right)?);
        let d = self.temp(draft)?;
        let does = step_of(operator, kind);
        draft.step(does, a, b, d, at);
        if let (Does::Binary, Some((step, _))) = (does, draft.steps.last_mut()) {
            step.row = u16::try_from(row(&mut self.regions.binaries, (operator, kind))).ok()?;
        }
        draft.stack.push(Value::Place(d));
        Some(())
    }

    fn store(&mut self, cell: Cell, at: usize, draft: &mut Draft) -> Option<()> {
        let value = draft.pop()?;
        let a = self.place(value)?;
        if !is_cell(cell) {
            let b = row(&mut self.regions.cells, cell);
            draft.step(Does::Store, a, b, 0, at);
            return Some(());
        }
        let d = cell.at / 8;
        match draft.steps.last_mut() {
            // The value in between was made by the last step: it can go to the variable at once.
            Some((step, _)) if step.d == a && a >= self.base && step.does != Does::StoreAt => step.d = d,
            _ => draft.step(Does::Copy, a, 0, d, at),
        }
        Some(())
    }

    fn jump(&mut self, op: Op, at: usize, draft: &mut Draft) -> Option<()> {
        let (does, a, b, d, to) = match op {
            Op::Jump(to) => (Does::Jump, 0, 0, 0, to),
            Op::ForNext(cell, number, to) if matches!(cell.kind, VarType::Long | VarType::SLong) => {
                let value = draft.pop()?;
                let does = if cell.kind == VarType::Long { Does::NextUnsigned } else { Does::NextSigned };
                (does, self.place(value)?, number, cell.at / 8, to)
            }
            Op::JumpIfZero(to) | Op::JumpIfNotZero(to) => {
                let value = draft.pop()?;
                let a = self.place(value)?;
                let if_zero = matches!(op, Op::JumpIfZero(_));
                if let Some((does, a, b)) =
                    draft.steps.last().and_then(|(step, _)| self.compared(step, a, if_zero))
                {
                    draft.steps.pop();
                    (does, a, b, 0, to)
                } else {
                    (if if_zero { Does::JumpIfZero } else { Does::JumpIfNotZero }, a, 0, 0, to)
                }
            }
            _ => return None,
        };
        draft.step(does, a, b, d, at);
        if let Some((step, _)) = draft.steps.last_mut() {
            step.to = to;
        }
        Some(())
    }

    /// A comparison and the jump on its result, in one.
    fn compared(&self, step: &Step, a: u32, if_zero: bool) -> Option<(Does, u32, u32)> {
        if step.does != Does::Binary || step.d != a || a < self.base {
            return None;
        }
        let (operator, kind) = *self.regions.binaries.get(usize::from(step.row))?;
        let signed = match kind {
            Type::Signed => true,
            Type::Unsigned => false,
            Type::Float => return None,
        };
        // Whether the jump is made when the left is less, and the order of the two.
        let (less, swapped) = match operator {
            Binary::Less => (!if_zero, false),
            Binary::Greater => (!if_zero, true),
            Binary::GreaterOrEqual => (if_zero, false),
            Binary::LessOrEqual => (if_zero, true),
            Binary::Equal | Binary::NotEqual => {
                let equal = (operator == Binary::Equal) != if_zero;
                return Some((if equal { Does::JumpIfEqual } else { Does::JumpUnlessEqual }, step.a, step.b));
            }
            _ => return None,
        };
        let does = match (less, signed) {
            (true, false) => Does::JumpIfLessUnsigned,
            (true, true) => Does::JumpIfLessSigned,
            (false, false) => Does::JumpUnlessLessUnsigned,
            (false, true) => Does::JumpUnlessLessSigned,
        };
        Some(if swapped { (does, step.b, step.a) } else { (does, step.a, step.b) })
    }

    fn temp(&self, draft: &mut Draft) -> Option<u32> {
        let temp = draft.temps;
        draft.temps += 1;
        (temp < TEMPS).then_some(self.base + temp * 4)
    }

    /// Where a value lies; constants get a place.
    fn place(&mut self, value: Value) -> Option<u32> {
        let known = match value {
            Value::Place(place) => return Some(place),
            Value::Known(known) => known,
        };
        if let Some(place) = self.places.get(&known) {
            return Some(*place);
        }
        if self.regions.constants.len() >= MOST_CONSTANTS {
            return None;
        }
        let place = self.base + (TEMPS + self.regions.constants.len() as u32) * 4;
        self.regions.constants.push(known);
        self.places.insert(known, place);
        Some(place)
    }

    /// Turns the targets of jumps from instructions into steps, and jumps back to a condition into the condition itself.
    fn resolve(&mut self) {
        for index in 0..self.regions.steps.len() {
            if self.regions.steps[index].does == Does::Jump {
                self.turn_loop(index);
            }
        }
        let entry = &self.regions.entry;
        for target in self.regions.steps.iter_mut().flat_map(|step| [&mut step.to, &mut step.fall]) {
            if *target != NONE {
                let step = entry.get(*target as usize).copied().unwrap_or(NONE);
                *target = if step == NONE { *target | Regions::OUT } else { step };
            }
        }
    }

    /// A jump back to the condition of a WHILE, whose way out is the instruction after that jump: it is asked at the end of the loop.
    fn turn_loop(&mut self, index: usize) -> Option<()> {
        let jump = self.regions.steps[index];
        let head = *self.regions.entry.get(jump.to as usize)?;
        let condition = *self.regions.steps.get(head as usize)?;
        let after = self.regions.at[index] + 1;
        let is_alone = condition.count > 0 && self.regions.first[head as usize] == jump.to;
        if !is_alone || condition.to != after || self.regions.at[head as usize] >= self.regions.at[index] {
            return None;
        }
        let does = match condition.does {
            Does::JumpIfLessUnsigned => Does::JumpUnlessLessUnsigned,
            Does::JumpIfLessSigned => Does::JumpUnlessLessSigned,
            Does::JumpUnlessLessUnsigned => Does::JumpIfLessUnsigned,
            Does::JumpUnlessLessSigned => Does::JumpIfLessSigned,
            Does::JumpIfEqual => Does::JumpUnlessEqual,
            Does::JumpUnlessEqual => Does::JumpIfEqual,
            Does::JumpIfZero => Does::JumpIfNotZero,
            Does::JumpIfNotZero => Does::JumpIfZero,
            _ => return None,
        };
        let count = jump.count + condition.count;
        let to = jump.to + u32::from(condition.count);
        self.regions.steps[index] = Step { does, count, to, fall: jump.fall, ..condition };
        Some(())
    }
}

fn step_of(operator: Binary, kind: Type) -> Does {
    match (operator, kind) {
        (_, Type::Float) => Does::Binary,
        (Binary::Add, _) => Does::Add,
        (Binary::Subtract, _) => Does::Subtract,
        (Binary::Multiply, _) => Does::Multiply,
        (Binary::Divide, Type::Unsigned) => Does::DivideUnsigned,
        (Binary::Divide, Type::Signed) => Does::DivideSigned,
        (Binary::Remainder, Type::Unsigned) => Does::RemainderUnsigned,
        (Binary::Remainder, Type::Signed) => Does::RemainderSigned,
        (Binary::BitAnd, _) => Does::And,
        (Binary::BitOr, _) => Does::Or,
        (Binary::BitXor, _) => Does::Xor,
        (Binary::ShiftLeft, _) => Does::ShiftLeft,
        (Binary::ShiftRight, _) => Does::ShiftRight,
        _ => Does::Binary,
    }
}

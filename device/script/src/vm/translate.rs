//! Translates the statements of a program to the steps of regions, before several become one (see `regions`).

use super::memory::SPAN;
use super::step::{LONGEST_REGION, NONE, Regions, TEMPS};
use super::steps::{Alu, Jump};
use crate::arithmetic::Type;
use crate::mcl::ast::Binary;
use crate::mcl::types::VarType;
use crate::op::{Array, Cell, Op};
use crate::program::Program;
use std::collections::HashMap;

/// What a step does with the cells at its places `a` and `b`, for that at `d`. Places are bytes of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Does {
    /// What cannot fail.
    Alu(Alu),
    /// A jump ends its region.
    Jump(Jump),
    DivideUnsigned,
    DivideSigned,
    RemainderUnsigned,
    RemainderSigned,
    /// Any other operator, by its row.
    Binary,
    Unary,
    Convert,
    /// A variable of less than 32 bits, by its row.
    LoadPart,
    StorePart,
    /// An element of the array of the row: index at `a`.
    LoadAt,
    /// Index at `a`, value at `b`.
    StoreAt,
    /// An element of 32 bits of the array of `row` elements that begins at `b`.
    LoadCellAt,
    /// The same, which begins at `d`; value at `b`.
    StoreCellAt,
    LoadTable,
    /// See `fast::for_start`.
    ForStart,
    /// The loop of the row, of any counter: the row of cells `d`.
    ForNext,
    /// Leaves for an instruction, where no region follows the one before.
    Exit,
}

/// One step as it is translated.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    pub does: Does,
    /// Instructions done with it; 0 if the region goes on.
    pub count: u16,
    /// Row of a table, or number of a loop.
    pub row: u16,
    pub a: u16,
    pub b: u16,
    pub d: u16,
    /// Second operands of the few that have them.
    pub more: [u16; 3],
    /// Where a jump leads.
    pub to: u32,
    /// The instruction that it comes from, where a fault is.
    pub at: u32,
    /// The first instruction of its region.
    pub first: u32,
}

/// Translates a program: plans, with instructions as targets.
pub fn translate(program: &Program, regions: &mut Regions) -> Vec<Plan> {
    let mut translation =
        Translation { program, starts: starts(program), regions, plans: Vec::new(), places: HashMap::new() };
    let mut at = 0;
    while at < program.ops.len() {
        match translation.region(at) {
            Some(end) => at = end,
            None => {
                translation.leave_for(at);
                at += 1;
            }
        }
    }
    translation.leave_for(at);
    translation.plans
}

/// Where instructions jump to: a region may begin there and cannot go over it.
fn starts(program: &Program) -> Vec<bool> {
    let mut starts = vec![false; program.ops.len() + 1];
    // Up to where the tables of BRANCHes have been marked: those of an image may lie across each other.
    let mut branched = 0;
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
                let end = at.saturating_add(1).saturating_add(*count).min(program.ops.len() as u32);
                (branched.max(at + 1)..=end).for_each(&mut mark);
                branched = branched.max(end + 1);
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
    Place(u16),
}

struct Translation<'a> {
    program: &'a Program,
    starts: Vec<bool>,
    regions: &'a mut Regions,
    plans: Vec<Plan>,
    /// Places of constants.
    places: HashMap<u32, u16>,
}

/// What a region has so far.
struct Draft {
    stack: Vec<Value>,
    plans: Vec<Plan>,
    /// Cells in use for values in between.
    temps: u32,
    first: u32,
}

impl Draft {
    fn pop(&mut self) -> Option<Value> {
        self.stack.pop()
    }

    fn step(&mut self, does: Does, a: u16, b: u16, d: u16, at: usize) -> &mut Plan {
        let (at, first) = (at as u32, self.first);
        self.plans.push(Plan { does, count: 0, row: 0, a, b, d, more: [0; 3], to: NONE, at, first });
        let last = self.plans.len() - 1;
        &mut self.plans[last]
    }
}

fn is_cell(cell: Cell) -> bool {
    matches!(cell.kind, VarType::Long | VarType::SLong | VarType::Float)
}

/// The byte of a variable, if steps reach it.
fn byte_of(cell: Cell) -> Option<u16> {
    u16::try_from(cell.at / 8).ok()
}

/// First byte and length of an array whose elements are cells in a row, if steps reach it.
fn cells_of(array: Array) -> Option<(u16, u16)> {
    let end = u64::from(array.first.at) + u64::from(array.length) * 32;
    let fits = is_cell(array.first) && array.stride == 32 && end / 8 < SPAN as u64;
    fits.then_some(())?;
    Some((byte_of(array.first)?, u16::try_from(array.length).ok()?))
}

fn row<T: PartialEq>(rows: &mut Vec<T>, value: T) -> Option<u16> {
    let found = rows.iter().position(|row| *row == value).unwrap_or_else(|| {
        rows.push(value);
        rows.len() - 1
    });
    u16::try_from(found).ok()
}

impl Translation<'_> {
    /// Translates the region that begins at an instruction; the instruction after it, or `None` if there is none.
    fn region(&mut self, first: usize) -> Option<usize> {
        let mut draft = Draft { stack: Vec::new(), plans: Vec::new(), temps: 0, first: first as u32 };
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
        let last = draft.plans.last_mut()?;
        last.count = (at - first) as u16;
        self.plans.append(&mut draft.plans);
        Some(at)
    }

    /// After a region that ends here: on with the instruction here.
    fn leave_for(&mut self, at: usize) {
        let at = at as u32;
        let Some(last) = self.plans.last().copied().filter(|last| last.does != Does::Exit) else { return };
        if last.first + u32::from(last.count) == at {
            self.plans.push(Plan { does: Does::Exit, count: 0, to: at, at, first: at, ..last });
        }
    }

    /// Translates one instruction; whether the region ends with it. `None` if it has no step.
    fn instruction(&mut self, op: Op, at: usize, draft: &mut Draft) -> Option<bool> {
        match op {
            Op::Push(value) => draft.stack.push(Value::Known(value)),
            Op::Load(cell) if is_cell(cell) => draft.stack.push(Value::Place(byte_of(cell)?)),
            Op::Load(cell) => {
                let (d, row) = (self.temp(draft)?, row(&mut self.regions.cells, cell)?);
                draft.step(Does::LoadPart, 0, 0, d, at).row = row;
                draft.stack.push(Value::Place(d));
            }
            Op::LoadAt(array) => match cells_of(array) {
                Some((first, length)) => self.take_one(draft, Does::LoadCellAt, first, length, at)?,
                None => {
                    let row = row(&mut self.regions.arrays, array)?;
                    self.take_one(draft, Does::LoadAt, 0, row, at)?;
                }
            },
            Op::LoadTable(table) => {
                let row = row(&mut self.regions.tables, table)?;
                self.take_one(draft, Does::LoadTable, 0, row, at)?;
            }
            Op::Unary(operator, kind) => {
                let row = row(&mut self.regions.unaries, (operator, kind))?;
                self.take_one(draft, Does::Unary, 0, row, at)?;
            }
            Op::Convert(from, to) => {
                let row = row(&mut self.regions.converts, (from, to))?;
                self.take_one(draft, Does::Convert, 0, row, at)?;
            }
            Op::Binary(operator, kind) => self.binary(operator, kind, at, draft)?,
            ends => {
                self.end(ends, at, draft)?;
                return Some(true);
            }
        }
        Some(false)
    }

    /// Translates an instruction that leaves nothing on the stack.
    fn end(&mut self, op: Op, at: usize, draft: &mut Draft) -> Option<()> {
        match op {
            Op::Store(cell) => self.store(cell, at, draft),
            Op::StoreAt(array) => {
                let (index, value) = (draft.pop()?, draft.pop()?);
                let (a, b) = (self.place(index)?, self.place(value)?);
                let (does, d, row) = match cells_of(array) {
                    Some((first, length)) => (Does::StoreCellAt, first, length),
                    None => (Does::StoreAt, 0, row(&mut self.regions.arrays, array)?),
                };
                draft.step(does, a, b, d, at).row = row;
                Some(())
            }
            Op::ForStart(cell, number, has_step) => self.for_start(cell, number, has_step, at, draft),
            Op::ForNext(cell, number, to) => self.for_next(cell, number, to, at, draft),
            Op::Jump(to) => {
                draft.step(Does::Jump(Jump::Always), 0, 0, 0, at).to = to;
                Some(())
            }
            Op::JumpIfZero(to) => self.jump(to, true, at, draft),
            Op::JumpIfNotZero(to) => self.jump(to, false, at, draft),
            _ => None,
        }
    }

    /// A step that takes one value and gives one.
    fn take_one(&mut self, draft: &mut Draft, does: Does, b: u16, row: u16, at: usize) -> Option<()> {
        let value = draft.pop()?;
        let a = self.place(value)?;
        let d = self.temp(draft)?;
        draft.step(does, a, b, d, at).row = row;
        draft.stack.push(Value::Place(d));
        Some(())
    }

    fn binary(&mut self, operator: Binary, kind: Type, at: usize, draft: &mut Draft) -> Option<()> {
        let (right, left) = (draft.pop()?, draft.pop()?);
        let (a, b) = (self.place(left)?, self.place(right)?);
        let d = self.temp(draft)?;
        let does = step_of(operator, kind);
        let row = if does == Does::Binary { row(&mut self.regions.binaries, (operator, kind))? } else { 0 };
        draft.step(does, a, b, d, at).row = row;
        draft.stack.push(Value::Place(d));
        Some(())
    }

    fn store(&mut self, cell: Cell, at: usize, draft: &mut Draft) -> Option<()> {
        let value = draft.pop()?;
        let a = self.place(value)?;
        if !is_cell(cell) {
            draft.step(Does::StorePart, a, 0, 0, at).row = row(&mut self.regions.cells, cell)?;
            return Some(());
        }
        let d = byte_of(cell)?;
        match draft.plans.last_mut() {
            // The value in between was made by the last step: it can go to the variable at once.
            Some(plan) if plan.d == a && self.is_temp(a) && plan.does != Does::StorePart => plan.d = d,
            _ => {
                draft.step(Does::Alu(Alu::Copy), a, 0, d, at);
            }
        }
        Some(())
    }

    fn for_start(
        &mut self,
        cell: Cell,
        number: u32,
        has_step: bool,
        at: usize,
        draft: &mut Draft,
    ) -> Option<()> {
        let step = if has_step { Some(draft.pop()?) } else { None };
        let (finish, start) = (draft.pop()?, draft.pop()?);
        let (a, b) = (self.place(start)?, self.place(finish)?);
        let step = match step {
            Some(step) => [self.place(step)?, 1],
            None => [0, 0],
        };
        let (row, counter) = (u16::try_from(number).ok()?, row(&mut self.regions.cells, cell)?);
        let plan = draft.step(Does::ForStart, a, b, 0, at);
        plan.row = row;
        plan.more = [step[0], step[1], counter];
        Some(())
    }

    fn for_next(&mut self, cell: Cell, number: u32, to: u32, at: usize, draft: &mut Draft) -> Option<()> {
        let finish = draft.pop()?;
        let a = self.place(finish)?;
        let (does, d) = match cell.kind {
            VarType::Long => (Does::Jump(Jump::NextUnsigned), byte_of(cell)?),
            VarType::SLong => (Does::Jump(Jump::NextSigned), byte_of(cell)?),
            _ => (Does::ForNext, row(&mut self.regions.cells, cell)?),
        };
        let plan = draft.step(does, a, 0, d, at);
        plan.row = u16::try_from(number).ok()?;
        plan.to = to;
        Some(())
    }

    fn jump(&mut self, to: u32, if_zero: bool, at: usize, draft: &mut Draft) -> Option<()> {
        let value = draft.pop()?;
        let a = self.place(value)?;
        let compared = draft.plans.last().and_then(|plan| self.compared(plan, a, if_zero));
        let (jump, a, b) = match compared {
            Some(jump) => {
                draft.plans.pop();
                jump
            }
            None => (if if_zero { Jump::IfZero } else { Jump::IfNotZero }, a, 0),
        };
        draft.step(Does::Jump(jump), a, b, 0, at).to = to;
        Some(())
    }

    /// A comparison and the jump on its result, in one.
    fn compared(&self, plan: &Plan, a: u16, if_zero: bool) -> Option<(Jump, u16, u16)> {
        if plan.does != Does::Binary || plan.d != a || !self.is_temp(a) {
            return None;
        }
        let (operator, kind) = *self.regions.binaries.get(usize::from(plan.row))?;
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
                return Some((if equal { Jump::IfEqual } else { Jump::UnlessEqual }, plan.a, plan.b));
            }
            _ => return None,
        };
        let jump = match (less, signed) {
            (true, false) => Jump::IfLessUnsigned,
            (true, true) => Jump::IfLessSigned,
            (false, false) => Jump::UnlessLessUnsigned,
            (false, true) => Jump::UnlessLessSigned,
        };
        Some(if swapped { (jump, plan.b, plan.a) } else { (jump, plan.a, plan.b) })
    }

    fn is_temp(&self, place: u16) -> bool {
        u32::from(place) >= self.program.ram_bytes
    }

    fn temp(&self, draft: &mut Draft) -> Option<u16> {
        let temp = draft.temps;
        draft.temps += 1;
        (temp < TEMPS).then(|| self.program.ram_bytes + temp * 4).and_then(|at| u16::try_from(at).ok())
    }

    /// Where a value lies; constants get a place.
    fn place(&mut self, value: Value) -> Option<u16> {
        let known = match value {
            Value::Place(place) => return Some(place),
            Value::Known(known) => known,
        };
        if let Some(place) = self.places.get(&known) {
            return Some(*place);
        }
        let place = self.program.ram_bytes + (TEMPS + self.regions.constants.len() as u32) * 4;
        let place = u16::try_from(place).ok()?;
        self.regions.constants.push(known);
        self.places.insert(known, place);
        Some(place)
    }
}

fn step_of(operator: Binary, kind: Type) -> Does {
    match (operator, kind) {
        (_, Type::Float) => Does::Binary,
        (Binary::Add, _) => Does::Alu(Alu::Add),
        (Binary::Subtract, _) => Does::Alu(Alu::Subtract),
        (Binary::Multiply, _) => Does::Alu(Alu::Multiply),
        (Binary::Divide, Type::Unsigned) => Does::DivideUnsigned,
        (Binary::Divide, Type::Signed) => Does::DivideSigned,
        (Binary::Remainder, Type::Unsigned) => Does::RemainderUnsigned,
        (Binary::Remainder, Type::Signed) => Does::RemainderSigned,
        (Binary::BitAnd, _) => Does::Alu(Alu::And),
        (Binary::BitOr, _) => Does::Alu(Alu::Or),
        (Binary::BitXor, _) => Does::Alu(Alu::Xor),
        (Binary::ShiftLeft, _) => Does::Alu(Alu::ShiftLeft),
        (Binary::ShiftRight, _) => Does::Alu(Alu::ShiftRight),
        _ => Does::Binary,
    }
}

//! Runs regions (see `regions`): statements of plain arithmetic without going through the stack.

use super::counter::{Loop, step_of};
use super::execute::{entry, type_of};
use super::fault::{FaultKind, outside};
use super::memory::{SPAN, cell, load, set_cell, store};
use super::step::{Around, FAULT, MARGIN, NONE, Regions, Step};
use super::{Machine, element};
use crate::arithmetic;
use crate::program::Program;

impl Machine {
    /// Runs regions from the one that begins here until there is none or the budget is nearly used up; what is left of it.
    pub(super) fn run_regions(&mut self, regions: &Regions, program: &Program, budget: u32) -> u32 {
        let Some(first) = regions.entry.get(self.at as usize).copied().filter(|step| *step != NONE) else {
            return budget;
        };
        let Some(bytes) = self.memory.all_for(regions) else { return budget };
        let fault = (0, FaultKind::DivisionByZero);
        let mut around = Around { regions, program, loops: &mut self.loops, fault };
        let steps = &regions.steps[..];
        let (mut left, mut here, mut next) = (budget, first, first);
        while let Some(step) = steps.get(next as usize) {
            here = next;
            (next, left) = (step.run)(bytes, &mut around, step, here, left);
            if left < MARGIN {
                break;
            }
        }
        let (part, fault) = around.fault;
        if next == FAULT {
            let (at, first) = (regions.at[(here + part) as usize], regions.first[here as usize]);
            left -= at - first + 1;
            self.executed += u64::from(budget - left);
            self.fault(at, fault);
        } else {
            self.executed += u64::from(budget - left);
            self.at = regions.instruction(next);
        }
        left
    }
}

impl Around<'_> {
    /// The loop of this number.
    #[inline(always)]
    pub fn counted(&self, number: u16) -> Loop {
        self.loops.get(usize::from(number)).copied().unwrap_or_default()
    }

    fn result(
        &mut self,
        bytes: &mut [u8; SPAN],
        step: &Step,
        here: u32,
        left: u32,
        value: Result<u32, FaultKind>,
    ) -> (u32, u32) {
        match value {
            Ok(value) => {
                set_cell(bytes, step.d[0], value);
                step.done::<1>(here, left)
            }
            Err(kind) => self.fault(left, 0, kind),
        }
    }

    /// A part of a step went wrong; those before it belong to the same region.
    #[cold]
    pub fn fault(&mut self, left: u32, part: u32, kind: FaultKind) -> (u32, u32) {
        self.fault = (part, kind);
        (FAULT, left)
    }
}

/// Any operator of two values, by its row.
pub fn binary(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let (operator, kind) = around.regions.binaries[usize::from(step.row)];
    let value = arithmetic::binary(operator, kind, cell(bytes, step.a[0]), cell(bytes, step.b[0]));
    around.result(bytes, step, here, left, value.map_err(|_| FaultKind::DivisionByZero))
}

/// Division and remainder.
pub fn divide<const SIGNED: bool, const REMAINDER: bool>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let (a, b) = (cell(bytes, step.a[0]), cell(bytes, step.b[0]));
    if b == 0 {
        return around.fault(left, 0, FaultKind::DivisionByZero);
    }
    let value = match (SIGNED, REMAINDER) {
        (false, false) => a / b,
        (false, true) => a % b,
        (true, false) => (a as i32).wrapping_div(b as i32) as u32,
        (true, true) => (a as i32).wrapping_rem(b as i32) as u32,
    };
    set_cell(bytes, step.d[0], value);
    step.done::<1>(here, left)
}

/// Any operator of one value.
pub fn unary(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let (operator, kind) = around.regions.unaries[usize::from(step.row)];
    let value = arithmetic::unary(operator, kind, cell(bytes, step.a[0]));
    around.result(bytes, step, here, left, Ok(value))
}

/// A value as another type.
pub fn convert(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let (from, to) = around.regions.converts[usize::from(step.row)];
    let value = arithmetic::convert(cell(bytes, step.a[0]), from, to);
    around.result(bytes, step, here, left, Ok(value))
}

/// A variable of less than 32 bits.
pub fn load_part(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let value = load(bytes, around.regions.cells[usize::from(step.row)]);
    around.result(bytes, step, here, left, Ok(value))
}

/// The same, stored.
pub fn store_part(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let value = cell(bytes, step.a[0]);
    store(bytes, around.regions.cells[usize::from(step.row)], value);
    step.done::<1>(here, left)
}

/// An element of an array.
pub fn load_at(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let array = around.regions.arrays[usize::from(step.row)];
    let index = cell(bytes, step.a[0]);
    let value = element(array, index).map(|place| load(bytes, place)).ok_or(outside(index, array.length));
    around.result(bytes, step, here, left, value)
}

/// A value from `b` into an element.
pub fn store_at(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let array = around.regions.arrays[usize::from(step.row)];
    let index = cell(bytes, step.a[0]);
    let Some(place) = element(array, index) else {
        return around.fault(left, 0, outside(index, array.length));
    };
    let value = cell(bytes, step.b[0]);
    store(bytes, place, value);
    step.done::<1>(here, left)
}

/// An entry of a table.
pub fn load_table(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let table = around.regions.tables[usize::from(step.row)];
    let value = entry(around.program, table, cell(bytes, step.a[0]));
    around.result(bytes, step, here, left, value)
}

/// Begins the loop `row`: first value at `a`, last at `b`, step in the second `a` if the second `b` is not 0, counter in the row of cells
/// named by the second `d`.
pub fn for_start(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let (start, finish) = (cell(bytes, step.a[0]), cell(bytes, step.b[0]));
    let counter = around.regions.cells[usize::from(step.d[1])];
    let by =
        if step.b[1] == 0 { step_of(type_of(counter.kind), start, finish) } else { cell(bytes, step.a[1]) };
    store(bytes, counter, start);
    if let Some(counted) = around.loops.get_mut(usize::from(step.row)) {
        *counted = Loop { start, step: by };
    }
    step.done::<1>(here, left)
}

/// Counts the loop `row` of any counter (row of cells `d`), whose last value is at `a`.
pub fn for_next(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let counter = around.regions.cells[usize::from(step.d[0])];
    let finish = cell(bytes, step.a[0]);
    let (next, goes_on) = around.counted(step.row).next(type_of(counter.kind), load(bytes, counter), finish);
    store(bytes, counter, next);
    let (fall, left) = step.done::<1>(here, left);
    (if goes_on { step.to } else { fall }, left)
}

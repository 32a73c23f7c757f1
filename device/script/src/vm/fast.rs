//! Runs regions (see `regions`): statements of plain arithmetic without going through the stack.

use super::execute::{entry, outside};
use super::memory::{cell, load, set_cell, store};
use super::regions::{Does, LONGEST_REGION, NONE, Regions, Step};
use super::{FaultKind, Loop, Machine, element};
use crate::arithmetic;
use crate::program::Program;

/// With less left of a budget, instructions are run one by one, so that a budget is kept exactly. Turned loops count two regions.
pub const MARGIN: u32 = 2 * LONGEST_REGION + 2;

impl Machine {
    /// Runs regions from the one that begins here until there is none or the budget is nearly used up; what is left of it.
    pub(super) fn run_regions(&mut self, regions: &Regions, program: &Program, budget: u32) -> u32 {
        let Some(first) = regions.entry.get(self.at as usize).copied().filter(|step| *step != NONE) else {
            return budget;
        };
        if !regions.fits(&self.memory) {
            return budget;
        }
        let mut left = budget;
        let mut run = Run { regions, program, bytes: self.memory.all(), loops: &mut self.loops };
        match run.steps(first as usize, &mut left) {
            Ok(at) => {
                self.executed += u64::from(budget - left);
                self.at = at;
            }
            Err((step, kind)) => {
                let at = regions.at[step];
                left -= at - regions.first[step] + 1;
                self.executed += u64::from(budget - left);
                self.fault(at, kind);
            }
        }
        left
    }
}

/// What steps work on.
struct Run<'a> {
    regions: &'a Regions,
    program: &'a Program,
    bytes: &'a mut [u8],
    loops: &'a mut [Loop],
}

impl Run<'_> {
    /// Runs until the way leads out: the next instruction, or the step at fault.
    fn steps(&mut self, mut next: usize, budget: &mut u32) -> Result<u32, (usize, FaultKind)> {
        let steps = &self.regions.steps[..];
        let mut left = *budget;
        // Ends a region: on to where it leads, or out.
        macro_rules! go {
            ($step:ident, $jumps:expr) => {{
                let target = if $jumps { $step.to } else { $step.fall };
                left -= u32::from($step.count);
                if target >= Regions::OUT || left < MARGIN {
                    break Ok(self.regions.instruction(target));
                }
                next = target as usize;
                continue;
            }};
        }
        let out = loop {
            let Some(step) = steps.get(next) else { break Ok(0) };
            let (a, b) = (cell(self.bytes, step.a), cell(self.bytes, step.b));
            let value = match step.does {
                Does::Copy => a,
                Does::Add => a.wrapping_add(b),
                Does::Subtract => a.wrapping_sub(b),
                Does::Multiply => a.wrapping_mul(b),
                Does::And => a & b,
                Does::Or => a | b,
                Does::Xor => a ^ b,
                Does::ShiftLeft => a.checked_shl(b).unwrap_or(0),
                Does::ShiftRight => a.checked_shr(b).unwrap_or(0),
                Does::DivideUnsigned if b != 0 => a / b,
                Does::RemainderUnsigned if b != 0 => a % b,
                Does::DivideSigned if b != 0 => (a as i32).wrapping_div(b as i32) as u32,
                Does::RemainderSigned if b != 0 => (a as i32).wrapping_rem(b as i32) as u32,
                Does::Jump => go!(step, true),
                Does::JumpIfZero => go!(step, a == 0),
                Does::JumpIfNotZero => go!(step, a != 0),
                Does::JumpIfLessUnsigned => go!(step, a < b),
                Does::JumpUnlessLessUnsigned => go!(step, a >= b),
                Does::JumpIfLessSigned => go!(step, (a as i32) < b as i32),
                Does::JumpUnlessLessSigned => go!(step, a as i32 >= b as i32),
                Does::JumpIfEqual => go!(step, a == b),
                Does::JumpUnlessEqual => go!(step, a != b),
                Does::NextUnsigned => go!(step, self.next(step, a, i64::from)),
                Does::NextSigned => go!(step, self.next(step, a, |cell| i64::from(cell as i32))),
                _ => match self.other(step, a, b) {
                    Ok(Some(value)) => value,
                    Ok(None) => go!(step, false),
                    Err(kind) => break Err((next, kind)),
                },
            };
            set_cell(self.bytes, step.d, value);
            next += 1;
            if step.count > 0 {
                left -= u32::from(step.count);
                if step.fall >= Regions::OUT || left < MARGIN {
                    break Ok(self.regions.instruction(step.fall));
                }
            }
        };
        *budget = left;
        out
    }

    /// Counts a loop; whether it goes on.
    #[inline(always)]
    fn next(&mut self, step: &Step, finish: u32, wide: impl Fn(u32) -> i64) -> bool {
        let counted = self.loops.get(step.b as usize).copied().unwrap_or_default();
        let next = wide(cell(self.bytes, step.d)) + i64::from(counted.step as i32);
        set_cell(self.bytes, step.d, next as u32);
        let (start, finish) = (wide(counted.start), wide(finish));
        start.min(finish) <= next && next <= start.max(finish)
    }

    /// Steps that are rarer: the value for `d`, or none if all is done.
    #[inline(never)]
    fn other(&mut self, step: &Step, a: u32, b: u32) -> Result<Option<u32>, FaultKind> {
        let regions = self.regions;
        Ok(Some(match step.does {
            Does::Binary => {
                let (operator, kind) = regions.binaries[usize::from(step.row)];
                arithmetic::binary(operator, kind, a, b).map_err(|_| FaultKind::DivisionByZero)?
            }
            Does::Unary => {
                let (operator, kind) = regions.unaries[step.b as usize];
                arithmetic::unary(operator, kind, a)
            }
            Does::Convert => {
                let (from, to) = regions.converts[step.b as usize];
                arithmetic::convert(a, from, to)
            }
            Does::Load => load(self.bytes, regions.cells[step.a as usize]),
            Does::Store => {
                store(self.bytes, regions.cells[step.b as usize], a);
                return Ok(None);
            }
            Does::LoadAt => {
                let array = regions.arrays[step.b as usize];
                load(self.bytes, element(array, a).ok_or(outside(a, array.length))?)
            }
            Does::StoreAt => {
                let array = regions.arrays[step.b as usize];
                let place = element(array, a).ok_or(outside(a, array.length))?;
                let value = cell(self.bytes, step.d);
                store(self.bytes, place, value);
                return Ok(None);
            }
            Does::LoadTable => entry(self.program, regions.tables[step.b as usize], a)?,
            // Divisions by zero: all others have been done.
            _ => return Err(FaultKind::DivisionByZero),
        }))
    }
}

impl Regions {
    /// The instruction that a target stands for.
    fn instruction(&self, target: u32) -> u32 {
        if target >= Self::OUT { target & !Self::OUT } else { self.first[target as usize] }
    }
}

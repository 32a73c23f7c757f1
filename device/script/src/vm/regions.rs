//! Statements of plain arithmetic, translated when a program is loaded: from the stack's instructions to steps that work on memory in
//! place, several instructions in one.
//!
//! A region is what lies between two moments with nothing of its own on the stack: an assignment, a condition with its jump, the
//! beginning or the end of a FOR. It has one way in, its first instruction, and is done as a whole or up to its fault, so that lines,
//! faults and counts are those of the instructions. Whatever has no region is run instruction by instruction.

use super::fast;
use super::memory::{Memory, SPAN};
use super::step::{NONE, Regions, Run, Step, TEMPS};
use super::steps::{self, Alu, Jump};
use super::translate::{Does, Plan, translate};
use crate::program::Program;

impl Regions {
    /// A target with this bit is an instruction and no step.
    const OUT: u32 = 1 << 31;

    /// The regions of a program.
    pub fn of(program: &Program) -> Self {
        let mut regions = Self::default();
        let mut plans = translate(program, &mut regions);
        regions.entry = entries(&plans, program.ops.len());
        turn_loops(&mut plans, &regions.entry);
        resolve(&mut plans, &regions.entry);
        regions.at = plans.iter().map(|plan| plan.at).collect();
        regions.first = plans.iter().map(|plan| plan.first).collect();
        regions.steps = (0..plans.len()).map(|index| fused(&plans[index..], index as u32)).collect();
        regions
    }

    /// Memory for the program, with cells behind its variables for values in between and constants.
    pub fn memory(&self, program: &Program) -> Memory {
        if self.steps.is_empty() {
            return Memory::new(program.ram_bytes);
        }
        let zeros = std::iter::repeat_n(0, TEMPS as usize);
        Memory::with_hidden(program.ram_bytes, zeros.chain(self.constants.iter().copied()))
    }

    /// The instruction that a target stands for.
    pub fn instruction(&self, target: u32) -> u32 {
        if target >= Self::OUT { target & !Self::OUT } else { self.first[target as usize] }
    }
}

impl Memory {
    /// All bytes, for the steps of `regions`.
    pub(super) fn all_for(&mut self, regions: &Regions) -> Option<&mut [u8; SPAN]> {
        if regions.steps.is_empty() { None } else { self.all() }
    }
}

/// Where regions begin.
fn entries(plans: &[Plan], instructions: usize) -> Vec<u32> {
    let mut entry = vec![NONE; instructions + 1];
    for (index, plan) in (0..).zip(plans).filter(|(_, plan)| plan.does != Does::Exit) {
        let place = &mut entry[plan.first as usize];
        *place = index.min(*place);
    }
    entry
}

/// Turns the targets of jumps from instructions into steps.
fn resolve(plans: &mut [Plan], entry: &[u32]) {
    for plan in plans.iter_mut().filter(|plan| plan.to != NONE) {
        plan.to = match entry.get(plan.to as usize) {
            Some(&step) if step != NONE => step,
            _ => plan.to | Regions::OUT,
        };
    }
}

/// A jump back to the condition of a WHILE, whose way out is the instruction after that jump: it is asked at the end of the loop.
fn turn_loops(plans: &mut [Plan], entry: &[u32]) {
    for index in 0..plans.len() {
        if let Some(turned) = turned(plans, entry, plans[index]) {
            plans[index] = turned;
        }
    }
}

fn turned(plans: &[Plan], entry: &[u32], back: Plan) -> Option<Plan> {
    let condition = *plans.get(*entry.get(back.to as usize)? as usize)?;
    let (Does::Jump(Jump::Always), Does::Jump(jump)) = (back.does, condition.does) else { return None };
    let is_alone = condition.count > 0 && condition.first == back.to;
    if !is_alone || condition.to != back.at + 1 || condition.at >= back.at {
        return None;
    }
    let jump = match jump {
        Jump::IfLessUnsigned => Jump::UnlessLessUnsigned,
        Jump::IfLessSigned => Jump::UnlessLessSigned,
        Jump::UnlessLessUnsigned => Jump::IfLessUnsigned,
        Jump::UnlessLessSigned => Jump::IfLessSigned,
        Jump::IfEqual => Jump::UnlessEqual,
        Jump::UnlessEqual => Jump::IfEqual,
        Jump::IfZero => Jump::IfNotZero,
        Jump::IfNotZero => Jump::IfZero,
        Jump::Always | Jump::NextUnsigned | Jump::NextSigned => return None,
    };
    let count = back.count + condition.count;
    let to = back.to + u32::from(condition.count);
    Some(Plan { does: Does::Jump(jump), count, to, a: condition.a, b: condition.b, ..back })
}

/// The step for the first of these plans, which is step `index`, with those after it that can be one with it.
fn fused(plans: &[Plan], index: u32) -> Step {
    let second = match plans {
        [Plan { does: Does::Alu(_), .. }, second, after @ ..] => {
            Some((second.does, after.first().map(|plan| plan.does)))
        }
        _ => None,
    };
    let (run, parts): (Run, usize) = match (plans[0].does, second) {
        (Does::Alu(first), Some((Does::Jump(second), _))) => (steps::alu_jump(first, second), 2),
        (Does::Alu(first), Some((Does::LoadCellAt | Does::StoreCellAt, _))) if plans[0].count == 0 => {
            (steps::alu_element(first, plans[1].does == Does::StoreCellAt), 2)
        }
        (Does::Alu(first), Some((Does::Alu(second), third))) => alu_alu(first, second, third),
        (alone, _) => (run_of(alone), 1),
    };
    let step = step_of(&plans[..parts], run);
    Step { spins: step.to == index, ..step }
}

fn alu_alu(first: Alu, second: Alu, third: Option<Does>) -> (Run, usize) {
    let three = match third {
        Some(Does::Jump(third)) => steps::alu_alu_jump(first, second, third),
        _ => None,
    };
    three.map_or_else(|| (steps::alu_alu(first, second), 2), |run| (run, 3))
}

/// The step of plans that are one.
fn step_of(plans: &[Plan], run: Run) -> Step {
    let mut step = Step { run, count: 0, row: 0, spins: false, a: [0; 3], b: [0; 3], d: [0; 3], to: NONE };
    for (part, plan) in plans.iter().enumerate() {
        (step.a[part], step.b[part], step.d[part]) = (plan.a, plan.b, plan.d);
        (step.row, step.to) = (plan.row, plan.to);
        step.count += plan.count;
    }
    if let [Plan { does: Does::ForStart, more, .. }] = plans {
        [step.a[1], step.b[1], step.d[1]] = *more;
    }
    step
}

fn run_of(does: Does) -> Run {
    match does {
        Does::Alu(alu) => steps::alu(alu),
        Does::Jump(jump) => steps::jump(jump),
        Does::DivideUnsigned => fast::divide::<false, false>,
        Does::DivideSigned => fast::divide::<true, false>,
        Does::RemainderUnsigned => fast::divide::<false, true>,
        Does::RemainderSigned => fast::divide::<true, true>,
        Does::Binary => fast::binary,
        Does::Unary => fast::unary,
        Does::Convert => fast::convert,
        Does::LoadPart => fast::load_part,
        Does::StorePart => fast::store_part,
        Does::LoadAt => fast::load_at,
        Does::StoreAt => fast::store_at,
        Does::LoadCellAt => steps::load_cell_at::<0, 1>,
        Does::StoreCellAt => steps::store_cell_at::<0, 1>,
        Does::LoadTable => fast::load_table,
        Does::ForStart => fast::for_start,
        Does::ForNext => fast::for_next,
        Does::Exit => steps::exit,
    }
}

//! The steps of regions as the machine runs them. A step is a function and what it works on; up to three that follow each other, two
//! operators and a jump, are one.

use super::fault::outside;
use super::memory::{SPAN, cell, set_cell};
use super::step::{Around, MARGIN, Run, Step};
use crate::arithmetic::Type;

/// Operators that cannot fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alu {
    Add,
    Subtract,
    Multiply,
    And,
    Copy,
    Or,
    Xor,
    ShiftLeft,
    ShiftRight,
}

/// Jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jump {
    Always,
    IfZero,
    IfNotZero,
    IfLessUnsigned,
    UnlessLessUnsigned,
    IfLessSigned,
    UnlessLessSigned,
    IfEqual,
    UnlessEqual,
    /// Counts the loop `row`, whose last value is at `a` and its counter, a Long, at `d`.
    NextUnsigned,
    /// The same for an SLong.
    NextSigned,
}

/// The function of one operator.
pub fn alu(only: Alu) -> Run {
    ALU[only as usize]
}

/// Two operators.
pub fn alu_alu(first: Alu, second: Alu) -> Run {
    ALU_ALU[first as usize][second as usize]
}

/// A jump.
pub fn jump(only: Jump) -> Run {
    JUMP[only as usize]
}

/// An operator and an access to an element of 32 bits.
pub fn alu_element(first: Alu, stores: bool) -> Run {
    (if stores { ALU_STORE } else { ALU_LOAD })[first as usize]
}

/// An operator and a jump.
pub fn alu_jump(first: Alu, second: Jump) -> Run {
    ALU_JUMP[first as usize][second as usize]
}

/// Two operators and a jump, where there is a function for them.
pub fn alu_alu_jump(first: Alu, second: Alu, third: Jump) -> Option<Run> {
    Some(ALU_ALU_JUMP.get(first as usize)?.get(second as usize)?[third as usize])
}

const ADD: u8 = Alu::Add as u8;
const SUBTRACT: u8 = Alu::Subtract as u8;
const MULTIPLY: u8 = Alu::Multiply as u8;
const AND: u8 = Alu::And as u8;
const COPY: u8 = Alu::Copy as u8;
const OR: u8 = Alu::Or as u8;
const XOR: u8 = Alu::Xor as u8;
const SHIFT_LEFT: u8 = Alu::ShiftLeft as u8;

/// Does part `N`, the operator `A`.
#[inline(always)]
fn operate<const A: u8, const N: usize>(bytes: &mut [u8; SPAN], step: &Step) {
    let (a, b) = (cell(bytes, step.a[N]), cell(bytes, step.b[N]));
    let value = match A {
        ADD => a.wrapping_add(b),
        SUBTRACT => a.wrapping_sub(b),
        MULTIPLY => a.wrapping_mul(b),
        AND => a & b,
        COPY => a,
        OR => a | b,
        XOR => a ^ b,
        SHIFT_LEFT => a.checked_shl(b).unwrap_or(0),
        _ => a.checked_shr(b).unwrap_or(0),
    };
    set_cell(bytes, step.d[N], value);
}

const ALWAYS: u8 = Jump::Always as u8;
const IF_ZERO: u8 = Jump::IfZero as u8;
const IF_NOT_ZERO: u8 = Jump::IfNotZero as u8;
const IF_LESS_UNSIGNED: u8 = Jump::IfLessUnsigned as u8;
const UNLESS_LESS_UNSIGNED: u8 = Jump::UnlessLessUnsigned as u8;
const IF_LESS_SIGNED: u8 = Jump::IfLessSigned as u8;
const UNLESS_LESS_SIGNED: u8 = Jump::UnlessLessSigned as u8;
const IF_EQUAL: u8 = Jump::IfEqual as u8;
const UNLESS_EQUAL: u8 = Jump::UnlessEqual as u8;
const NEXT_UNSIGNED: u8 = Jump::NextUnsigned as u8;

/// Does part `N`, the jump `J`: whether it jumps.
#[inline(always)]
fn jumps<const J: u8, const N: usize>(bytes: &mut [u8; SPAN], around: &Around<'_>, step: &Step) -> bool {
    let (a, b) = (cell(bytes, step.a[N]), cell(bytes, step.b[N]));
    match J {
        ALWAYS => true,
        IF_ZERO => a == 0,
        IF_NOT_ZERO => a != 0,
        IF_LESS_UNSIGNED => a < b,
        UNLESS_LESS_UNSIGNED => a >= b,
        IF_LESS_SIGNED => (a as i32) < b as i32,
        UNLESS_LESS_SIGNED => a as i32 >= b as i32,
        IF_EQUAL => a == b,
        UNLESS_EQUAL => a != b,
        next => {
            let kind = if next == NEXT_UNSIGNED { Type::Unsigned } else { Type::Signed };
            let (next, goes_on) = around.counted(step.row).next(kind, cell(bytes, step.d[N]), a);
            set_cell(bytes, step.d[N], next);
            goes_on
        }
    }
}

/// Goes on at another step. Not inlined, so that a jump is a branch that the processor can predict: as a choice between two numbers it
/// would let everything after it wait for the values compared.
#[inline(never)]
fn go(next: u32, left: u32) -> (u32, u32) {
    (next, left)
}

/// Does a step of so many parts that ends with a jump, again and again while it leads back to itself and the budget lasts.
#[inline(always)]
fn lead<const PARTS: u32>(
    step: &Step,
    here: u32,
    mut left: u32,
    mut does_jump: impl FnMut() -> bool,
) -> (u32, u32) {
    loop {
        let jumps = does_jump();
        left -= u32::from(step.count);
        if !jumps {
            return go(here + PARTS, left);
        }
        if !step.spins || left < MARGIN {
            return (step.to, left);
        }
    }
}

/// Leaves for an instruction that has no step.
pub fn exit(_: &mut [u8; SPAN], _: &mut Around<'_>, step: &Step, _: u32, left: u32) -> (u32, u32) {
    (step.to, left)
}

fn run_alu<const A: u8>(
    bytes: &mut [u8; SPAN],
    _: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    operate::<A, 0>(bytes, step);
    step.done::<1>(here, left)
}

fn run_alu_alu<const A: u8, const B: u8>(
    bytes: &mut [u8; SPAN],
    _: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    operate::<A, 0>(bytes, step);
    operate::<B, 1>(bytes, step);
    step.done::<2>(here, left)
}

fn run_jump<const J: u8>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    lead::<1>(step, here, left, || jumps::<J, 0>(bytes, around, step))
}

fn run_alu_jump<const A: u8, const J: u8>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    lead::<2>(step, here, left, || {
        operate::<A, 0>(bytes, step);
        jumps::<J, 1>(bytes, around, step)
    })
}

fn run_alu_alu_jump<const A: u8, const B: u8, const J: u8>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    lead::<3>(step, here, left, || {
        operate::<A, 0>(bytes, step);
        operate::<B, 1>(bytes, step);
        jumps::<J, 2>(bytes, around, step)
    })
}

/// An operator and then an element of 32 bits, as its second part.
fn run_alu_element<const STORES: bool, const A: u8>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    operate::<A, 0>(bytes, step);
    if STORES {
        store_cell_at::<1, 2>(bytes, around, step, here, left)
    } else {
        load_cell_at::<1, 2>(bytes, around, step, here, left)
    }
}

/// Part `N`: an element of 32 bits; the array begins at `b` and has `row` elements.
#[inline(always)]
pub fn load_cell_at<const N: usize, const PARTS: u32>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let index = cell(bytes, step.a[N]);
    if index >= u32::from(step.row) {
        return around.fault(left, N as u32, outside(index, step.row.into()));
    }
    let value = cell(bytes, step.b[N].wrapping_add(index as u16 * 4));
    set_cell(bytes, step.d[N], value);
    step.done::<PARTS>(here, left)
}

/// Part `N`: a value from `b` into an element of 32 bits; the array begins at `d`.
#[inline(always)]
pub fn store_cell_at<const N: usize, const PARTS: u32>(
    bytes: &mut [u8; SPAN],
    around: &mut Around<'_>,
    step: &Step,
    here: u32,
    left: u32,
) -> (u32, u32) {
    let index = cell(bytes, step.a[N]);
    if index >= u32::from(step.row) {
        return around.fault(left, N as u32, outside(index, step.row.into()));
    }
    let value = cell(bytes, step.b[N]);
    set_cell(bytes, step.d[N].wrapping_add(index as u16 * 4), value);
    step.done::<PARTS>(here, left)
}

impl Step {
    /// The way on after it and the `PARTS - 1` after it, with what is left of the budget.
    #[inline(always)]
    pub fn done<const PARTS: u32>(&self, here: u32, left: u32) -> (u32, u32) {
        (here + PARTS, left - u32::from(self.count))
    }
}

/// An array of a function for each operator, in their order: `$f::<…, operator>`.
macro_rules! per_alu {
    ($f:ident $(, $before:literal)*) => {
        [$f::<$($before,)* 0>, $f::<$($before,)* 1>, $f::<$($before,)* 2>, $f::<$($before,)* 3>, $f::<$($before,)* 4>,
         $f::<$($before,)* 5>, $f::<$($before,)* 6>, $f::<$($before,)* 7>, $f::<$($before,)* 8>]
    };
}

/// The same for each jump.
macro_rules! per_jump {
    ($f:ident $(, $before:literal)*) => {
        [$f::<$($before,)* 0>, $f::<$($before,)* 1>, $f::<$($before,)* 2>, $f::<$($before,)* 3>, $f::<$($before,)* 4>,
         $f::<$($before,)* 5>, $f::<$($before,)* 6>, $f::<$($before,)* 7>, $f::<$($before,)* 8>, $f::<$($before,)* 9>,
         $f::<$($before,)* 10>]
    };
}

/// Each jump after an operator and each of the first five.
macro_rules! per_common_alu_and_jump {
    ($first:literal) => {
        [
            per_jump!(run_alu_alu_jump, $first, 0),
            per_jump!(run_alu_alu_jump, $first, 1),
            per_jump!(run_alu_alu_jump, $first, 2),
            per_jump!(run_alu_alu_jump, $first, 3),
            per_jump!(run_alu_alu_jump, $first, 4),
        ]
    };
}

const ALUS: usize = Alu::ShiftRight as usize + 1;
const JUMPS: usize = Jump::NextSigned as usize + 1;
/// Operators up to [`Alu::Copy`] stand in threes.
const COMMON_ALUS: usize = Alu::Copy as usize + 1;

static ALU: [Run; ALUS] = per_alu!(run_alu);
static JUMP: [Run; JUMPS] = per_jump!(run_jump);
static ALU_LOAD: [Run; ALUS] = per_alu!(run_alu_element, false);
static ALU_STORE: [Run; ALUS] = per_alu!(run_alu_element, true);
static ALU_ALU: [[Run; ALUS]; ALUS] = [
    per_alu!(run_alu_alu, 0),
    per_alu!(run_alu_alu, 1),
    per_alu!(run_alu_alu, 2),
    per_alu!(run_alu_alu, 3),
    per_alu!(run_alu_alu, 4),
    per_alu!(run_alu_alu, 5),
    per_alu!(run_alu_alu, 6),
    per_alu!(run_alu_alu, 7),
    per_alu!(run_alu_alu, 8),
];
static ALU_JUMP: [[Run; JUMPS]; ALUS] = [
    per_jump!(run_alu_jump, 0),
    per_jump!(run_alu_jump, 1),
    per_jump!(run_alu_jump, 2),
    per_jump!(run_alu_jump, 3),
    per_jump!(run_alu_jump, 4),
    per_jump!(run_alu_jump, 5),
    per_jump!(run_alu_jump, 6),
    per_jump!(run_alu_jump, 7),
    per_jump!(run_alu_jump, 8),
];
static ALU_ALU_JUMP: [[[Run; JUMPS]; COMMON_ALUS]; COMMON_ALUS] = [
    per_common_alu_and_jump!(0),
    per_common_alu_and_jump!(1),
    per_common_alu_and_jump!(2),
    per_common_alu_and_jump!(3),
    per_common_alu_and_jump!(4),
];

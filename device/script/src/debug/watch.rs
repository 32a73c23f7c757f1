//! Expressions that are worked out beside a program, and places that are set from outside.

use super::value::Value;
use crate::arithmetic::{self, Type};
use crate::mcl::types::VarType;
use crate::op::{Array, Op};
use crate::program::Program;
use crate::vm::{Host, Machine, State, element};
use std::sync::Arc;

/// Instructions that an expression may take; it has no loops, so this is never reached by what the compiler made.
const MOST: u32 = 100_000;

/// An expression in the scope of a program. Made by [`crate::names::Names::watch`].
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    /// As it was typed.
    pub text: String,
    pub(crate) program: Arc<Program>,
    pub(crate) kind: Type,
    pub(crate) shown_as: VarType,
    pub(crate) array: Option<Array>,
}

/// A place with the value it is to get. Made by [`crate::names::Names::setting`].
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The place, as it was typed.
    pub place: String,
    pub(crate) value: Watch,
    pub(crate) kind: VarType,
    pub(crate) ops: Arc<[Op]>,
    /// The value was typed as bits (0x or %), which may fill a signed type.
    pub(crate) is_pattern: bool,
}

impl Watch {
    /// An expression of these instructions, at whose end its value is on the stack.
    pub(crate) fn of(text: &str, ops: Vec<Op>, kind: Type, shown_as: VarType, array: Option<Array>) -> Self {
        let lines = vec![0; ops.len()];
        let program = Arc::new(Program { ops, lines, ..Program::default() });
        Self { text: text.to_owned(), program, kind, shown_as, array }
    }

    /// What it is now.
    ///
    /// # Errors
    /// A sentence: an index outside, a division by zero.
    pub fn value(&self, machine: &mut Machine, host: &mut dyn Host) -> Result<Value, String> {
        if let Some(array) = self.array {
            let cells = (0..array.length).filter_map(|index| element(array, index));
            let values = cells.map(|cell| machine.memory().load(cell)).collect();
            return Ok(Value { kind: array.first.kind, cells: values, is_array: true });
        }
        let bits = evaluate(&self.program, machine, host, None)?;
        Ok(Value::single(self.shown_as, bits))
    }

    /// Whether it holds, as a condition of IF would.
    ///
    /// # Errors
    /// As for [`Watch::value`].
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn holds(&self, machine: &mut Machine, host: &mut dyn Host) -> Result<bool, String> {
        let value = self.value(machine, host)?;
        Ok(value.cells.iter().any(|cell| match value.kind {
            VarType::Float => f32::from_bits(*cell) != 0.0,
            _ => *cell != 0,
        }))
    }
}

impl Setting {
    /// A place that these instructions set to what is on the stack.
    pub(crate) fn of(place: &str, value: Watch, kind: VarType, ops: Vec<Op>) -> Self {
        Self { place: place.to_owned(), value, kind, ops: ops.into(), is_pattern: false }
    }

    /// Sets the place.
    ///
    /// # Errors
    /// A sentence: the value does not fit, or an index is outside; nothing is changed then.
    pub fn set(&self, machine: &mut Machine, host: &mut dyn Host) -> Result<Value, String> {
        if self.value.array.is_some() {
            return Err(format!("`{}` is an array and no single value.", self.value.text));
        }
        let bits = evaluate(&self.value.program, machine, host, None)?;
        let cell = self.checked(bits)?;
        let program = Program { ops: self.ops.to_vec(), ..Program::default() };
        let program = Program { lines: vec![0; program.ops.len()], ..program };
        let data = self.value.program.data.clone();
        evaluate(&Arc::new(Program { data, ..program }), machine, host, Some(cell))?;
        Ok(Value::single(self.kind, self.kind.keep(cell)))
    }

    /// The value as a cell of the place's type, if it fits.
    fn checked(&self, bits: u32) -> Result<u32, String> {
        let (place, name) = (&self.place, self.kind.name());
        let Some((least, most)) = self.kind.range() else {
            return Ok(arithmetic::convert(bits, self.value.kind, Type::Float));
        };
        let whole = match self.value.kind {
            Type::Float => {
                let float = f32::from_bits(bits);
                if float.fract() != 0.0 || !float.is_finite() {
                    return Err(format!("`{place}` is a {name} and takes whole numbers, not {float}."));
                }
                float as i64
            }
            Type::Signed => i64::from(bits as i32),
            Type::Unsigned => i64::from(bits),
        };
        let top = if self.is_pattern && self.kind.is_signed() { most * 2 + 1 } else { most };
        if (least..=top).contains(&whole) {
            return Ok(whole as u32);
        }
        Err(format!("{whole} does not fit `{place}`, a {name}: it goes from {least} to {most}."))
    }
}

/// Runs the few instructions of an expression on the memory of a machine; what is on the stack at the end is its value.
fn evaluate(
    program: &Arc<Program>,
    machine: &mut Machine,
    host: &mut dyn Host,
    first: Option<u32>,
) -> Result<u32, String> {
    let mut scratch = Machine::new(program.clone());
    first.into_iter().for_each(|cell| scratch.put_first(cell));
    std::mem::swap(scratch.memory_mut(), machine.memory_mut());
    let state = scratch.run(host, MOST).clone();
    std::mem::swap(scratch.memory_mut(), machine.memory_mut());
    match state {
        State::Faulted(fault) => Err(format!("It cannot be worked out now: {}.", fault.kind)),
        State::Ready | State::Pausing { .. } | State::Listening { .. } | State::Ended => {
            Ok(scratch.top().unwrap_or(0))
        }
    }
}

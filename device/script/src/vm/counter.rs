//! How the counter of a FOR goes on.

use crate::arithmetic::{self, Type};
use crate::mcl::ast::Binary;

/// A FOR that runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Loop {
    pub start: u32,
    pub step: u32,
}

impl Loop {
    /// The next value of a counter, and whether the loop goes on with it: "The FOR...NEXT loop will exit when the count value is no longer
    /// between start and finish" (MCP manual 3.4.1). The sum is looked at before it is stored, so that a byte can count to 255.
    #[inline(always)]
    pub fn next(self, kind: Type, value: u32, finish: u32) -> (u32, bool) {
        let wide = |cell: u32| if kind == Type::Signed { i64::from(cell as i32) } else { i64::from(cell) };
        if kind == Type::Float {
            let [value, step, start, finish] = [value, self.step, self.start, finish].map(f32::from_bits);
            let next = value + step;
            return (next.to_bits(), start.min(finish) <= next && next <= start.max(finish));
        }
        let next = wide(value) + i64::from(self.step as i32);
        let (start, finish) = (wide(self.start), wide(finish));
        (next as u32, start.min(finish) <= next && next <= start.max(finish))
    }
}

/// The step of a loop without one, which counts towards its last value.
pub fn step_of(kind: Type, start: u32, finish: u32) -> u32 {
    one(kind, arithmetic::binary(Binary::LessOrEqual, kind, start, finish) == Ok(1))
}

fn one(kind: Type, up: bool) -> u32 {
    match (kind, up) {
        (Type::Float, true) => 1f32.to_bits(),
        (Type::Float, false) => (-1f32).to_bits(),
        (_, true) => 1,
        (_, false) => u32::MAX,
    }
}

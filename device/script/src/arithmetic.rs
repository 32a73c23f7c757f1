//! What the operators do to 32 bit cells (MCP manual 3.2): the compiler folds constants with it, the machine runs on it.
//!
//! A cell holds a whole number or the bits of a float. Whole numbers are signed where one operand is ("The resulting number is
//! not signed unless a signed variable is used"); comparisons and logic give 0 or 1.

use crate::mcl::ast::{Binary, Unary};
use serde::{Deserialize, Serialize};

/// How a cell is to be understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Type {
    /// A whole number from 0.
    Unsigned,
    /// A whole number, perhaps negative.
    Signed,
    /// A floating point number.
    Float,
}

impl Type {
    /// Every one, in the order in which images number them.
    pub const ALL: [Self; 3] = [Self::Unsigned, Self::Signed, Self::Float];
}

/// A whole number divided by zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DivisionByZero;

/// The type of an operation on two operands.
#[must_use]
pub fn common(left: Type, right: Type) -> Type {
    match (left, right) {
        (Type::Float, _) | (_, Type::Float) => Type::Float,
        (Type::Signed, _) | (_, Type::Signed) => Type::Signed,
        _ => Type::Unsigned,
    }
}

/// The type of what an operator gives when its operands are of type `of`.
#[must_use]
pub fn result_of(operator: Binary, of: Type) -> Type {
    if operator.compares() || operator.order() == 9 || operator == Binary::Dig { Type::Unsigned } else { of }
}

/// The type of what an operator of one operand gives.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn result_of_unary(operator: Unary, of: Type) -> Type {
    match operator {
        Unary::Negative if of == Type::Float => Type::Float,
        Unary::Negative | Unary::Sin | Unary::Cos | Unary::ToInt => Type::Signed,
        Unary::BitNot => of,
        Unary::ToFloat => Type::Float,
        operator if operator.is_float() => Type::Float,
        _ => Type::Unsigned,
    }
}

/// Whether an operator works on floats at all.
#[must_use]
pub fn takes_floats(operator: Binary) -> bool {
    use Binary::{Add, And, Divide, Max, Min, Multiply, Or, Subtract, Xor};
    operator.compares() || matches!(operator, Add | And | Divide | Max | Min | Multiply | Or | Subtract | Xor)
}

/// A value as another type.
#[must_use]
pub fn convert(value: u32, from: Type, to: Type) -> u32 {
    match (from, to) {
        // Through 64 bits, so that a float up to 4294967295 fits an unsigned variable too.
        (Type::Float, Type::Signed | Type::Unsigned) => f32::from_bits(value) as i64 as u32,
        (Type::Signed, Type::Float) => (value as i32 as f32).to_bits(),
        (Type::Unsigned, Type::Float) => (value as f32).to_bits(),
        _ => value,
    }
}

/// What an operator of two operands gives.
///
/// # Errors
/// A whole number is divided by zero.
pub fn binary(operator: Binary, of: Type, a: u32, b: u32) -> Result<u32, DivisionByZero> {
    match of {
        Type::Float => Ok(floats(operator, f32::from_bits(a), f32::from_bits(b))),
        Type::Signed => signed(operator, a as i32, b as i32),
        Type::Unsigned => unsigned(operator, a, b),
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn floats(operator: Binary, a: f32, b: f32) -> u32 {
    let value = match operator {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Max => a.min(b),
        Binary::Min => a.max(b),
        _ => return truth_of_floats(operator, a, b),
    };
    value.to_bits()
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn truth_of_floats(operator: Binary, a: f32, b: f32) -> u32 {
    let (left, right) = (a != 0.0, b != 0.0);
    u32::from(match operator {
        Binary::Less => a < b,
        Binary::LessOrEqual => a <= b,
        Binary::Equal => a == b,
        Binary::GreaterOrEqual => a >= b,
        Binary::Greater => a > b,
        Binary::NotEqual => a != b,
        Binary::And => left && right,
        Binary::Or => left || right,
        Binary::Xor => left != right,
        // The compiler lets no other operator have floats.
        _ => false,
    })
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn signed(operator: Binary, a: i32, b: i32) -> Result<u32, DivisionByZero> {
    let wide = i64::from(a) * i64::from(b);
    Ok(match operator {
        Binary::Divide if b == 0 => return Err(DivisionByZero),
        Binary::Remainder if b == 0 => return Err(DivisionByZero),
        Binary::Divide => a.wrapping_div(b) as u32,
        Binary::Remainder => a.wrapping_rem(b) as u32,
        Binary::Max => a.min(b) as u32,
        Binary::Min => a.max(b) as u32,
        Binary::MultiplyHigh => (wide >> 32) as u32,
        Binary::MultiplyFraction => (wide / 65_536) as u32,
        Binary::Less => u32::from(a < b),
        Binary::LessOrEqual => u32::from(a <= b),
        Binary::GreaterOrEqual => u32::from(a >= b),
        Binary::Greater => u32::from(a > b),
        Binary::Dig => digit(a.unsigned_abs(), b as u32),
        _ => return unsigned(operator, a as u32, b as u32),
    })
}

fn unsigned(operator: Binary, a: u32, b: u32) -> Result<u32, DivisionByZero> {
    let wide = u64::from(a) * u64::from(b);
    Ok(match operator {
        Binary::Divide => a.checked_div(b).ok_or(DivisionByZero)?,
        Binary::Remainder => a.checked_rem(b).ok_or(DivisionByZero)?,
        Binary::Dig => digit(a, b),
        Binary::Max => a.min(b),
        Binary::Min => a.max(b),
        Binary::Multiply => a.wrapping_mul(b),
        Binary::MultiplyHigh => (wide >> 32) as u32,
        Binary::MultiplyFraction => (wide >> 16) as u32,
        Binary::Add => a.wrapping_add(b),
        Binary::Subtract => a.wrapping_sub(b),
        Binary::ShiftLeft => a.checked_shl(b).unwrap_or(0),
        Binary::ShiftRight => a.checked_shr(b).unwrap_or(0),
        Binary::Less => u32::from(a < b),
        Binary::LessOrEqual => u32::from(a <= b),
        Binary::Equal => u32::from(a == b),
        Binary::GreaterOrEqual => u32::from(a >= b),
        Binary::Greater => u32::from(a > b),
        Binary::NotEqual => u32::from(a != b),
        Binary::BitAnd => a & b,
        Binary::BitOr => a | b,
        Binary::BitXor => a ^ b,
        Binary::BitNand => !(a & b),
        Binary::BitNor => !(a | b),
        Binary::BitNxor => !(a ^ b),
        Binary::And => u32::from(a != 0 && b != 0),
        Binary::Or => u32::from(a != 0 || b != 0),
        Binary::Xor => u32::from((a != 0) != (b != 0)),
    })
}

/// What an operator of one operand gives. `of` is the operand's type; float functions want a float.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn unary(operator: Unary, of: Type, value: u32) -> u32 {
    let float = f32::from_bits(value);
    match operator {
        Unary::Negative if of == Type::Float => (-float).to_bits(),
        Unary::Negative => value.wrapping_neg(),
        Unary::BitNot => !value,
        Unary::Not if of == Type::Float => u32::from(float == 0.0),
        Unary::Not => u32::from(value == 0),
        Unary::Abs if of == Type::Signed => (value as i32).unsigned_abs(),
        Unary::Abs => value,
        Unary::Sin => sine(value),
        Unary::Cos => sine(value.wrapping_add(64)),
        Unary::Sqr if of == Type::Signed && (value as i32) < 0 => 0,
        Unary::Sqr => value.isqrt(),
        Unary::Bin2Bcd => packed_decimal(value),
        Unary::Random => random(value),
        Unary::ToInt => convert(value, of, Type::Signed),
        Unary::ToFloat => convert(value, of, Type::Float),
        operator => float_function(operator, float).to_bits(),
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn float_function(operator: Unary, x: f32) -> f32 {
    match operator {
        Unary::FAbs => x.abs(),
        Unary::FSqrt => x.sqrt(),
        Unary::FSin => x.sin(),
        Unary::FCos => x.cos(),
        Unary::FTan => x.tan(),
        Unary::FAsin => x.asin(),
        Unary::FAcos => x.acos(),
        Unary::FAtan => x.atan(),
        Unary::FSinh => x.sinh(),
        Unary::FCosh => x.cosh(),
        Unary::FTanh => x.tanh(),
        Unary::FAtanh => x.atanh(),
        Unary::FLn => x.ln(),
        Unary::FExp => x.exp(),
        _ => x,
    }
}

/// Decimal digit `place` of a number, the lowest is 1; 0 where there is none (MCP manual 3.2, DIG).
fn digit(value: u32, place: u32) -> u32 {
    match place {
        1..=10 => value / 10u32.pow(place - 1) % 10,
        _ => 0,
    }
}

/// 128 times the sine of `angle` 256ths of a circle, without its fraction: sin 42 is 109 (MCP manual 3.2). The manual gives the range
/// as -127 to 128, so -128 is kept to -127.
fn sine(angle: u32) -> u32 {
    let turn = f64::from(angle % 256) / 256.0 * std::f64::consts::TAU;
    ((128.0 * turn.sin()) as i32).max(-127) as u32
}

fn packed_decimal(value: u32) -> u32 {
    (1..=8).fold(0, |packed, place| packed | digit(value, place) << (4 * (place - 1)))
}

/// Assumed: the manual only says that the sequence follows from the seed. A linear congruential generator (Numerical Recipes).
fn random(seed: u32) -> u32 {
    seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn int(operator: Binary, a: u32, b: u32) -> u32 {
        binary(operator, Type::Unsigned, a, b).unwrap()
    }

    #[test]
    fn the_manuals_examples_of_operators() {
        assert_eq!(unary(Unary::Sin, Type::Unsigned, 42), 109);
        assert_eq!(unary(Unary::Sin, Type::Unsigned, 64), 128);
        assert_eq!(unary(Unary::Sin, Type::Unsigned, 192), (-127i32) as u32);
        assert_eq!(unary(Unary::Sqr, Type::Unsigned, 220), 14);
        assert_eq!(unary(Unary::Sqr, Type::Unsigned, 2_200_000), 1483);
        assert_eq!(unary(Unary::Bin2Bcd, Type::Unsigned, 93), 0b1001_0011);
        assert_eq!(int(Binary::MultiplyHigh, 80_000, 80_000), 1);
        assert_eq!(int(Binary::MultiplyFraction, 346, 2 << 16 | 32_782), 865);
        assert_eq!(int(Binary::Dig, 17_458, 4), 7);
        assert_eq!(int(Binary::Remainder, 13, 5), 3);
        assert_eq!(int(Binary::BitNand, 0b0101_1101, 0b1001_0011) & 0xFF, 0b1110_1110);
        assert_eq!(int(Binary::BitNor, 0b0101_1101, 0b1001_0011) & 0xFF, 0b0010_0000);
        assert_eq!(int(Binary::BitNxor, 0b0101_1101, 0b1001_0011) & 0xFF, 0b0011_0001);
        assert_eq!(int(Binary::Max, 20, 13), 13);
        assert_eq!(int(Binary::Min, 5, 9), 9);
    }

    #[test]
    fn signs_count_where_an_operand_has_one() {
        let minus = |value: i32| value as u32;
        let signed = |operator, a, b| binary(operator, Type::Signed, a, b).unwrap();
        assert_eq!(signed(Binary::Divide, minus(-7), 2), minus(-3));
        assert_eq!(signed(Binary::Remainder, minus(-7), 2), minus(-1));
        assert_eq!(signed(Binary::Less, minus(-1), 0), 1);
        assert_eq!(int(Binary::Less, minus(-1), 0), 0);
        assert_eq!(signed(Binary::Divide, i32::MIN as u32, minus(-1)), i32::MIN as u32);
        // Shifts fill with zeros in any case: "The sign bit is not preserved".
        assert_eq!(signed(Binary::ShiftRight, minus(-1), 28), 15);
        assert_eq!(binary(Binary::Divide, Type::Signed, 1, 0), Err(DivisionByZero));
    }

    #[test]
    fn floats_lose_their_fraction_on_the_way_to_integers() {
        assert_eq!(convert(1231.23f32.to_bits(), Type::Float, Type::Unsigned), 1231);
        assert_eq!(convert((-1.9f32).to_bits(), Type::Float, Type::Signed), (-1i32) as u32);
        assert_eq!(convert(f32::NAN.to_bits(), Type::Float, Type::Signed), 0);
        assert_eq!(convert(4e9f32.to_bits(), Type::Float, Type::Unsigned), 4_000_000_000);
    }
}

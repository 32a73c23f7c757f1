//! The operators as a table (MCP manual 3.2.3 to 3.2.5): help, completion and the reference read it; a test holds it against the parser.

use super::ast::{Binary, Unary};
use serde::Serialize;

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operator {
    /// Its word or sign.
    pub name: &'static str,
    /// How it is written.
    pub syntax: &'static str,
    /// What it gives.
    pub help: &'static str,
    /// What it is for the compiler.
    pub does: Does,
}

/// What an operator is for the compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Does {
    /// It stands before its operand.
    One(Unary),
    /// It stands between its operands.
    Two(Binary),
}

/// Which numbers an operator takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Takes {
    /// Whole numbers alone.
    Integers,
    /// Floating point numbers alone; whole ones are converted.
    Floats,
    /// Both.
    Both,
}

impl Operator {
    /// How tightly it binds: the order of MCP manual 3.2.5, 1 first, 9 last.
    #[must_use]
    pub fn order(&self) -> u8 {
        match self.does {
            Does::One(_) => 1,
            Does::Two(operator) => operator.order(),
        }
    }

    /// Which numbers it takes.
    #[must_use]
    pub fn takes(&self) -> Takes {
        match self.does {
            Does::One(operator) if operator.is_float() => Takes::Floats,
            Does::One(Unary::Negative | Unary::Not | Unary::ToInt | Unary::ToFloat) => Takes::Both,
            Does::Two(operator) if crate::arithmetic::takes_floats(operator) => Takes::Both,
            Does::One(_) | Does::Two(_) => Takes::Integers,
        }
    }

    /// Whether it is a word and not a sign.
    #[must_use]
    pub fn is_word(&self) -> bool {
        self.name.starts_with(|letter: char| letter.is_ascii_alphabetic())
    }
}

impl Unary {
    /// The operator of this word.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        named(word).filter(|row| row.is_word()).find_map(|row| match row.does {
            Does::One(operator) => Some(operator),
            Does::Two(_) => None,
        })
    }
}

impl Binary {
    /// The operator of this word or sign.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        named(name).find_map(|row| match row.does {
            Does::One(_) => None,
            Does::Two(operator) => Some(operator),
        })
    }
}

fn named(name: &str) -> impl Iterator<Item = &'static Operator> {
    OPERATORS.iter().filter(move |row| row.name.eq_ignore_ascii_case(name))
}

const fn one(name: &'static str, syntax: &'static str, does: Unary, help: &'static str) -> Operator {
    Operator { name, syntax, help, does: Does::One(does) }
}

const fn two(name: &'static str, syntax: &'static str, does: Binary, help: &'static str) -> Operator {
    Operator { name, syntax, help, does: Does::Two(does) }
}

/// Every operator, by the order of MCP manual 3.2.5.
pub static OPERATORS: [Operator; 53] = [
    one("NOT", "NOT x", Unary::Not, "1 when x is zero, else 0. It is worked out before any comparison."),
    one("ABS", "ABS x", Unary::Abs, "Absolute value."),
    one("SIN", "SIN x", Unary::Sin, "Sine of x in 256ths of a circle, from -127 to 128."),
    one("COS", "COS x", Unary::Cos, "Cosine of x in 256ths of a circle, from -127 to 128."),
    one("-", "-x", Unary::Negative, "The negative of x, which is signed."),
    one("SQR", "SQR x", Unary::Sqr, "Whole part of the square root."),
    one("RANDOM", "RANDOM seed", Unary::Random, "A 32 bit number that follows from the seed."),
    one("TOINT", "TOINT x", Unary::ToInt, "A float without its fraction."),
    one("TOFLOAT", "TOFLOAT x", Unary::ToFloat, "A whole number as a float."),
    one("BIN2BCD", "BIN2BCD x", Unary::Bin2Bcd, "Packed decimal digits, four bits each."),
    one("~", "~x", Unary::BitNot, "Each bit turned over."),
    one("!", "!x", Unary::BitNot, "Each bit turned over, as ~."),
    one("FABS", "FABS x", Unary::FAbs, "Absolute value of a float."),
    one("FSQRT", "FSQRT x", Unary::FSqrt, "Square root of a float."),
    one("FSIN", "FSIN x", Unary::FSin, "Sine of radians."),
    one("FCOS", "FCOS x", Unary::FCos, "Cosine of radians."),
    one("FTAN", "FTAN x", Unary::FTan, "Tangent of radians."),
    one("FASIN", "FASIN x", Unary::FAsin, "Arc sine, radians."),
    one("FACOS", "FACOS x", Unary::FAcos, "Arc cosine, radians."),
    one("FATAN", "FATAN x", Unary::FAtan, "Arc tangent, radians."),
    one("FSINH", "FSINH x", Unary::FSinh, "Hyperbolic sine."),
    one("FCOSH", "FCOSH x", Unary::FCosh, "Hyperbolic cosine."),
    one("FTANH", "FTANH x", Unary::FTanh, "Hyperbolic tangent."),
    one("FATANH", "FATANH x", Unary::FAtanh, "Hyperbolic arc tangent."),
    one("FLN", "FLN x", Unary::FLn, "Natural logarithm."),
    one("FEXP", "FEXP x", Unary::FExp, "e to the power of x."),
    two("DIG", "x DIG n", Binary::Dig, "Decimal digit n of x, the lowest is 1."),
    two("MAX", "x MAX limit", Binary::Max, "The smaller of the two: x up to a maximum."),
    two("MIN", "x MIN limit", Binary::Min, "The larger of the two: x down to a minimum."),
    two("*", "a * b", Binary::Multiply, "Low 32 bits of the product."),
    two("**", "a ** b", Binary::MultiplyHigh, "High 32 bits of the product."),
    two("*/", "a */ b", Binary::MultiplyFraction, "Product with b in 65536ths, without its fraction."),
    two("/", "a / b", Binary::Divide, "Quotient; of whole numbers without its fraction."),
    two("//", "a // b", Binary::Remainder, "Remainder of the division of whole numbers."),
    two("+", "a + b", Binary::Add, "Sum."),
    two("-", "a - b", Binary::Subtract, "Difference."),
    two("<<", "a << n", Binary::ShiftLeft, "Bits shifted left by n, zeros come in."),
    two(">>", "a >> n", Binary::ShiftRight, "Bits shifted right by n, zeros come in: the sign is lost."),
    two("<", "a < b", Binary::Less, "1 when a is less, else 0."),
    two("<=", "a <= b", Binary::LessOrEqual, "1 when a is less or equal, else 0."),
    two("=", "a = b", Binary::Equal, "1 when both are equal, else 0."),
    two(">=", "a >= b", Binary::GreaterOrEqual, "1 when a is greater or equal, else 0."),
    two(">", "a > b", Binary::Greater, "1 when a is greater, else 0."),
    two("<>", "a <> b", Binary::NotEqual, "1 when they differ, else 0."),
    two("&", "a & b", Binary::BitAnd, "Bits that both have."),
    two("|", "a | b", Binary::BitOr, "Bits that either has."),
    two("^", "a ^ b", Binary::BitXor, "Bits that exactly one has."),
    two("&/", "a &/ b", Binary::BitNand, "Bits that not both have."),
    two("|/", "a |/ b", Binary::BitNor, "Bits that neither has."),
    two("^/", "a ^/ b", Binary::BitNxor, "Bits in which they are alike."),
    two("AND", "a AND b", Binary::And, "1 when both are not zero, else 0."),
    two("OR", "a OR b", Binary::Or, "1 when one is not zero, else 0."),
    two("XOR", "a XOR b", Binary::Xor, "1 when exactly one is not zero, else 0."),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_what_the_parser_reads() {
        for row in &OPERATORS {
            match row.does {
                Does::One(operator) if row.is_word() => {
                    assert_eq!(Unary::of_word(row.name), Some(operator), "{}", row.name);
                }
                Does::One(_) => assert!(["-", "~", "!"].contains(&row.name)),
                Does::Two(operator) => {
                    assert_eq!(Binary::of_name(row.name), Some(operator), "{}", row.name);
                }
            }
        }
        assert!(OPERATORS.windows(2).all(|pair| pair[0].order() <= pair[1].order()));
    }
}

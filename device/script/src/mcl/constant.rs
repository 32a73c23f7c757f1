//! Values known when a program is compiled.

use super::ast::{Binary, Expr, ExprKind, Link, Unary};
use super::codes;
use crate::arithmetic::{self, Type};
use crate::text::Span;

/// A known value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// A whole number and whether it is signed.
    Whole(u32, Type),
    /// A float.
    Float(f32),
}

/// Why a value is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotConstant {
    /// What is in the way.
    pub span: Span,
    /// Why.
    pub why: Why,
}

/// What is in the way of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// It is no constant.
    Varies,
    /// A text of several characters.
    LongText,
    /// A division by zero.
    Division,
    /// An operator that takes no floats.
    Floats,
}

impl Constant {
    /// Its bits and how to read them.
    #[must_use]
    pub fn cell(self) -> (u32, Type) {
        match self {
            Self::Whole(value, kind) => (value, kind),
            Self::Float(value) => (value.to_bits(), Type::Float),
        }
    }

    /// As a float.
    #[must_use]
    pub fn as_float(self) -> f32 {
        let (value, kind) = self.cell();
        f32::from_bits(arithmetic::convert(value, kind, Type::Float))
    }

    /// As a whole number with its sign; floats lose their fraction.
    #[must_use]
    pub fn as_whole(self) -> i64 {
        match self {
            Self::Whole(value, Type::Signed) => i64::from(value as i32),
            Self::Whole(value, _) => i64::from(value),
            Self::Float(value) => value as i64,
        }
    }

    /// Whether a condition of this value holds.
    #[must_use]
    pub fn is_true(self) -> bool {
        match self {
            Self::Whole(value, _) => value != 0,
            Self::Float(value) => value != 0.0,
        }
    }

    fn of(value: u32, kind: Type) -> Self {
        if kind == Type::Float { Self::Float(f32::from_bits(value)) } else { Self::Whole(value, kind) }
    }
}

impl NotConstant {
    /// The sentence and hint for it; `what` is what should have been constant.
    #[must_use]
    pub fn reported(&self, what: &str) -> (String, Option<String>) {
        self.why.reported(what)
    }

    /// The code of the diagnostic.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.why.code()
    }
}

impl Why {
    /// The sentence and hint for it; `what` is what should have been constant.
    #[must_use]
    pub fn reported(self, what: &str) -> (String, Option<String>) {
        match self {
            Self::Varies => (
                format!("{what} must be known when the program is compiled."),
                Some("Use numbers and names defined with CON or FCON above.".to_owned()),
            ),
            Self::LongText => ("A text of one character is a number, a longer one is not.".to_owned(), None),
            Self::Division => ("This divides by zero.".to_owned(), None),
            Self::Floats => {
                ("This operator takes whole numbers only.".to_owned(), Some("Convert with TOINT.".to_owned()))
            }
        }
    }

    /// The code of the diagnostic.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Self::Varies => codes::NOT_CONSTANT,
            Self::LongText => codes::LONG_TEXT,
            Self::Division => codes::DIVISION_BY_ZERO,
            Self::Floats => codes::NO_FLOATS,
        }
    }
}

/// Works out an expression; `lookup` knows the constants by their names in small letters.
///
/// # Errors
/// It holds something that is not constant, or something that cannot be worked out.
pub fn evaluate(expr: &Expr, lookup: &dyn Fn(&str) -> Option<Constant>) -> Result<Constant, NotConstant> {
    let not = |why| NotConstant { span: expr.span, why };
    Ok(match &expr.kind {
        ExprKind::Integer(value) => Constant::Whole(*value, Type::Unsigned),
        ExprKind::Float(value) => Constant::Float(*value),
        ExprKind::Text(bytes) => match bytes[..] {
            [byte] => Constant::Whole(byte.into(), Type::Unsigned),
            _ => return Err(not(Why::LongText)),
        },
        ExprKind::Group(inner) => evaluate(inner, lookup)?,
        ExprKind::Place(place) if place.index.is_none() && place.modifier.is_none() => {
            lookup(&place.name.key).ok_or(not(Why::Varies))?
        }
        ExprKind::Place(_) => return Err(not(Why::Varies)),
        ExprKind::Unary(operator, operand) => unary(*operator, evaluate(operand, lookup)?).map_err(not)?,
        ExprKind::Chain(first, links) => {
            let mut value = evaluate(first, lookup)?;
            for Link { operator, right } in links {
                let so_far = expr.span.start;
                let not = |why| NotConstant { span: Span { start: so_far, end: right.span.end }, why };
                value = binary(*operator, value, evaluate(right, lookup)?).map_err(not)?;
            }
            value
        }
    })
}

/// What an operator makes of two known values.
///
/// # Errors
/// It takes no floats, or divides by zero.
pub fn binary(operator: Binary, left: Constant, right: Constant) -> Result<Constant, Why> {
    let ((left, left_kind), (right, right_kind)) = (left.cell(), right.cell());
    let kind = arithmetic::common(left_kind, right_kind);
    if kind == Type::Float && !arithmetic::takes_floats(operator) {
        return Err(Why::Floats);
    }
    let left = arithmetic::convert(left, left_kind, kind);
    let right = arithmetic::convert(right, right_kind, kind);
    let value = arithmetic::binary(operator, kind, left, right).map_err(|_| Why::Division)?;
    Ok(Constant::of(value, arithmetic::result_of(operator, kind)))
}

/// What an operator makes of a known value.
///
/// # Errors
/// It takes no floats.
pub fn unary(operator: Unary, operand: Constant) -> Result<Constant, Why> {
    let (mut value, mut kind) = operand.cell();
    let either = matches!(operator, Unary::Negative | Unary::Not | Unary::ToInt | Unary::ToFloat);
    if operator.is_float() {
        value = arithmetic::convert(value, kind, Type::Float);
        kind = Type::Float;
    } else if kind == Type::Float && !either {
        return Err(Why::Floats);
    }
    Ok(Constant::of(arithmetic::unary(operator, kind, value), arithmetic::result_of_unary(operator, kind)))
}

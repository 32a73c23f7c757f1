//! A program as a tree.

use super::types::VarType;
use crate::listed::listed;
use crate::text::Span;
use std::sync::Arc;

/// A name as it stands in the text; `key` is it in small letters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// For look-ups; one for all places of a name.
    pub key: Arc<str>,
    /// Where it stands.
    pub span: Span,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// What it is.
    pub kind: StatementKind,
    /// Where it stands; for blocks, where their first line does.
    pub span: Span,
}

/// What a statement is. It is small, since a text can hold one in every two bytes: large parts are boxed.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the line above each variant shows its parts")]
pub enum StatementKind {
    /// `name VAR type` or `name VAR type(size)`.
    Variable { name: Name, kind: VarType, size: Option<Box<Expr>> },
    /// `name VAR other.modifier`.
    Alias { name: Name, of: Place },
    /// `name CON value`, or FCON.
    Constant { name: Name, value: Box<Expr>, float: bool },
    /// `name ByteTable values`.
    Table { name: Name, kind: VarType, values: Vec<Expr> },
    /// A label, with the variables that a subroutine takes.
    Label { name: Name, arguments: Option<Vec<Place>> },
    /// `place = items`.
    Assign { to: Place, items: Vec<Item> },
    /// `IF` with its branches, in order; the last may have no condition.
    If { branches: Vec<(Option<Expr>, Vec<Statement>)>, end: Span },
    /// `IF condition THEN label`, or GOTO or GOSUB on the line.
    IfJump { condition: Box<Expr>, then: Box<Statement> },
    /// `WHILE` to `WEND`.
    While { condition: Box<Expr>, body: Vec<Statement>, end: Span },
    /// `DO` to `WHILE`, or `REPEAT` to `UNTIL`.
    Repeat { body: Vec<Statement>, condition: Box<Expr>, until: bool },
    /// `FOR` to `NEXT`.
    For(Box<For>),
    /// `GOTO label`.
    Goto(Name),
    /// `GOSUB label[arguments], result`.
    Gosub { label: Name, arguments: Vec<Expr>, result: Option<Box<Place>> },
    /// `RETURN value`.
    Return(Option<Expr>),
    /// `BRANCH index, [labels]`.
    Branch { index: Box<Expr>, labels: Vec<Name> },
    /// `PUTS stream, [items]`.
    Puts { stream: Box<Expr>, items: Vec<Item> },
    /// `GETS stream, [items]`.
    Gets { stream: Box<Expr>, items: Vec<Item> },
    /// `READ address, place`.
    Read { address: Box<Expr>, to: Place },
    /// `WRITE address, value`.
    Write { address: Box<Expr>, value: Box<Expr> },
    /// `I2COUT` and `I2COUTNS`.
    I2cOut { otherwise: Option<Box<(Name, Expr)>>, bytes: Vec<Expr>, stop: bool },
    /// `I2CIN`.
    I2cIn { otherwise: Option<Box<(Name, Expr)>>, to: Vec<Place> },
    /// `PAUSE time`.
    Pause(Expr),
    /// A motion command.
    Motion { command: Motion, arguments: Vec<Expr> },
    /// `CLEAR`.
    Clear,
    /// `END` and `STOP`.
    End,
}

/// `FOR variable = start TO finish STEP step`, its body and its `NEXT`.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the line above shows its parts")]
pub struct For {
    pub variable: Place,
    pub start: Expr,
    pub finish: Expr,
    pub step: Option<Expr>,
    pub body: Vec<Statement>,
    pub end: Span,
}

listed! {
    /// A motion command.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
    pub enum Motion {
        /// `DIST motor, speed, accel, distance, buffer`.
        Dist "DIST",
        /// The same for both motors.
        Dist2 "DIST2",
        /// `MOVE motor, speed, accel, deccel, position, buffer`.
        Move "MOVE",
        /// The same for both motors.
        Move2 "MOVE2",
        /// `POWER motor, duty, accel`.
        Power "POWER",
        /// The same for both motors.
        Power2 "POWER2",
        /// `SPEED motor, speed, accel`.
        Speed "SPEED",
        /// The same for both motors.
        Speed2 "SPEED2",
    }
    /// Its word.
    #[must_use]
    fn word;
}

impl Motion {
    /// How many arguments it has.
    #[must_use]
    pub const fn arguments(self) -> usize {
        match self {
            Self::Dist => 5,
            Self::Dist2 => 7,
            Self::Move => 6,
            Self::Move2 => 9,
            Self::Power | Self::Speed => 3,
            Self::Power2 | Self::Speed2 => 4,
        }
    }

    /// Whether a buffer argument may follow although the syntax line has none.
    #[must_use]
    pub const fn takes_extra_buffer(self) -> bool {
        matches!(self, Self::Speed | Self::Speed2)
    }
}

/// A variable, register, table or constant, perhaps an element of it, perhaps a part of that.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Its name.
    pub name: Name,
    /// `(index)`.
    pub index: Option<Box<Expr>>,
    /// `.modifier`.
    pub modifier: Option<Box<Name>>,
    /// All of it.
    pub span: Span,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

/// What an expression is.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// A whole number.
    Integer(u32),
    /// A number with a point.
    Float(f32),
    /// A text; one of one character is a number.
    Text(Vec<u8>),
    /// A variable, register, table entry or constant.
    Place(Place),
    /// An operator before its operand.
    Unary(Unary, Box<Expr>),
    /// Operators of one order, worked out from left to right. They stand side by side and not within each other, so that the tree of a long
    /// sum is no deeper than that of a short one.
    Chain(Box<Expr>, Vec<Link>),
    /// Something in parentheses.
    Group(Box<Expr>),
}

/// An operator of a chain and what stands to its right.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The operator.
    pub operator: Binary,
    /// Its right operand.
    pub right: Expr,
}

impl ExprKind {
    /// The order of the operators of a chain; `None` for everything else.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn order(&self) -> Option<u8> {
        match self {
            Self::Chain(_, links) => links.first().map(|link| link.operator.order()),
            _ => None,
        }
    }
}

listed! {
    /// Operators of one operand; all bind tighter than any other (MCP manual 3.2.5).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[expect(missing_docs, reason = "each is the word or sign of MCP manual 3.2.3")]
    pub enum Unary {
        Negative,
        BitNot,
        Not,
        Abs,
        Sin,
        Cos,
        Sqr,
        Bin2Bcd,
        Random,
        ToInt,
        ToFloat,
        FAbs,
        FSqrt,
        FSin,
        FCos,
        FTan,
        FAsin,
        FAcos,
        FAtan,
        FSinh,
        FCosh,
        FTanh,
        FAtanh,
        FLn,
        FExp,
    }
}

listed! {
    /// Operators of two operands.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[expect(missing_docs, reason = "each is the word or sign of MCP manual 3.2.3")]
    pub enum Binary {
        Dig,
        Max,
        Min,
        Multiply,
        MultiplyHigh,
        MultiplyFraction,
        Divide,
        Remainder,
        Add,
        Subtract,
        ShiftLeft,
        ShiftRight,
        Less,
        LessOrEqual,
        Equal,
        GreaterOrEqual,
        Greater,
        NotEqual,
        BitAnd,
        BitOr,
        BitXor,
        BitNand,
        BitNor,
        BitNxor,
        And,
        Or,
        Xor,
    }
}

impl Unary {
    /// Whether it takes and gives floats, as all from FABS on do.
    #[must_use]
    pub const fn is_float(self) -> bool {
        self as u8 >= Self::FAbs as u8
    }
}

impl Binary {
    /// How tightly it binds: the order of MCP manual 3.2.5, from 2 (first) to 9.
    #[must_use]
    pub const fn order(self) -> u8 {
        match self {
            Self::Dig => 2,
            Self::Max | Self::Min => 3,
            Self::Multiply | Self::MultiplyHigh | Self::MultiplyFraction | Self::Divide | Self::Remainder => {
                4
            }
            Self::Add | Self::Subtract => 5,
            Self::ShiftLeft | Self::ShiftRight => 6,
            Self::Less
            | Self::LessOrEqual
            | Self::Equal
            | Self::GreaterOrEqual
            | Self::Greater
            | Self::NotEqual => 7,
            Self::BitAnd | Self::BitOr | Self::BitXor | Self::BitNand | Self::BitNor | Self::BitNxor => 8,
            Self::And | Self::Or | Self::Xor => 9,
        }
    }

    /// Whether the result is 0 or 1 by comparing.
    #[must_use]
    pub const fn compares(self) -> bool {
        self.order() == 7
    }
}

listed! {
    /// How a value is written or read (MCP manual 3.3).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[expect(missing_docs, reason = "each is the word of MCP manual 3.3.2")]
    pub enum Format {
        Dec "DEC",
        SDec "SDEC",
        Hex "HEX",
        IHex "IHEX",
        Rep "REP",
        Real "REAL",
        Str "STR",
    }
    /// Its word.
    #[must_use]
    fn word;
}

impl Format {
    /// The modifier that a word names, with the number written after it: `hex2` is `HEX` with 2.
    #[must_use]
    pub fn of_word(word: &str) -> Option<(Self, Option<u32>)> {
        let letters = word.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let format = Self::ALL.into_iter().find(|format| format.word().eq_ignore_ascii_case(letters))?;
        let digits = &word[letters.len()..];
        if digits.is_empty() { Some((format, None)) } else { Some((format, Some(digits.parse().ok()?))) }
    }
}

/// One entry of an output or input list.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Its modifier and the number after that.
    pub format: Option<(Format, Option<u32>)>,
    /// The value, or the place of an input.
    pub value: Expr,
    /// What follows, each after a backslash.
    pub arguments: Vec<Expr>,
    /// Where it stands.
    pub span: Span,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_tree_are_small() {
        // A text holds a statement in every two bytes at most, and an operand.
        assert!(size_of::<Statement>() <= 88, "{}", size_of::<Statement>());
        assert!(size_of::<Expr>() <= 64, "{}", size_of::<Expr>());
    }
}

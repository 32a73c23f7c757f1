//! A program as a tree.

use crate::board::Board;
use crate::mcl::ast::Binary;
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

/// The type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 0 to 255.
    Byte,
    /// 0 to 65535.
    Word,
    /// A byte of memory.
    Pointer,
}

/// `Declare Byte name = value`, or a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub kind: Kind,
    /// Its first value.
    pub value: Option<Expr>,
}

/// `Declare DataTable name` to `End DataTable`.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Its name.
    pub name: Name,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// What a routine is.
#[derive(Clone, Debug, PartialEq)]
pub enum RoutineKind {
    /// `Begin Program`.
    Program,
    /// `Declare EventHandler`.
    Handler,
    /// `Declare Function` with its parameters and the type of its value.
    Function(Vec<Variable>, Option<Kind>),
}

/// The program, a function or a handler.
#[derive(Clone, Debug, PartialEq)]
pub struct Routine {
    /// Which.
    pub kind: RoutineKind,
    /// Its name; that of the program is the word `Program`.
    pub name: Name,
    /// Its statements.
    pub body: Vec<Statement>,
    /// Where it ends.
    pub end: Span,
}

/// What stands outside of routines, and these.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A global variable.
    Variable(Variable),
    /// A table.
    Table(Table),
    /// A routine.
    Routine(Routine),
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// What it is.
    pub kind: StatementKind,
    /// Where it stands; for blocks, where their first line does.
    pub span: Span,
}

/// What a statement is.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the line above each variant shows its parts")]
pub enum StatementKind {
    /// `Declare Byte name = value` in a routine.
    Declare(Box<Variable>),
    /// `name = value`.
    Assign { to: Name, value: Box<Expr> },
    /// `Increment name`.
    Increment(Name),
    /// `Call name(arguments)`.
    Call { name: Name, arguments: Vec<Expr> },
    /// `Loop` to `End Loop`.
    Loop(Vec<Statement>),
    /// `Do` to `Until condition`; `end` is where that stands.
    Until { body: Vec<Statement>, condition: Box<Expr>, end: Span },
    /// `While condition` to `End While`.
    While { condition: Box<Expr>, body: Vec<Statement> },
    /// `If condition Then` to `End If`.
    If { condition: Box<Expr>, then: Vec<Statement>, otherwise: Vec<Statement> },
    /// `Select value` to `End Select`.
    Select { value: Box<Expr>, cases: Vec<Case>, otherwise: Vec<Statement> },
    /// `Wait ticks`.
    Wait(Box<Expr>),
    /// `SetEvent event, handler`.
    SetEvent { event: u32, handler: Name },
    /// `Enable Events` and `Disable Events`.
    Events(bool),
    /// `Transmit pointer`.
    Transmit(Name),
    /// `Receive pointer`.
    Receive(Name),
    /// `Return value`.
    Return(Option<Box<Expr>>),
    /// A command of the board.
    Board { command: Board, arguments: Vec<Expr> },
}

/// `Case values` and what stands behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its values.
    pub values: Vec<Expr>,
    /// What it does.
    pub body: Vec<Statement>,
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
    /// A number, or a text of one character.
    Number(u16),
    /// A variable.
    Name(Name),
    /// A function of the program.
    Call(Name, Vec<Expr>),
    /// `GetClock()`, `ReadAnalogue(n)`, `GetProgramNumber`.
    Board(Board, Vec<Expr>),
    /// `ReadData(pointer)`.
    ReadData(Name),
    /// `SetPointer(table)`.
    Address(Name),
    /// A minus before a value.
    Negative(Box<Expr>),
    /// `Not`.
    Not(Box<Expr>),
    /// Operators of one rank, worked out from left to right. They stand side by side and not within each other, so that the tree of a long
    /// sum is no deeper than that of a short one.
    Chain(Box<Expr>, Vec<Link>),
}

/// An operator of a chain and what stands to its right.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The operator.
    pub operator: Binary,
    /// Its right operand.
    pub right: Expr,
}

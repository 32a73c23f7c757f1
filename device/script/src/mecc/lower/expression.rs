//! Expressions: every value is a Word, and what goes beyond 65535 is lost at each operator.

use super::Lowering;
use super::scope::Meaning;
use crate::arithmetic::{self, Type};
use crate::mcl::ast::{Binary, Unary};
use crate::mcl::types::{Part, VarType};
use crate::mecc::ast::{Expr, ExprKind, Kind, Name};
use crate::mecc::{codes, words};
use crate::op::{Cell, Op};
use crate::text::Span;

/// What is left of a value in a Word.
const WORD: Op = Op::Part(Part { kind: VarType::Word, first_bit: 0 });

impl Lowering<'_> {
    /// The value of an expression that is the same in every run.
    pub fn constant(&self, expr: &Expr) -> Option<u32> {
        let value = match &expr.kind {
            ExprKind::Number(value) => u32::from(*value),
            ExprKind::Negative(inner) => self.constant(inner)?.wrapping_neg(),
            ExprKind::Not(inner) => u32::from(self.constant(inner)? == 0),
            ExprKind::Chain(first, links) => {
                let mut value = self.constant(first)?;
                for link in links {
                    let right = self.constant(&link.right)?;
                    value = arithmetic::binary(link.operator, Type::Unsigned, value, right).ok()? & 0xFFFF;
                }
                value
            }
            ExprKind::Name(_)
            | ExprKind::Call(..)
            | ExprKind::Board(..)
            | ExprKind::ReadData(_)
            | ExprKind::Address(_) => return None,
        };
        Some(value & 0xFFFF)
    }

    /// Puts the value of an expression on the stack.
    pub fn expression(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Number(value) => self.emit(Op::Push((*value).into())),
            ExprKind::Name(name) => self.load(name),
            ExprKind::Call(name, arguments) => {
                let returns = self.call(name, arguments);
                if let Some(None) = returns {
                    let message = format!("`{}` gives no value.", name.span.of(self.text));
                    let hint =
                        Some("Write Returns Word behind its parameters, or call it with Call.".to_owned());
                    self.report(codes::NO_VALUE, name.span, message, hint);
                }
                self.emit(Op::Result(Type::Unsigned));
            }
            ExprKind::Board(command, arguments) => {
                arguments.iter().for_each(|argument| self.expression(argument));
                self.facts.uses_clock |= *command == crate::board::Board::GetClock;
                self.check_board(*command, arguments);
                self.emit(Op::Board(*command));
            }
            ExprKind::ReadData(pointer) => {
                let Some(cell) = self.pointer(pointer, "ReadData") else { return };
                self.emit(Op::Load(cell));
                self.emit(Op::LoadByte);
                self.move_on(cell, 1);
            }
            ExprKind::Address(table) => match self.look_up_or(table, "Declare DataTable name") {
                Some(Meaning::Table(at, _)) => {
                    self.used(table);
                    self.facts.has_pointers = true;
                    self.emit(Op::Push(at));
                }
                Some(other) => {
                    let message =
                        format!("`{}` is {}, no DataTable.", table.span.of(self.text), other.title());
                    let hint = Some(format!("It is written: {}", words::syntax("SetPointer")));
                    self.report(codes::NOT_A_TABLE, table.span, message, hint);
                }
                None => {}
            },
            ExprKind::Negative(inner) => {
                self.expression(inner);
                self.emit(Op::Unary(Unary::Negative, Type::Unsigned));
                self.emit(WORD);
            }
            ExprKind::Not(inner) => {
                self.expression(inner);
                self.emit(Op::Unary(Unary::Not, Type::Unsigned));
            }
            ExprKind::Chain(first, links) => {
                self.expression(first);
                for link in links {
                    self.expression(&link.right);
                    self.operator(link.operator, &link.right);
                    self.note_clock(link.operator, first, &link.right);
                }
            }
        }
    }

    fn operator(&mut self, operator: Binary, right: &Expr) {
        if matches!(operator, Binary::Divide | Binary::Remainder) && right.kind == ExprKind::Number(0) {
            let hint = Some("Divide by something else.".to_owned());
            self.report(codes::DIVISION_BY_ZERO, right.span, "A division by zero.".to_owned(), hint);
        }
        self.emit(Op::Binary(operator, Type::Unsigned));
        if matches!(operator, Binary::Add | Binary::Subtract | Binary::Multiply) {
            self.emit(WORD);
        }
    }

    /// Constants that the clock is compared with.
    fn note_clock(&mut self, operator: Binary, left: &Expr, right: &Expr) {
        if operator.compares() {
            for side in [left, right] {
                if let ExprKind::Number(value) = side.kind {
                    self.facts.compared_with.push((side.span, value));
                }
            }
        }
    }

    fn load(&mut self, name: &Name) {
        match self.look_up(name) {
            Some(Meaning::Variable(kind, at)) => {
                self.used(name);
                self.emit(Op::Load(Cell { kind: kind.stored(), at: at * 8 }));
            }
            Some(Meaning::Function(_)) => {
                let shown = name.span.of(self.text);
                // Its value so far, where the function names itself.
                if let Some((_, at, kind)) = self.result.clone().filter(|(own, _, _)| *own == name.key) {
                    return self.emit(Op::Load(Cell { kind: kind.stored(), at: at * 8 }));
                }
                let message = format!("`{shown}` is a function and is written with parentheses.");
                self.report(codes::UNEXPECTED, name.span, message, Some(format!("Write {shown}().")));
            }
            Some(other @ (Meaning::Table(..) | Meaning::Handler(_))) => {
                let shown = name.span.of(self.text);
                let message = format!("`{shown}` is {} and has no value.", other.title());
                let hint = match other {
                    Meaning::Table(..) => {
                        format!("Point at it with SetPointer({shown}), and read with ReadData.")
                    }
                    Meaning::Variable(..) | Meaning::Function(_) | Meaning::Handler(_) => {
                        "Name a variable here.".to_owned()
                    }
                };
                self.report(codes::NOT_A_VARIABLE, name.span, message, Some(hint));
            }
            None => {}
        }
    }

    /// Calls a function; what it returns, or nothing if it is none.
    pub fn call(&mut self, name: &Name, arguments: &[Expr]) -> Option<Option<Kind>> {
        let function = match self.look_up_or(name, "Declare Function name() ... End Function")? {
            Meaning::Function(function) => function,
            other @ (Meaning::Variable(..) | Meaning::Table(..) | Meaning::Handler(_)) => {
                let message = format!("`{}` is {}, no function.", name.span.of(self.text), other.title());
                let hint = match other {
                    Meaning::Handler(_) => {
                        "A handler is run by its event: SetEvent event, handler".to_owned()
                    }
                    Meaning::Variable(..) | Meaning::Table(..) | Meaning::Function(_) => {
                        "Declare Function name() declares a function.".to_owned()
                    }
                };
                self.report(codes::NOT_A_FUNCTION, name.span, message, Some(hint));
                return None;
            }
        };
        self.used(name);
        if function.parameters.len() != arguments.len() {
            let message = format!(
                "`{}` takes {}, and {} here.",
                name.span.of(self.text),
                crate::mecc::parser::values(function.parameters.len()),
                crate::mecc::parser::are(arguments.len())
            );
            let hint = Some("Give it a value for each of its parameters.".to_owned());
            self.report(codes::ARGUMENT_COUNT, name.span, message, hint);
        }
        for (argument, kind) in arguments.iter().zip(function.parameters.iter()) {
            self.expression(argument);
            if let ExprKind::Number(value) = argument.kind {
                self.facts.compared_with.push((argument.span, value));
            }
            if let Some(constant) = self.constant(argument) {
                self.check_fit(constant, *kind, name, argument.span);
            }
        }
        let count = u32::try_from(function.parameters.len()).unwrap_or(u32::MAX);
        self.emit_to(Op::Gosub(0, count), function.routine);
        Some(function.returns)
    }

    /// The place of a DataPointer.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn pointer(&mut self, name: &Name, command: &str) -> Option<Cell> {
        match self.look_up(name)? {
            Meaning::Variable(Kind::Pointer, at) => {
                self.used(name);
                Some(Cell { kind: VarType::Word, at: at * 8 })
            }
            other => {
                let message = format!("`{}` is {}, no DataPointer.", name.span.of(self.text), other.title());
                let hint = "Declare DataPointer p, set it with p = SetPointer(table), and write ";
                self.report(
                    codes::NOT_A_POINTER,
                    name.span,
                    message,
                    Some(format!("{hint}{command} with p.")),
                );
                None
            }
        }
    }

    /// Moves a pointer on by so many bytes.
    pub fn move_on(&mut self, pointer: Cell, bytes: u32) {
        self.emit(Op::Load(pointer));
        self.emit(Op::Push(bytes));
        self.emit(Op::Binary(Binary::Add, Type::Unsigned));
        self.emit(Op::Store(pointer));
    }

    /// Warns of a constant that is more than its place holds.
    pub fn check_fit(&mut self, constant: u32, kind: Kind, name: &Name, span: Span) {
        if kind == Kind::Byte && constant > 0xFF {
            let message = format!(
                "{constant} does not fit a Byte: `{}` gets {}.",
                name.span.of(self.text),
                constant & 0xFF
            );
            self.report(
                codes::DOES_NOT_FIT,
                span,
                message,
                Some("A Byte is 0 to 255; declare a Word.".to_owned()),
            );
        }
    }
}

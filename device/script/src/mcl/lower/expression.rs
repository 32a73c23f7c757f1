//! Expressions onto the stack.

use super::super::ast::{Binary, Expr, ExprKind, Link, Unary};
use super::super::codes;
use super::super::constant::{self, Constant, Why};
use super::super::registers::{self, RegisterId};
use super::Lowering;
use crate::arithmetic::{self, Type};
use crate::op::Op;
use crate::text::Span;

impl Lowering<'_> {
    /// Puts the value of an expression on the stack and says how to read it.
    pub(super) fn expression(&mut self, expr: &Expr) -> Type {
        self.warn_of_precedence(expr);
        self.value(expr).kind
    }

    /// The value on the stack, worked out as far as it is known now: then it is one [`Op::Push`].
    fn value(&mut self, expr: &Expr) -> Value {
        let mut expr = expr;
        while let ExprKind::Group(inner) = &expr.kind {
            expr = inner;
        }
        match &expr.kind {
            ExprKind::Integer(value) => self.push(Constant::Whole(*value, Type::Unsigned)),
            ExprKind::Float(value) => self.push(Constant::Float(*value)),
            ExprKind::Text(bytes) => match bytes[..] {
                [byte] => self.push(Constant::Whole(byte.into(), Type::Unsigned)),
                _ => self.refused(Why::LongText, expr.span),
            },
            ExprKind::Place(place) => match constant::evaluate(expr, &|key| self.scope.constant(key)) {
                Ok(known) => {
                    self.use_constants(expr);
                    self.push(known)
                }
                Err(_) => Value::of(self.load(place)),
            },
            ExprKind::Unary(operator, operand) => self.unary(*operator, operand, expr.span),
            ExprKind::Chain(first, links) => {
                let mut left = self.value(first);
                let mut before = Before { span: first.span, place: Some(first) };
                for link in links {
                    left = self.binary(left, &before, link);
                    before = Before { span: before.span.to(link.right.span), place: None };
                }
                left
            }
            ExprKind::Group(_) => Value::of(Type::Unsigned),
        }
    }

    fn push(&mut self, known: Constant) -> Value {
        let (cell, kind) = known.cell();
        self.emit(Op::Push(cell));
        Value { kind, known: Some(known) }
    }

    /// Something that cannot be worked out: it is said, and a number stands for it.
    fn refused(&mut self, why: Why, span: Span) -> Value {
        let (message, hint) = why.reported("");
        self.report(why.code(), span, message, hint);
        self.emit(Op::Push(0));
        Value::of(Type::Unsigned)
    }

    /// Takes back the instructions of so many known values, each of which is one.
    fn unpush(&mut self, count: usize) {
        for _ in 0..count {
            self.unemit();
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn unary(&mut self, operator: Unary, operand: &Expr, span: Span) -> Value {
        let Value { kind: from, known } = self.value(operand);
        if let Some(known) = known {
            self.unpush(1);
            return match constant::unary(operator, known) {
                Ok(known) => self.push(known),
                Err(why) => self.refused(why, span),
            };
        }
        let mut kind = from;
        if operator.is_float() {
            if from != Type::Float {
                self.warn_of_mixing(operand.span);
            }
            self.convert(from, Type::Float);
            kind = Type::Float;
        } else if from == Type::Float && !matches!(operator, Unary::Negative | Unary::Not | Unary::ToInt) {
            match operator {
                Unary::ToFloat => {}
                Unary::Abs => self.no_floats_but(operand.span, "FABS takes a float."),
                Unary::Sin => self.no_floats_but(operand.span, "FSIN takes a float, in radians."),
                Unary::Cos => self.no_floats_but(operand.span, "FCOS takes a float, in radians."),
                Unary::Sqr => self.no_floats_but(operand.span, "FSQRT takes a float."),
                _ => self.no_floats(operand.span),
            }
            return Value::of(from);
        }
        self.emit(Op::Unary(operator, kind));
        Value::of(arithmetic::result_of_unary(operator, kind))
    }

    fn no_floats(&mut self, span: Span) {
        self.no_floats_but(span, "Convert with TOINT.");
    }

    fn no_floats_but(&mut self, span: Span, hint: &str) {
        let hint = Some(hint.to_owned());
        self.report(codes::NO_FLOATS, span, "Only whole numbers work here.".to_owned(), hint);
    }

    /// An operator of a chain; the value of what stands before it is on the stack already.
    fn binary(&mut self, left: Value, before: &Before<'_>, link: &Link) -> Value {
        let Link { operator, right: right_expr } = link;
        let (operator, span) = (*operator, before.span.to(right_expr.span));
        let after_left = self.ops.len();
        let right = self.value(right_expr);
        if let (Some(known), Some(other)) = (left.known, right.known) {
            self.unpush(2);
            return match constant::binary(operator, known, other) {
                Ok(known) => self.push(known),
                Err(why) => self.refused(why, span),
            };
        }
        self.warn_of_disputed_operand(operator, before.place, right.known, right_expr.span);
        self.warn_of_disputed_operand(operator, Some(right_expr), left.known, before.span);
        let kind = arithmetic::common(left.kind, right.kind);
        if kind == Type::Float {
            if !arithmetic::takes_floats(operator) {
                self.no_floats(if left.kind == Type::Float { before.span } else { right_expr.span });
                self.emit(Op::Drop);
                return Value::of(Type::Unsigned);
            }
            if left.kind != right.kind {
                self.warn_of_mixing(span);
            }
            if left.kind != Type::Float {
                self.insert(after_left, Op::Convert(left.kind, kind));
            }
            self.convert(right.kind, kind);
        }
        let divides = matches!(operator, Binary::Divide | Binary::Remainder) && kind != Type::Float;
        if divides && right.known.is_some_and(|known| known.as_whole() == 0) {
            self.report(codes::DIVISION_BY_ZERO, right_expr.span, "This divides by zero.".to_owned(), None);
        }
        self.emit(Op::Binary(operator, kind));
        Value::of(arithmetic::result_of(operator, kind))
    }

    /// Looks at a register beside a constant: comparisons and masks depend on what its values mean.
    fn warn_of_disputed_operand(
        &mut self,
        operator: Binary,
        place: Option<&Expr>,
        other: Option<Constant>,
        span: Span,
    ) {
        let (Some(mut inner), Some(known)) = (place, other) else { return };
        if !(operator.compares() || operator.order() == MASKS) {
            return;
        }
        while let ExprKind::Group(deeper) = &inner.kind {
            inner = deeper;
        }
        if let ExprKind::Place(place) = &inner.kind
            && let Some(id) = self.register_of(place)
        {
            self.warn_of_dispute(id, known.as_whole(), span);
        }
    }

    /// Warns of a register's value about which the manual's pages disagree.
    pub(super) fn warn_of_dispute(&mut self, id: RegisterId, value: i64, span: Span) {
        if let Some(dispute) = registers::dispute(id, value) {
            self.report(codes::DISPUTED_VALUE, span, dispute.to_owned(), None);
        }
    }

    fn warn_of_mixing(&mut self, span: Span) {
        let message = "Whole and floating point numbers are mixed; the whole one is converted.".to_owned();
        self.report(codes::MIXED, span, message, Some("Write TOFLOAT before the whole one.".to_owned()));
    }

    /// Puts a whole number on the stack; a float is refused.
    pub(super) fn whole_number(&mut self, expr: &Expr) -> Type {
        let kind = self.expression(expr);
        if kind == Type::Float {
            self.no_floats(expr.span);
        }
        kind
    }

    /// Puts a condition on the stack: zero or not.
    pub(super) fn condition(&mut self, expr: &Expr) {
        if self.expression(expr) == Type::Float {
            self.emit(Op::Push(0));
            self.emit(Op::Binary(Binary::NotEqual, Type::Float));
        }
    }

    /// Notes the constants of an expression that was worked out.
    pub(super) fn use_constants(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Place(place) => {
                if let Some(entry) = self.scope.get_mut(&place.name.key) {
                    entry.symbol.uses.push(place.name.span);
                }
            }
            ExprKind::Unary(_, inner) | ExprKind::Group(inner) => self.use_constants(inner),
            ExprKind::Chain(first, links) => {
                self.use_constants(first);
                links.iter().for_each(|link| self.use_constants(&link.right));
            }
            ExprKind::Integer(_) | ExprKind::Float(_) | ExprKind::Text(_) => {}
        }
    }

    /// Says where the order of operators is not what other languages, or the manual's own examples, suggest. An index is an expression of its
    /// own, which is looked at by itself.
    pub(super) fn warn_of_precedence(&mut self, expr: &Expr) {
        let (first, links) = match &expr.kind {
            ExprKind::Unary(_, inner) | ExprKind::Group(inner) => return self.warn_of_precedence(inner),
            ExprKind::Chain(first, links) => (first, links),
            ExprKind::Integer(_) | ExprKind::Float(_) | ExprKind::Text(_) | ExprKind::Place(_) => return,
        };
        let sides = || std::iter::once(&**first).chain(links.iter().map(|link| &link.right));
        if expr.kind.order() == Some(MASKS) {
            for side in sides().filter(|side| side.kind.order() == Some(COMPARISONS)) {
                let message = "The comparison is worked out before & | ^.".to_owned();
                let hint = Some("Put the part with & | ^ in parentheses.".to_owned());
                self.report(codes::COMPARISON_FIRST, side.span, message, hint);
            }
        }
        if let (Some(COMPARISONS), ExprKind::Unary(Unary::Not, _), [link, ..]) =
            (expr.kind.order(), &first.kind, &links[..])
        {
            let message = "NOT is worked out before the comparison.".to_owned();
            let hint = Some("Put the comparison in parentheses: NOT (a < b).".to_owned());
            self.report(codes::NOT_FIRST, first.span.to(link.right.span), message, hint);
        }
        sides().for_each(|side| self.warn_of_precedence(side));
    }
}

/// The order of comparisons (MCP manual 3.2.5).
const COMPARISONS: u8 = 7;
/// The order of `& | ^` and their kin (MCP manual 3.2.5).
const MASKS: u8 = 8;

/// What stands before an operator of a chain.
struct Before<'a> {
    span: Span,
    /// The expression, where it is the first of the chain.
    place: Option<&'a Expr>,
}

/// A value on the stack.
#[derive(Clone, Copy)]
struct Value {
    /// How it is read.
    kind: Type,
    /// What it is, if that is known now.
    known: Option<Constant>,
}

impl Value {
    /// One that the program works out when it runs.
    fn of(kind: Type) -> Self {
        Self { kind, known: None }
    }
}

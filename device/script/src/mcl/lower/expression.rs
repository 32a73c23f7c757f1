//! Expressions onto the stack.

use super::super::ast::{Binary, Expr, ExprKind, Unary};
use super::super::codes;
use super::super::constant::Why;
use super::super::registers::{self, RegisterId};
use super::Lowering;
use crate::arithmetic::{self, Type};
use crate::op::Op;
use crate::text::Span;

impl Lowering<'_> {
    /// Puts the value of an expression on the stack and says how to read it.
    pub(super) fn expression(&mut self, expr: &Expr) -> Type {
        self.warn_of_precedence(expr);
        self.value(expr)
    }

    fn value(&mut self, expr: &Expr) -> Type {
        match self.folded(expr) {
            Ok(known) => {
                self.use_constants(expr);
                let (cell, kind) = known.cell();
                self.emit(Op::Push(cell));
                return kind;
            }
            Err(error) if error.why != Why::Varies && error.span == expr.span => {
                let (message, hint) = error.told("");
                self.report(error.code(), error.span, message, hint);
                self.emit(Op::Push(0));
                return Type::Unsigned;
            }
            Err(_) => {}
        }
        match &expr.kind {
            ExprKind::Group(inner) => self.value(inner),
            ExprKind::Place(place) => self.load(place),
            ExprKind::Unary(operator, operand) => self.unary(*operator, operand),
            ExprKind::Binary(operator, left, right) => self.binary(*operator, left, right, expr.span),
            // Constants have been folded above.
            ExprKind::Integer(_) | ExprKind::Float(_) | ExprKind::Text(_) => Type::Unsigned,
        }
    }

    fn unary(&mut self, operator: Unary, operand: &Expr) -> Type {
        let from = self.value(operand);
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
            return from;
        }
        self.emit(Op::Unary(operator, kind));
        arithmetic::result_of_unary(operator, kind)
    }

    fn no_floats(&mut self, span: Span) {
        self.no_floats_but(span, "Convert with TOINT.");
    }

    fn no_floats_but(&mut self, span: Span, hint: &str) {
        let hint = Some(hint.to_owned());
        self.report(codes::NO_FLOATS, span, "Only whole numbers work here.".to_owned(), hint);
    }

    fn binary(&mut self, operator: Binary, left: &Expr, right: &Expr, span: Span) -> Type {
        self.warn_of_disputed_operand(operator, left, right);
        self.warn_of_disputed_operand(operator, right, left);
        let left_kind = self.value(left);
        let after_left = self.ops.len();
        let right_kind = self.value(right);
        let kind = arithmetic::common(left_kind, right_kind);
        if kind == Type::Float {
            if !arithmetic::takes_floats(operator) {
                self.no_floats(if left_kind == Type::Float { left.span } else { right.span });
                self.emit(Op::Drop);
                return Type::Unsigned;
            }
            if left_kind != right_kind {
                self.warn_of_mixing(span);
            }
            if left_kind != Type::Float {
                self.insert(after_left, Op::Convert(left_kind, kind));
            }
            self.convert(right_kind, kind);
        }
        if matches!(operator, Binary::Divide | Binary::Remainder)
            && kind != Type::Float
            && self.folded(right).is_ok_and(|known| known.as_whole() == 0)
        {
            self.report(codes::DIVISION_BY_ZERO, right.span, "This divides by zero.".to_owned(), None);
        }
        self.emit(Op::Binary(operator, kind));
        arithmetic::result_of(operator, kind)
    }

    /// Looks at a register beside a constant: comparisons and masks depend on what its values mean.
    fn warn_of_disputed_operand(&mut self, operator: Binary, place: &Expr, other: &Expr) {
        if !(operator.compares() || operator.order() == 8) {
            return;
        }
        let mut inner = place;
        while let ExprKind::Group(deeper) = &inner.kind {
            inner = deeper;
        }
        if let ExprKind::Place(place) = &inner.kind
            && let Some(id) = self.register_of(place)
            && let Ok(known) = self.folded(other)
        {
            self.warn_of_dispute(id, known.as_whole(), other.span);
        }
    }

    /// Warns of a register's value about which the manual's pages disagree.
    pub(super) fn warn_of_dispute(&mut self, id: RegisterId, value: i64, span: Span) {
        if let Some(dispute) = registers::dispute(id, value) {
            self.report(codes::DISPUTED_VALUE, span, dispute.to_owned(), None);
        }
    }

    /// Puts an instruction between those of one expression, where no jump leads.
    fn insert(&mut self, at: usize, op: Op) {
        self.ops.insert(at, op);
        self.lines.insert(at, self.line);
        self.spans.insert(at, self.span);
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
            ExprKind::Binary(_, left, right) => {
                self.use_constants(left);
                self.use_constants(right);
            }
            _ => {}
        }
    }

    /// Says where the order of operators is not what other languages, or the manual's own examples, suggest.
    fn warn_of_precedence(&mut self, expr: &Expr) {
        let ExprKind::Binary(operator, left, right) = &expr.kind else {
            match &expr.kind {
                ExprKind::Unary(_, inner) | ExprKind::Group(inner) => self.warn_of_precedence(inner),
                ExprKind::Place(place) => {
                    place.index.iter().for_each(|index| self.warn_of_precedence(index));
                }
                _ => {}
            }
            return;
        };
        if operator.order() == 8 {
            for side in [left, right] {
                if let ExprKind::Binary(inner, ..) = &side.kind
                    && inner.compares()
                {
                    let message = "The comparison is worked out before & | ^.".to_owned();
                    let hint = Some("Put the part with & | ^ in parentheses.".to_owned());
                    self.report(codes::COMPARISON_FIRST, side.span, message, hint);
                }
            }
        }
        if operator.compares()
            && let ExprKind::Unary(Unary::Not, _) = &left.kind
        {
            let message = "NOT is worked out before the comparison.".to_owned();
            let hint = Some("Put the comparison in parentheses: NOT (a < b).".to_owned());
            self.report(codes::NOT_FIRST, left.span.to(right.span), message, hint);
        }
        self.warn_of_precedence(left);
        self.warn_of_precedence(right);
    }
}

//! Labels, jumps, subroutines, conditions and loops.

use super::super::ast::{Expr, For, Name, Place, Statement};
use super::super::codes;
use super::super::constant::Constant;
use super::super::registers::RegisterId;
use super::super::types::{self, VarType};
use super::super::words;
use super::place::Target;
use super::scope::{Meaning, type_of};
use super::{Argument, Lowering, Mark};
use crate::arithmetic::Type;
use crate::diagnostic::excerpt;
use crate::op::{Cell, Op};
use crate::text::Span;

impl Lowering<'_> {
    /// A label; a subroutine's takes its arguments from the stack, the last one first.
    pub(super) fn label(&mut self, name: &Name, arguments: Option<&[Place]>) {
        let at = Some(self.here());
        let places = arguments.unwrap_or_default();
        let mut types = vec![Type::Unsigned; places.len()];
        for (place, kind) in places.iter().zip(&mut types).rev() {
            if let Some(target) = self.settable(place) {
                *kind = type_of(target.kind());
            }
            self.scope.get_mut(&place.name.key).into_iter().for_each(|entry| {
                entry.symbol.uses.pop();
            });
            self.store(place, *kind);
        }
        self.scope.settle(name, Meaning::Label { at, arguments: Some(types) });
    }

    pub(super) fn if_branches(&mut self, branches: &[(Option<Expr>, Vec<Statement>)], end: Span) {
        let mut done = Mark::default();
        for (index, (condition, body)) in branches.iter().enumerate() {
            let mut next = Mark::default();
            if let Some(condition) = condition {
                if index > 0 {
                    self.at(condition.span);
                }
                self.condition(condition);
                self.jump(Op::JumpIfZero(0), &mut next);
            }
            self.block(body);
            if index + 1 < branches.len() {
                done.jumps.push(self.ops.len());
                self.emit_unwritten(Op::Jump(0));
            }
            self.set(next);
        }
        self.line = self.text_lines.line_of(end.start);
        self.set(done);
    }

    pub(super) fn if_jump(&mut self, condition: &Expr, then: &Statement) {
        self.condition(condition);
        let mut over = Mark::default();
        self.jump(Op::JumpIfZero(0), &mut over);
        self.statement(then);
        self.set(over);
    }

    pub(super) fn while_loop(&mut self, condition: &Expr, body: &[Statement], end: Span) {
        let mut top = self.here();
        let mut out = Mark::default();
        if self.always(condition) == Some(true) {
            // The line has an instruction to stop at, which is passed once.
            self.emit(Op::Nop);
            top = self.here();
        } else {
            self.condition(condition);
            self.jump(Op::JumpIfZero(0), &mut out);
        }
        self.block(body);
        self.line = self.text_lines.line_of(end.start);
        self.emit_unwritten(Op::Jump(top));
        self.set(out);
    }

    pub(super) fn repeat_loop(&mut self, body: &[Statement], condition: &Expr, until: bool) {
        let top = self.here();
        self.block(body);
        self.at(condition.span);
        match self.always(condition) {
            Some(holds) if holds != until => self.emit_unwritten(Op::Jump(top)),
            _ => {
                self.condition(condition);
                self.emit(if until { Op::JumpIfZero(top) } else { Op::JumpIfNotZero(top) });
            }
        }
    }

    /// Whether the condition of a loop always holds, or never; `None` if that is not known now.
    fn always(&mut self, condition: &Expr) -> Option<bool> {
        let known = self.folded(condition).ok()?;
        self.use_constants(condition);
        Some(known.is_true())
    }

    pub(super) fn for_loop(&mut self, parts: &For) {
        let For { variable, start, finish, step, body, end } = parts;
        let cell = self.counter(variable);
        let kind = type_of(cell.kind);
        let number = self.loops;
        self.loops += 1;
        for bound in [start, finish] {
            if let Ok(known @ Constant::Whole(..)) = self.folded(bound) {
                self.warn_of_loss(known, cell.kind, bound.span);
            }
        }
        self.value_as(start, kind);
        self.value_as(finish, kind);
        if let Some(step) = step {
            // A step of an unsigned counter may be negative: it counts down by wrapping round.
            let from = self.expression(step);
            self.convert(from, kind);
        } else {
            self.warn_of_counting_down(start, finish);
        }
        self.emit(Op::ForStart(cell, number, step.is_some()));
        let top = self.here();
        self.block(body);
        self.line = self.text_lines.line_of(end.start);
        self.span = None;
        self.value_as(finish, kind);
        self.emit(Op::ForNext(cell, number, top));
    }

    /// The variable of a FOR, which has to be one at a known place.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn counter(&mut self, variable: &Place) -> Cell {
        let nowhere = Cell { kind: VarType::Long, at: 0 };
        let target = if self.register_of(variable).is_some() { None } else { self.settable(variable) };
        let Some(target) = target else {
            if self.register_of(variable).is_some() {
                let message = "FOR counts a variable, not a system register.".to_owned();
                self.report(codes::NOT_A_VARIABLE, variable.span, message, None);
            }
            return nowhere;
        };
        self.mark_read(&target);
        match target {
            Target::Cell { cell, .. } => cell,
            _ => {
                let message = "FOR counts a variable, or an element with a constant index.".to_owned();
                self.report(codes::NOT_A_VARIABLE, variable.span, message, None);
                nowhere
            }
        }
    }

    /// Puts an expression on the stack as a value of this type.
    fn value_as(&mut self, expr: &Expr, kind: Type) {
        let from = self.expression(expr);
        if from == Type::Float && kind != Type::Float {
            let message = "A floating point number is used for a whole one; its fraction is lost.".to_owned();
            self.report(
                codes::FLOAT_INTO_INTEGER,
                expr.span,
                message,
                Some("Write TOINT if that is meant.".into()),
            );
        }
        self.convert(from, kind);
    }

    fn warn_of_counting_down(&mut self, start: &Expr, finish: &Expr) {
        if let (Ok(first), Ok(last)) = (self.folded(start), self.folded(finish))
            && first.as_float() > last.as_float()
        {
            let message = "Without STEP this counts down, one at a time.".to_owned();
            let hint = Some("Write step -1 to make that plain.".to_owned());
            self.report(codes::COUNTS_DOWN, start.span.to(finish.span), message, hint);
        }
    }

    pub(super) fn gosub(&mut self, label: &Name, arguments: &[Expr], result: Option<&Place>) {
        let wanted = self.scope.get(&label.key).and_then(|entry| entry.argument_count);
        if let Some(wanted) = wanted.filter(|wanted| *wanted != arguments.len()) {
            let name = excerpt(label.span.of(self.text));
            let message = format!("`{name}` takes {wanted} arguments, not {}.", arguments.len());
            let hint = Some("By the manual the stack overflows or underflows then.".to_owned());
            self.report(codes::GOSUB_ARGUMENTS, label.span, message, hint);
        }
        self.check_count(arguments.iter().map(|argument| argument.span));
        for (index, argument) in arguments.iter().enumerate() {
            let from = self.expression(argument);
            self.arguments.push(Argument { op: self.ops.len(), label: label.key.clone(), index, from });
            self.emit(Op::Nop);
        }
        let count = u32::try_from(arguments.len()).unwrap_or(u32::MAX);
        self.jump_to_label(Op::Gosub(0, count), label);
        if let Some(place) = result {
            let kind = self.kind_of(place);
            self.emit(Op::Result(kind));
            self.store(place, kind);
        }
    }

    /// How values of a place are read; uses and faults are not noted.
    fn kind_of(&self, place: &Place) -> Type {
        self.stored_kind(place).map_or(Type::Unsigned, type_of)
    }

    /// The register that a place names, perhaps by an alias.
    pub(super) fn register_of(&self, place: &Place) -> Option<RegisterId> {
        if let Some((id, _)) = words::register(&place.name.key) {
            return Some(id);
        }
        match self.scope.get(&place.name.key)?.meaning.as_ref()? {
            Meaning::Register { id, .. } => Some(*id),
            Meaning::Memory { .. }
            | Meaning::Constant(_)
            | Meaning::Table(_)
            | Meaning::Label { .. }
            | Meaning::Broken => None,
        }
    }

    /// The type that a variable, a register or a part of one is stored as; uses and faults are not noted.
    pub(super) fn stored_kind(&self, place: &Place) -> Option<VarType> {
        let whole = match (words::register(&place.name.key), self.scope.get(&place.name.key)) {
            (Some((id, _)), _) => id.row().kind,
            (None, entry) => match entry?.meaning.as_ref()? {
                Meaning::Memory { memory, .. } => memory.first.kind,
                Meaning::Register { id, part, .. } => part.map_or(id.row().kind, |part| part.kind),
                Meaning::Constant(_) | Meaning::Table(_) | Meaning::Label { .. } | Meaning::Broken => {
                    return None;
                }
            },
        };
        let part = place.modifier.as_ref().map(|modifier| modifier.span.of(self.text));
        let part = part.and_then(|part| types::part(whole, part).ok());
        Some(part.map_or(whole, |part| part.kind))
    }

    pub(super) fn return_value(&mut self, value: Option<&Expr>) {
        let kind = value.map(|value| self.expression(value));
        self.emit(Op::Return(kind));
    }

    pub(super) fn branch(&mut self, index: &Expr, labels: &[Name]) {
        self.whole_number(index);
        self.emit(Op::Branch(u32::try_from(labels.len()).unwrap_or(u32::MAX)));
        for label in labels {
            self.jump_to_label(Op::Jump(0), label);
        }
    }
}

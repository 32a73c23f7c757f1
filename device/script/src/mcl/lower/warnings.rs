//! What can be said of a whole program: names without use, statements without a way to them, ways out of the program.

use super::super::ast::{Statement, StatementKind};
use super::super::codes;
use super::Lowering;
use super::scope::SymbolKind;
use crate::diagnostic::Diagnostic;
use crate::text::Span;
use std::collections::HashSet;

impl Lowering<'_> {
    /// Names that nothing uses.
    pub(super) fn warn_of_unused(&mut self) {
        let mut found = Vec::new();
        for entry in self.scope.entries() {
            let name = entry.symbol.defined.of(self.text);
            let (code, message) = match entry.symbol.kind {
                SymbolKind::Variable if !entry.is_read && entry.is_written => {
                    (codes::UNUSED_VARIABLE, format!("`{name}` is set but never read."))
                }
                SymbolKind::Variable if !entry.is_read => {
                    (codes::UNUSED_VARIABLE, format!("`{name}` is never used."))
                }
                SymbolKind::Label if entry.symbol.uses.is_empty() => {
                    (codes::UNUSED_LABEL, format!("Nothing jumps to `{name}`."))
                }
                _ => continue,
            };
            found.push((code, entry.symbol.defined, message));
        }
        for (code, span, message) in found {
            self.report(code, span, message, None);
        }
    }
}

/// Where the program cannot get to, runs out, or lets the stack grow.
pub fn flow(text: &str, statements: &[Statement], diagnostics: &mut Vec<Diagnostic>) {
    let mut called = HashSet::new();
    let mut jumped = HashSet::new();
    walk(statements, &mut |statement| note_targets(statement, &mut called, &mut jumped));
    let mut flow = Flow { text, called, jumped, diagnostics };
    flow.list(statements);
    flow.ends(statements);
    flow.subroutines(statements);
}

fn walk(statements: &[Statement], visit: &mut dyn FnMut(&Statement)) {
    for statement in statements {
        visit(statement);
        match &statement.kind {
            StatementKind::If { branches, .. } => {
                branches.iter().for_each(|(_, body)| walk(body, visit));
            }
            StatementKind::While { body, .. }
            | StatementKind::Repeat { body, .. }
            | StatementKind::For { body, .. } => walk(body, visit),
            StatementKind::IfJump { then, .. } => visit(then),
            _ => {}
        }
    }
}

fn note_targets(statement: &Statement, called: &mut HashSet<String>, jumped: &mut HashSet<String>) {
    match &statement.kind {
        StatementKind::Gosub { label, .. } => {
            called.insert(label.key.clone());
        }
        StatementKind::Goto(label) => {
            jumped.insert(label.key.clone());
        }
        StatementKind::Branch { labels, .. } => jumped.extend(labels.iter().map(|label| label.key.clone())),
        StatementKind::I2cOut { otherwise: Some((label, _)), .. }
        | StatementKind::I2cIn { otherwise: Some((label, _)), .. } => {
            jumped.insert(label.key.clone());
        }
        _ => {}
    }
}

struct Flow<'a> {
    text: &'a str,
    /// Labels that GOSUB goes to.
    called: HashSet<String>,
    /// Labels that other jumps go to.
    jumped: HashSet<String>,
    diagnostics: &'a mut Vec<Diagnostic>,
}

/// Whether the next statement is never reached from this one.
fn leaves(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Goto(_) | StatementKind::Return(_) | StatementKind::End => true,
        StatementKind::If { branches, .. } => {
            let has_else = branches.last().is_some_and(|(condition, _)| condition.is_none());
            has_else && branches.iter().all(|(_, body)| executable(body).next_back().is_some_and(leaves))
        }
        _ => false,
    }
}

/// Statements that do something when the program runs, labels included.
fn executable(statements: &[Statement]) -> impl DoubleEndedIterator<Item = &Statement> {
    statements.iter().filter(|statement| {
        !matches!(
            statement.kind,
            StatementKind::Variable { .. }
                | StatementKind::Alias { .. }
                | StatementKind::Constant { .. }
                | StatementKind::Table { .. }
        )
    })
}

impl Flow<'_> {
    fn report(&mut self, code: &'static str, span: Span, message: String, hint: Option<String>) {
        self.diagnostics.push(Diagnostic { code, span, message, hint });
    }

    /// Statements after one that leaves, up to the next label.
    fn list(&mut self, statements: &[Statement]) {
        let mut left = false;
        for statement in executable(statements) {
            if matches!(statement.kind, StatementKind::Label { .. }) {
                left = false;
            } else if left && !has_label(statement) {
                self.report(codes::UNREACHABLE, statement.span, "Nothing leads here.".to_owned(), None);
                return self.rest(statements, statement);
            }
            self.inside(statement);
            left |= leaves(statement);
        }
    }

    /// Goes on at the next label after `from`, so that each stretch is named once.
    fn rest(&mut self, statements: &[Statement], from: &Statement) {
        let after = statements.iter().skip_while(|statement| statement.span != from.span);
        let label = |statement: &&Statement| !matches!(statement.kind, StatementKind::Label { .. });
        let skipped = statements.len() - after.clone().skip_while(label).count();
        if skipped < statements.len() {
            self.list(&statements[skipped..]);
        }
    }

    fn inside(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::If { branches, .. } => branches.iter().for_each(|(_, body)| self.list(body)),
            StatementKind::While { body, .. }
            | StatementKind::Repeat { body, .. }
            | StatementKind::For { body, .. } => self.list(body),
            _ => {}
        }
    }

    /// The last statement, and those before a subroutine.
    fn ends(&mut self, statements: &[Statement]) {
        let mut before: Option<&Statement> = None;
        for statement in executable(statements) {
            if let (StatementKind::Label { name, arguments }, Some(previous)) = (&statement.kind, before) {
                let only_called = self.called.contains(&name.key) && !self.jumped.contains(&name.key);
                if (only_called || arguments.is_some()) && !leaves(previous) {
                    let name = name.span.of(self.text);
                    let message = format!("The program runs into the subroutine `{name}` here.");
                    let hint = Some("Write END before it.".to_owned());
                    self.report(codes::MISSING_END, previous.span, message, hint);
                }
            }
            before = Some(statement);
        }
        if let Some(last) = before.filter(|last| !leaves(last)) {
            let message = "The program runs out here and ends.".to_owned();
            self.report(
                codes::MISSING_END,
                last.span,
                message,
                Some("Write END, or GOTO to go on.".to_owned()),
            );
        }
    }

    /// Subroutines that call themselves or leave by GOTO.
    fn subroutines(&mut self, statements: &[Statement]) {
        for (index, statement) in statements.iter().enumerate() {
            let StatementKind::Label { name, .. } = &statement.kind else { continue };
            if !self.called.contains(&name.key) {
                continue;
            }
            let length =
                statements[index..].iter().position(leaves).map_or(statements.len() - index, |at| at + 1);
            let body = &statements[index..index + length];
            let mut found = Vec::new();
            walk(body, &mut |inner| {
                if let StatementKind::Gosub { label, .. } = &inner.kind
                    && label.key == name.key
                {
                    found.push((inner.span, format!("`{}` calls itself.", name.span.of(self.text))));
                }
            });
            if let Some(Statement { kind: StatementKind::Goto(label), span }) = body.last()
                && !has_return_after(statements, &label.key)
            {
                found.push((*span, format!("The subroutine `{}` leaves by GOTO.", name.span.of(self.text))));
            }
            for (span, message) in found {
                let hint = Some("Each call that does not return takes room on the stack.".to_owned());
                self.report(codes::STACK_GROWTH, span, message, hint);
            }
        }
    }
}

/// Whether the code at a label reaches a RETURN before it leaves otherwise.
fn has_return_after(statements: &[Statement], label: &str) -> bool {
    let at = |statement: &Statement| matches!(&statement.kind, StatementKind::Label { name, .. } if name.key == label);
    let Some(start) = statements.iter().position(at) else { return true };
    let mut found = false;
    let end =
        statements[start..].iter().position(leaves).map_or(statements.len(), |length| start + length + 1);
    walk(&statements[start..end], &mut |inner| found |= matches!(inner.kind, StatementKind::Return(_)));
    found
}

/// Whether a jump can lead into a block.
fn has_label(statement: &Statement) -> bool {
    let mut found = false;
    walk(std::slice::from_ref(statement), &mut |inner| {
        found |= matches!(inner.kind, StatementKind::Label { .. });
    });
    found
}

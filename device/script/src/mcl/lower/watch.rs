//! Expressions and places in the scope of a program that is compiled already, for the debugger.

use super::super::ast::{Expr, ExprKind, StatementKind};
use super::super::codes;
use super::place::Target;
use super::scope::{Scope, type_of};
use super::{Lowering, Parsed, compile_whole, parse};
use crate::arithmetic::Type;
use crate::debug::{Setting, Watch};
use crate::diagnostic::Severity;
use crate::mcl::types::VarType;
use crate::op::{Array, Op};
use crate::program::Program;
use std::sync::Arc;

/// Longest text that is taken for an expression.
const LONGEST: usize = 4096;

/// The names of a compiled program.
#[derive(Clone, Debug)]
pub struct Names {
    program: Arc<Program>,
    scope: Scope,
}

impl Names {
    /// The names of a program; `None` if it does not compile.
    #[must_use]
    pub fn of(text: &str) -> Option<Self> {
        let (compiled, scope) = compile_whole(text);
        compiled.program.map(|program| Self { program: Arc::new(program), scope })
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// An expression to be worked out while the program runs or stands: any that the program itself could have at its end.
    ///
    /// # Errors
    /// A sentence: what is wrong with it.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn watch(&mut self, text: &str) -> Result<Watch, String> {
        self.lower(&format!("write 0,{}\n", one_line(text)?), |lowering, parsed| {
            let Some(StatementKind::Write { value, .. }) = first(parsed) else {
                return Err("This is no expression.".to_owned());
            };
            if let Some(array) = lowering.named_array(value) {
                return Ok((Type::Unsigned, array.first.kind, Some(array)));
            }
            let place_kind = match &value.kind {
                ExprKind::Place(place) => lowering.target(place).map(|target| target.kind()),
                _ => None,
            };
            let kind = lowering.expression(value);
            Ok((kind, place_kind.unwrap_or(widest(kind)), None))
        })
        .map(|(program, (kind, shown_as, array))| Watch {
            text: text.trim().to_owned(),
            program: Arc::new(program),
            kind,
            shown_as,
            array,
        })
    }

    /// A place to be set while the program stands.
    ///
    /// # Errors
    /// A sentence: there is no such place, it is read-only, or the value is no expression.
    pub fn setting(&mut self, place: &str, value: &str) -> Result<Setting, String> {
        let watch = self.watch(value)?;
        let written = place.trim().to_owned();
        let (program, kind) = self.lower(&format!("{} = 0\n", one_line(place)?), |lowering, parsed| {
            let Some(StatementKind::Assign { to, .. }) = first(parsed) else {
                return Err(format!("`{written}` names nothing that can be set."));
            };
            let kind = match lowering.settable(to) {
                Some(Target::Whole { .. }) => {
                    return Err(format!("`{written}` is an array: set one element, as in {written}(0)."));
                }
                Some(target) => target.kind(),
                None => VarType::Long,
            };
            // The value is put on the stack by whoever runs this.
            lowering.store(to, type_of(kind));
            Ok(kind)
        })?;
        let is_pattern = value.trim_start().starts_with("0x") || value.trim_start().starts_with('%');
        Ok(Setting { place: written, value: watch, kind, ops: program.ops.into(), is_pattern })
    }

    /// Lowers one line in the scope of the program. Its instructions come back as a program that ends after them.
    fn lower<T>(
        &mut self,
        line: &str,
        make: impl FnOnce(&mut Lowering<'_>, &Parsed) -> Result<T, String>,
    ) -> Result<(Program, T), String> {
        let mut parsed = parse(line);
        let mut lowering = Lowering::new(line, std::mem::take(&mut parsed.diagnostics));
        std::mem::swap(&mut lowering.scope, &mut self.scope);
        let made = make(&mut lowering, &parsed);
        std::mem::swap(&mut lowering.scope, &mut self.scope);
        // Setting what can only be read is a warning in a program; here it would be a promise that is not kept.
        let wrong = lowering.diagnostics.iter().find(|diagnostic| {
            diagnostic.severity() == Severity::Error || diagnostic.code == codes::READ_ONLY
        });
        if let Some(wrong) = wrong {
            let hint = wrong.hint.as_ref().filter(|_| wrong.severity() == Severity::Error);
            let hint = hint.map(|hint| format!(" {hint}")).unwrap_or_default();
            return Err(format!("{}{hint}", wrong.message));
        }
        let made = made?;
        lowering.emit(Op::End);
        let reads_data = lowering.ops.iter().any(|op| matches!(op, Op::LoadTable(_)));
        let program = Program {
            ops: lowering.ops,
            lines: lowering.lines,
            data: if reads_data { self.program.data.clone() } else { Vec::new() },
            ..Program::default()
        };
        Ok((program, made))
    }
}

impl Lowering<'_> {
    /// The array that an expression names, if it is nothing but that.
    fn named_array(&mut self, expr: &Expr) -> Option<Array> {
        let ExprKind::Place(place) = &expr.kind else { return None };
        if place.index.is_some() || place.modifier.is_some() {
            return None;
        }
        let said = std::mem::take(&mut self.diagnostics);
        let target = self.target(place);
        self.diagnostics = said;
        match target {
            Some(Target::Whole { memory, .. }) => Some(memory),
            _ => None,
        }
    }
}

/// A text as one line of a program.
fn one_line(text: &str) -> Result<&str, String> {
    let text = text.trim();
    match text {
        "" => Err("There is nothing here yet.".to_owned()),
        text if text.len() > LONGEST => Err("This is too long for an expression.".to_owned()),
        text if text.contains(['\n', '\r', ';']) => Err("This is more than an expression.".to_owned()),
        text => Ok(text),
    }
}

/// The one statement of a line.
fn first(parsed: &Parsed) -> Option<&StatementKind> {
    match &parsed.statements[..] {
        [statement] => Some(&statement.kind),
        _ => None,
    }
}

fn widest(kind: Type) -> VarType {
    match kind {
        Type::Float => VarType::Float,
        Type::Signed => VarType::SLong,
        Type::Unsigned => VarType::Long,
    }
}

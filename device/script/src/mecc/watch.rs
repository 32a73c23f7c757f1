//! Names and expressions of a program for its debugger: any that the program could have at its end, as long as working them out changes nothing.

use super::ast::{Item, StatementKind};
use super::lower::{compile, lower_value};
use super::parser::parse;
use crate::arithmetic::Type;
use crate::board::Board;
use crate::debug::{Setting, Watch};
use crate::diagnostic::Severity;
use crate::mcl::types::VarType;
use crate::op::{Array, Cell, Op};
use crate::program::{Program, Variable};
use crate::vm::element;
use std::sync::Arc;

/// Longer than any expression that a person types beside a program.
const LONGEST: usize = 1000;
/// The function that an expression is read in. It is never run, and no program can have a name with two underscores at its beginning in use: that
/// one would be declared twice, which is said.
const READER: &str = "__watched";

/// The names of a program that compiles.
#[derive(Clone, Debug)]
pub struct Names {
    text: Arc<str>,
    program: Arc<Program>,
}

impl Names {
    /// The names of a program; `None` if it does not compile.
    #[must_use]
    pub fn of(text: &str) -> Option<Self> {
        let program = compile(text).program?;
        Some(Self { text: text.into(), program: Arc::new(program) })
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// An expression to be worked out while the program runs or stands: of globals as the program would write it, a local as `routine.local`,
    /// or a byte of a table as `table(2)`.
    ///
    /// # Errors
    /// A sentence: what is wrong with it.
    pub fn watch(&self, text: &str) -> Result<Watch, String> {
        let text = one_line(text)?;
        if let Some(variable) = self.variable(text).filter(|variable| variable.is_array) {
            return Ok(Watch::of(text, Vec::new(), Type::Unsigned, VarType::Byte, Some(variable.memory)));
        }
        if let Some(cell) = self.cell(text)? {
            return Ok(Watch::of(text, vec![Op::Load(cell), Op::End], Type::Unsigned, cell.kind, None));
        }
        let ops = self.expression(text)?;
        Ok(Watch::of(text, ops, Type::Unsigned, VarType::Word, None))
    }

    /// A place to be set while the program stands.
    ///
    /// # Errors
    /// A sentence: there is no such place, or the value is no expression.
    pub fn setting(&self, place: &str, value: &str) -> Result<Setting, String> {
        let value = self.watch(value)?;
        let place = one_line(place)?;
        let Some(cell) = self.cell(place)? else {
            return Err(match self.variable(place) {
                Some(_) => format!("`{place}` is a table: set one byte, as in {place}(0)."),
                None => format!("`{place}` names nothing that can be set."),
            });
        };
        // The value is put on the stack by whoever runs this.
        Ok(Setting::of(place, value, cell.kind, vec![Op::Store(cell), Op::End]))
    }

    fn variable(&self, name: &str) -> Option<&Variable> {
        self.program.variables.iter().find(|variable| variable.name.eq_ignore_ascii_case(name))
    }

    /// The cell of a variable, or of one byte of a table; none where the text names neither.
    fn cell(&self, text: &str) -> Result<Option<Cell>, String> {
        if let Some(variable) = self.variable(text) {
            return Ok((!variable.is_array).then_some(variable.memory.first));
        }
        let Some((name, index)) = text.strip_suffix(')').and_then(|text| text.split_once('(')) else {
            return Ok(None);
        };
        let Some(variable) = self.variable(name.trim()).filter(|variable| variable.is_array) else {
            return Ok(None);
        };
        let Array { length, .. } = variable.memory;
        let cell = index.trim().parse().ok().and_then(|index: u32| element(variable.memory, index));
        cell.map(Some)
            .ok_or_else(|| format!("`{}` has the bytes 0 to {}.", name.trim(), length.saturating_sub(1)))
    }

    /// The instructions of an expression that changes nothing.
    fn expression(&self, text: &str) -> Result<Vec<Op>, String> {
        let whole =
            format!("{}\nDeclare Function {READER}() Returns Word\nReturn {text}\nEnd Function\n", self.text);
        let begun = self.text.len();
        let mut parsed = parse(&whole);
        let Some(Item::Routine(reader)) = parsed.items.pop() else { return Err(NO_EXPRESSION.to_owned()) };
        let [statement] = reader.body.as_slice() else { return Err(NO_EXPRESSION.to_owned()) };
        let StatementKind::Return(Some(value)) = &statement.kind else {
            return Err(NO_EXPRESSION.to_owned());
        };
        let (mut ops, diagnostics) = lower_value(&whole, parsed, value);
        // What the program itself is warned of was said when it was compiled.
        let wrong = diagnostics
            .iter()
            .find(|found| found.severity() == Severity::Error && found.span.start as usize > begun);
        if let Some(wrong) = wrong {
            return Err(wrong.message.clone());
        }
        if !ops.iter().all(changes_nothing) {
            return Err(
                "This would do something: names, numbers, operators and GetClock are worked out here."
                    .to_owned(),
            );
        }
        ops.push(Op::End);
        Ok(ops)
    }
}

const NO_EXPRESSION: &str = "This is no expression.";

/// Whether an instruction of an expression leaves program and board as they are.
#[allow(clippy::wildcard_enum_match_arm, reason = "whatever else comes may do something")]
fn changes_nothing(op: &Op) -> bool {
    match op {
        Op::Board(command) => *command == Board::GetClock,
        Op::Push(_) | Op::Load(_) | Op::Part(_) | Op::Unary(..) | Op::Binary(..) => true,
        _ => false,
    }
}

/// A text as one line of a program.
fn one_line(text: &str) -> Result<&str, String> {
    match text.trim() {
        "" => Err("There is nothing here yet.".to_owned()),
        text if text.len() > LONGEST => Err("This is too long for an expression.".to_owned()),
        text if text.contains(['\n', '\r', ';']) => Err("This is more than an expression.".to_owned()),
        text => Ok(text),
    }
}

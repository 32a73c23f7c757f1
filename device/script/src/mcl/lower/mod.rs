//! A tree into instructions: names are looked up, types settled, and whatever is wrong is said.
//!
//! Statements are taken in the order of the text, because a variable is known only below its definition (MCP manual 3.1.3).
//! Jumps to labels are patched at the end.

mod command;
mod define;
mod expression;
mod flow;
mod output;
mod place;
mod reach;
mod scope;
mod unused;
pub mod watch;

use super::ast::{Name, Statement, StatementKind};
use super::codes;
use super::parser::{Parsed, parse};
use crate::arithmetic::Type;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::op::Op;
use crate::program::{Program, limits};
use crate::text::{Lines, Span};
use scope::Scope;
pub use scope::{Symbol, SymbolKind};
use std::sync::Arc;

/// What became of a program.
#[derive(Clone, Debug, Default)]
pub struct Compiled {
    /// The program, unless there are errors.
    pub program: Option<Program>,
    /// What there is to say, in the order of the text; at last how much more there is than is listed.
    pub diagnostics: Vec<Diagnostic>,
    /// Every name with its places, for editors.
    pub symbols: Vec<Symbol>,
    /// What compile-time directives left out.
    pub left_out: Vec<Span>,
}

impl Compiled {
    /// Whether there is a program.
    #[must_use]
    pub fn is_ok(&self) -> bool {
        self.program.is_some()
    }
}

/// Compiles a program.
#[must_use]
pub fn compile(text: &str) -> Compiled {
    compile_whole(text).0
}

/// Compiles a program and hands its names out besides.
fn compile_whole(text: &str) -> (Compiled, Scope) {
    if let Some(refused) = too_long(text) {
        return (Compiled { diagnostics: vec![refused], ..Compiled::default() }, Scope::default());
    }
    let Parsed { statements, diagnostics, left_out } = parse(text);
    let mut lowering = Lowering::new(text, diagnostics);
    lowering.scope.collect(&statements, &mut lowering.diagnostics);
    lowering.block(&statements);
    lowering.end_of_program(&statements);
    lowering.patch_jumps();
    lowering.check_size();
    lowering.warn_of_unused();
    lowering.warn_of_flow();
    lowering.finish(left_out)
}

/// Bytes of a program's text. In our examples, comments included, two bytes of text make a byte of the image, in the manual's less: the
/// 256 KiB of the largest controller are full at a quarter of this.
pub const LONGEST_TEXT: usize = 2 * 1024 * 1024;

/// What is said of a text that is too long for a program. It is not read: what a reader keeps is many times as long.
#[must_use]
pub fn too_long(text: &str) -> Option<Diagnostic> {
    if text.len() <= LONGEST_TEXT {
        return None;
    }
    let end = text.floor_char_boundary(LONGEST_TEXT);
    Some(Diagnostic {
        code: codes::TOO_LARGE,
        span: Span::new(end, end),
        message: format!(
            "The text has {} bytes; a program has at most {LONGEST_TEXT}, which end here.",
            text.len()
        ),
        hint: None,
    })
}

/// A jump whose target is not known yet: instruction, label.
struct Jump {
    op: usize,
    label: Arc<str>,
}

/// An argument whose type is known only when its subroutine has been seen.
struct Argument {
    op: usize,
    label: Arc<str>,
    index: usize,
    from: Type,
}

struct Lowering<'a> {
    text: &'a str,
    text_lines: Lines,
    line: u32,
    ops: Vec<Op>,
    lines: Vec<u32>,
    /// The statement of each instruction; none for those that nobody wrote, such as the jump over an ELSE.
    spans: Vec<Option<Span>>,
    span: Option<Span>,
    /// Instructions beyond those that a program may have, and the place of the first.
    surplus: usize,
    full_at: Option<Span>,
    data: Vec<u8>,
    ram_bits: u64,
    loops: u32,
    scope: Scope,
    diagnostics: Diagnostics,
    jumps: Vec<Jump>,
    arguments: Vec<Argument>,
    /// How many names were compared with unknown ones, to find what might have been meant.
    compared: usize,
}

/// Comparisons of names after which no name is looked for that might have been meant: a tenth of a second's worth.
const MOST_COMPARED: usize = 100_000;

/// A place to jump to inside a statement; all jumps to it are patched when it is set.
#[derive(Default)]
struct Mark {
    jumps: Vec<usize>,
}

impl<'a> Lowering<'a> {
    fn new(text: &'a str, diagnostics: Diagnostics) -> Self {
        Self {
            text,
            text_lines: Lines::of(text),
            line: 1,
            ops: Vec::new(),
            lines: Vec::new(),
            spans: Vec::new(),
            span: None,
            surplus: 0,
            full_at: None,
            data: Vec::new(),
            ram_bits: 0,
            loops: 0,
            scope: Scope::default(),
            diagnostics,
            jumps: Vec::new(),
            arguments: Vec::new(),
            compared: 0,
        }
    }

    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            self.at(statement.span);
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        use StatementKind as Kind;
        match &statement.kind {
            Kind::Variable { name, kind, size } => self.variable(name, *kind, size.as_deref()),
            Kind::Alias { name, of } => self.alias(name, of),
            Kind::Constant { name, value, float } => self.constant(name, value, *float),
            Kind::Table { name, kind, values } => self.table(name, *kind, values),
            Kind::Label { name, arguments } => self.label(name, arguments.as_deref()),
            Kind::Assign { to, items } => self.assign(to, items),
            Kind::If { branches, end } => self.if_branches(branches, *end),
            Kind::IfJump { condition, then } => self.if_jump(condition, then),
            Kind::While { condition, body, end } => self.while_loop(condition, body, *end),
            Kind::Repeat { body, condition, until } => self.repeat_loop(body, condition, *until),
            Kind::For(parts) => self.for_loop(parts),
            Kind::Goto(label) => self.jump_to_label(Op::Jump(0), label),
            Kind::Gosub { label, arguments, result } => self.gosub(label, arguments, result.as_deref()),
            Kind::Return(value) => self.return_value(value.as_ref()),
            Kind::Branch { index, labels } => self.branch(index, labels),
            Kind::Puts { stream, items } => self.puts(stream, items),
            Kind::Gets { stream, items } => self.gets(stream, items),
            Kind::Read { address, to } => self.read(address, to),
            Kind::Write { address, value } => self.write(address, value),
            Kind::I2cOut { otherwise, bytes, stop } => self.i2c_out(otherwise.as_deref(), bytes, *stop),
            Kind::I2cIn { otherwise, to } => self.i2c_in(otherwise.as_deref(), to),
            Kind::Pause(time) => self.pause(time),
            Kind::Motion { command, arguments } => self.motion(*command, arguments),
            Kind::Clear => self.emit(Op::Clear),
            Kind::End => self.emit(Op::End),
        }
    }

    /// What is emitted next belongs to what stands here.
    fn at(&mut self, span: Span) {
        self.line = self.text_lines.line_of(span.start);
        self.span = Some(span);
    }

    fn emit(&mut self, op: Op) {
        self.insert(self.ops.len(), op);
    }

    /// Puts an instruction between those of one expression, where no jump leads. A program that is full takes none: it is refused.
    fn insert(&mut self, at: usize, op: Op) {
        if self.ops.len() > limits::INSTRUCTIONS {
            self.surplus += 1;
            return;
        }
        if self.ops.len() == limits::INSTRUCTIONS {
            self.full_at = self.span;
        }
        self.ops.insert(at, op);
        self.lines.insert(at, self.line);
        self.spans.insert(at, self.span);
    }

    /// Takes the last instruction back.
    fn unemit(&mut self) {
        if self.surplus > 0 {
            self.surplus -= 1;
            return;
        }
        self.ops.pop();
        self.lines.pop();
        self.spans.pop();
    }

    /// An instruction that nobody wrote: it is not missed where nothing leads to it.
    fn emit_unwritten(&mut self, op: Op) {
        self.emit(op);
        if let Some(span) = self.spans.last_mut() {
            *span = None;
        }
    }

    /// The number of the next instruction.
    fn here(&self) -> u32 {
        u32::try_from(self.ops.len()).unwrap_or(u32::MAX)
    }

    /// A jump to a place further down in the same statement.
    fn jump(&mut self, op: Op, mark: &mut Mark) {
        mark.jumps.push(self.ops.len());
        self.emit(op);
    }

    fn set(&mut self, mark: Mark) {
        let here = self.here();
        for op in mark.jumps {
            self.retarget(op, here);
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn retarget(&mut self, op: usize, to: u32) {
        if let Some(op) = self.ops.get_mut(op) {
            *op = match *op {
                Op::Jump(_) => Op::Jump(to),
                Op::JumpIfZero(_) => Op::JumpIfZero(to),
                Op::JumpIfNotZero(_) => Op::JumpIfNotZero(to),
                Op::Gosub(_, count) => Op::Gosub(to, count),
                Op::I2cOut(count, stop, Some(_)) => Op::I2cOut(count, stop, Some(to)),
                Op::I2cIn(count, Some(_)) => Op::I2cIn(count, Some(to)),
                other => other,
            };
        }
    }

    /// A jump to a label, which may stand anywhere.
    fn jump_to_label(&mut self, op: Op, label: &Name) {
        self.use_label(label);
        self.jumps.push(Jump { op: self.ops.len(), label: label.key.clone() });
        self.emit(op);
    }

    /// Says that an instruction takes more values at once than the stack holds; `spans` are theirs.
    fn check_count(&mut self, mut spans: impl Iterator<Item = Span>) {
        if let Some(span) = spans.nth(limits::STACK_CELLS) {
            let message =
                format!("At most {} values are taken at once; this is one more.", limits::STACK_CELLS);
            self.report(codes::TOO_LARGE, span, message, None);
        }
    }

    fn report(&mut self, code: &'static str, span: Span, message: String, hint: Option<String>) {
        self.diagnostics.push(Diagnostic { code, span, message, hint });
    }

    fn end_of_program(&mut self, statements: &[Statement]) {
        if let Some(last) = statements.last() {
            self.line = self.text_lines.line_of(last.span.end);
        }
        self.emit_unwritten(Op::End);
    }

    fn patch_jumps(&mut self) {
        for jump in std::mem::take(&mut self.jumps) {
            if let Some(at) = self.scope.label_at(&jump.label) {
                self.retarget(jump.op, at);
            }
        }
        for argument in std::mem::take(&mut self.arguments) {
            let to = self.scope.argument_type(&argument.label, argument.index).unwrap_or(argument.from);
            let op = if to == argument.from { Op::Nop } else { Op::Convert(argument.from, to) };
            if let Some(place) = self.ops.get_mut(argument.op) {
                *place = op;
            }
        }
    }

    /// Says what of the program does not fit, where the bound is met if that is known.
    fn check_size(&mut self) {
        let whole = Span::new(0, self.text.find('\n').unwrap_or(self.text.len()));
        let instructions = self.ops.len() + self.surplus;
        for (what, is, most, at) in [
            ("bytes of variables", self.ram_bits.div_ceil(8), u64::from(limits::RAM_BYTES), None),
            ("instructions", instructions as u64, limits::INSTRUCTIONS as u64, self.full_at),
            ("bytes of tables and texts", self.data.len() as u64, limits::DATA_BYTES as u64, None),
            ("FOR loops", u64::from(self.loops), u64::from(limits::LOOPS), None),
            ("names", self.scope.count() as u64, limits::NAMES as u64, self.scope.full_at()),
        ] {
            if is > most {
                let message = format!("The program has {is} {what}; {most} are allowed.");
                self.report(codes::TOO_LARGE, at.unwrap_or(whole), message, None);
            }
        }
    }

    fn finish(mut self, left_out: Vec<Span>) -> (Compiled, Scope) {
        let is_wrong = self.diagnostics.has_errors();
        let diagnostics = std::mem::take(&mut self.diagnostics).finish();
        let symbols = self.scope.symbols(self.text);
        let program = (!is_wrong).then(|| Program {
            variables: self.scope.variables(self.text),
            labels: self.scope.labels(self.text),
            ops: self.ops,
            lines: self.lines,
            data: self.data,
            loops: self.loops,
            ram_bytes: u32::try_from(self.ram_bits.div_ceil(8)).unwrap_or(u32::MAX),
        });
        (Compiled { program, diagnostics, symbols, left_out }, self.scope)
    }
}

#[cfg(test)]
mod tests;

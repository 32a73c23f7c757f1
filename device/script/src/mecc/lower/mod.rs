//! A tree into instructions: names are looked up, memory laid out, and whatever is wrong is said.
//!
//! Globals lie in memory in the order of the text, from byte 0 on, and a Word with its low byte first; what routines declare for themselves
//! lies behind them. The program comes first, then handlers and functions; who calls them is patched at the end.

mod expression;
mod facts;
mod pending;
mod scope;
mod statement;
mod warnings;

use super::ast::{Expr, Item, Kind, Name, Routine, RoutineKind, Statement, StatementKind, Variable};
use super::board::FRAME_BYTES;
use super::codes;
use super::parser::{Parsed, parse};
use crate::arithmetic::Type;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::mcl::lexer::LONGEST_NAME;
use crate::mcl::words::did_you_mean;
use crate::op::{Cell, Op};
use crate::program::{Program, limits};
use crate::text::{Lines, Span};
use facts::Facts;
use scope::{Function, Meaning, Symbol, Symbols};
use std::sync::Arc;

/// Parameters of a function.
const MOST_PARAMETERS: usize = 32;

/// Comparisons of names after which no name is looked for that might have been meant.
const MOST_COMPARED: usize = 100_000;

/// What became of a program.
#[derive(Clone, Debug, Default)]
pub struct Compiled {
    /// The program, unless there are errors.
    pub program: Option<Program>,
    /// What there is to say, in the order of the text; at last how much more there is than is listed.
    pub diagnostics: Vec<Diagnostic>,
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
    if let Some(refused) = crate::mcl::too_long(text) {
        return Compiled { program: None, diagnostics: vec![refused] };
    }
    let Parsed { items, diagnostics } = parse(text);
    let mut lowering = Lowering::new(text, diagnostics);
    lowering.collect(&items);
    lowering.routines(&items);
    lowering.patch();
    lowering.check_size();
    lowering.warn(&items);
    lowering.finish()
}

/// The instructions of an expression in the scope of a program, and what is wrong with it. `text` has both.
pub(super) fn lower_value(text: &str, parsed: Parsed, value: &Expr) -> (Vec<Op>, Diagnostics) {
    let mut lowering = Lowering::new(text, parsed.diagnostics);
    lowering.collect(&parsed.items);
    let before = lowering.ops.len();
    lowering.expression(value);
    (lowering.ops.split_off(before), lowering.diagnostics)
}

/// An instruction that waits for the first instruction of a routine.
struct Patch {
    op: usize,
    routine: usize,
}

struct Lowering<'a> {
    text: &'a str,
    text_lines: Lines,
    line: u32,
    ops: Vec<Op>,
    lines: Vec<u32>,
    /// Instructions beyond those that a program may have.
    surplus: usize,
    diagnostics: Diagnostics,
    globals: Symbols,
    locals: Symbols,
    /// Bytes of globals, and of everything so far.
    global_bytes: u32,
    ram_bytes: u64,
    /// What globals are at the start.
    initial: Vec<u8>,
    /// First instruction of each routine.
    entries: Vec<u32>,
    patches: Vec<Patch>,
    /// The function that is being lowered: its name, the place of its value, the type of that.
    result: Option<(Arc<str>, u32, Kind)>,
    /// Whether the routine is the program.
    in_program: bool,
    facts: Facts,
    compared: usize,
    /// Names of locals with what they are, for the debugger.
    shown: Vec<(String, Meaning)>,
    labels: Vec<(String, u32)>,
}

impl<'a> Lowering<'a> {
    fn new(text: &'a str, diagnostics: Diagnostics) -> Self {
        Self {
            text,
            text_lines: Lines::of(text),
            line: 1,
            ops: Vec::new(),
            lines: Vec::new(),
            surplus: 0,
            diagnostics,
            globals: Symbols::default(),
            locals: Symbols::default(),
            global_bytes: 0,
            ram_bytes: 0,
            initial: Vec::new(),
            entries: Vec::new(),
            patches: Vec::new(),
            result: None,
            in_program: false,
            facts: Facts::default(),
            compared: 0,
            shown: Vec::new(),
            labels: Vec::new(),
        }
    }

    // ----- declarations

    /// Lays out globals and learns the names of routines, so that what stands above knows what stands below.
    fn collect(&mut self, items: &[Item]) {
        let mut programs = 0;
        let mut routine = 0;
        for item in items {
            match item {
                Item::Variable(variable) => self.global(variable),
                Item::Table(table) => {
                    let count = u32::try_from(table.bytes.len()).unwrap_or(u32::MAX);
                    let meaning = Meaning::Table(self.global_bytes, count);
                    self.declare_global(&table.name, meaning);
                    self.lay_out(&table.bytes);
                }
                Item::Routine(of) => {
                    match &of.kind {
                        RoutineKind::Program => {
                            programs += 1;
                            if programs > 1 {
                                let hint = Some("Keep one of them.".to_owned());
                                let message = "There is a second Begin Program.".to_owned();
                                self.report(codes::NO_PROGRAM, of.name.span, message, hint);
                            }
                            self.globals_of_program(&of.body);
                        }
                        RoutineKind::Handler => self.declare_global(&of.name, Meaning::Handler(routine)),
                        RoutineKind::Function(parameters, returns) => {
                            let kinds = parameters.iter().map(|parameter| parameter.kind).collect();
                            let function = Function { routine, parameters: kinds, returns: *returns };
                            self.declare_global(&of.name, Meaning::Function(function));
                        }
                    }
                    routine += 1;
                }
            }
        }
        if programs == 0 {
            let end = self.text.len();
            let message = "There is no program: nothing would run.".to_owned();
            let hint = Some("Write Begin Program, what is to be done, and End Program.".to_owned());
            self.report(codes::NO_PROGRAM, Span::new(end, end), message, hint);
        }
        // Behind the globals lie some bytes of nothing, which a frame that begins in the last table sends. What routines and Select keep for
        // themselves lies behind those.
        self.ram_bytes = u64::from(self.global_bytes) + u64::from(FRAME_BYTES);
        self.entries = vec![0; routine];
    }

    /// What the program declares is known everywhere. Assumed: no page says how far such a name reaches.
    fn globals_of_program(&mut self, body: &[Statement]) {
        for statement in body {
            if let StatementKind::Declare(variable) = &statement.kind {
                self.global(variable);
            }
        }
    }

    fn global(&mut self, variable: &Variable) {
        self.declare_global(&variable.name, Meaning::Variable(variable.kind, self.global_bytes));
        let value = self.first_value(variable).unwrap_or(0);
        let bytes = value.to_le_bytes();
        self.lay_out(&bytes[..variable.kind.bytes() as usize]);
    }

    fn lay_out(&mut self, bytes: &[u8]) {
        let count = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        self.global_bytes = self.global_bytes.saturating_add(count);
        // What does not fit is refused by its size; only so much of it is kept.
        if self.initial.len() <= limits::RAM_BYTES as usize {
            self.initial.extend_from_slice(bytes);
        }
    }

    /// The constant that a variable begins with.
    fn first_value(&mut self, variable: &Variable) -> Option<u32> {
        let value = variable.value.as_ref()?;
        let Some(constant) = self.constant(value) else {
            let message = format!("`{}` has to begin with a constant.", variable.name.span.of(self.text));
            let hint = Some("Declare it without a value, and set it where the program begins.".to_owned());
            self.report(codes::NOT_CONSTANT, value.span, message, hint);
            return None;
        };
        self.check_fit(constant, variable.kind, &variable.name, value.span);
        Some(constant)
    }

    fn declare_global(&mut self, name: &Name, meaning: Meaning) {
        if let Some(known) = self.globals.get(&name.key) {
            let (what, at) = (known.meaning.title(), self.text_lines.line_of(known.declared.start));
            return self.declared_twice(name, what, at);
        }
        self.globals.insert(name.key.clone(), Symbol::new(meaning, name));
    }

    fn declare_local(&mut self, name: &Name, kind: Kind, is_known: bool) -> u32 {
        let at = self.allocate(kind.bytes());
        if let Some(known) = self.locals.get(&name.key) {
            let at = self.text_lines.line_of(known.declared.start);
            self.declared_twice(name, "a variable", at);
            return 0;
        }
        let symbol = Symbol { is_known, ..Symbol::new(Meaning::Variable(kind, at), name) };
        self.locals.insert(name.key.clone(), symbol);
        at
    }

    fn declared_twice(&mut self, name: &Name, what: &str, line: u32) {
        let message = format!("`{}` is {what} already, declared in line {line}.", name.span.of(self.text));
        self.report(codes::DECLARED_TWICE, name.span, message, Some("Take another name.".to_owned()));
    }

    fn allocate(&mut self, bytes: u32) -> u32 {
        let at = u32::try_from(self.ram_bytes).unwrap_or(u32::MAX).min(limits::RAM_BYTES);
        self.ram_bytes += u64::from(bytes);
        at
    }

    // ----- routines

    fn routines(&mut self, items: &[Item]) {
        let all = items.iter().filter_map(|item| match item {
            Item::Routine(routine) => Some(routine),
            Item::Variable(_) | Item::Table(_) => None,
        });
        let (program, others): (Vec<_>, Vec<_>) =
            all.enumerate().partition(|(_, routine)| routine.kind == RoutineKind::Program);
        for (_, routine) in program {
            self.program(routine);
        }
        for (number, routine) in others {
            self.routine(number, routine);
        }
    }

    fn program(&mut self, routine: &Routine) {
        self.at(routine.name.span);
        if self.initial.iter().any(|byte| *byte != 0) {
            let count = u32::try_from(self.initial.len()).unwrap_or(u32::MAX);
            self.emit(Op::Fill(0, 0, count));
        }
        self.in_program = true;
        self.block(&routine.body);
        self.in_program = false;
        self.at(routine.end);
        self.emit(Op::End);
    }

    fn routine(&mut self, number: usize, routine: &Routine) {
        let entry = self.here();
        if let Some(place) = self.entries.get_mut(number) {
            *place = entry;
        }
        let name = routine.name.span.of(self.text).to_owned();
        self.labels.push((name.clone(), entry));
        self.at(routine.name.span);
        self.locals.clear();
        let first = self.allocate(0);
        // The place of what it keeps is known at its end alone.
        let kept = self.ops.len();
        if let RoutineKind::Function(parameters, returns) = &routine.kind {
            self.emit(Op::Nop);
            self.begin_function(routine, parameters, *returns);
        }
        self.locals_of(&routine.body);
        self.block(&routine.body);
        self.at(routine.end);
        match self.result.take() {
            Some((_, at, kind)) => {
                if !self.facts.sets_value {
                    let message = format!(
                        "`{}` returns a value and never sets one: it gives 0.",
                        crate::diagnostic::excerpt(&name)
                    );
                    let hint = Some("Write Return and the value.".to_owned());
                    self.report(codes::NO_RETURN, routine.name.span, message, hint);
                }
                self.emit(Op::Load(Cell { kind: kind.stored(), at: at * 8 }));
                self.emit(Op::Return(Some(Type::Unsigned)));
            }
            None => self.emit(Op::Return(None)),
        }
        let count = self.allocate(0).saturating_sub(first);
        if let (RoutineKind::Function(..), 1.., Some(op)) = (&routine.kind, count, self.ops.get_mut(kept)) {
            *op = Op::Keep(first, count);
        }
        self.warn_of_unused_locals();
        let locals = std::mem::take(&mut self.locals);
        let mut locals: Vec<(Span, Meaning)> =
            locals.into_values().map(|symbol| (symbol.declared, symbol.meaning)).collect();
        locals.sort_by_key(|(declared, _)| declared.start);
        for (declared, meaning) in locals {
            let local = declared.of(self.text);
            let whole = format!("{name}.{local}");
            self.shown.push((if whole.len() <= LONGEST_NAME { whole } else { local.to_owned() }, meaning));
        }
    }

    fn begin_function(&mut self, routine: &Routine, parameters: &[Variable], returns: Option<Kind>) {
        if parameters.len() > MOST_PARAMETERS {
            let message = format!("A function takes at most {MOST_PARAMETERS} values.");
            let hint = Some("Put some of them into globals.".to_owned());
            self.report(codes::TOO_LARGE, routine.name.span, message, hint);
        }
        let places: Vec<(Kind, u32)> = parameters
            .iter()
            .map(|parameter| (parameter.kind, self.declare_local(&parameter.name, parameter.kind, true)))
            .collect();
        // A parameter that is not used says what the function is given all the same.
        self.locals.values_mut().for_each(|symbol| symbol.is_used = true);
        for (kind, at) in places.into_iter().rev() {
            self.emit(Op::Store(Cell { kind: kind.stored(), at: at * 8 }));
        }
        if let Some(kind) = returns {
            let at = self.allocate(kind.bytes());
            self.emit(Op::Push(0));
            self.emit(Op::Store(Cell { kind: kind.stored(), at: at * 8 }));
            self.result = Some((routine.name.key.clone(), at, kind));
            self.facts.sets_value = false;
        }
    }

    /// Locals get their places before the statements are read, so that one that is used too early can be told from one that is not there.
    fn locals_of(&mut self, body: &[Statement]) {
        for statement in body {
            if let StatementKind::Declare(variable) = &statement.kind {
                self.declare_local(&variable.name, variable.kind, false);
            }
        }
    }

    // ----- names

    /// What a name stands for; one that is not known is reported.
    fn look_up(&mut self, name: &Name) -> Option<Meaning> {
        self.look_up_or(name, "Declare Byte name")
    }

    /// The same where the declaration that is lacking would be this one.
    fn look_up_or(&mut self, name: &Name, declaration: &str) -> Option<Meaning> {
        if let Some(symbol) = self.locals.get(&name.key) {
            if symbol.is_known {
                return Some(symbol.meaning.clone());
            }
            let line = self.text_lines.line_of(symbol.declared.start);
            let message = format!("`{}` is declared only in line {line}.", name.span.of(self.text));
            let hint = Some("Move its Declare above this line.".to_owned());
            self.report(codes::USED_BEFORE, name.span, message, hint);
            return None;
        }
        if let Some(symbol) = self.globals.get(&name.key) {
            return Some(symbol.meaning.clone());
        }
        let shown = name.span.of(self.text);
        let hint = match shown.len() {
            1 => format!("Declare it, or write a character in quotes: \"{shown}\""),
            _ => self.meant(name).unwrap_or_else(|| format!("Declare it: {declaration}")),
        };
        let message = format!("`{}` is not declared.", crate::diagnostic::excerpt(name.span.of(self.text)));
        self.report(codes::UNKNOWN_NAME, name.span, message, Some(hint));
        None
    }

    /// Notes that something reads or calls what a name stands for.
    fn used(&mut self, name: &Name) {
        let symbol = match self.locals.get_mut(&name.key) {
            Some(symbol) => Some(symbol),
            None => self.globals.get_mut(&name.key),
        };
        if let Some(symbol) = symbol {
            symbol.is_used = true;
        }
    }

    fn meant(&mut self, name: &Name) -> Option<String> {
        let count = self.globals.len() + self.locals.len();
        self.compared += count;
        if self.compared > MOST_COMPARED {
            return None;
        }
        let mut known: Vec<Span> =
            self.globals.values().chain(self.locals.values()).map(|symbol| symbol.declared).collect();
        known.sort_unstable();
        did_you_mean(name.span.of(self.text), known.into_iter().map(|span| span.of(self.text)))
    }

    // ----- instructions

    /// What is emitted next belongs to what stands here.
    fn at(&mut self, span: Span) {
        self.line = self.text_lines.line_of(span.start);
    }

    fn emit(&mut self, op: Op) {
        if self.ops.len() > limits::INSTRUCTIONS {
            self.surplus += 1;
            return;
        }
        self.ops.push(op);
        self.lines.push(self.line);
    }

    fn here(&self) -> u32 {
        u32::try_from(self.ops.len()).unwrap_or(u32::MAX)
    }

    /// A jump whose target [`Lowering::land`] sets.
    fn jump(&mut self, op: Op) -> usize {
        self.emit(op);
        self.ops.len() - 1
    }

    fn land(&mut self, jump: usize) {
        let here = self.here();
        self.retarget(jump, here);
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn retarget(&mut self, at: usize, to: u32) {
        if let Some(op) = self.ops.get_mut(at) {
            *op = match *op {
                Op::Jump(_) => Op::Jump(to),
                Op::JumpIfZero(_) => Op::JumpIfZero(to),
                Op::JumpIfNotZero(_) => Op::JumpIfNotZero(to),
                Op::Gosub(_, count) => Op::Gosub(to, count),
                Op::Handle(event, _) => Op::Handle(event, to),
                other => other,
            };
        }
    }

    /// An instruction that leads to a routine.
    fn emit_to(&mut self, op: Op, routine: usize) {
        self.patches.push(Patch { op: self.ops.len(), routine });
        self.emit(op);
    }

    fn patch(&mut self) {
        for Patch { op, routine } in std::mem::take(&mut self.patches) {
            let to = self.entries.get(routine).copied().unwrap_or(0);
            self.retarget(op, to);
        }
    }

    fn report(&mut self, code: &'static str, span: Span, message: String, hint: Option<String>) {
        self.diagnostics.push(Diagnostic { code, span, message, hint });
    }

    /// Says what of the program does not fit.
    fn check_size(&mut self) {
        let whole = Span::new(0, self.text.find('\n').unwrap_or(self.text.len()));
        let instructions = self.ops.len() + self.surplus;
        let names = self.globals.len() + self.shown.len();
        for (what, is, most) in [
            ("bytes of variables", self.ram_bytes, u64::from(limits::RAM_BYTES)),
            ("instructions", instructions as u64, limits::INSTRUCTIONS as u64),
            ("names", names as u64, limits::NAMES as u64),
        ] {
            if is > most {
                let message = format!("The program has {is} {what}; {most} are allowed.");
                self.report(codes::TOO_LARGE, whole, message, Some("Make it smaller.".to_owned()));
            }
        }
    }

    fn finish(mut self) -> Compiled {
        let is_wrong = self.diagnostics.has_errors();
        let diagnostics = std::mem::take(&mut self.diagnostics).finish();
        if is_wrong {
            return Compiled { program: None, diagnostics };
        }
        let mut globals: Vec<(Span, Meaning)> =
            self.globals.into_values().map(|symbol| (symbol.declared, symbol.meaning)).collect();
        globals.sort_by_key(|(declared, _)| declared.start);
        let globals =
            globals.into_iter().map(|(declared, meaning)| (declared.of(self.text).to_owned(), meaning));
        let variables = globals.chain(self.shown).filter_map(|(name, meaning)| {
            let (memory, is_array) = meaning.memory()?;
            Some(crate::program::Variable { name, memory, is_array })
        });
        let program = Program {
            variables: variables.collect(),
            labels: self.labels,
            ops: self.ops,
            lines: self.lines,
            data: self.initial,
            loops: 0,
            ram_bytes: u32::try_from(self.ram_bytes).unwrap_or(u32::MAX),
        };
        Compiled { program: Some(program), diagnostics }
    }
}

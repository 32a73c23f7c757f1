//! The names of a program: what they mean, where they were defined and used.

use super::super::ast::{Expr, Name, Statement, StatementKind};
use super::super::codes;
use super::super::constant::Constant;
use super::super::registers::RegisterId;
use super::super::types::{Part, VarType};
use crate::arithmetic::Type;
use crate::diagnostic::{Diagnostic, Diagnostics, excerpt};
use crate::op::{Array, TableRef};
use crate::program::{Variable, limits};
use crate::text::Span;
use serde::Serialize;
use std::collections::HashMap;
use std::sync::Arc;

/// What a name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SymbolKind {
    /// A variable.
    Variable,
    /// Another name for a variable or a part of one.
    Alias,
    /// A constant.
    Constant,
    /// A table of constants.
    Table,
    /// A label.
    Label,
    /// A function, of a language that has some.
    Function,
    /// What an event runs, of a language that has some.
    Handler,
}

/// A name with its places.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Symbol {
    /// The name in small letters.
    pub key: String,
    /// The name as it is defined.
    pub name: String,
    /// What it is.
    pub kind: SymbolKind,
    /// Type of a variable or table entry.
    pub value: Option<VarType>,
    /// Elements of an array or entries of a table.
    pub length: Option<u32>,
    /// Where it is defined.
    pub defined: Span,
    /// Where it is used.
    pub uses: Vec<Span>,
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub enum Meaning {
    /// A variable or an alias; `root` is the variable whose memory it is.
    Memory { memory: Array, is_array: bool, root: Arc<str> },
    /// A constant.
    Constant(Constant),
    /// Another name for a register, for an element or for a part of one.
    Register { id: RegisterId, element: Option<u8>, part: Option<Part> },
    /// A table.
    Table(TableRef),
    /// A label; where it is once it has been seen.
    Label { at: Option<u32>, arguments: Option<Vec<Type>> },
    /// A definition with something wrong in it. Uses of it are not complained about.
    Broken,
}

#[derive(Clone, Debug)]
pub struct Entry {
    pub symbol: Symbol,
    /// None until its definition has been passed.
    pub meaning: Option<Meaning>,
    pub is_read: bool,
    pub is_written: bool,
    /// Arguments that a subroutine's label takes.
    pub argument_count: Option<usize>,
}

/// All names.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    entries: HashMap<Arc<str>, Entry>,
    order: Vec<Arc<str>>,
    /// The first definition for which there is no room, and how many there are.
    full_at: Option<Span>,
    surplus: usize,
}

impl Scope {
    /// Notes every definition, wherever it stands.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn collect(&mut self, statements: &[Statement], diagnostics: &mut Diagnostics) {
        for statement in statements {
            match &statement.kind {
                StatementKind::Variable { name, .. } => self.define(name, SymbolKind::Variable, diagnostics),
                StatementKind::Alias { name, .. } => self.define(name, SymbolKind::Alias, diagnostics),
                StatementKind::Constant { name, .. } => self.define(name, SymbolKind::Constant, diagnostics),
                StatementKind::Table { name, .. } => self.define(name, SymbolKind::Table, diagnostics),
                StatementKind::Label { name, arguments } => {
                    self.define(name, SymbolKind::Label, diagnostics);
                    if let Some(entry) = self.entries.get_mut(&name.key)
                        && entry.symbol.defined == name.span
                    {
                        entry.argument_count = Some(arguments.as_ref().map_or(0, Vec::len));
                        entry.meaning = Some(Meaning::Label { at: None, arguments: None });
                    }
                }
                StatementKind::If { branches, .. } => {
                    for (_, body) in branches {
                        self.collect(body, diagnostics);
                    }
                }
                StatementKind::While { body, .. } | StatementKind::Repeat { body, .. } => {
                    self.collect(body, diagnostics);
                }
                StatementKind::For(parts) => self.collect(&parts.body, diagnostics),
                _ => {}
            }
        }
    }

    fn define(&mut self, name: &Name, kind: SymbolKind, diagnostics: &mut Diagnostics) {
        if let Some(entry) = self.entries.get(&name.key) {
            let message = format!("`{}` is defined already.", excerpt(&name.key));
            let kind = match entry.symbol.kind {
                SymbolKind::Variable => "variable",
                SymbolKind::Alias => "alias",
                SymbolKind::Constant => "constant",
                SymbolKind::Table => "table",
                SymbolKind::Label => "label",
                SymbolKind::Function => "function",
                SymbolKind::Handler => "event handler",
            };
            let hint = Some(format!("There is a {kind} of this name above."));
            diagnostics.push(Diagnostic { code: codes::DEFINED_TWICE, span: name.span, message, hint });
            return;
        }
        if self.order.len() >= limits::NAMES {
            self.full_at.get_or_insert(name.span);
            self.surplus += 1;
            return;
        }
        let symbol = Symbol {
            key: name.key.to_string(),
            name: String::new(),
            kind,
            value: None,
            length: None,
            defined: name.span,
            uses: Vec::new(),
        };
        let entry = Entry { symbol, meaning: None, is_read: false, is_written: false, argument_count: None };
        self.entries.insert(name.key.clone(), entry);
        self.order.push(name.key.clone());
    }

    /// Gives a name its meaning, at its definition. A second definition has been complained about and changes nothing.
    pub fn settle(&mut self, name: &Name, meaning: Meaning) {
        let Some(entry) = self.entries.get_mut(&name.key).filter(|entry| entry.symbol.defined == name.span)
        else {
            return;
        };
        match &meaning {
            Meaning::Memory { memory, is_array, .. } => {
                entry.symbol.value = Some(memory.first.kind);
                entry.symbol.length = is_array.then_some(memory.length);
            }
            Meaning::Register { id, element, part } => {
                let row = id.row();
                entry.symbol.value = Some(part.map_or(row.kind, |part| part.kind));
                entry.symbol.length = element.is_none().then_some(row.length.into());
            }
            Meaning::Table(table) => {
                entry.symbol.value = Some(table.kind);
                entry.symbol.length = Some(table.length);
            }
            Meaning::Constant(_) | Meaning::Label { .. } | Meaning::Broken => {}
        }
        entry.meaning = Some(meaning);
    }

    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.get(key)
    }

    pub fn get_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.get_mut(key)
    }

    /// Names of these kinds, for "did you mean".
    pub fn names(&self, labels: bool) -> impl Iterator<Item = &str> {
        self.order.iter().map(|key| &**key).filter(move |key| {
            self.entries.get(*key).is_some_and(|entry| (entry.symbol.kind == SymbolKind::Label) == labels)
        })
    }

    /// The value of a constant that has been passed.
    pub fn constant(&self, key: &str) -> Option<Constant> {
        match self.entries.get(key)?.meaning.as_ref()? {
            Meaning::Constant(constant) => Some(*constant),
            Meaning::Memory { .. }
            | Meaning::Register { .. }
            | Meaning::Table(_)
            | Meaning::Label { .. }
            | Meaning::Broken => None,
        }
    }

    pub fn label_at(&self, key: &str) -> Option<u32> {
        match self.entries.get(key)?.meaning.as_ref()? {
            Meaning::Label { at, .. } => *at,
            Meaning::Memory { .. }
            | Meaning::Constant(_)
            | Meaning::Register { .. }
            | Meaning::Table(_)
            | Meaning::Broken => None,
        }
    }

    /// The labels of instructions as they are written; of several at one instruction the last.
    pub fn label_names<'t>(&self, text: &'t str) -> HashMap<usize, &'t str> {
        let of = |entry: &Entry| match entry.meaning {
            Some(Meaning::Label { at: Some(at), .. }) => Some((at as usize, entry.symbol.defined.of(text))),
            _ => None,
        };
        self.entries().filter_map(of).collect()
    }

    /// The type that a subroutine's argument is stored as.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn argument_type(&self, key: &str, index: usize) -> Option<Type> {
        match self.entries.get(key)?.meaning.as_ref()? {
            Meaning::Label { arguments: Some(arguments), .. } => arguments.get(index).copied(),
            _ => None,
        }
    }

    /// How many names there are.
    pub fn count(&self) -> usize {
        self.order.len() + self.surplus
    }

    /// The first definition for which there is no room. Names after that are not known.
    pub fn full_at(&self) -> Option<Span> {
        self.full_at
    }

    /// All entries in the order of the text.
    pub fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.order.iter().filter_map(|key| self.entries.get(key))
    }

    pub fn symbols(&self, text: &str) -> Vec<Symbol> {
        let spelt =
            |entry: &Entry| Symbol { name: entry.symbol.defined.of(text).to_owned(), ..entry.symbol.clone() };
        self.entries().map(spelt).collect()
    }

    pub fn variables(&self, text: &str) -> Vec<Variable> {
        let of = |entry: &Entry| match &entry.meaning {
            Some(Meaning::Memory { memory, is_array, .. }) => {
                let name = entry.symbol.defined.of(text).to_owned();
                Some(Variable { name, memory: *memory, is_array: *is_array })
            }
            _ => None,
        };
        self.entries().filter_map(of).collect()
    }

    pub fn labels(&self, text: &str) -> Vec<(String, u32)> {
        let of = |entry: &Entry| match entry.meaning {
            Some(Meaning::Label { at: Some(at), .. }) => Some((entry.symbol.defined.of(text).to_owned(), at)),
            _ => None,
        };
        self.entries().filter_map(of).collect()
    }
}

/// How values of a type are reckoned with.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn type_of(kind: VarType) -> Type {
    match kind {
        VarType::Float => Type::Float,
        kind if kind.is_signed() => Type::Signed,
        _ => Type::Unsigned,
    }
}

/// The text in an expression, if it is nothing else.
pub fn text_of(expr: &Expr) -> Option<&[u8]> {
    match &expr.kind {
        super::super::ast::ExprKind::Text(bytes) => Some(bytes),
        super::super::ast::ExprKind::Group(inner) => text_of(inner),
        super::super::ast::ExprKind::Integer(_)
        | super::super::ast::ExprKind::Float(_)
        | super::super::ast::ExprKind::Place(_)
        | super::super::ast::ExprKind::Unary(..)
        | super::super::ast::ExprKind::Chain(..) => None,
    }
}

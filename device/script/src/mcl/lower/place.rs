//! What a name with index and modifier stands for, and how it is read and set.

use super::super::ast::{Expr, Name, Place};
use super::super::codes;
use super::super::constant::Constant;
use super::super::registers::{self, RegisterId};
use super::super::types::{self, Part, PartError, VarType};
use super::super::words;
use super::scope::{Meaning, SymbolKind, type_of};
use super::{Lowering, MOST_COMPARED};
use crate::arithmetic::{self, Type};
use crate::diagnostic::excerpt;
use crate::op::{Array, Cell, Op, TableRef};
use std::sync::Arc;

/// Something that can be read, and mostly set.
#[derive(Clone, Debug)]
pub enum Target {
    /// A value at a known place.
    Cell { cell: Cell, root: Arc<str> },
    /// An element whose index is worked out when the program runs.
    Element { array: Array, root: Arc<str> },
    /// An array without an index.
    Whole { memory: Array, root: Arc<str> },
    /// A register; `None` with an index that is worked out.
    Register { id: RegisterId, element: Option<u8>, part: Option<Part> },
    /// A table entry; `None` with an index that is worked out.
    Table { table: TableRef, index: Option<u32>, part: Option<Part> },
    /// A table without an index.
    WholeTable(TableRef),
    /// A constant.
    Constant(Constant),
}

impl Target {
    /// The type of its value.
    pub fn kind(&self) -> VarType {
        match self {
            Self::Cell { cell, .. } => cell.kind,
            Self::Element { array, .. } => array.first.kind,
            Self::Whole { memory, .. } => memory.first.kind,
            Self::Register { id, part, .. } => part.map_or(id.row().kind, |part| part.kind),
            Self::Table { table, part, .. } => part.map_or(table.kind, |part| part.kind),
            Self::WholeTable(table) => table.kind,
            Self::Constant(constant) => match constant.cell().1 {
                Type::Float => VarType::Float,
                Type::Signed => VarType::SLong,
                Type::Unsigned => VarType::Long,
            },
        }
    }
}

/// What is said of streams 2 and 3 wherever they are named.
pub const AMBIGUOUS_STREAM: &str =
    "The manual numbers streams 2 and 3 in two ways; here 2 is TTL and 3 RS-232.";

impl Lowering<'_> {
    /// What a place is; what is wrong with it is reported.
    pub(super) fn target(&mut self, place: &Place) -> Option<Target> {
        if let Some((id, misspelt)) = words::register(place.name.span.of(self.text)) {
            return self.register(place, id, misspelt);
        }
        match self.meaning(&place.name)? {
            Meaning::Memory { memory, is_array, root } => self.memory(place, memory, is_array, root),
            Meaning::Table(table) => self.table_target(place, table),
            Meaning::Constant(constant) => self.constant_target(place, constant),
            Meaning::Register { id, element, part } => self.register_alias(place, id, element, part),
            Meaning::Label { .. } => {
                let message = format!("`{}` is a label, not a value.", excerpt(&place.name.key));
                self.report(codes::UNKNOWN_NAME, place.name.span, message, None);
                None
            }
            Meaning::Broken => None,
        }
    }

    /// What a name means here.
    fn meaning(&mut self, name: &Name) -> Option<Meaning> {
        let Some(entry) = self.scope.get_mut(&name.key) else {
            if self.scope.full_at().is_some() {
                return None;
            }
            let registers = registers::REGISTERS.iter().map(|register| register.name);
            let hint = self.nearest_name(&name.key, false, registers).or_else(|| {
                let kinds = VarType::ALL.map(VarType::name);
                Some(format!("Define it above: {} VAR {}", excerpt(name.span.of(self.text)), kinds[7]))
            });
            let message = format!("`{}` is not defined.", excerpt(name.span.of(self.text)));
            self.report(codes::UNKNOWN_NAME, name.span, message, hint);
            return None;
        };
        entry.symbol.uses.push(name.span);
        if entry.meaning.is_none() {
            let message = format!("`{}` is used above its definition.", excerpt(name.span.of(self.text)));
            let hint = Some("Definitions stand before the first use.".to_owned());
            self.report(codes::USED_BEFORE, name.span, message, hint);
            return None;
        }
        entry.meaning.clone()
    }

    fn memory(&mut self, place: &Place, memory: Array, is_array: bool, root: Arc<str>) -> Option<Target> {
        let mut memory = memory;
        if let Some(modifier) = &place.modifier {
            let part = self.part(modifier, memory.first.kind)?;
            memory.first = Cell { kind: part.kind, at: memory.first.at + part.first_bit };
        }
        let Some(index) = &place.index else {
            return Some(match is_array && place.modifier.is_none() {
                true => Target::Whole { memory, root },
                false => Target::Cell { cell: memory.first, root },
            });
        };
        if !is_array {
            return self.no_index(place);
        }
        match self.known_index(index, memory.length)? {
            Some(index) => {
                let at = memory.first.at + index * memory.stride;
                Some(Target::Cell { cell: Cell { at, ..memory.first }, root })
            }
            None => Some(Target::Element { array: memory, root }),
        }
    }

    fn no_index<T>(&mut self, place: &Place) -> Option<T> {
        let name = excerpt(place.name.span.of(self.text));
        let is_variable = self.register_of(place).is_none();
        let hint = is_variable.then(|| format!("An array is defined with its size: {name} VAR Byte(10)"));
        self.report(
            codes::NOT_AN_ARRAY,
            place.span,
            format!("`{name}` is no array and takes no index."),
            hint,
        );
        None
    }

    /// The index if it is constant and inside; `Some(None)` if it has to be worked out, `None` if it is wrong.
    fn known_index(&mut self, index: &Expr, length: u32) -> Option<Option<u32>> {
        let Ok(known) = self.folded(index) else { return Some(None) };
        self.use_constants(index);
        self.warn_of_precedence(index);
        let value = known.as_whole();
        match u32::try_from(value) {
            Ok(value) if value < length => Some(Some(value)),
            _ => {
                let message =
                    format!("Index {value} is outside: it goes from 0 to {}.", length.saturating_sub(1));
                self.report(codes::INDEX_OUTSIDE, index.span, message, None);
                None
            }
        }
    }

    fn part(&mut self, modifier: &Name, of: VarType) -> Option<Part> {
        let written = modifier.span.of(self.text).to_owned();
        match types::part(of, &written) {
            Ok(part) => Some(part),
            Err(PartError::Outside) => {
                let message = format!("A {} has no {}.", of.name(), excerpt(&written));
                self.report(codes::NO_SUCH_PART, modifier.span, message, None);
                None
            }
            Err(PartError::Unknown) => {
                let parts = types::parts(of);
                self.compared += parts.len();
                let is_searched = self.compared <= MOST_COMPARED;
                let hint =
                    is_searched.then(|| words::did_you_mean(&written, parts.iter().map(String::as_str)));
                let hint = hint.flatten();
                let message = format!("`{}` is no modifier.", excerpt(&written));
                self.report(codes::UNKNOWN_MODIFIER, modifier.span, message, hint);
                None
            }
        }
    }

    fn register(&mut self, place: &Place, id: RegisterId, misspelt: bool) -> Option<Target> {
        let row = id.row();
        if misspelt {
            let message = format!("The register's pages write it {}.", row.name);
            self.report(codes::MISSPELT, place.name.span, message, None);
        }
        let mut part = None;
        if let Some(modifier) = &place.modifier {
            part = Some(self.part(modifier, row.kind)?);
            let message =
                "Modifiers on system registers are forbidden by one page of the manual and used by another.";
            let hint = Some("Copy the register to a variable first.".to_owned());
            self.report(codes::REGISTER_PART, modifier.span, message.to_owned(), hint);
        }
        let element = match &place.index {
            None => Some(0),
            Some(_) if row.length == 1 => return self.no_index(place),
            Some(index) => self.known_index(index, u32::from(row.length))?.map(|index| index as u8),
        };
        if place.index.is_none() && row.length > 1 {
            self.warn_of_whole(place);
        }
        if row.name.starts_with("STREAM") && place.index.is_some() && matches!(element, Some(2 | 3)) {
            self.report(codes::AMBIGUOUS_STREAM, place.span, AMBIGUOUS_STREAM.to_owned(), None);
        }
        Some(Target::Register { id, element, part })
    }

    /// A name that an alias gives to a register, to an element or to a part of one.
    fn register_alias(
        &mut self,
        place: &Place,
        id: RegisterId,
        element: Option<u8>,
        part: Option<Part>,
    ) -> Option<Target> {
        if let (None, None) = (element, part) {
            return self.register(place, id, false);
        }
        if place.index.is_some() {
            return self.no_index(place);
        }
        let part = match &place.modifier {
            Some(modifier) => {
                let inner = self.part(modifier, part.map_or(id.row().kind, |part| part.kind))?;
                let first_bit = part.map_or(0, |part| part.first_bit) + inner.first_bit;
                Some(Part { first_bit, ..inner })
            }
            None => part,
        };
        Some(Target::Register { id, element, part })
    }

    fn warn_of_whole(&mut self, place: &Place) {
        let name = excerpt(place.name.span.of(self.text));
        let message = format!("`{name}` is an array; without an index its first element is taken.");
        self.report(codes::WHOLE_ARRAY, place.span, message, Some(format!("Write {name}(0).")));
    }

    fn table_target(&mut self, place: &Place, table: TableRef) -> Option<Target> {
        let Some(index) = &place.index else { return Some(Target::WholeTable(table)) };
        let part = match &place.modifier {
            Some(modifier) => Some(self.part(modifier, table.kind)?),
            None => None,
        };
        let index = self.known_index(index, table.length)?;
        Some(Target::Table { table, index, part })
    }

    fn constant_target(&mut self, place: &Place, constant: Constant) -> Option<Target> {
        if place.index.is_some() {
            return self.no_index(place);
        }
        if let Some(modifier) = &place.modifier {
            let message = "A constant has no parts.".to_owned();
            self.report(codes::UNKNOWN_MODIFIER, modifier.span, message, None);
            return None;
        }
        Some(Target::Constant(constant))
    }

    /// Puts the value of a place on the stack and says how to read it.
    pub(super) fn load(&mut self, place: &Place) -> Type {
        let Some(target) = self.target(place) else {
            self.emit(Op::Push(0));
            return Type::Unsigned;
        };
        self.mark_read(&target);
        let kind = target.kind();
        match target {
            Target::Cell { cell, .. } => self.emit(Op::Load(cell)),
            Target::Whole { memory, .. } => {
                self.warn_of_whole(place);
                self.emit(Op::Load(memory.first));
            }
            Target::Element { array, .. } => {
                self.index(place);
                self.emit(Op::LoadAt(array));
            }
            Target::Register { id, element, part } => {
                match element {
                    Some(element) => self.emit(Op::LoadRegister(id, element)),
                    None => {
                        self.index(place);
                        self.emit(Op::LoadRegisterAt(id));
                    }
                }
                part.into_iter().for_each(|part| self.emit(Op::Part(part)));
            }
            Target::Table { table, index, part } => {
                match index {
                    Some(index) => self.emit(Op::Push(index)),
                    None => self.index(place),
                }
                self.emit(Op::LoadTable(table));
                part.into_iter().for_each(|part| self.emit(Op::Part(part)));
            }
            Target::WholeTable(table) => {
                self.warn_of_whole(place);
                self.emit(Op::Push(0));
                self.emit(Op::LoadTable(table));
            }
            Target::Constant(constant) => self.emit(Op::Push(constant.cell().0)),
        }
        type_of(kind)
    }

    /// Works out the index of a place.
    fn index(&mut self, place: &Place) {
        if let Some(index) = &place.index {
            self.whole_number(index);
        }
    }

    /// Takes the value on the stack, of type `from`, into a place.
    pub(super) fn store(&mut self, place: &Place, from: Type) {
        let Some(target) = self.settable(place) else { return self.emit(Op::Drop) };
        let to = type_of(target.kind());
        if from == Type::Float && to != Type::Float {
            let message = "A floating point number is stored in an integer; its fraction is lost.".to_owned();
            let hint = Some("Write TOINT if that is meant.".to_owned());
            self.report(codes::FLOAT_INTO_INTEGER, place.span, message, hint);
        }
        self.convert(from, to);
        match target {
            Target::Cell { cell, .. } => self.emit(Op::Store(cell)),
            Target::Whole { memory, .. } => self.emit(Op::Store(memory.first)),
            Target::Element { array, .. } => {
                self.index(place);
                self.emit(Op::StoreAt(array));
            }
            Target::Register { id, element: Some(element), .. } => self.emit(Op::StoreRegister(id, element)),
            Target::Register { id, element: None, .. } => {
                self.index(place);
                self.emit(Op::StoreRegisterAt(id));
            }
            Target::Table { .. } | Target::WholeTable(_) | Target::Constant(_) => self.emit(Op::Drop),
        }
    }

    /// The type that a place is set with; nothing is reported.
    pub(super) fn settable(&mut self, place: &Place) -> Option<Target> {
        let target = self.target(place)?;
        let name = excerpt(place.name.span.of(self.text));
        let what = match &target {
            Target::Table { .. } | Target::WholeTable(_) => "an entry of a table",
            Target::Constant(_) => "a constant",
            Target::Register { id, .. } if !id.row().writable => {
                let message = format!("{name} can only be read.");
                self.report(codes::READ_ONLY, place.span, message, Some("Nothing is stored.".to_owned()));
                return None;
            }
            Target::Register { part: Some(_), .. } => {
                let message = "A part of a system register cannot be set.".to_owned();
                let hint = Some("Set the whole register.".to_owned());
                self.report(codes::NOT_A_VARIABLE, place.span, message, hint);
                return None;
            }
            Target::Cell { .. } | Target::Element { .. } | Target::Whole { .. } | Target::Register { .. } => {
                self.mark_written(&target);
                return Some(target);
            }
        };
        let message = format!("`{name}` is {what} and cannot be set.");
        self.report(codes::NOT_A_VARIABLE, place.span, message, None);
        None
    }

    pub(super) fn convert(&mut self, from: Type, to: Type) {
        let changes = arithmetic::common(from, to) == Type::Float && from != to;
        if changes {
            self.emit(Op::Convert(from, to));
        }
    }

    fn root(target: &Target) -> Option<&str> {
        match target {
            Target::Cell { root, .. } | Target::Element { root, .. } | Target::Whole { root, .. } => {
                Some(root)
            }
            Target::Register { .. } | Target::Table { .. } | Target::WholeTable(_) | Target::Constant(_) => {
                None
            }
        }
    }

    pub(super) fn mark_read(&mut self, target: &Target) {
        if let Some(entry) = Self::root(target).and_then(|root| self.scope.get_mut(root)) {
            entry.is_read = true;
        }
    }

    fn mark_written(&mut self, target: &Target) {
        if let Some(entry) = Self::root(target).and_then(|root| self.scope.get_mut(root)) {
            entry.is_written = true;
        }
    }

    /// The hint at a name that was meant, among those of the program and some more. A text with more mistakes than a person reads is
    /// searched for the first of them alone, so that it is checked as quickly as any other.
    fn nearest_name(
        &mut self,
        typed: &str,
        labels: bool,
        more: impl IntoIterator<Item = &'static str>,
    ) -> Option<String> {
        self.compared += self.scope.count();
        let is_searched = self.compared <= MOST_COMPARED;
        let more = more.into_iter().map(|word| -> &str { word });
        is_searched.then(|| words::did_you_mean(typed, self.scope.names(labels).chain(more))).flatten()
    }

    /// Notes the use of a label, or says that there is none.
    pub(super) fn use_label(&mut self, label: &Name) {
        if let Some(entry) = self.scope.get_mut(&label.key)
            && entry.symbol.kind == SymbolKind::Label
        {
            entry.symbol.uses.push(label.span);
            return;
        }
        if self.scope.full_at().is_some() {
            return;
        }
        let written = label.span.of(self.text);
        let hint = self.nearest_name(written, true, []);
        let message = format!("There is no label `{}`.", excerpt(written));
        self.report(codes::UNKNOWN_LABEL, label.span, message, hint);
    }
}

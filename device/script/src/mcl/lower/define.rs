//! Definitions: variables, aliases, constants, tables (MCP manual 3.1.4 to 3.1.12).

use super::super::ast::{Expr, Name, Place};
use super::super::codes;
use super::super::constant::{self, Constant};
use super::super::types::VarType;
use super::super::words;
use super::Lowering;
use super::place::Target;
use super::scope::{Meaning, text_of};
use crate::arithmetic::{self, Type};
use crate::op::{Array, Cell, TableRef};
use crate::program::limits;
use crate::text::Span;

impl Lowering<'_> {
    /// Memory for `length` values, one after the other.
    pub(super) fn allocate(&mut self, kind: VarType, length: u32) -> Array {
        let bits = kind.bits();
        if bits >= 8 {
            self.ram_bits = self.ram_bits.next_multiple_of(8);
        } else {
            self.ram_bits = self.ram_bits.next_multiple_of(u64::from(bits));
        }
        // A program that needs more than there is is refused; its places stay where they can be reckoned with.
        let most = u64::from(limits::RAM_BYTES) * 8;
        let at = u32::try_from(self.ram_bits.min(most)).unwrap_or(0);
        self.ram_bits += u64::from(bits) * u64::from(length);
        Array { first: Cell { kind, at }, stride: bits, length }
    }

    pub(super) fn variable(&mut self, name: &Name, kind: VarType, size: Option<&Expr>) {
        let length = match size {
            None => 1,
            Some(size) => match self.array_size(size, kind) {
                Some(length) => length,
                None => return self.scope.settle(name, Meaning::Broken),
            },
        };
        let memory = self.allocate(kind, length);
        let meaning = Meaning::Memory { memory, is_array: size.is_some(), root: name.key.clone() };
        self.scope.settle(name, meaning);
    }

    fn array_size(&mut self, size: &Expr, kind: VarType) -> Option<u32> {
        let value = self.known(size, "The size of an array")?.as_whole();
        let most = i64::from(limits::RAM_BYTES) * 8 / i64::from(kind.bits());
        if (1..=most).contains(&value) {
            return u32::try_from(value).ok();
        }
        let message = format!("An array has 1 to {most} elements of this type, not {value}.");
        self.report(codes::BAD_ARRAY_SIZE, size.span, message, None);
        None
    }

    /// The value of an expression that has to be constant; what is wrong with it is reported.
    pub(super) fn known(&mut self, expr: &Expr, what: &str) -> Option<Constant> {
        self.use_constants(expr);
        match constant::evaluate(expr, &|key| self.scope.constant(key)) {
            Ok(value) => Some(value),
            Err(error) => {
                let (message, hint) = error.reported(what);
                self.report(error.code(), error.span, message, hint);
                None
            }
        }
    }

    /// The value of an expression if it is constant; nothing is said if it is not.
    pub(super) fn folded(&self, expr: &Expr) -> Result<Constant, constant::NotConstant> {
        constant::evaluate(expr, &|key| self.scope.constant(key))
    }

    pub(super) fn alias(&mut self, name: &Name, of: &Place) {
        let whole = words::register(of.name.span.of(self.text))
            .filter(|(id, _)| id.row().length > 1 && of.index.is_none() && of.modifier.is_none());
        if let Some((id, _)) = whole {
            return self.scope.settle(name, Meaning::Register { id, element: None, part: None });
        }
        let meaning = match self.target(of) {
            Some(Target::Cell { cell, root }) => {
                let memory = Array { first: cell, stride: cell.kind.bits(), length: 1 };
                Meaning::Memory { memory, is_array: false, root }
            }
            Some(Target::Whole { memory, root }) => Meaning::Memory { memory, is_array: true, root },
            Some(Target::Register { id, element: element @ Some(_), part }) => {
                Meaning::Register { id, element, part }
            }
            Some(_) => {
                let message =
                    "An alias names a variable, an element with a constant index, or a part of one.";
                self.report(codes::NOT_CONSTANT, of.span, message.to_owned(), None);
                Meaning::Broken
            }
            None => Meaning::Broken,
        };
        self.scope.settle(name, meaning);
    }

    pub(super) fn constant(&mut self, name: &Name, value: &Expr, float: bool) {
        let meaning = match self.known(value, "A constant") {
            Some(known) if float => Meaning::Constant(Constant::Float(known.as_float())),
            Some(known) => Meaning::Constant(known),
            None => Meaning::Broken,
        };
        self.scope.settle(name, meaning);
    }

    pub(super) fn table(&mut self, name: &Name, kind: VarType, values: &[Expr]) {
        let at = u32::try_from(self.data.len()).unwrap_or(u32::MAX);
        let mut length = 0;
        for value in values {
            if let Some(bytes) = text_of(value).filter(|bytes| bytes.len() != 1) {
                for byte in bytes.iter().copied() {
                    self.table_entry(kind, Constant::Whole(byte.into(), Type::Unsigned), value.span);
                    length += 1;
                }
            } else if let Some(known) = self.known(value, "An entry of a table") {
                self.table_entry(kind, known, value.span);
                length += 1;
            }
        }
        if self.data.len() % 2 == 1 {
            // "Constant tables are restricted to word boundaries" (MCP manual 3.1.12).
            self.data.push(0);
        }
        let is_empty = length == 0;
        let meaning = if is_empty { Meaning::Broken } else { Meaning::Table(TableRef { kind, at, length }) };
        self.scope.settle(name, meaning);
    }

    fn table_entry(&mut self, kind: VarType, value: Constant, span: Span) {
        self.warn_of_loss(value, kind, span);
        let (cell, from) = value.cell();
        let cell = kind.keep(arithmetic::convert(cell, from, super::scope::type_of(kind)));
        let bytes = cell.to_le_bytes();
        self.data.extend(&bytes[..(kind.bits() / 8) as usize]);
    }

    /// Warns when a constant does not survive being stored as `kind`.
    pub(super) fn warn_of_loss(&mut self, value: Constant, kind: VarType, span: Span) {
        let Some((least, most)) = kind.range() else { return };
        if let Constant::Float(float) = value {
            let message = format!("{float} is stored without its fraction.");
            let hint = Some("Write TOINT if that is meant.".to_owned());
            return self.report(codes::FLOAT_INTO_INTEGER, span, message, hint);
        }
        let whole = value.as_whole();
        // -1 is a usual way to write "all bits set"; 0xFF is one to write -1.
        let top = most.max(-(least * 2) - 1);
        if whole < least.min(-1) || whole > top {
            let message = format!("{whole} does not fit a {}: it goes from {least} to {most}.", kind.name());
            let cell = kind.keep(value.cell().0);
            let kept = if kind.is_signed() { i64::from(cell as i32) } else { i64::from(cell) };
            self.report(codes::DOES_NOT_FIT, span, message, Some(format!("{kept} would be stored.")));
        }
    }
}

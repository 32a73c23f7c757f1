//! PUTS, GETS and assignments, with the modifiers of MCP manual 3.3.

use super::super::ast::{Expr, ExprKind, Format, Item, Place};
use super::super::codes;
use super::super::constant::Constant;
use super::super::types::VarType;
use super::Lowering;
use super::place::{AMBIGUOUS_STREAM, Target};
use super::scope::{text_of, type_of};
use crate::arithmetic::Type;
use crate::op::{Array, Op};

/// "As many decimals as the number has."
const ALL_DECIMALS: u32 = u32::MAX;

impl Lowering<'_> {
    pub(super) fn puts(&mut self, stream: &Expr, items: &[Item]) {
        self.stream(stream);
        self.emit(Op::OutStream);
        for item in items {
            self.output(item, None);
        }
        self.emit(Op::OutEnd);
    }

    /// A stream's number on the stack.
    fn stream(&mut self, stream: &Expr) {
        self.whole_number(stream);
        match self.folded(stream).map(Constant::as_whole) {
            Ok(2 | 3) => {
                self.report(codes::AMBIGUOUS_STREAM, stream.span, AMBIGUOUS_STREAM.to_owned(), None);
            }
            Ok(number) if !(0..=3).contains(&number) => {
                let message = format!("There is no stream {number}.");
                let hint = Some("0 is USB, 1 CAN, 2 TTL, 3 RS-232.".to_owned());
                self.report(codes::DOES_NOT_FIT, stream.span, message, hint);
            }
            _ => {}
        }
    }

    /// `place = items`.
    pub(super) fn assign(&mut self, to: &Place, items: &[Item]) {
        if let Some(array) = self.whole_array(to) {
            let whole_text =
                items.len() > 1 || items.iter().any(|item| item.format.is_some() || is_text(&item.value));
            if whole_text {
                self.settable(to);
                self.emit(Op::OutArray(array));
                for item in items {
                    self.output(item, Some(array));
                }
                return self.emit(Op::OutEnd);
            }
        }
        let [item] = items else {
            let message = "Only an array takes several values.".to_owned();
            return self.report(codes::BAD_OUTPUT, to.span, message, None);
        };
        if let Some((format, _)) = item.format {
            let message = format!("{} makes characters, which only an array can take.", format.word());
            return self.report(codes::BAD_OUTPUT, item.span, message, None);
        }
        if let [argument, ..] = &item.arguments[..] {
            let message = "A backslash belongs to an output modifier.".to_owned();
            return self.report(codes::BAD_OUTPUT, argument.span, message, None);
        }
        if let Ok(known @ Constant::Whole(..)) = self.folded(&item.value)
            && let Some(kind) = self.stored_kind(to)
        {
            self.warn_of_loss(known, kind, item.value.span);
            if let Some(id) = self.register_of(to) {
                self.warn_of_dispute(id, known.as_whole(), item.value.span);
            }
        }
        let from = self.expression(&item.value);
        self.store(to, from);
    }

    /// The memory of an array that is named without an index.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn whole_array(&mut self, place: &Place) -> Option<Array> {
        if place.index.is_some() || place.modifier.is_some() {
            return None;
        }
        match self.scope.get(&place.name.key)?.meaning.as_ref()? {
            super::scope::Meaning::Memory { memory, is_array: true, .. } => Some(*memory),
            _ => None,
        }
    }

    /// One item, to a stream or into an array.
    fn output(&mut self, item: &Item, array: Option<Array>) {
        let Some((format, limit)) = item.format else { return self.plain_output(item, array) };
        match format {
            Format::Dec | Format::SDec | Format::Hex | Format::IHex => {
                self.whole_number(&item.value);
                self.argument(item, 0);
                self.emit(Op::OutNumber(format, limit.unwrap_or(0)));
            }
            Format::Real => {
                let from = self.expression(&item.value);
                if from != Type::Float {
                    let message =
                        "REAL shows a floating point number; this whole one is converted.".to_owned();
                    let hint = Some("Write TOFLOAT before it.".to_owned());
                    self.report(codes::MIXED, item.value.span, message, hint);
                    self.convert(from, Type::Float);
                }
                self.argument(item, ALL_DECIMALS);
                self.emit(Op::OutReal(limit.unwrap_or(0)));
            }
            Format::Rep => {
                self.whole_number(&item.value);
                if item.arguments.is_empty() {
                    self.wrong(item, "REP takes a character and a count: REP \"-\"\\10");
                }
                self.argument(item, 0);
                self.emit(Op::OutRepeat);
            }
            Format::Str => self.string_output(item),
        }
    }

    fn plain_output(&mut self, item: &Item, array: Option<Array>) {
        if !item.arguments.is_empty() {
            self.wrong(item, "A backslash belongs to an output modifier, such as DEC x\\4");
        }
        if let Some(bytes) = text_of(&item.value) {
            let at = u32::try_from(self.data.len()).unwrap_or(u32::MAX);
            let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
            self.data.extend(bytes);
            return self.emit(Op::OutText(at, length));
        }
        if let (None, Ok(known @ Constant::Whole(..))) = (array, self.folded(&item.value)) {
            self.warn_of_loss(known, VarType::Byte, item.value.span);
        }
        let from = self.expression(&item.value);
        let Some(array) = array else {
            if from == Type::Float {
                self.wrong(item, "A floating point number is not one byte; show it with REAL");
            }
            return self.emit(Op::OutByte);
        };
        self.convert(from, type_of(array.first.kind));
        self.emit(Op::OutValue);
    }

    fn string_output(&mut self, item: &Item) {
        let ExprKind::Place(place) = &item.value.kind else {
            return self.wrong(item, "STR takes an array or a table: STR text\\20");
        };
        let target = self.target(place);
        let Some(has_end) = self.string_arguments(item) else { return };
        match target {
            Some(Target::Whole { memory, root }) => {
                self.mark_read(&Target::Whole { memory, root });
                self.emit(Op::OutString(memory, has_end));
            }
            Some(Target::WholeTable(table)) => self.emit(Op::OutTable(table, has_end)),
            Some(_) => self.wrong(item, "STR takes an array or a table without an index"),
            None => {}
        }
    }

    /// Length and perhaps end of a STR on the stack; whether there is an end.
    fn string_arguments(&mut self, item: &Item) -> Option<bool> {
        if !(1..=2).contains(&item.arguments.len()) {
            self.wrong(item, "STR takes a length and perhaps an end: STR text\\20\\0");
            return None;
        }
        for argument in &item.arguments {
            self.whole_number(argument);
        }
        Some(item.arguments.len() == 2)
    }

    /// The one argument that a format may have, on the stack.
    fn argument(&mut self, item: &Item, default: u32) {
        match &item.arguments[..] {
            [] => self.emit(Op::Push(default)),
            [argument] => {
                self.whole_number(argument);
            }
            _ => self.wrong(item, "This modifier takes one number after a backslash"),
        }
    }

    fn wrong(&mut self, item: &Item, message: &str) {
        self.report(codes::BAD_OUTPUT, item.span, format!("{message}."), None);
    }

    pub(super) fn gets(&mut self, stream: &Expr, items: &[Item]) {
        self.stream(stream);
        self.emit(Op::InStream);
        for item in items {
            self.input(item);
        }
    }

    fn input(&mut self, item: &Item) {
        let ExprKind::Place(place) = &item.value.kind else {
            let message = "GETS stores in variables; this is none.".to_owned();
            return self.report(codes::NOT_A_VARIABLE, item.value.span, message, None);
        };
        let is_string = matches!(item.format, Some((Format::Str, _)));
        if !is_string && let [argument, ..] = &item.arguments[..] {
            let message = "Only STR takes numbers after a backslash here.".to_owned();
            self.report(codes::BAD_OUTPUT, argument.span, message, None);
        }
        match item.format {
            None => {
                self.emit(Op::InByte);
                self.store(place, Type::Unsigned);
            }
            Some((Format::Str, _)) => {
                let Some(has_end) = self.string_arguments(item) else { return };
                match self.settable(place) {
                    Some(Target::Whole { memory, .. }) => self.emit(Op::InString(memory, has_end)),
                    Some(_) => self.wrong(item, "STR takes an array without an index"),
                    None => {}
                }
            }
            Some((Format::Rep, _)) => self.wrong(item, "REP only writes"),
            Some((Format::Real, _)) => {
                self.emit(Op::InReal);
                self.store(place, Type::Float);
            }
            Some((format, limit)) => {
                self.emit(Op::InNumber(format, limit.unwrap_or(0)));
                let from = if format == Format::SDec { Type::Signed } else { Type::Unsigned };
                self.store(place, from);
            }
        }
    }
}

fn is_text(expr: &Expr) -> bool {
    text_of(expr).is_some()
}

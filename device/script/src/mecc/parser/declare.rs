//! What stands outside of routines: variables, tables, functions, handlers and the program.

use super::block::{Block, Closer};
use super::{Broken, MOST_STATEMENTS, Parse, Parser};
use crate::mecc::ast::{Item, Kind, Name, Routine, RoutineKind, Table, Variable};
use crate::mecc::codes;
use crate::mecc::lexer::{TokenKind, text_bytes};
use crate::mecc::words;
use crate::program::limits;
use crate::text::Span;

/// How a declaration is written.
const DECLARE: &str = "Declare Byte name, Declare Word name, Declare DataPointer name, Declare DataTable name, Declare Function name() or \
                       Declare EventHandler name()";

impl Parser<'_> {
    pub fn items(&mut self) -> Vec<Item> {
        let mut items = Vec::new();
        loop {
            self.skip_newlines();
            if self.is_end() {
                return items;
            }
            self.count += 1;
            if self.count > MOST_STATEMENTS {
                self.give_up();
                return items;
            }
            let before = self.at;
            match self.item() {
                Ok(item) => {
                    items.push(item);
                    self.end_of_statement();
                }
                Err(Broken) => self.skip_line(),
            }
            if self.at == before {
                self.advance();
            }
        }
    }

    fn item(&mut self) -> Parse<Item> {
        let head = self.span();
        match self.word_here().as_deref() {
            Some("begin") => {
                self.advance();
                let name = self.span();
                self.expect_word("Program", "behind Begin", words::syntax("Begin Program"))?;
                let name = Name { key: self.key("program".to_owned()), span: name };
                Ok(Item::Routine(self.routine(RoutineKind::Program, name, head)))
            }
            Some("declare") => self.declaration(head),
            Some(word) => {
                if let Some(Closer::EndOf(_) | Closer::Until | Closer::Else | Closer::Case) = self.closer() {
                    self.ends_nothing();
                    return Err(Broken);
                }
                self.form_unknown(word)?;
                let shown = crate::diagnostic::excerpt(head.of(self.text)).into_owned();
                let message =
                    format!("`{shown}` stands outside of the program, of functions and of handlers.");
                let hint = self.meant(word).filter(|_| !words::is_reserved(word));
                let hint = hint.unwrap_or_else(|| "Put it between Begin Program and End Program.".to_owned());
                self.fail(codes::MISPLACED, message, Some(hint))
            }
            None => {
                let found = self.found_here();
                let message =
                    format!("A declaration or Begin Program should stand here, but there is {found}.");
                self.fail(codes::UNEXPECTED, message, Some(format!("Declarations are written: {DECLARE}")))
            }
        }
    }

    /// Says that a word exists whose form is not known.
    pub fn form_unknown(&mut self, word: &str) -> Parse<()> {
        let Some((_, hint)) = words::FORM_UNKNOWN.iter().find(|(known, _)| *known == word) else {
            return Ok(());
        };
        let shown = self.span().of(self.text);
        let message = format!("`{shown}` exists, but the maker's pages do not show how it is written.");
        self.fail(codes::FORM_UNKNOWN, message, Some((*hint).to_owned()))
    }

    /// The type behind `Declare`, `as` or `Returns`, if one stands here.
    fn variable_kind(&mut self) -> Option<Kind> {
        let kind = match self.word_here()?.as_str() {
            "byte" => Kind::Byte,
            "word" => Kind::Word,
            "datapointer" => Kind::Pointer,
            _ => return None,
        };
        self.advance();
        Some(kind)
    }

    fn declaration(&mut self, head: Span) -> Parse<Item> {
        self.advance();
        if let Some(kind) = self.variable_kind() {
            return self.variable(kind).map(Item::Variable);
        }
        match self.word_here().as_deref() {
            Some("datatable") => self.table(head).map(Item::Table),
            Some("function") => self.function(head).map(Item::Routine),
            Some("eventhandler") => self.handler(head).map(Item::Routine),
            _ => {
                let found = self.found_here();
                let message = format!("What is declared should stand behind Declare, but there is {found}.");
                self.fail(codes::UNEXPECTED, message, Some(format!("It is written: {DECLARE}")))
            }
        }
    }

    /// A declaration inside a routine, whose `Declare` has been taken.
    pub fn local(&mut self) -> Parse<Variable> {
        if let Some(kind) = self.variable_kind() {
            return self.variable(kind);
        }
        let found = self.found_here();
        let message = format!("Only a Byte, a Word or a DataPointer can be declared in here, not {found}.");
        self.fail(codes::MISPLACED, message, Some("Declare it outside, above Begin Program.".to_owned()))
    }

    /// The name and the first value of a variable.
    fn variable(&mut self, kind: Kind) -> Parse<Variable> {
        let name = self.name("a variable")?;
        let value = if self.skip_sign("=") { Some(self.expression()?) } else { None };
        if self.is_sign(",") {
            let hint = "Write another Declare in the next line.".to_owned();
            return self.fail(codes::UNEXPECTED, "One Declare declares one variable.".to_owned(), Some(hint));
        }
        Ok(Variable { name, kind, value })
    }

    fn table(&mut self, head: Span) -> Parse<Table> {
        self.advance();
        let name = self.name("a table")?;
        self.end_of_statement();
        let mut bytes = Vec::new();
        loop {
            self.skip_newlines();
            let ends = self.is_word("end") && self.word_next().as_deref() == Some("datatable");
            if ends {
                self.advance();
                self.advance();
                break;
            }
            if self.is_end() || self.is_word("end") || self.is_word("declare") || self.is_word("begin") {
                let hint = "Write End DataTable where it ends.".to_owned();
                self.report(
                    codes::NO_BLOCK_END,
                    head,
                    "This table has no End DataTable.".to_owned(),
                    Some(hint),
                );
                break;
            }
            match self.table_row(&mut bytes) {
                Ok(()) => self.end_of_statement(),
                Err(Broken) => self.skip_line(),
            }
        }
        let is_full = self.table_bytes > limits::RAM_BYTES as usize;
        self.table_bytes += bytes.len();
        if bytes.is_empty() && !is_full {
            let message = format!("Table `{}` has no byte.", name.span.of(self.text));
            let hint = "Put a text in quotes, numbers, or Reserve and a number into it.".to_owned();
            self.report(codes::EMPTY_TABLE, name.span, message, Some(hint));
        }
        Ok(Table { name, bytes })
    }

    /// A line of a table: texts and numbers, or `Reserve count`.
    fn table_row(&mut self, bytes: &mut Vec<u8>) -> Parse<()> {
        loop {
            match self.kind() {
                TokenKind::Text => bytes.extend(text_bytes(self.span().of(self.text))),
                TokenKind::Number(value) => match u8::try_from(value) {
                    Ok(byte) => bytes.push(byte),
                    Err(_) => {
                        let message = format!("{value} is no byte of a table.");
                        return self.fail(
                            codes::OUT_OF_RANGE,
                            message,
                            Some("A byte is 0 to 255.".to_owned()),
                        );
                    }
                },
                TokenKind::Word if self.is_word("reserve") => {
                    self.advance();
                    let TokenKind::Number(count) = self.kind() else {
                        let found = self.found_here();
                        let message = format!("A number should stand behind Reserve, but there is {found}.");
                        return self.fail(codes::UNEXPECTED, message, Some("Write Reserve 8.".to_owned()));
                    };
                    bytes.resize(bytes.len() + usize::from(count), 0);
                }
                TokenKind::Word
                | TokenKind::Sign(_)
                | TokenKind::Comment
                | TokenKind::Newline
                | TokenKind::End => {
                    let found = self.found_here();
                    let message = format!("A row of a table should stand here, but there is {found}.");
                    let hint =
                        "A row is a text in quotes, numbers with commas, or Reserve and a number.".to_owned();
                    return self.fail(codes::UNEXPECTED, message, Some(hint));
                }
            }
            // More can never fit; what is said of it is said once, by the size of all.
            bytes.truncate((limits::RAM_BYTES as usize + 1).saturating_sub(self.table_bytes));
            self.advance();
            if !self.skip_sign(",") {
                return Ok(());
            }
        }
    }

    fn function(&mut self, head: Span) -> Parse<Routine> {
        self.advance();
        let syntax = words::syntax("Declare Function");
        let name = self.name("a function")?;
        self.expect_sign("(", "behind the name of the function", syntax)?;
        let mut parameters = Vec::new();
        while !self.is_sign(")") {
            let name = self.name("a parameter")?;
            self.expect_word("as", "behind the name of the parameter", syntax)?;
            let Some(kind) = self.variable_kind() else {
                let found = self.found_here();
                let message = format!("A type should stand behind `as`, but there is {found}.");
                return self.fail(
                    codes::UNEXPECTED,
                    message,
                    Some("Types are Byte, Word and DataPointer.".to_owned()),
                );
            };
            parameters.push(Variable { name, kind, value: None });
            if !self.skip_sign(",") {
                break;
            }
        }
        self.expect_sign(")", "behind the parameters", syntax)?;
        let returns = if self.skip_word("returns") {
            let Some(kind) = self.variable_kind() else {
                let found = self.found_here();
                let message = format!("A type should stand behind Returns, but there is {found}.");
                return self.fail(codes::UNEXPECTED, message, Some("Types are Byte and Word.".to_owned()));
            };
            Some(kind)
        } else {
            None
        };
        Ok(self.routine(RoutineKind::Function(parameters, returns), name, head))
    }

    fn handler(&mut self, head: Span) -> Parse<Routine> {
        self.advance();
        let syntax = words::syntax("Declare EventHandler");
        let name = self.name("an event handler")?;
        self.expect_sign("(", "behind the name of the handler", syntax)?;
        if !self.is_sign(")") {
            let hint = "An event gives nothing along: leave the parentheses empty.".to_owned();
            return self.fail(
                codes::ARGUMENT_COUNT,
                "An event handler takes nothing.".to_owned(),
                Some(hint),
            );
        }
        self.advance();
        Ok(self.routine(RoutineKind::Handler, name, head))
    }

    fn routine(&mut self, kind: RoutineKind, name: Name, head: Span) -> Routine {
        self.end_of_statement();
        let body = self.statements(Block::Routine);
        let end = self.span();
        let (word, begun) = match kind {
            RoutineKind::Program => ("program", "the program"),
            RoutineKind::Handler => ("eventhandler", "an event handler"),
            RoutineKind::Function(..) => ("function", "a function"),
        };
        if self.closer() == Some(Closer::EndOf(Block::Routine)) {
            if self.word_next().as_deref() != Some(word) {
                let message =
                    format!("`End {}` ends {begun} here.", self.word_at(self.at + 1).unwrap_or_default());
                let hint = Some(format!("Write End {}.", title(word)));
                self.report(codes::NO_BLOCK_END, self.span(), message, hint);
            }
            self.advance();
            self.advance();
        } else {
            let message = format!("There is no End {} to this.", title(word));
            let hint = format!("Write End {} where it ends.", title(word));
            self.report(codes::NO_BLOCK_END, head.to(name.span), message, Some(hint));
        }
        Routine { kind, name, body, end }
    }
}

fn title(word: &str) -> &'static str {
    match word {
        "program" => "Program",
        "function" => "Function",
        _ => "EventHandler",
    }
}

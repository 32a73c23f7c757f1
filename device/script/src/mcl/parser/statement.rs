//! Single statements: definitions, labels, assignments and commands.

use super::{Broken, CLOSERS, Parse, Parser};
use crate::diagnostic::excerpt;
use crate::mcl::ast::{Motion, Name, Place, Statement, StatementKind};
use crate::mcl::codes;
use crate::mcl::constant::{self, Constant};
use crate::mcl::lexer::TokenKind;
use crate::mcl::types::{TABLES, VarType};
use crate::mcl::words;

impl Parser<'_> {
    pub(super) fn statement(&mut self) -> Parse<Statement> {
        let start = self.span();
        let Some(word) = self.word_here() else {
            let found = self.found_here();
            let message = format!("A statement cannot begin with {found}.");
            return self.fail(codes::UNKNOWN_COMMAND, message, None);
        };
        let kind = match self.command(&word.to_ascii_lowercase())? {
            Some(kind) => kind,
            None => self.named(word)?,
        };
        Ok(Statement { kind, span: start.to(self.span_before()) })
    }

    /// A statement that begins with a command word; `None` if it is no such word.
    fn command(&mut self, word: &str) -> Parse<Option<StatementKind>> {
        if let Some(motion) = Motion::ALL.into_iter().find(|motion| motion.word().eq_ignore_ascii_case(word))
        {
            self.advance();
            return self.motion(motion).map(Some);
        }
        let read = match word {
            "if" => Self::if_statement,
            "for" => Self::for_statement,
            "while" => Self::while_statement,
            "do" => Self::do_statement,
            "repeat" => Self::repeat_statement,
            "let" => Self::assignment,
            "goto" => |parser: &mut Self| Ok(StatementKind::Goto(parser.label_name()?)),
            "gosub" => Self::gosub,
            "return" => Self::return_statement,
            "branch" => Self::branch,
            "puts" => Self::puts,
            "gets" => Self::gets,
            "read" => Self::read,
            "write" => Self::write,
            "i2cout" => |parser: &mut Self| parser.i2c_out(true),
            "i2coutns" => |parser: &mut Self| parser.i2c_out(false),
            "i2cin" => Self::i2c_in,
            "pause" => |parser: &mut Self| Ok(StatementKind::Pause(parser.expression()?)),
            "clear" => |_: &mut Self| Ok(StatementKind::Clear),
            "end" | "stop" => |_: &mut Self| Ok(StatementKind::End),
            _ => return self.misplaced(word),
        };
        self.advance();
        read(self).map(Some)
    }

    /// Words that begin no statement get a sentence of their own.
    fn misplaced(&mut self, word: &str) -> Parse<Option<StatementKind>> {
        if CLOSERS.contains(&word) {
            let start = match word {
                "next" => "FOR",
                "wend" => "WHILE",
                "until" => "REPEAT",
                _ => "IF",
            };
            let hint =
                (start == "IF").then(|| "An IF with a jump on its own line takes no ENDIF.".to_owned());
            let upper = word.to_uppercase();
            return self.fail(codes::NO_BLOCK_START, format!("{upper} without its {start}."), hint);
        }
        if words::CAN.iter().any(|can| can.eq_ignore_ascii_case(word)) {
            let word = word.to_uppercase();
            return self.no_public_syntax(&word);
        }
        if words::OTHER_PRODUCT.iter().any(|other| other.eq_ignore_ascii_case(word)) {
            let message = format!("{} belongs to another product of the maker.", word.to_uppercase());
            let hint = match word {
                "serin" => "Here it is: gets 0,[variable]",
                _ => "Here it is: puts 0,[\"result = \", dec result, 13]",
            };
            return self.fail(codes::OTHER_PRODUCT, message, Some(hint.to_owned()));
        }
        Ok(None)
    }

    /// A definition, a label or an assignment.
    fn named(&mut self, word: &str) -> Parse<StatementKind> {
        if let Some(defines) = self.word_at(self.at + 1).map(str::to_ascii_lowercase) {
            match defines.as_str() {
                "var" => return self.variable(),
                "con" => return self.constant(false),
                "fcon" => return self.constant(true),
                _ => {}
            }
            if let Some((_, kind)) = TABLES.iter().find(|(table, _)| table.eq_ignore_ascii_case(&defines)) {
                return self.table(*kind);
            }
        }
        match self.peek(1) {
            TokenKind::Sign("=" | "(" | ".") => self.assignment(),
            TokenKind::Sign("[" | ":") | TokenKind::Newline | TokenKind::End | TokenKind::Directive(_) => {
                self.label()
            }
            TokenKind::Word if self.is_label_before_statement() => self.label(),
            TokenKind::Word
            | TokenKind::Integer(_)
            | TokenKind::Float(_)
            | TokenKind::Text(_)
            | TokenKind::Sign(_) => {
                let commands = words::COMMANDS.iter().map(|command| command.name);
                let hint = self.did_you_mean(word, commands);
                self.fail(codes::UNKNOWN_COMMAND, format!("`{}` is no command.", excerpt(word)), hint)
            }
        }
    }

    /// `loop goto loop`: a label with a statement on its line.
    fn is_label_before_statement(&self) -> bool {
        let follows = self.word_at(self.at + 1).unwrap_or("");
        let command = words::COMMANDS.iter().any(|command| command.name.eq_ignore_ascii_case(follows));
        let assigns = matches!(self.peek(2), TokenKind::Sign("="));
        let word = self.word_here().unwrap_or("");
        let near = words::nearest(word, words::COMMANDS.iter().map(|command| command.name));
        (command || assigns) && near.is_none()
    }

    fn define(&mut self, name: &Name) {
        self.defined.insert(name.key.clone());
    }

    fn label(&mut self) -> Parse<StatementKind> {
        let name = self.label_name()?;
        let arguments = if self.is_sign("[") {
            Some(self.bracketed("after the label", Self::variable_place)?)
        } else {
            None
        };
        self.skip_sign(":");
        self.define(&name);
        Ok(StatementKind::Label { name, arguments })
    }

    fn variable(&mut self) -> Parse<StatementKind> {
        let name = self.name("The name of a variable")?;
        self.define(&name);
        self.advance();
        let Some(word) = self.word_here() else {
            let found = self.found_here();
            let message = format!("A type or a variable should follow VAR, but there is {found}.");
            return self.fail(codes::UNEXPECTED, message, Some("For example: speed VAR SLong".into()));
        };
        let Some(kind) = VarType::lookup(word) else {
            if words::register(word).is_none() && words::is_reserved(word) {
                let types = VarType::ALL.map(VarType::name).join(", ");
                let hint = Some(format!("Types are {types}."));
                return self.fail(codes::UNEXPECTED, format!("`{word}` is no type."), hint);
            }
            let of = self.variable_place()?;
            return Ok(StatementKind::Alias { name, of });
        };
        self.advance();
        let mut size = None;
        if self.skip_sign("(") {
            size = Some(Box::new(self.expression()?));
            self.expect_sign(")", "after the size")?;
        }
        Ok(StatementKind::Variable { name, kind, size })
    }

    fn constant(&mut self, float: bool) -> Parse<StatementKind> {
        let name = self.name("The name of a constant")?;
        self.define(&name);
        self.advance();
        let value = Box::new(self.expression()?);
        let constants = &self.constants;
        if let Ok(known) = constant::evaluate(&value, &|key| constants.get(key).copied()) {
            let known = if float { Constant::Float(known.as_float()) } else { known };
            self.constants.insert(name.key.clone(), known);
        }
        Ok(StatementKind::Constant { name, value, float })
    }

    fn table(&mut self, kind: VarType) -> Parse<StatementKind> {
        let name = self.name("The name of a table")?;
        self.define(&name);
        self.advance();
        let values = self.table_values()?;
        Ok(StatementKind::Table { name, kind, values })
    }

    fn assignment(&mut self) -> Parse<StatementKind> {
        let to = self.variable_place()?;
        self.expect_sign("=", "after what is set")?;
        let items = self.assigned_items()?;
        Ok(StatementKind::Assign { to, items })
    }

    pub(super) fn gosub(&mut self) -> Parse<StatementKind> {
        let label = self.label_name()?;
        let arguments =
            if self.is_sign("[") { self.bracketed("after the label", Self::expression)? } else { Vec::new() };
        let result = if self.skip_sign(",") { Some(Box::new(self.variable_place()?)) } else { None };
        Ok(StatementKind::Gosub { label, arguments, result })
    }

    fn return_statement(&mut self) -> Parse<StatementKind> {
        let none = self.at_newline()
            || self.is_end()
            || self.is_sign(":")
            || self.is_directive()
            || self.is_closed();
        Ok(StatementKind::Return(if none { None } else { Some(self.expression()?) }))
    }

    fn branch(&mut self) -> Parse<StatementKind> {
        let index = Box::new(self.expression()?);
        self.expect_sign(",", "after the index")?;
        let labels = self.bracketed("before the labels", Self::label_name)?;
        Ok(StatementKind::Branch { index, labels })
    }

    fn puts(&mut self) -> Parse<StatementKind> {
        let stream = Box::new(self.expression()?);
        self.expect_sign(",", "after the stream")?;
        let items = self.bracketed("before what is sent", Self::output_item)?;
        Ok(StatementKind::Puts { stream, items })
    }

    fn gets(&mut self) -> Parse<StatementKind> {
        let stream = Box::new(self.expression()?);
        self.expect_sign(",", "after the stream")?;
        let items = self.bracketed("before the variables", Self::input_item)?;
        Ok(StatementKind::Gets { stream, items })
    }

    fn read(&mut self) -> Parse<StatementKind> {
        let address = Box::new(self.expression()?);
        self.expect_sign(",", "after the address")?;
        Ok(StatementKind::Read { address, to: self.variable_place()? })
    }

    fn write(&mut self) -> Parse<StatementKind> {
        let address = Box::new(self.expression()?);
        self.expect_sign(",", "after the address")?;
        Ok(StatementKind::Write { address, value: Box::new(self.expression()?) })
    }

    fn i2c_otherwise(&mut self) -> Parse<Option<Box<(Name, crate::mcl::ast::Expr)>>> {
        // "{label,timeout}, [...]": with the first part left out the comma may stay.
        self.skip_sign(",");
        if self.is_sign("[") {
            return Ok(None);
        }
        let label = self.label_name()?;
        self.expect_sign(",", "between label and timeout")?;
        let timeout = self.expression()?;
        self.expect_sign(",", "after the timeout")?;
        Ok(Some(Box::new((label, timeout))))
    }

    fn i2c_out(&mut self, stop: bool) -> Parse<StatementKind> {
        let otherwise = self.i2c_otherwise()?;
        let bytes = self.bracketed("before the bytes", Self::expression)?;
        Ok(StatementKind::I2cOut { otherwise, bytes, stop })
    }

    fn i2c_in(&mut self) -> Parse<StatementKind> {
        let otherwise = self.i2c_otherwise()?;
        let to: Vec<Place> = self.bracketed("before the variables", Self::variable_place)?;
        Ok(StatementKind::I2cIn { otherwise, to })
    }

    fn motion(&mut self, command: Motion) -> Parse<StatementKind> {
        let start = self.span_before();
        let arguments = self.expressions()?;
        let (got, wanted) = (arguments.len(), command.arguments());
        if got != wanted && !(command.takes_extra_buffer() && got == wanted + 1) {
            let row = words::COMMANDS.iter().find(|word| word.name == command.word());
            let hint = row.map(|word| format!("It is written: {}", word.syntax));
            let message = format!("{} takes {wanted} arguments, not {got}.", command.word());
            self.report(codes::ARGUMENT_COUNT, start.to(self.span_before()), message, hint);
            return Err(Broken);
        }
        Ok(StatementKind::Motion { command, arguments })
    }
}

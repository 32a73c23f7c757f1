//! Statements that hold others: IF, FOR, WHILE, DO, REPEAT.

use super::{Parse, Parser};
use crate::mcl::ast::{For, Statement, StatementKind};
use crate::mcl::codes;
use crate::mcl::lexer::TokenKind;
use crate::text::Span;

impl Parser<'_> {
    /// The statements of a block up to one of `ends`, which is left standing.
    fn body(&mut self, ends: &'static [&'static str]) -> Parse<Vec<Statement>> {
        self.deeper(|parser| Ok(parser.statements(ends)))
    }

    /// Takes the word that ends a block, or says that it is missing.
    fn close(&mut self, word: &str, opener: &str, opened_at: Span) -> Span {
        if self.is_word(word) {
            self.advance();
            return self.span_before();
        }
        let upper = word.to_uppercase();
        let message = format!("This {opener} has no {upper}.");
        let hint = match opener {
            "IF" => {
                "Write ENDIF where it ends; only a label, GOTO or GOSUB on the line of THEN does without."
                    .to_owned()
            }
            _ => format!("Write {upper} where it ends."),
        };
        self.report(codes::NO_BLOCK_END, opened_at, message, Some(hint));
        self.span_before()
    }

    pub(super) fn if_statement(&mut self) -> Parse<StatementKind> {
        let opened_at = self.span_before();
        let condition = self.expression()?;
        if !self.skip_word("then") {
            let found = self.found_here();
            let message = format!("THEN should follow the condition, but there is {found}.");
            return self.fail(codes::UNEXPECTED, message, None);
        }
        if let Some(jump) = self.jump_on_this_line()? {
            return Ok(StatementKind::IfJump { condition: Box::new(condition), then: Box::new(jump) });
        }
        let mut branches = vec![(Some(condition), self.body(&["endif", "else", "elseif"])?)];
        loop {
            if self.skip_word("elseif") {
                let condition = self.expression()?;
                // The manual's ELSEIF has no THEN.
                self.skip_word("then");
                branches.push((Some(condition), self.body(&["endif", "else", "elseif"])?));
            } else if self.skip_word("else") {
                branches.push((None, self.body(&["endif"])?));
                break;
            } else {
                break;
            }
        }
        let end = self.close("endif", "IF", opened_at);
        Ok(StatementKind::If { branches, end })
    }

    /// `label`, `goto label` or `gosub label` after THEN.
    fn jump_on_this_line(&mut self) -> Parse<Option<Statement>> {
        let start = self.span();
        let kind = if self.skip_word("goto") {
            StatementKind::Goto(self.label_name()?)
        } else if self.skip_word("gosub") {
            self.gosub()?
        } else if *self.kind() == TokenKind::Word
            && matches!(self.peek(1), TokenKind::Newline | TokenKind::End)
        {
            if crate::mcl::words::is_reserved(self.word_here().unwrap_or("")) {
                return Ok(None);
            }
            StatementKind::Goto(self.label_name()?)
        } else {
            return Ok(None);
        };
        Ok(Some(Statement { kind, span: start.to(self.span_before()) }))
    }

    pub(super) fn for_statement(&mut self) -> Parse<StatementKind> {
        let opened_at = self.span_before();
        let variable = self.variable_place()?;
        self.expect_sign("=", "after the variable")?;
        let start = self.expression()?;
        if !self.skip_word("to") {
            let found = self.found_here();
            let message = format!("TO should follow the first value, but there is {found}.");
            return self.fail(codes::UNEXPECTED, message, None);
        }
        let finish = self.expression()?;
        let step = if self.skip_word("step") { Some(self.expression()?) } else { None };
        let body = self.body(&["next"])?;
        let end = self.close("next", "FOR", opened_at);
        Ok(StatementKind::For(Box::new(For { variable, start, finish, step, body, end })))
    }

    pub(super) fn while_statement(&mut self) -> Parse<StatementKind> {
        let opened_at = self.span_before();
        if self.open.iter().any(|ends| ends.contains(&"while")) {
            let message = "This WHILE stands inside a DO; it is taken for a loop of its own.".to_owned();
            let hint = Some("The manual advises against it: use REPEAT for one of the two.".to_owned());
            self.report(codes::NESTED_WHILE, opened_at, message, hint);
        }
        let condition = Box::new(self.expression()?);
        let body = self.body(&["wend"])?;
        let end = self.close("wend", "WHILE", opened_at);
        Ok(StatementKind::While { condition, body, end })
    }

    pub(super) fn do_statement(&mut self) -> Parse<StatementKind> {
        self.repeated("while", &["while"], "DO", false)
    }

    pub(super) fn repeat_statement(&mut self) -> Parse<StatementKind> {
        self.repeated("until", &["until"], "REPEAT", true)
    }

    fn repeated(
        &mut self,
        word: &str,
        ends: &'static [&'static str],
        opener: &str,
        until: bool,
    ) -> Parse<StatementKind> {
        let opened_at = self.span_before();
        let body = self.body(ends)?;
        let is_closed = self.is_word(word);
        self.close(word, opener, opened_at);
        if !is_closed {
            return Err(super::Broken);
        }
        let condition = Box::new(self.expression()?);
        Ok(StatementKind::Repeat { body, condition, until })
    }
}

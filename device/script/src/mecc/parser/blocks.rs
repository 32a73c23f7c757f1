//! Where blocks end, and the statements in them.

use super::block::{Block, Closer, ENDS};
use super::{Broken, MOST_STATEMENTS, Parse, Parser};
use crate::mecc::ast::Statement;
use crate::mecc::codes;
use crate::text::Span;

impl Parser<'_> {
    /// What the words here end, if they end anything.
    pub fn closer(&self) -> Option<Closer> {
        let second = || self.word_next();
        match self.word_here()?.as_str() {
            "until" => Some(Closer::Until),
            "else" => Some(Closer::Else),
            "case" => Some(Closer::Case),
            "end" => {
                let second = second()?;
                let found = ENDS.iter().find(|(word, _)| *word == second)?;
                Some(Closer::EndOf(found.1))
            }
            "begin" => Some(Closer::Routine),
            "declare" => matches!(second()?.as_str(), "function" | "eventhandler").then_some(Closer::Routine),
            _ => None,
        }
    }

    /// Statements up to what ends this block or one around it.
    pub fn statements(&mut self, block: Block) -> Vec<Statement> {
        let mut statements = Vec::new();
        self.open.push(block);
        loop {
            self.skip_newlines();
            if self.is_end() {
                break;
            }
            if let Some(closer) = self.closer() {
                if self.open.iter().any(|open| open.takes(closer)) {
                    break;
                }
                self.ends_nothing();
                continue;
            }
            self.count += 1;
            if self.count > MOST_STATEMENTS {
                self.give_up();
                break;
            }
            let before = self.at;
            match self.statement() {
                Ok(statement) => {
                    statements.push(statement);
                    self.end_of_statement();
                }
                Err(Broken) => self.skip_line(),
            }
            if self.at == before {
                self.advance();
            }
        }
        self.open.pop();
        statements
    }

    /// The program has too many statements: the rest is not read.
    pub fn give_up(&mut self) {
        let message = format!("A program has at most {MOST_STATEMENTS} statements; this is one more.");
        self.report(codes::TOO_LARGE, self.span(), message, Some("Make it shorter.".to_owned()));
        self.at = self.tokens.len() - 1;
    }

    /// The end of a block that was not begun.
    pub fn ends_nothing(&mut self) {
        if self.parted.contains(&self.span().start) {
            return self.skip_line();
        }
        let words = match self.word_next() {
            Some(_) if self.is_word("end") => {
                let second = self.word_at(self.at + 1).unwrap_or_default();
                format!("{} {second}", self.word_at(self.at).unwrap_or_default())
            }
            _ => self.word_at(self.at).unwrap_or_default().to_owned(),
        };
        let message = format!("`{words}` ends nothing: no block is open that it could belong to.");
        self.report(
            codes::NO_BLOCK_START,
            self.span(),
            message,
            Some("Take it out, or begin the block.".to_owned()),
        );
        self.skip_line();
    }

    /// Takes the `End` of a block, or says that it is missing; `head` is where the block begins.
    pub fn end_of_block(&mut self, block: Block, head: Span) {
        if self.closer() == Some(Closer::EndOf(block)) {
            self.advance();
            self.advance();
            return;
        }
        self.no_end(block, head);
    }

    pub fn no_end(&mut self, block: Block, head: Span) {
        let (what, end) = block.words();
        let message = format!("{what} has no {}.", end.split(" condition").next().unwrap_or(end));
        self.report(codes::NO_BLOCK_END, head, message, Some(format!("Write {end} where it ends.")));
    }

    /// The statements of a block and its end, one level deeper.
    pub fn block(&mut self, block: Block, head: Span) -> Parse<Vec<Statement>> {
        self.end_of_statement();
        self.deeper(|parser| {
            let body = parser.statements(block);
            parser.end_of_block(block, head);
            Ok(body)
        })
    }
}

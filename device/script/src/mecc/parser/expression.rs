//! Expressions and conditions.

use super::{Parse, Parser};
use crate::board::Board;
use crate::mcl::ast::Binary;
use crate::mecc::ast::{Expr, ExprKind, Link};
use crate::mecc::lexer::{TokenKind, text_bytes};
use crate::mecc::{codes, words};

/// Operators of each rank, as they are written; what binds tightest comes first. `Not` stands between the comparisons and `And`.
const RANKS: [&[(&str, Binary)]; 5] = [
    &[("*", Binary::Multiply), ("/", Binary::Divide), ("mod", Binary::Remainder)],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[
        ("=", Binary::Equal),
        ("<>", Binary::NotEqual),
        ("<", Binary::Less),
        (">", Binary::Greater),
        ("<=", Binary::LessOrEqual),
        (">=", Binary::GreaterOrEqual),
    ],
    &[("and", Binary::And)],
    &[("or", Binary::Or)],
];
const COMPARISONS: usize = 2;

impl Parser<'_> {
    pub fn expression(&mut self) -> Parse<Expr> {
        self.rank(RANKS.len() - 1)
    }

    fn operator(&mut self, rank: usize) -> Option<Binary> {
        let here = self.span().of(self.text);
        let found = match self.kind() {
            TokenKind::Sign(_) => RANKS[rank].iter().find(|(sign, _)| *sign == here),
            TokenKind::Word => RANKS[rank].iter().find(|(word, _)| word.eq_ignore_ascii_case(here)),
            TokenKind::Number(_)
            | TokenKind::Text
            | TokenKind::Comment
            | TokenKind::Newline
            | TokenKind::End => None,
        };
        let operator = found.map(|(_, operator)| *operator);
        if operator.is_some() {
            self.advance();
        }
        operator
    }

    fn rank(&mut self, rank: usize) -> Parse<Expr> {
        let below = |parser: &mut Self| match rank {
            0 => parser.operand(),
            rank if rank == COMPARISONS + 1 => parser.negated(),
            rank => parser.rank(rank - 1),
        };
        let first = below(self)?;
        let mut links = Vec::new();
        while let Some(operator) = self.operator(rank) {
            let right = below(self)?;
            links.push(Link { operator, right });
        }
        let Some(last) = links.last() else { return Ok(first) };
        let span = first.span.to(last.right.span);
        if rank == COMPARISONS && links.len() > 1 {
            let hint = "Join two comparisons with And.".to_owned();
            self.report(codes::UNEXPECTED, span, "One comparison has two sides.".to_owned(), Some(hint));
        }
        Ok(Expr { kind: ExprKind::Chain(Box::new(first), links), span })
    }

    /// `Not` before a comparison.
    fn negated(&mut self) -> Parse<Expr> {
        let head = self.span();
        if !self.skip_word("not") {
            return self.rank(COMPARISONS);
        }
        let inner = self.deeper(Self::negated)?;
        let span = head.to(inner.span);
        Ok(Expr { kind: ExprKind::Not(Box::new(inner)), span })
    }

    fn operand(&mut self) -> Parse<Expr> {
        let span = self.span();
        let plain = |kind| Ok(Expr { kind, span });
        match self.kind() {
            TokenKind::Number(value) => {
                self.advance();
                plain(ExprKind::Number(value))
            }
            TokenKind::Text => {
                let bytes = text_bytes(span.of(self.text));
                let [byte] = bytes[..] else {
                    let message = format!("One character is wanted here; this text has {}.", bytes.len());
                    let hint = "A longer text stands in a DataTable.".to_owned();
                    return self.fail(codes::LONG_TEXT, message, Some(hint));
                };
                self.advance();
                plain(ExprKind::Number(byte.into()))
            }
            TokenKind::Sign("-") => {
                self.advance();
                let inner = self.deeper(Self::operand)?;
                let span = span.to(inner.span);
                Ok(Expr { kind: ExprKind::Negative(Box::new(inner)), span })
            }
            TokenKind::Sign("(") => {
                self.advance();
                let inner = self.deeper(Self::expression)?;
                self.expect_sign(")", "behind the value", "")?;
                Ok(inner)
            }
            TokenKind::Word => self.word_operand(),
            TokenKind::Sign(_) | TokenKind::Comment | TokenKind::Newline | TokenKind::End => {
                let found = self.found_here();
                let message = format!("A value should stand here, but there is {found}.");
                let is_comparison = ["=", "<", ">"].into_iter().any(|sign| self.is_sign(sign));
                let hint = if self.is_sign("=") && self.is_behind("=") {
                    "One = compares."
                } else if is_comparison && self.is_behind_comparison() {
                    "Comparisons are written =, <>, <, >, <= and >=."
                } else {
                    "A value is a number, one character in quotes, a variable or a function."
                };
                let hint = hint.to_owned();
                self.fail(codes::UNEXPECTED, message, Some(hint))
            }
        }
    }

    /// Whether this sign stands before what is read now.
    fn is_behind(&self, sign: &str) -> bool {
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        before.is_some_and(|token| matches!(token.kind, TokenKind::Sign(here) if here == sign))
    }

    fn is_behind_comparison(&self) -> bool {
        RANKS[COMPARISONS].iter().any(|(sign, _)| self.is_behind(sign))
    }

    fn word_operand(&mut self) -> Parse<Expr> {
        let span = self.span();
        let word = self.word_here().unwrap_or_default();
        if let Some(command) = words::command(&word).filter(|command: &Board| command.gives()) {
            self.advance();
            let arguments = self.deeper(|parser| parser.board_value(command))?;
            let span = span.to(self.span_before());
            return Ok(Expr { kind: ExprKind::Board(command, arguments), span });
        }
        self.form_unknown(&word)?;
        match word.as_str() {
            "readdata" => {
                self.advance();
                self.expect_sign("(", "behind ReadData", words::syntax("ReadData"))?;
                let pointer = self.name("a DataPointer")?;
                self.expect_sign(")", "behind the pointer", words::syntax("ReadData"))?;
                Ok(Expr { kind: ExprKind::ReadData(pointer), span: span.to(self.span_before()) })
            }
            "setpointer" => {
                self.advance();
                self.expect_sign("(", "behind SetPointer", words::syntax("SetPointer"))?;
                let table = self.name("a table")?;
                self.expect_sign(")", "behind the table", words::syntax("SetPointer"))?;
                Ok(Expr { kind: ExprKind::Address(table), span: span.to(self.span_before()) })
            }
            _ => {
                let name = self.name("a variable")?;
                if !self.is_sign("(") {
                    return Ok(Expr { kind: ExprKind::Name(name), span });
                }
                let arguments = self.deeper(|parser| parser.in_parentheses(""))?;
                Ok(Expr { kind: ExprKind::Call(name, arguments), span: span.to(self.span_before()) })
            }
        }
    }
}

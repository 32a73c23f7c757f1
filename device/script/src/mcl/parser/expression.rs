//! Expressions, by the precedence of MCP manual 3.2.5: from left to right, unary operators first.

use super::{DEEPEST, Parse, Parser};
use crate::mcl::ast::{Binary, Expr, ExprKind, Link, Name, Place, Unary};
use crate::mcl::codes;
use crate::mcl::lexer::TokenKind;
use crate::mcl::words;
use crate::text::Span;

impl Parser<'_> {
    /// A whole expression. Left operands wait in a list for their right ones, each with an operator that binds tighter than the one before:
    /// the list is no longer than there are orders, and no operator takes room on the stack of whoever calls this.
    pub(super) fn expression(&mut self) -> Parse<Expr> {
        let mut waiting: Vec<(Expr, Binary)> = Vec::new();
        let mut value = self.unary()?;
        loop {
            let next = self.operator();
            let is_done = |operator: Binary| next.is_none_or(|next| operator.order() <= next.order());
            while let Some((left, operator)) = waiting.pop_if(|(_, operator)| is_done(*operator)) {
                value = joined(left, operator, value);
            }
            let Some(operator) = next else { return Ok(value) };
            self.advance();
            waiting.push((value, operator));
            value = self.unary()?;
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn operator(&self) -> Option<Binary> {
        match self.kind() {
            TokenKind::Sign(sign) => Binary::of_name(sign),
            TokenKind::Word => self.word_here().and_then(Binary::of_name),
            _ => None,
        }
    }

    /// A value with the operators before it.
    fn unary(&mut self) -> Parse<Expr> {
        let mut operators = Vec::new();
        while let Some(operator) = self.unary_operator() {
            operators.push((operator, self.span()));
            if self.depth + operators.len() > DEEPEST {
                return self.too_deep();
            }
            self.advance();
        }
        self.depth += operators.len();
        let operand = self.primary();
        self.depth -= operators.len();
        let around = |operand: Expr, (operator, start): (Unary, Span)| {
            let span = start.to(operand.span);
            Expr { kind: ExprKind::Unary(operator, Box::new(operand)), span }
        };
        Ok(operators.into_iter().rev().fold(operand?, around))
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn unary_operator(&self) -> Option<Unary> {
        match self.kind() {
            TokenKind::Sign("-") => Some(Unary::Negative),
            TokenKind::Sign("~" | "!") => Some(Unary::BitNot),
            TokenKind::Word => self.word_here().and_then(Unary::of_word),
            _ => None,
        }
    }

    fn primary(&mut self) -> Parse<Expr> {
        let span = self.span();
        let kind = match self.kind().clone() {
            TokenKind::Integer(value) => ExprKind::Integer(value),
            TokenKind::Float(value) => ExprKind::Float(value),
            TokenKind::Text(bytes) => ExprKind::Text(bytes),
            TokenKind::Sign("(") => {
                self.advance();
                let inner = self.deeper(Self::expression)?;
                self.expect_sign(")", "at the end of what is in parentheses")?;
                let span = span.to(self.span_before());
                return Ok(Expr { kind: ExprKind::Group(Box::new(inner)), span });
            }
            TokenKind::Word => {
                let place = self.place("A value")?;
                return Ok(Expr { span: place.span, kind: ExprKind::Place(place) });
            }
            TokenKind::Directive(_) | TokenKind::Sign(_) | TokenKind::Newline | TokenKind::End => {
                let found = self.found_here();
                return self.fail(
                    codes::UNEXPECTED,
                    format!("A value should stand here, but there is {found}."),
                    None,
                );
            }
        };
        self.advance();
        Ok(Expr { kind, span })
    }

    /// A variable, register, table or constant with its index and modifier.
    pub(super) fn place(&mut self, what: &str) -> Parse<Place> {
        let name = self.place_name(what)?;
        let mut span = name.span;
        let mut index = None;
        if self.skip_sign("(") {
            index = Some(Box::new(self.deeper(Self::expression)?));
            self.expect_sign(")", "after the index")?;
            span = span.to(self.span_before());
        }
        let mut modifier = None;
        if self.skip_sign(".") {
            let Some(word) = self.word_here() else {
                let found = self.found_here();
                let message = format!("A modifier should follow the point, but there is {found}.");
                return self.fail(
                    codes::UNEXPECTED,
                    message,
                    Some("For example: .byte0, .highword, .bit3".into()),
                );
            };
            let part = self.any_name(word);
            span = span.to(part.span);
            modifier = Some(Box::new(part));
        }
        Ok(Place { name, index, modifier, span })
    }

    /// A name that may be a system register.
    fn place_name(&mut self, what: &str) -> Parse<Name> {
        if let Some(word) = self.word_here() {
            if words::CAN.iter().any(|can| can.eq_ignore_ascii_case(word)) {
                return self.no_public_syntax(word);
            }
            if words::register(word).is_some() {
                return Ok(self.any_name(word));
            }
        }
        self.name(what)
    }

    pub(super) fn no_public_syntax<T>(&mut self, word: &str) -> Parse<T> {
        let message = format!("`{word}` is a word for the CAN bus, but no syntax for it is public.");
        let hint = "CAN is stream 1 of GETS and PUTS.".to_owned();
        self.fail(codes::NO_PUBLIC_SYNTAX, message, Some(hint))
    }
}

/// An operator with its operands; operators of one order become one chain.
fn joined(mut left: Expr, operator: Binary, right: Expr) -> Expr {
    let span = left.span.to(right.span);
    let link = Link { operator, right };
    if left.kind.order() == Some(operator.order())
        && let ExprKind::Chain(_, links) = &mut left.kind
    {
        links.push(link);
        return Expr { kind: left.kind, span };
    }
    Expr { kind: ExprKind::Chain(Box::new(left), vec![link]), span }
}

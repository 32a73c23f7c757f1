//! Lists: arguments, labels, and what PUTS, GETS and array assignments take (MCP manual 3.3).

use super::{Parse, Parser};
use crate::diagnostic::excerpt;
use crate::mcl::ast::{Expr, ExprKind, Format, Item, Name, Place};
use crate::mcl::codes;
use crate::mcl::lexer::TokenKind;
use crate::mcl::words;

impl Parser<'_> {
    /// Expressions with commas between.
    pub(super) fn expressions(&mut self) -> Parse<Vec<Expr>> {
        let mut list = vec![self.expression()?];
        while self.skip_sign(",") {
            list.push(self.expression()?);
        }
        Ok(list)
    }

    /// `[one, two, ...]` of whatever `entry` reads.
    pub(super) fn bracketed<T>(
        &mut self,
        after: &str,
        mut entry: impl FnMut(&mut Self) -> Parse<T>,
    ) -> Parse<Vec<T>> {
        self.expect_sign("[", after)?;
        let mut list = Vec::new();
        if !self.is_sign("]") {
            list.push(entry(self)?);
            while self.skip_sign(",") {
                list.push(entry(self)?);
            }
        }
        self.expect_sign("]", "at the end of the list")?;
        Ok(list)
    }

    pub(super) fn label_name(&mut self) -> Parse<Name> {
        self.name("A label")
    }

    pub(super) fn variable_place(&mut self) -> Parse<Place> {
        self.place("A variable")
    }

    /// One entry of PUTS or of an array assignment.
    pub(super) fn output_item(&mut self) -> Parse<Item> {
        self.item(false)
    }

    /// One entry of GETS; `DEC(4) x` is another way to write `DEC4 x` there (MCP manual 3.3.2).
    pub(super) fn input_item(&mut self) -> Parse<Item> {
        self.item(true)
    }

    fn item(&mut self, input: bool) -> Parse<Item> {
        let start = self.span();
        let mut format = self.format();
        if format.is_some() {
            self.advance();
        }
        if let (true, Some((_, limit @ None))) = (input, &mut format) {
            *limit = self.parenthesised_limit();
        }
        let value = self.expression()?;
        let mut arguments = Vec::new();
        while self.skip_sign("\\") {
            arguments.push(self.expression()?);
        }
        if matches!(format, Some((Format::Rep, _))) && arguments.is_empty() && !self.ends_item() {
            // The manual's example has no backslash: REP "A" 10.
            arguments.push(self.expression()?);
        }
        Ok(Item { format, value, arguments, span: start.to(self.span_before()) })
    }

    /// The format named here, unless the word is something else, such as a variable.
    fn format(&mut self) -> Option<(Format, Option<u32>)> {
        let word = self.word_here()?;
        if let Some(format) = Format::of_word(word) {
            let follows = self.peek(1);
            let ends = matches!(follows, TokenKind::Sign("," | "]" | "=" | "." | "\\") | TokenKind::Newline);
            return (!ends).then_some(format);
        }
        let starts_value =
            matches!(self.peek(1), TokenKind::Word | TokenKind::Integer(_) | TokenKind::Text(_));
        let letters = word.trim_end_matches(|letter: char| letter.is_ascii_digit());
        if starts_value && crate::mcl::ast::Binary::of_name(self.word_at(self.at + 1).unwrap_or("")).is_none()
        {
            let is_other = words::OTHER_PRODUCT.iter().any(|other| other.eq_ignore_ascii_case(letters));
            let hint = match is_other {
                true => Some("Use DEC or HEX.".to_owned()),
                false => self.did_you_mean(letters, words::FORMATS.iter().map(|format| format.name)),
            };
            if crate::mcl::ast::Unary::of_word(word).is_none() {
                let message = format!("`{}` is no output modifier.", excerpt(word));
                self.report_here(codes::BAD_OUTPUT, message, hint);
                self.advance();
            }
        }
        None
    }

    fn parenthesised_limit(&mut self) -> Option<u32> {
        let (TokenKind::Sign("("), TokenKind::Integer(limit), TokenKind::Sign(")"), TokenKind::Word) =
            (self.kind(), self.peek(1), self.peek(2), self.peek(3))
        else {
            return None;
        };
        let limit = *limit;
        for _ in 0..3 {
            self.advance();
        }
        Some(limit)
    }

    fn ends_item(&self) -> bool {
        matches!(self.kind(), TokenKind::Sign("," | "]") | TokenKind::Newline | TokenKind::End)
    }

    /// The items of an assignment: several, texts and formats only make sense for arrays, which is looked at later.
    pub(super) fn assigned_items(&mut self) -> Parse<Vec<Item>> {
        let mut items = vec![self.output_item()?];
        while self.skip_sign(",") {
            items.push(self.output_item()?);
        }
        Ok(items)
    }

    /// A table's entries: values and texts.
    pub(super) fn table_values(&mut self) -> Parse<Vec<Expr>> {
        let values = self.expressions()?;
        let empty =
            values.iter().find(|value| matches!(&value.kind, ExprKind::Text(bytes) if bytes.is_empty()));
        if let Some(empty) = empty {
            let span = empty.span;
            self.report(codes::LONG_TEXT, span, "An empty text is no entry.".into(), None);
        }
        Ok(values)
    }
}

//! What the pieces of a line are, for colours. No text goes over the end of its line, so a line is enough to know.

use crate::mcl::lexer::{Token, TokenKind, tokens};
use crate::mcl::words::{self, Known};
use std::ops::Range;

/// What a piece of a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// A statement's word.
    Command,
    /// An operator, as a word or a sign.
    Operator,
    /// An output modifier such as DEC.
    Format,
    /// A type of a variable or table.
    Type,
    /// A modifier after a point.
    Modifier,
    /// A system register.
    Register,
    /// A name that the program gives.
    Name,
    /// A name that stands where a label does.
    Label,
    /// A number.
    Number,
    /// Characters between quotes.
    Text,
    /// From `;` to the end of the line.
    Comment,
    /// `#IF` and its kin.
    Directive,
    /// Parentheses, brackets, commas and the like.
    Punctuation,
    /// A word that is kept but cannot be used, or a character that means nothing.
    Wrong,
}

/// The pieces of a line (without its end) in their order; what lies between them is white space.
#[must_use]
pub fn classes(line: &str) -> Vec<(Range<usize>, Class)> {
    let (tokens, _) = tokens(line);
    let mut pieces = Vec::with_capacity(tokens.len() + 1);
    let mut at = 0;
    for (index, token) in tokens.iter().enumerate() {
        let range = token.span.start as usize..token.span.end as usize;
        gap(line, at..range.start, &mut pieces);
        at = range.end.max(at);
        if let Some(class) = class(line, &tokens, index) {
            pieces.push((range, class));
        }
    }
    pieces
}

/// What the lexer left out: comments and characters without a meaning.
fn gap(line: &str, range: Range<usize>, pieces: &mut Vec<(Range<usize>, Class)>) {
    let Some(text) = line.get(range.clone()) else { return };
    let comment = text.find(';').map_or(range.end, |found| range.start + found);
    let wrong = line[range.start..comment].trim();
    if !wrong.is_empty() {
        let start = range.start + line[range.start..comment].find(wrong).unwrap_or(0);
        pieces.push((start..start + wrong.len(), Class::Wrong));
    }
    if comment < range.end {
        pieces.push((comment..range.end, Class::Comment));
    }
}

fn class(line: &str, tokens: &[Token], index: usize) -> Option<Class> {
    let token = &tokens[index];
    Some(match &token.kind {
        TokenKind::Word => word_class(line, tokens, index),
        TokenKind::Integer(_) | TokenKind::Float(_) => Class::Number,
        TokenKind::Text(_) => Class::Text,
        TokenKind::Directive(_) => Class::Directive,
        TokenKind::Sign("(" | ")" | "[" | "]" | "," | "." | "\\" | ":") => Class::Punctuation,
        TokenKind::Sign(_) => Class::Operator,
        TokenKind::Newline | TokenKind::End => return None,
    })
}

fn word_class(line: &str, tokens: &[Token], index: usize) -> Class {
    let word = tokens[index].span.of(line);
    let before = index.checked_sub(1).map(|before| &tokens[before].kind);
    if before == Some(&TokenKind::Sign(".")) {
        return Class::Modifier;
    }
    match words::known(word) {
        Some(Known::Command(_)) => Class::Command,
        Some(Known::Operator(_)) => Class::Operator,
        Some(Known::Format(_)) => Class::Format,
        Some(Known::Type(_) | Known::Table(_)) => Class::Type,
        Some(Known::Register(_) | Known::Misspelt(_)) => Class::Register,
        Some(Known::Can | Known::OtherProduct) => Class::Wrong,
        None => name_class(line, tokens, index),
    }
}

fn name_class(line: &str, tokens: &[Token], index: usize) -> Class {
    let follows = tokens.get(index + 1).map(|token| &token.kind);
    let is_format = crate::mcl::ast::Format::of_word(tokens[index].span.of(line)).is_some();
    if is_format && !matches!(follows, Some(TokenKind::Sign("," | "]" | "=") | TokenKind::Newline)) {
        return Class::Format;
    }
    let before = index.checked_sub(1).map(|before| tokens[before].span.of(line).to_ascii_lowercase());
    let stands_alone =
        index == 0 && matches!(follows, Some(TokenKind::Newline | TokenKind::Sign("[" | ":")) | None);
    let is_jumped_to = matches!(before.as_deref(), Some("goto" | "gosub"));
    if stands_alone || is_jumped_to { Class::Label } else { Class::Name }
}

//! Tokens into a tree: recursive descent that goes on after an error at the next line. Blocks, statements and expressions stand in a file
//! each.

mod block;
mod blocks;
mod counted;
mod declare;
mod expression;
mod statement;

use super::ast::{Item, Name};
use super::codes;
use super::lexer::{Token, TokenKind, reported, tokens};
use super::words;
use crate::diagnostic::{Diagnostic, Diagnostics, excerpt};
use crate::mcl::words::did_you_mean;
use crate::program::limits;
use crate::text::Span;
use block::Block;
pub use counted::{are, values};
use std::collections::HashSet;
use std::sync::Arc;

/// How deep blocks, parentheses and operators before a value may be nested, all together; as in MCL, and for the same reason.
const DEEPEST: usize = 100;

/// Statements of a program; each makes an instruction or a name.
const MOST_STATEMENTS: usize = limits::INSTRUCTIONS + limits::NAMES;

/// Unknown words for which the nearest known one is looked for.
const MOST_GUESSES: u32 = 100;

/// A program as it was read.
#[derive(Clone, Debug, Default)]
pub struct Parsed {
    /// What stands in it, in order.
    pub items: Vec<Item>,
    /// What is wrong with it so far.
    pub diagnostics: Diagnostics,
}

/// Reads a program.
#[must_use]
pub fn parse(text: &str) -> Parsed {
    let (mut tokens, wrong) = tokens(text);
    tokens.retain(|token| token.kind != TokenKind::Comment);
    let joined = part_joined(&mut tokens, text);
    let mut parser = Parser {
        text,
        tokens,
        at: 0,
        diagnostics: Diagnostics::default(),
        depth: 0,
        open: Vec::new(),
        names: HashSet::new(),
        count: 0,
        guesses: 0,
        table_bytes: 0,
        parted: HashSet::new(),
    };
    for (both, span) in joined {
        let typed = excerpt(span.of(text));
        let hint = format!("It is two words: {both}");
        parser.report(codes::UNKNOWN_COMMAND, span, format!("`{typed}` is no command."), Some(hint));
        parser.parted.insert(span.start);
    }
    let items = parser.items();
    let mut diagnostics = parser.diagnostics;
    for wrong in wrong {
        diagnostics.note(wrong.span.start, wrong.code, || reported(wrong, text));
    }
    Parsed { items, diagnostics }
}

/// The two words that one stands for, and where it stands.
type Joined = (&'static str, Span);

/// Reads `EndIf`, alone in its line, as the two words that were meant, so that the block ends there and one mistake is told once.
fn part_joined(tokens: &mut Vec<Token>, text: &str) -> Vec<Joined> {
    let (mut parted, mut found, mut begins_line) = (Vec::with_capacity(tokens.len()), Vec::new(), true);
    for (index, token) in tokens.iter().enumerate() {
        let ends_line = tokens
            .get(index + 1)
            .is_some_and(|next| matches!(next.kind, TokenKind::Newline | TokenKind::End));
        // With `BeginProgram` and the ends of blocks nothing else stands in a line.
        let place = (token.kind == TokenKind::Word && begins_line && ends_line)
            .then(|| words::joined(token.span.of(text)))
            .flatten();
        begins_line = token.kind == TokenKind::Newline;
        let Some((both, place)) = place else {
            parted.push(*token);
            continue;
        };
        let middle = token.span.start + place as u32;
        let halves =
            [Span { start: token.span.start, end: middle }, Span { start: middle, end: token.span.end }];
        parted.extend(halves.map(|span| Token { span, ..*token }));
        found.push((both, token.span));
    }
    *tokens = parted;
    found
}

/// A parse that cannot go on in this line; what is wrong has been reported.
#[derive(Debug)]
struct Broken;

type Parse<T> = Result<T, Broken>;

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    diagnostics: Diagnostics,
    depth: usize,
    /// Open blocks, the routine outermost.
    open: Vec<Block>,
    /// Every name in small letters, once.
    names: HashSet<Arc<str>>,
    /// Statements so far.
    count: usize,
    /// How often a word was looked for that might have been meant.
    guesses: u32,
    /// Bytes of tables so far.
    table_bytes: usize,
    /// Where words stand that were read as two: that was told.
    parted: HashSet<u32>,
}

impl<'a> Parser<'a> {
    fn token(&self) -> Token {
        // The list ends with a token of its own, and `advance` stops there.
        self.tokens[self.at.min(self.tokens.len() - 1)]
    }

    fn kind(&self) -> TokenKind {
        self.token().kind
    }

    fn span(&self) -> Span {
        self.token().span
    }

    fn span_before(&self) -> Span {
        self.tokens[self.at.saturating_sub(1)].span
    }

    fn advance(&mut self) {
        if self.at + 1 < self.tokens.len() {
            self.at += 1;
        }
    }

    fn is_end(&self) -> bool {
        self.kind() == TokenKind::End
    }

    fn at_newline(&self) -> bool {
        self.kind() == TokenKind::Newline
    }

    fn skip_newlines(&mut self) {
        while self.at_newline() {
            self.advance();
        }
    }

    fn skip_line(&mut self) {
        while !self.at_newline() && !self.is_end() {
            self.advance();
        }
    }

    fn is_sign(&self, sign: &str) -> bool {
        matches!(self.kind(), TokenKind::Sign(here) if here == sign)
    }

    fn skip_sign(&mut self, sign: &str) -> bool {
        let is = self.is_sign(sign);
        if is {
            self.advance();
        }
        is
    }

    fn expect_sign(&mut self, sign: &str, after: &str, syntax: &str) -> Parse<()> {
        if self.skip_sign(sign) {
            return Ok(());
        }
        let found = self.found_here();
        self.fail(
            codes::UNEXPECTED,
            format!("`{sign}` should stand {after}, but there is {found}."),
            written(syntax),
        )
    }

    fn word_at(&self, index: usize) -> Option<&'a str> {
        let token = self.tokens.get(index)?;
        (token.kind == TokenKind::Word).then(|| token.span.of(self.text))
    }

    /// The word here in small letters; a name that is too long is none of the language's.
    fn word_here(&self) -> Option<String> {
        self.small(self.at)
    }

    fn word_next(&self) -> Option<String> {
        self.small(self.at + 1)
    }

    fn small(&self, index: usize) -> Option<String> {
        self.word_at(index)
            .map(|word| if word.len() <= 64 { word.to_ascii_lowercase() } else { "_".to_owned() })
    }

    fn is_word(&self, word: &str) -> bool {
        self.word_at(self.at).is_some_and(|here| here.eq_ignore_ascii_case(word))
    }

    fn skip_word(&mut self, word: &str) -> bool {
        let is = self.is_word(word);
        if is {
            self.advance();
        }
        is
    }

    fn expect_word(&mut self, word: &str, after: &str, syntax: &str) -> Parse<()> {
        if self.skip_word(word) {
            return Ok(());
        }
        let found = self.found_here();
        self.fail(
            codes::UNEXPECTED,
            format!("`{word}` should stand {after}, but there is {found}."),
            written(syntax),
        )
    }

    /// A name that is no word of the language.
    fn name(&mut self, what: &str) -> Parse<Name> {
        let Some(word) = self.word_at(self.at) else {
            let found = self.found_here();
            return self.fail(
                codes::UNEXPECTED,
                format!("The name of {what} should stand here, but there is {found}."),
                Some("A name begins with a letter and goes on with letters, digits and _.".to_owned()),
            );
        };
        let small = word.to_ascii_lowercase();
        if words::is_reserved(&small) {
            return self.fail(
                codes::RESERVED_WORD,
                format!("`{word}` is a word of the language and cannot be the name of {what}."),
                Some("Take another name.".to_owned()),
            );
        }
        let name = Name { key: self.key(small), span: self.span() };
        self.advance();
        Ok(name)
    }

    /// A word in small letters, which all places of it share.
    fn key(&mut self, small: String) -> Arc<str> {
        if let Some(known) = self.names.get(small.as_str()) {
            return known.clone();
        }
        let key: Arc<str> = small.into();
        self.names.insert(key.clone());
        key
    }

    /// What stands here, for messages.
    fn found_here(&self) -> String {
        match self.kind() {
            TokenKind::Newline => "the end of the line".to_owned(),
            TokenKind::End => "the end of the text".to_owned(),
            TokenKind::Word
            | TokenKind::Number(_)
            | TokenKind::Text
            | TokenKind::Sign(_)
            | TokenKind::Comment => format!("`{}`", excerpt(self.span().of(self.text))),
        }
    }

    fn end_of_statement(&mut self) {
        // What ends an outer block begins a line of its own: that its inner one has no end has been said.
        let begins_line = self.tokens[self.at.saturating_sub(1)].kind == TokenKind::Newline;
        if self.at_newline() || self.is_end() || begins_line && self.closer().is_some() {
            return;
        }
        let found = self.found_here();
        let hint = Some("One statement stands in a line; a comment begins with a semicolon.".to_owned());
        self.report(
            codes::UNEXPECTED,
            self.span(),
            format!("The line should end here, but there is {found}."),
            hint,
        );
        self.skip_line();
    }

    fn report(&mut self, code: &'static str, span: Span, message: String, hint: Option<String>) {
        // What would be missing of a program that is not read to its end is not missing.
        if self.count <= MOST_STATEMENTS || code == codes::TOO_LARGE {
            self.diagnostics.push(Diagnostic { code, span, message, hint });
        }
    }

    fn fail<T>(&mut self, code: &'static str, message: String, hint: Option<String>) -> Parse<T> {
        self.report(code, self.span(), message, hint);
        Err(Broken)
    }

    /// Goes one level deeper for `inner`.
    fn deeper<T>(&mut self, inner: impl FnOnce(&mut Self) -> Parse<T>) -> Parse<T> {
        if self.depth >= DEEPEST {
            let message = format!("This is nested more than {DEEPEST} levels deep.");
            let hint = "Put what is inside into a function, or into a variable.".to_owned();
            return self.fail(codes::TOO_DEEP, message, Some(hint));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    /// The hint at a word that was meant. A text with more mistakes than a person reads is searched for the first of them alone.
    fn meant(&mut self, typed: &str) -> Option<String> {
        self.guesses += 1;
        (self.guesses <= MOST_GUESSES).then(|| did_you_mean(typed, words::all())).flatten()
    }
}

/// The hint that shows how a statement is written.
fn written(syntax: &str) -> Option<String> {
    (!syntax.is_empty()).then(|| format!("It is written: {syntax}"))
}

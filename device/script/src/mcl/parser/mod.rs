//! Tokens into a tree: recursive descent that goes on after an error at the next line.
//!
//! Compile-time directives are obeyed here, since what they leave out need not even be a program. Read
//! [`Parser::statements`] first; expressions, single statements and blocks stand in a file each.

mod blocks;
mod directive;
mod expression;
mod list;
mod statement;
mod whiles;

use super::ast::{Name, Statement};
use super::codes;
use super::constant::Constant;
use super::lexer::{Token, TokenKind, reported, tokens};
use super::words;
use crate::diagnostic::{Diagnostic, Diagnostics, excerpt};
use crate::program::limits;
use crate::text::Span;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// How deep blocks, parentheses and operators before a value may be nested, all together. The tree is walked by functions that call themselves
/// so often and no oftener, whatever the length of the text: a test compiles the deepest programs on a stack of 512 KiB. C promises a
/// programmer 127 levels of blocks and 63 of parentheses (ISO/IEC 9899:2011, 5.2.4.1).
const DEEPEST: usize = 100;

/// Statements of a program. Each makes an instruction or a name, so that one with more of them cannot fit.
const MOST_STATEMENTS: usize = limits::INSTRUCTIONS + limits::NAMES;

/// A program as it was read.
#[derive(Clone, Debug, Default)]
pub struct Parsed {
    /// Its statements.
    pub statements: Vec<Statement>,
    /// What is wrong with it so far.
    pub diagnostics: Diagnostics,
    /// What compile-time directives left out.
    pub left_out: Vec<Span>,
}

/// Reads a program.
#[must_use]
pub fn parse(text: &str) -> Parsed {
    let (tokens, wrong) = tokens(text);
    let heads = whiles::heads(text, &tokens);
    let mut parser = Parser {
        text,
        tokens,
        at: 0,
        diagnostics: Diagnostics::default(),
        depth: 0,
        open: Vec::new(),
        heads,
        conditions: Vec::new(),
        left_out: Vec::new(),
        names: HashSet::new(),
        constants: HashMap::new(),
        defined: HashSet::new(),
        count: 0,
        guesses: 0,
    };
    let statements = parser.statements(&[]);
    parser.close_conditions();
    let Parser { mut diagnostics, left_out, .. } = parser;
    // What is left out need not even consist of words: an apostrophe in prose is no open text. The parts stand in their order.
    let counts = |span: Span| {
        let part = left_out.partition_point(|part| part.start <= span.start).checked_sub(1);
        part.is_none_or(|part| !left_out[part].contains(span))
    };
    for wrong in wrong.into_iter().filter(|wrong| counts(wrong.span)) {
        diagnostics.note(wrong.span.start, wrong.code, || reported(wrong, text));
    }
    Parsed { statements, diagnostics, left_out }
}

/// A parse that cannot go on in this line; what is wrong has been reported.
#[derive(Debug)]
struct Broken;

type Parse<T> = Result<T, Broken>;

pub use whiles::heads as while_heads;

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    diagnostics: Diagnostics,
    depth: usize,
    /// The words that end each open block, outermost first.
    open: Vec<&'static [&'static str]>,
    /// Where the WHILEs stand that begin a loop, as indices of tokens.
    heads: BTreeSet<usize>,
    /// Open #IFs: where they stand.
    conditions: Vec<Span>,
    left_out: Vec<Span>,
    /// Every name in small letters, once.
    names: HashSet<Arc<str>>,
    /// Constants defined so far, for #IF.
    constants: HashMap<Arc<str>, Constant>,
    /// Everything defined so far, for #IFDEF.
    defined: HashSet<Arc<str>>,
    /// Statements so far.
    count: usize,
    /// How often a word was looked for that might have been meant.
    guesses: u32,
}

/// Unknown words for which the nearest known one is looked for.
const MOST_GUESSES: u32 = 100;

/// Words that end a block.
const CLOSERS: [&str; 6] = ["endif", "else", "elseif", "next", "wend", "until"];

impl<'a> Parser<'a> {
    /// Statements up to one of the words `ends`, to the end of the program, or to a word that ends an outer block.
    fn statements(&mut self, ends: &'static [&'static str]) -> Vec<Statement> {
        let mut statements = Vec::new();
        self.open.push(ends);
        loop {
            self.skip_newlines();
            if self.is_end() || self.is_closed() {
                break;
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
    fn give_up(&mut self) {
        let message = format!("A program has at most {MOST_STATEMENTS} statements; this is one more.");
        self.report_here(codes::TOO_LARGE, message, None);
        self.at = self.tokens.len() - 1;
    }

    /// Whether the word here ends this block or one around it.
    fn is_closed(&self) -> bool {
        let Some(word) = self.word_here() else { return false };
        if word.eq_ignore_ascii_case("while") {
            return !self.heads.contains(&self.at) && self.open.iter().any(|ends| ends.contains(&"while"));
        }
        self.open.iter().any(|ends| ends.iter().any(|end| end.eq_ignore_ascii_case(word)))
    }

    fn end_of_statement(&mut self) {
        if self.skip_sign(":")
            || self.at_newline()
            || self.is_end()
            || self.is_directive()
            || self.is_closed()
        {
            return;
        }
        let found = self.found_here();
        let before = self.span_before().of(self.text);
        let hint = before.eq_ignore_ascii_case("next").then(|| "NEXT takes no variable.".to_owned());
        self.report_here(codes::UNEXPECTED, format!("The line should end here, but there is {found}."), hint);
        self.skip_line();
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn skip_newlines(&mut self) {
        loop {
            match self.kind() {
                TokenKind::Newline => self.advance(),
                TokenKind::Directive(_) => self.directive(),
                TokenKind::Sign(":") => self.advance(),
                _ => return,
            }
        }
    }

    fn skip_line(&mut self) {
        while !self.at_newline() && !self.is_end() {
            self.advance();
        }
    }

    // ----- tokens

    fn token(&self) -> &Token {
        // The list ends with a token of its own, and `advance` stops there.
        &self.tokens[self.at.min(self.tokens.len() - 1)]
    }

    fn kind(&self) -> &TokenKind {
        &self.token().kind
    }

    fn span(&self) -> Span {
        self.token().span
    }

    /// The span of the token before this one.
    fn span_before(&self) -> Span {
        self.tokens[self.at.saturating_sub(1)].span
    }

    fn peek(&self, ahead: usize) -> &TokenKind {
        &self.tokens[(self.at + ahead).min(self.tokens.len() - 1)].kind
    }

    fn advance(&mut self) {
        if self.at + 1 < self.tokens.len() {
            self.at += 1;
        }
    }

    fn is_end(&self) -> bool {
        *self.kind() == TokenKind::End
    }

    fn at_newline(&self) -> bool {
        *self.kind() == TokenKind::Newline
    }

    fn is_directive(&self) -> bool {
        matches!(self.kind(), TokenKind::Directive(_))
    }

    fn is_sign(&self, sign: &str) -> bool {
        matches!(self.kind(), TokenKind::Sign(here) if *here == sign)
    }

    fn skip_sign(&mut self, sign: &str) -> bool {
        let is = self.is_sign(sign);
        if is {
            self.advance();
        }
        is
    }

    fn expect_sign(&mut self, sign: &str, after: &str) -> Parse<()> {
        if self.skip_sign(sign) {
            return Ok(());
        }
        let found = self.found_here();
        self.fail(codes::UNEXPECTED, format!("`{sign}` should stand {after}, but there is {found}."), None)
    }

    fn word_at(&self, index: usize) -> Option<&'a str> {
        let token = self.tokens.get(index)?;
        (token.kind == TokenKind::Word).then(|| token.span.of(self.text))
    }

    fn word_here(&self) -> Option<&'a str> {
        self.word_at(self.at)
    }

    fn is_word(&self, word: &str) -> bool {
        self.word_here().is_some_and(|here| here.eq_ignore_ascii_case(word))
    }

    fn skip_word(&mut self, word: &str) -> bool {
        let is = self.is_word(word);
        if is {
            self.advance();
        }
        is
    }

    /// A name that is no word of the language.
    fn name(&mut self, what: &str) -> Parse<Name> {
        let Some(word) = self.word_here() else {
            let found = self.found_here();
            return self.fail(
                codes::UNEXPECTED,
                format!("{what} should stand here, but there is {found}."),
                None,
            );
        };
        if words::is_reserved(word) {
            let message =
                format!("`{word}` is a word of the language and cannot be {}.", what.to_lowercase());
            return self.fail(codes::RESERVED_WORD, message, None);
        }
        Ok(self.any_name(word))
    }

    fn any_name(&mut self, word: &str) -> Name {
        let span = self.span();
        self.advance();
        Name { key: self.key(word), span }
    }

    /// A word in small letters, which all places of it share.
    fn key(&mut self, word: &str) -> Arc<str> {
        let small = word.to_ascii_lowercase();
        if let Some(known) = self.names.get(small.as_str()) {
            return known.clone();
        }
        let key: Arc<str> = small.into();
        self.names.insert(key.clone());
        key
    }

    /// What stands here, for messages.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn found_here(&self) -> String {
        match self.kind() {
            TokenKind::Newline => "the end of the line".to_owned(),
            TokenKind::End => "the end of the program".to_owned(),
            _ => format!("`{}`", excerpt(self.span().of(self.text))),
        }
    }

    // ----- reports

    /// Whether the text before this was not closed: that has been said, and what is missing after it stands in it.
    fn follows_open_text(&self) -> bool {
        let before = &self.tokens[self.at.saturating_sub(1)];
        let shown = before.span.of(self.text);
        matches!(before.kind, TokenKind::Text(_)) && (shown.len() < 2 || !shown.ends_with('"'))
    }

    fn report(&mut self, code: &'static str, span: Span, message: String, hint: Option<String>) {
        // What would be missing of a program that is not read to its end is not missing.
        if self.count > MOST_STATEMENTS && code != codes::TOO_LARGE {
            return;
        }
        self.diagnostics.push(Diagnostic { code, span, message, hint });
    }

    fn report_here(&mut self, code: &'static str, message: String, hint: Option<String>) {
        self.report(code, self.span(), message, hint);
    }

    fn fail<T>(&mut self, code: &'static str, message: String, hint: Option<String>) -> Parse<T> {
        if !self.follows_open_text() {
            self.report_here(code, message, hint);
        }
        Err(Broken)
    }

    /// Goes one level deeper for `inner`.
    fn deeper<T>(&mut self, inner: impl FnOnce(&mut Self) -> Parse<T>) -> Parse<T> {
        if self.depth >= DEEPEST {
            return self.too_deep();
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    fn too_deep<T>(&mut self) -> Parse<T> {
        let message = format!("This is nested more than {DEEPEST} levels deep.");
        self.fail(codes::TOO_DEEP, message, Some("Use a subroutine or a variable in between.".into()))
    }

    /// The hint at a word of the language that was meant. A text with more mistakes than a person reads is searched for the first of them
    /// alone, so that it is checked as quickly as any other.
    fn did_you_mean<'w>(&mut self, typed: &str, words: impl IntoIterator<Item = &'w str>) -> Option<String> {
        self.guesses += 1;
        (self.guesses <= MOST_GUESSES).then(|| words::did_you_mean(typed, words)).flatten()
    }
}

//! All that a text says of itself, worked out at once: its names, their places, its blocks.

use super::blocks::{self, Block, Fold, blocks};
use crate::diagnostic::Diagnostic;
use crate::mcl::lexer::{Token, TokenKind, tokens};
use crate::mcl::lower::{Symbol, compile, too_long};
use crate::text::{Lines, Span};
use std::collections::HashMap;

/// All there is to say about a text.
#[derive(Clone, Debug)]
pub struct Index {
    /// What is wrong with it.
    pub diagnostics: Vec<Diagnostic>,
    /// Its names in the order of their definitions. Uses are found by the word, so those in parts that directives leave out count too.
    pub symbols: Vec<Symbol>,
    /// Words that belong together: IF to ENDIF, FOR to NEXT, #IF to #ENDIF and so on.
    pub blocks: Vec<Block>,
    /// What can be folded, by its first line.
    pub folds: Vec<Fold>,
    /// What compile-time directives left out.
    pub left_out: Vec<Span>,
    /// Where the lines begin.
    pub lines: Lines,
}

impl Index {
    /// Of a text.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let mut compiled = compile(text);
        // Of the program itself nothing is asked here.
        compiled.program = None;
        let lines = Lines::of(text);
        let (tokens, _) = match too_long(text) {
            None => tokens(text),
            Some(_) => tokens(""),
        };
        let mut symbols = compiled.symbols;
        find_uses(text, &tokens, &mut symbols);
        let blocks = blocks(text, &tokens);
        let folds = blocks::folds(text, &lines, &blocks, &symbols);
        Self { diagnostics: compiled.diagnostics, symbols, blocks, folds, left_out: compiled.left_out, lines }
    }

    /// The name at byte `at`, or that ends there.
    #[must_use]
    pub fn symbol_at(&self, at: u32) -> Option<&Symbol> {
        let touches = |span: &Span| span.start <= at && at <= span.end;
        self.symbols.iter().find(|symbol| touches(&symbol.defined) || symbol.uses.iter().any(touches))
    }

    /// The name of this spelling, in any case.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.iter().find(|symbol| symbol.key.eq_ignore_ascii_case(name))
    }

    /// The block of which a word stands at byte `at`, or ends there.
    #[must_use]
    pub fn block_at(&self, at: u32) -> Option<&Block> {
        self.blocks.iter().find(|block| block.words.iter().any(|word| word.start <= at && at <= word.end))
    }
}

/// Every word that is a name and no modifier after a point is a use of that name: there is one scope.
fn find_uses(text: &str, tokens: &[Token], symbols: &mut [Symbol]) {
    let mut found: HashMap<String, Vec<Span>> =
        symbols.iter().map(|symbol| (symbol.key.clone(), Vec::new())).collect();
    let mut after_point = false;
    for token in tokens {
        if token.kind == TokenKind::Word && !after_point {
            let key = token.span.of(text).to_ascii_lowercase();
            if let Some(uses) = found.get_mut(&key) {
                uses.push(token.span);
            }
        }
        after_point = token.kind == TokenKind::Sign(".");
    }
    for symbol in symbols {
        let uses = found.remove(&symbol.key).unwrap_or_default();
        symbol.uses = uses.into_iter().filter(|span| *span != symbol.defined).collect();
    }
}

//! Words that belong together, and what can be folded. Only the tokens are looked at, so it works in programs with errors too.

use crate::mcl::lexer::{Token, TokenKind};
use crate::mcl::lower::{Symbol, SymbolKind};
use crate::mcl::parser::while_heads;
use crate::mcl::words;
use crate::text::{Lines, Span};

/// What kind of block it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockKind {
    /// IF, ELSEIF, ELSE, ENDIF.
    If,
    /// FOR, NEXT.
    For,
    /// WHILE, WEND.
    While,
    /// DO, WHILE.
    Do,
    /// REPEAT, UNTIL.
    Repeat,
    /// #IF and its kin, to #ENDIF.
    Directive,
    /// A program, a routine or a table, of a language that closes them.
    Routine,
    /// Loop, End Loop.
    Loop,
    /// Select, Case, End Select.
    Select,
}

/// Words that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// What kind.
    pub kind: BlockKind,
    /// The words in their order: the one that opens it first, the one that closes it last.
    pub words: Vec<Span>,
    /// Whether the closing word is there.
    pub is_closed: bool,
}

/// Lines that can be folded: the first stays to be seen, those after it up to the last go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fold {
    /// Its first line, from 1.
    pub first: u32,
    /// Its last line, from 1.
    pub last: u32,
}

/// The blocks of a program, by the place of their first word.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn blocks(text: &str, tokens: &[Token]) -> Vec<Block> {
    let heads = while_heads(text, tokens);
    let mut finder = Finder::default();
    let mut thens = Thens { text, tokens, at: 0 };
    for (index, token) in tokens.iter().enumerate() {
        match &token.kind {
            TokenKind::Word => {
                let word = token.span.of(text).to_ascii_lowercase();
                finder.word(&word, token.span, heads.contains(&index), || thens.is_block_if(index));
            }
            TokenKind::Directive(name) => finder.directive(name, token.span),
            _ => {}
        }
    }
    finder.finish()
}

#[derive(Default)]
struct Finder {
    open: Vec<Block>,
    /// Which of those are IFs.
    ifs: Vec<usize>,
    /// How many there are of each kind.
    counts: [usize; 9],
    directives: Vec<Block>,
    done: Vec<Block>,
}

impl Finder {
    fn word(&mut self, word: &str, span: Span, begins_loop: bool, mut is_block_if: impl FnMut() -> bool) {
        match word {
            "if" if is_block_if() => self.begin(BlockKind::If, span),
            "for" => self.begin(BlockKind::For, span),
            "do" => self.begin(BlockKind::Do, span),
            "repeat" => self.begin(BlockKind::Repeat, span),
            "while" if begins_loop => self.begin(BlockKind::While, span),
            "while" => self.end(BlockKind::Do, span),
            "wend" => self.end(BlockKind::While, span),
            "next" => self.end(BlockKind::For, span),
            "until" => self.end(BlockKind::Repeat, span),
            "endif" => self.end(BlockKind::If, span),
            "else" | "elseif" => {
                if let Some(at) = self.ifs.last() {
                    self.open[*at].words.push(span);
                }
            }
            _ => {}
        }
    }

    fn directive(&mut self, name: &str, span: Span) {
        match name {
            "if" | "ifdef" | "ifndef" => {
                self.directives.push(Block {
                    kind: BlockKind::Directive,
                    words: vec![span],
                    is_closed: false,
                });
            }
            "else" | "elseif" | "elseifdef" | "elseifndef" => {
                if let Some(block) = self.directives.last_mut() {
                    block.words.push(span);
                }
            }
            "endif" => {
                if let Some(mut block) = self.directives.pop() {
                    block.words.push(span);
                    block.is_closed = true;
                    self.done.push(block);
                }
            }
            _ => {}
        }
    }

    fn begin(&mut self, kind: BlockKind, span: Span) {
        if kind == BlockKind::If {
            self.ifs.push(self.open.len());
        }
        self.counts[kind as usize] += 1;
        self.open.push(Block { kind, words: vec![span], is_closed: false });
    }

    /// Closes the innermost block of this kind; blocks inside it that are still open stay unclosed.
    fn end(&mut self, kind: BlockKind, span: Span) {
        if self.counts[kind as usize] == 0 {
            return;
        }
        while let Some(mut block) = self.open.pop() {
            self.counts[block.kind as usize] -= 1;
            self.ifs.pop_if(|at| *at == self.open.len());
            let is_it = block.kind == kind;
            if is_it {
                block.words.push(span);
                block.is_closed = true;
            }
            self.done.push(block);
            if is_it {
                break;
            }
        }
    }

    fn finish(mut self) -> Vec<Block> {
        self.done.append(&mut self.open);
        self.done.append(&mut self.directives);
        self.done.sort_by_key(|block| block.words.first().map(|word| word.start));
        self.done
    }
}

/// Finds the THEN of each IF.
struct Thens<'a> {
    text: &'a str,
    tokens: &'a [Token],
    /// Where the search for the last IF ended: at its THEN or at the end of its line. Until there it is the same for the next ones.
    at: usize,
}

impl Thens<'_> {
    /// Whether the IF of a token is closed by ENDIF: a jump after THEN on its own line makes it one that is not. Asked from left to right.
    fn is_block_if(&mut self, index: usize) -> bool {
        let is_then = |token: &Token| token.span.of(self.text).eq_ignore_ascii_case("then");
        let ends = |token: &Token| token.kind == TokenKind::Newline || is_then(token);
        if self.at <= index {
            let found = self.tokens[index..].iter().position(ends);
            self.at = found.map_or(self.tokens.len(), |found| index + found);
        }
        let mut after =
            self.tokens[self.at..].iter().take_while(|token| token.kind != TokenKind::Newline).skip(1);
        let Some(first) = after.next() else { return true };
        let word = first.span.of(self.text);
        if word.eq_ignore_ascii_case("goto") || word.eq_ignore_ascii_case("gosub") {
            return false;
        }
        let is_label = first.kind == TokenKind::Word && !words::is_reserved(word);
        !is_label || after.next().is_some()
    }
}

/// What can be folded: blocks, subroutines and other stretches under a label, comments of several lines.
pub(super) fn folds(text: &str, lines: &Lines, blocks: &[Block], symbols: &[Symbol]) -> Vec<Fold> {
    let of_block = |block: &Block| {
        let (first, last) = (block.words.first()?, block.words.last()?);
        block.is_closed.then(|| Fold { first: lines.line_of(first.start), last: lines.line_of(last.start) })
    };
    let mut folds: Vec<Fold> = blocks.iter().filter_map(of_block).collect();
    folds.extend(label_folds(text, lines, symbols));
    folds.extend(comment_folds(text, lines));
    folds.retain(|fold| fold.last > fold.first);
    // Of several that begin in one line the longest is kept.
    folds.sort_by_key(|fold| (fold.first, std::cmp::Reverse(fold.last)));
    folds.dedup_by_key(|fold| fold.first);
    folds
}

/// From each label to the last line with something in it before the next one.
fn label_folds(text: &str, lines: &Lines, symbols: &[Symbol]) -> Vec<Fold> {
    let labels = symbols.iter().filter(|symbol| symbol.kind == SymbolKind::Label);
    let mut firsts: Vec<u32> = labels.map(|label| lines.line_of(label.defined.start)).collect();
    firsts.sort_unstable();
    let ends = firsts.iter().skip(1).map(|next| next - 1).chain([lines.count()]);
    let is_empty = |line: &u32| {
        let shown = lines.text_of(text, *line).trim();
        shown.is_empty() || shown.starts_with(';')
    };
    let last = |(first, end): (&u32, u32)| {
        let last = (*first..=end).rev().find(|line| !is_empty(line)).unwrap_or(*first);
        Fold { first: *first, last }
    };
    firsts.iter().zip(ends).map(last).collect()
}

fn comment_folds(text: &str, lines: &Lines) -> Vec<Fold> {
    let mut folds: Vec<Fold> = Vec::new();
    let comments =
        (1..=lines.count()).filter(|line| lines.text_of(text, *line).trim_start().starts_with(';'));
    for line in comments {
        match folds.last_mut().filter(|fold| fold.last + 1 == line) {
            Some(fold) => fold.last = line,
            None => folds.push(Fold { first: line, last: line }),
        }
    }
    folds
}

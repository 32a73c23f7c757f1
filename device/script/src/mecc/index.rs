//! What an editor asks about a program, as for MCL: its names, its blocks, what the pieces of a line are, what a word means, what could be
//! typed next.
//!
//! Names are found by their words: those that several routines declare for themselves count as one, so that giving it another name does so
//! in all of them.

use super::ast::Kind;
use super::events::{EVENTS, lookup};
use super::lexer::{Token, TokenKind, tokens};
use super::lower::compile;
use super::words::{FUNCTIONS, STATEMENTS, Source, Word, is_reserved};
use crate::mcl::index::{
    Block, BlockKind, Class, Completions, Entry, EntryKind, Fold, Help, Index, RenameError,
};
use crate::mcl::{Symbol, SymbolKind};
use crate::text::{Lines, Span};
use std::collections::HashMap;
use std::ops::Range;

/// All that a text says of itself.
#[must_use]
pub fn index(text: &str) -> Index {
    let diagnostics = compile(text).diagnostics;
    let lines = Lines::of(text);
    let (tokens, _) = match crate::mcl::too_long(text) {
        None => tokens(text),
        Some(_) => tokens(""),
    };
    let symbols = symbols(text, &tokens);
    let blocks = blocks(text, &tokens);
    let folds = folds(&lines, &blocks);
    Index { diagnostics, symbols, blocks, folds, left_out: Vec::new(), lines }
}

fn word(text: &str, token: &Token) -> Option<String> {
    (token.kind == TokenKind::Word).then(|| token.span.of(text).to_ascii_lowercase())
}

/// What is declared, with its uses.
fn symbols(text: &str, tokens: &[Token]) -> Vec<Symbol> {
    let mut found: Vec<Symbol> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut declare = |token: &Token, kind: SymbolKind, value: Option<Kind>| {
        let name = token.span.of(text).to_owned();
        let key = name.to_ascii_lowercase();
        if token.kind != TokenKind::Word || is_reserved(&key) || places.contains_key(&key) {
            return;
        }
        places.insert(key.clone(), found.len());
        let value = value.map(Kind::stored);
        found.push(Symbol { key, name, kind, value, length: None, defined: token.span, uses: Vec::new() });
    };
    for (at, token) in tokens.iter().enumerate() {
        let next = |by: usize| tokens.get(at + by);
        match word(text, token).as_deref() {
            Some("declare") => {
                let (Some(kind), Some(name)) = (next(1), next(2)) else { continue };
                match word(text, kind).as_deref() {
                    Some("byte") => declare(name, SymbolKind::Variable, Some(Kind::Byte)),
                    Some("word") => declare(name, SymbolKind::Variable, Some(Kind::Word)),
                    Some("datapointer") => declare(name, SymbolKind::Variable, Some(Kind::Pointer)),
                    Some("datatable") => declare(name, SymbolKind::Table, Some(Kind::Byte)),
                    Some("function") => declare(name, SymbolKind::Function, None),
                    Some("eventhandler") => declare(name, SymbolKind::Handler, None),
                    Some(_) | None => {}
                }
            }
            // A parameter: name As Word.
            Some("as") => {
                let kind = next(1).and_then(|kind| word(text, kind));
                let kind = match kind.as_deref() {
                    Some("byte") => Kind::Byte,
                    Some("word") => Kind::Word,
                    Some("datapointer") => Kind::Pointer,
                    Some(_) | None => continue,
                };
                if let Some(name) = at.checked_sub(1).and_then(|before| tokens.get(before)) {
                    declare(name, SymbolKind::Variable, Some(kind));
                }
            }
            Some(_) | None => {}
        }
    }
    for token in tokens {
        let Some(place) = word(text, token).and_then(|key| places.get(&key)) else { continue };
        let symbol = &mut found[*place];
        if symbol.defined != token.span {
            symbol.uses.push(token.span);
        }
    }
    found
}

/// What a word begins, where it begins a block.
fn begun(first: &str, second: Option<&str>) -> Option<(BlockKind, &'static str)> {
    Some(match (first, second) {
        ("begin", Some("program")) => (BlockKind::Routine, "program"),
        ("declare", Some("function")) => (BlockKind::Routine, "function"),
        ("declare", Some("eventhandler")) => (BlockKind::Routine, "eventhandler"),
        ("declare", Some("datatable")) => (BlockKind::Routine, "datatable"),
        ("loop", _) => (BlockKind::Loop, "loop"),
        ("while", _) => (BlockKind::While, "while"),
        ("select", _) => (BlockKind::Select, "select"),
        ("do", _) => (BlockKind::Do, "until"),
        _ => return None,
    })
}

/// Blocks by the place of their first word. Only the tokens are looked at, so that programs with errors have some too.
fn blocks(text: &str, tokens: &[Token]) -> Vec<Block> {
    let mut open: Vec<(Block, &'static str)> = Vec::new();
    let mut done: Vec<Block> = Vec::new();
    for line in tokens.split(|token| token.kind == TokenKind::Newline) {
        let words: Vec<(String, Span)> =
            line.iter().map_while(|token| Some((word(text, token)?, token.span))).collect();
        let Some((first, span)) = words.first() else { continue };
        let second = words.get(1).map(|(word, _)| word.as_str());
        let then = line.iter().rev().find(|token| token.kind != TokenKind::Comment);
        let is_block_if = || then.and_then(|token| word(text, token)).as_deref() == Some("then");
        match (first.as_str(), second) {
            ("end", Some(what)) => {
                close(&mut open, &mut done, what, Span { start: span.start, end: words[1].1.end });
            }
            ("until", _) => close(&mut open, &mut done, "until", *span),
            ("else" | "case", _) => {
                let wanted = if first == "else" { "if" } else { "select" };
                if let Some((block, _)) = open.last_mut().filter(|(_, end)| *end == wanted) {
                    block.words.push(*span);
                }
            }
            ("if", _) if is_block_if() => open.push((opened(BlockKind::If, *span), "if")),
            (first, second) => {
                if let Some((kind, end)) = begun(first, second) {
                    open.push((opened(kind, *span), end));
                }
            }
        }
    }
    done.extend(open.into_iter().map(|(block, _)| block));
    done.sort_by_key(|block| block.words.first().map(|word| word.start));
    done
}

fn opened(kind: BlockKind, span: Span) -> Block {
    Block { kind, words: vec![span], is_closed: false }
}

/// Closes the innermost block that ends so; those inside it stay open.
fn close(open: &mut Vec<(Block, &'static str)>, done: &mut Vec<Block>, what: &str, span: Span) {
    if !open.iter().any(|(_, end)| *end == what) {
        return;
    }
    while let Some((mut block, end)) = open.pop() {
        let is_it = end == what;
        if is_it {
            block.words.push(span);
            block.is_closed = true;
        }
        done.push(block);
        if is_it {
            return;
        }
    }
}

fn folds(lines: &Lines, blocks: &[Block]) -> Vec<Fold> {
    let of_block = |block: &Block| {
        let (first, last) = (block.words.first()?, block.words.last()?);
        block.is_closed.then(|| Fold { first: lines.line_of(first.start), last: lines.line_of(last.start) })
    };
    let mut folds: Vec<Fold> = blocks.iter().filter_map(of_block).collect();
    folds.retain(|fold| fold.last > fold.first);
    folds.sort_by_key(|fold| (fold.first, std::cmp::Reverse(fold.last)));
    folds.dedup_by_key(|fold| fold.first);
    folds
}

/// The pieces of a line in their order.
#[must_use]
pub fn classes(line: &str) -> Vec<(Range<usize>, Class)> {
    let (tokens, wrong) = tokens(line);
    let piece = |span: Span| span.start as usize..span.end as usize;
    let mut pieces: Vec<(Range<usize>, Class)> = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let class = match token.kind {
            TokenKind::Word => word_class(line, &tokens, at),
            TokenKind::Number(_) => Class::Number,
            TokenKind::Text => Class::Text,
            TokenKind::Sign("(" | ")" | ",") => Class::Punctuation,
            TokenKind::Sign(_) => Class::Operator,
            TokenKind::Comment => Class::Comment,
            TokenKind::Newline | TokenKind::End => continue,
        };
        pieces.push((piece(token.span), class));
    }
    for wrong in wrong {
        let range = piece(wrong.span);
        if !range.is_empty()
            && !pieces.iter().any(|(known, _)| known.start < range.end && range.start < known.end)
        {
            pieces.push((range, Class::Wrong));
        }
    }
    pieces.sort_by_key(|(range, _)| range.start);
    pieces
}

fn word_class(line: &str, tokens: &[Token], at: usize) -> Class {
    let word = tokens[at].span.of(line).to_ascii_lowercase();
    match word.as_str() {
        "and" | "or" | "not" | "mod" => Class::Operator,
        "byte" | "word" | "datapointer" | "datatable" | "function" | "eventhandler" => Class::Type,
        "include" | "randomise" => Class::Wrong,
        word if is_reserved(word) => Class::Command,
        word if lookup(word).is_some() => Class::Register,
        _ => {
            let before = at.checked_sub(1).map(|before| tokens[before].span.of(line).to_ascii_lowercase());
            let is_routine = matches!(before.as_deref(), Some("call" | "function" | "eventhandler"));
            if is_routine { Class::Label } else { Class::Name }
        }
    }
}

/// The places to be replaced when the name at byte `at` gets another.
///
/// # Errors
/// There is no name here, or the program would mean something else or nothing with the new one.
pub fn rename(index: &Index, at: u32, new: &str) -> Result<Vec<Span>, RenameError> {
    index.rename_unless(at, new, |word| is_reserved(&word.to_ascii_lowercase()) || lookup(word).is_some())
}

/// What a word of the language means, in any case.
#[must_use]
pub fn help(word: &str) -> Option<Help> {
    let rows = STATEMENTS.iter().chain(&FUNCTIONS);
    // Of words that begin several statements, such as Declare, the first one is as good as another.
    let row = rows.clone().find(|row| row.name.eq_ignore_ascii_case(word)).or_else(|| {
        let mut rows = rows.clone();
        rows.find(|row| row.name.split(' ').next_back().is_some_and(|last| last.eq_ignore_ascii_case(word)))
    })?;
    Some(of_row(row))
}

fn of_row(row: &Word) -> Help {
    let source = match row.source {
        Source::Manual => "The manual shows it.",
        Source::Pages => "From the maker's other pages.",
        Source::Assumed => "How it is written is assumed.",
    };
    Help {
        title: row.name.to_owned(),
        syntax: row.syntax.to_owned(),
        text: row.help.to_owned(),
        facts: vec![source.to_owned()],
    }
}

/// What could be typed at byte `at` of `text`.
pub fn completions(index: &Index, text: &str, at: usize) -> Completions {
    let Some(before) = text.get(..at) else { return Completions::default() };
    let line_start = before.rfind('\n').map_or(0, |found| found + 1);
    let line = &before[line_start..];
    let (tokens, _) = tokens(line);
    let is_in_text = tokens.iter().any(|token| {
        let shown = token.span.of(line);
        token.kind == TokenKind::Text
            && token.span.end as usize == line.len()
            && (shown.len() == 1 || !shown.ends_with('"'))
    });
    let is_in_comment = tokens.iter().any(|token| token.kind == TokenKind::Comment);
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let typed = &line[line.trim_end_matches(is_part).len()..];
    if is_in_text || is_in_comment || typed.starts_with(|letter: char| letter.is_ascii_digit()) {
        return Completions::default();
    }
    let begins = line[..line.len() - typed.len()].trim().is_empty();
    let starts = |word: &str| word.get(..typed.len()).is_some_and(|start| start.eq_ignore_ascii_case(typed));
    let of_language = STATEMENTS.iter().chain(&FUNCTIONS).filter(|row| starts(row.name)).map(|row| Entry {
        word: row.name.to_owned(),
        kind: EntryKind::Command,
        detail: row.syntax.to_owned(),
    });
    let of_program = index.symbols.iter().filter(|symbol| starts(&symbol.name)).map(|symbol| Entry {
        word: symbol.name.clone(),
        kind: match symbol.kind {
            SymbolKind::Table => EntryKind::Table,
            SymbolKind::Function | SymbolKind::Handler | SymbolKind::Label => EntryKind::Label,
            SymbolKind::Variable | SymbolKind::Alias | SymbolKind::Constant => EntryKind::Variable,
        },
        detail: symbol.value.map(|kind| kind.name().to_owned()).unwrap_or_default(),
    });
    let events = EVENTS.iter().filter(|event| starts(event.name)).map(|event| Entry {
        word: event.name.to_owned(),
        kind: EntryKind::Register,
        detail: event.help.to_owned(),
    });
    let entries = if begins {
        of_language.chain(of_program).collect()
    } else {
        of_program.chain(events).chain(of_language).collect()
    };
    Completions { replaces: Span::new(at - typed.len(), at), entries }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
Declare Byte count = 1 ; how often
Declare Function twice(n As Word)
    Declare Word half
    If n > 1 Then
        half = n / 2
    Else
        Increment count
    End If
End Function
Begin Program
    Loop
        Call twice(count)
    End Loop
End Program
";

    #[test]
    fn names_have_their_places_and_can_get_others() {
        let index = index(TEXT);
        assert_eq!(
            index.diagnostics.iter().filter(|said| said.code.starts_with('E')).count(),
            0,
            "{:?}",
            index.diagnostics
        );
        let names: Vec<_> = index
            .symbols
            .iter()
            .map(|symbol| (symbol.name.as_str(), symbol.kind, symbol.uses.len()))
            .collect();
        use SymbolKind::{Function, Variable};
        assert_eq!(
            names,
            [("count", Variable, 2), ("twice", Function, 1), ("n", Variable, 2), ("half", Variable, 1)]
        );
        let at = u32::try_from(TEXT.find("Increment count").unwrap() + 10).unwrap();
        assert_eq!(rename(&index, at, "rounds").unwrap().len(), 3);
        assert!(rename(&index, at, "SetMotor").is_err() && rename(&index, at, "half").is_err());
    }

    #[test]
    fn blocks_belong_together_and_fold() {
        let index = index(TEXT);
        let lines: Vec<Vec<u32>> = index
            .blocks
            .iter()
            .map(|block| block.words.iter().map(|word| index.lines.line_of(word.start)).collect())
            .collect();
        assert_eq!(lines, [vec![2, 9], vec![4, 6, 8], vec![10, 14], vec![11, 13]]);
        let folds: Vec<_> = index.folds.iter().map(|fold| (fold.first, fold.last)).collect();
        assert_eq!(folds, [(2, 9), (4, 8), (10, 14), (11, 13)]);
    }

    #[test]
    fn pieces_of_a_line_have_their_colours() {
        let shown = |line: &'static str| -> Vec<(&str, Class)> {
            classes(line).into_iter().map(|(range, class)| (&line[range], class)).collect()
        };
        assert_eq!(
            shown("SetEvent OnOff3Event, h ; x"),
            [
                ("SetEvent", Class::Command),
                ("OnOff3Event", Class::Register),
                (",", Class::Punctuation),
                ("h", Class::Name),
                ("; x", Class::Comment)
            ]
        );
        assert_eq!(shown("Call f(\"A\")")[1], ("f", Class::Label));
        assert!(shown("a = 1 ? 2").contains(&("?", Class::Wrong)));
    }

    #[test]
    fn words_are_explained_and_completed() {
        assert_eq!(help("settimer").unwrap().title, "SetTimer");
        assert_eq!(help("datatable").unwrap().title, "Declare DataTable");
        assert!(help("nothing").is_none());
        let index = index(TEXT);
        let offered = |line: &str| -> Vec<String> {
            completions(&index, line, line.len()).entries.into_iter().map(|entry| entry.word).collect()
        };
        assert_eq!(offered("SetT"), ["SetTimer"]);
        assert_eq!(offered("x = co")[0], "count");
        assert!(offered("SetEvent UserT").contains(&"UserTimer1Event".to_owned()));
        assert!(offered("; SetT").is_empty() && offered("x = \"Se").is_empty());
    }
}

//! What could be typed next, and the syntax line of the command that is being typed (MCP manual 3.4.1).

use super::whole::Index;
use crate::mcl::lexer::{Token, TokenKind, tokens};
use crate::mcl::lower::{Symbol, SymbolKind};
use crate::mcl::operators::OPERATORS;
use crate::mcl::registers::REGISTERS;
use crate::mcl::types::{self, TABLES, VarType};
use crate::mcl::words::register as lookup;
use crate::mcl::words::{self, COMMANDS, FORMATS, Known, Word};
use crate::text::Span;

/// What kind of word is offered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "each is what it says")]
pub enum EntryKind {
    Variable,
    Alias,
    Constant,
    Table,
    Label,
    Register,
    Modifier,
    Command,
    Operator,
    Format,
    Type,
    Directive,
}

/// One word that could be typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The word.
    pub word: String,
    /// What it is.
    pub kind: EntryKind,
    /// A few words on it: type, unit, syntax.
    pub detail: String,
}

/// What could stand at the cursor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completions {
    /// The beginning that is there already, to be replaced.
    pub replaces: Span,
    /// The words, the likeliest first.
    pub entries: Vec<Entry>,
}

/// The command that is being typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SyntaxHint {
    /// Its row, with the syntax line.
    pub word: &'static Word,
    /// Which of its arguments the cursor is in, from 0.
    pub argument: usize,
}

/// The command of the statement that ends at byte `at` of a line, with the argument that is being typed there.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn syntax_at(line: &str, at: usize) -> Option<SyntaxHint> {
    let before = line.get(..at)?;
    let (tokens, _) = tokens(before);
    if after_comment(before, &tokens) {
        return None;
    }
    let row = |token: &Token| match words::known(token.span.of(before)) {
        Some(Known::Command(word)) if token.kind == TokenKind::Word => Some(word),
        _ => None,
    };
    let (index, word) = tokens.iter().enumerate().rev().find_map(|(at, token)| Some((at, row(token)?)))?;
    let mut depth = 0i32;
    let mut argument = 0;
    for token in &tokens[index + 1..] {
        match token.kind {
            TokenKind::Sign("(" | "[") => depth += 1,
            TokenKind::Sign(")" | "]") => depth -= 1,
            TokenKind::Sign(",") if depth == 0 => argument += 1,
            _ => {}
        }
    }
    Some(SyntaxHint { word, argument })
}

/// Whether the end of `before` lies in a comment.
fn after_comment(before: &str, tokens: &[Token]) -> bool {
    let mut at = 0;
    tokens.iter().any(|token| {
        let gap = before.get(at..token.span.start as usize).unwrap_or("");
        at = token.span.end as usize;
        gap.contains(';')
    })
}

impl Index {
    /// What could be typed at byte `at` of `text`, which may be newer than the index by some keystrokes.
    #[must_use]
    pub fn completions(&self, text: &str, at: usize) -> Completions {
        let Some(before) = text.get(..at) else { return Completions::default() };
        let line_start = before.rfind('\n').map_or(0, |found| found + 1);
        let line = &before[line_start..];
        let in_text = tokens(line).0.iter().any(|token| {
            let shown = token.span.of(line);
            matches!(token.kind, TokenKind::Text(_))
                && token.span.end as usize == line.len()
                && (shown.len() == 1 || !shown.ends_with('"'))
        });
        if in_text || after_comment(line, &tokens(line).0) {
            return Completions::default();
        }
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let typed = &line[line.trim_end_matches(is_part).len()..];
        let lead = line[..line.len() - typed.len()].trim_end();
        let start = at - typed.len();
        if let Some(lead) = lead.strip_suffix('#') {
            let replaces = Span::new(line_start + lead.len(), at);
            return Completions { replaces, entries: directives(typed) };
        }
        let mut entries = match lead.strip_suffix('.') {
            Some(owner) => self.modifiers(owner),
            None if typed.starts_with(|letter: char| letter.is_ascii_digit()) => Vec::new(),
            None => self.words(lead, typed),
        };
        entries.retain(|entry| starts_with(&entry.word, typed));
        Completions { replaces: Span::new(start, at), entries }
    }

    /// The modifiers that fit what stands before the point.
    fn modifiers(&self, owner: &str) -> Vec<Entry> {
        let owner = owner.trim_end();
        let owner = match owner.strip_suffix(')') {
            Some(inside) => inside.rfind('(').map_or(inside, |open| inside[..open].trim_end()),
            None => owner,
        };
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let name = &owner[owner.trim_end_matches(is_part).len()..];
        let kind = match lookup(name) {
            Some((id, _)) => Some(id.row().kind),
            None => self.symbol(name).and_then(|symbol| symbol.value),
        };
        let parts = kind.map(types::parts).unwrap_or_default();
        let entry = |word: String| Entry { word, kind: EntryKind::Modifier, detail: String::new() };
        parts.into_iter().map(entry).collect()
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn words(&self, lead: &str, typed: &str) -> Vec<Entry> {
        let last = lead.rsplit(|letter: char| letter.is_whitespace()).next().unwrap_or("");
        let wants_label = ["goto", "gosub", "then"].iter().any(|word| last.eq_ignore_ascii_case(word));
        let wants_type = last.eq_ignore_ascii_case("var");
        let begins = lead.is_empty();
        let mut entries: Vec<Entry> = self.symbols.iter().map(symbol_entry).collect();
        entries.sort_by_key(|entry| (entry.kind == EntryKind::Label) != wants_label);
        let mut language = language(typed.starts_with(|letter: char| letter.is_ascii_lowercase()));
        language.sort_by_key(|entry| match entry.kind {
            EntryKind::Type => !wants_type,
            EntryKind::Command => !begins,
            _ => true,
        });
        let split = if begins || wants_type { 0 } else { entries.len() };
        entries.splice(split..split, language);
        entries
    }
}

fn starts_with(word: &str, typed: &str) -> bool {
    word.get(..typed.len()).is_some_and(|start| start.eq_ignore_ascii_case(typed))
}

fn symbol_entry(symbol: &Symbol) -> Entry {
    let kind = match symbol.kind {
        SymbolKind::Variable => EntryKind::Variable,
        SymbolKind::Alias => EntryKind::Alias,
        SymbolKind::Constant => EntryKind::Constant,
        SymbolKind::Table => EntryKind::Table,
        SymbolKind::Label | SymbolKind::Function | SymbolKind::Handler => EntryKind::Label,
    };
    let length = symbol.length.map(|length| format!("({length})")).unwrap_or_default();
    let detail = symbol.value.map(|kind| format!("{}{length}", kind.name())).unwrap_or_default();
    Entry { word: symbol.name.clone(), kind, detail }
}

fn directives(typed: &str) -> Vec<Entry> {
    let names = ["#IF", "#IFDEF", "#IFNDEF", "#ELSE", "#ELSEIF", "#ELSEIFDEF", "#ELSEIFNDEF", "#ENDIF"];
    let fits = names.into_iter().filter(|name| starts_with(&name[1..], typed));
    let entry = |name: &str| Entry { word: name.into(), kind: EntryKind::Directive, detail: String::new() };
    fits.map(entry).collect()
}

/// Every word of the language; commands in small letters if that is how the user writes.
fn language(small: bool) -> Vec<Entry> {
    let spelt = |name: &str| if small { name.to_ascii_lowercase() } else { name.to_owned() };
    let entry = |word: String, kind, detail: &str| Entry { word, kind, detail: detail.to_owned() };
    let commands = COMMANDS.iter().filter(|row| !row.name.starts_with('#') && row.name != "BYTETABLE");
    let commands = commands.map(|row| entry(spelt(row.name), EntryKind::Command, row.syntax));
    let operators = OPERATORS.iter().filter(|row| row.is_word());
    let operators = operators.map(|row| entry(spelt(row.name), EntryKind::Operator, row.syntax));
    let formats = FORMATS.iter().map(|row| entry(spelt(row.name), EntryKind::Format, row.syntax));
    let types = VarType::ALL.iter().map(|kind| entry(spelt(kind.name()), EntryKind::Type, ""));
    let tables = TABLES.iter().map(|(name, _)| entry((*name).to_owned(), EntryKind::Type, "table"));
    let registers = REGISTERS.iter().map(|row| entry(row.name.to_owned(), EntryKind::Register, row.unit));
    commands.chain(operators).chain(formats).chain(types).chain(tables).chain(registers).collect()
}

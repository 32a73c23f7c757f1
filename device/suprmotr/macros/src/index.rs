//! What an editor asks about a macro file: its names, what can be folded, what the pieces of a line are, what a word means, what could be typed
//! next.

use super::check::check;
use super::format::format;
use super::lexer::{self, Kind, Token};
use super::parser::{Operand, Statement, statements};
use brushwork_script::language::Grammar;
use brushwork_script::mcl::index::{Class, Completions, Entry, EntryKind, Fold, Help, Index};
use brushwork_script::mcl::{Symbol, SymbolKind};
use brushwork_script::text::{Lines, Span};
use brushwork_suprmotr_wire::{Absent, COMMANDS, CommandRow, Effect, Mnemonic, Parameter};
use std::ops::Range;

/// Macro files as an editor has them: their names end with `.macros`.
pub static MACROS: Grammar =
    Grammar { name: "Macro", ending: "macros", index, classes, help, completions, is_reserved, format };

const WORDS: [(&str, &str, &str); 2] = [
    (
        "macro",
        "macro NAME = NUMBER",
        "Begins a macro. Without a number it takes the lowest that is free from 1 on; 0 runs at power-up.",
    ),
    ("const", "const NAME = NUMBER", "Names a number."),
];

/// All that a text says of itself.
pub fn index(text: &str) -> Index {
    let checked = check(text);
    let lines = Lines::of(text);
    let text = if text.len() > super::LONGEST_TEXT { "" } else { text };
    let found = statements(text, &mut Vec::new());
    let symbols = symbols(&found);
    let folds = folds(text, &lines, &found);
    let diagnostics = checked.diagnostics;
    Index { diagnostics, symbols, blocks: Vec::new(), folds, left_out: Vec::new(), lines }
}

/// What is defined, with its uses.
fn symbols(found: &[Statement<'_>]) -> Vec<Symbol> {
    let mut symbols: Vec<Symbol> = Vec::new();
    for statement in found {
        let (name, defined, kind) = match *statement {
            Statement::Macro { name, span, .. } => (name, span, SymbolKind::Function),
            Statement::Const { name, span, .. } => (name, span, SymbolKind::Constant),
            Statement::Commands(_) => continue,
        };
        let key = name.to_ascii_lowercase();
        if !symbols.iter().any(|known| known.key == key) {
            let name = name.to_owned();
            symbols.push(Symbol { key, name, kind, value: None, length: None, defined, uses: Vec::new() });
        }
    }
    for statement in found {
        let Statement::Commands(commands) = statement else { continue };
        for command in commands {
            let Some((Operand::Name(name), span)) = command.operand else { continue };
            if let Some(symbol) = symbols.iter_mut().find(|known| known.key.eq_ignore_ascii_case(name)) {
                symbol.uses.push(span);
            }
        }
    }
    symbols
}

/// A macro goes from its head to the last line of it that has something.
fn folds(text: &str, lines: &Lines, found: &[Statement<'_>]) -> Vec<Fold> {
    let is_head = |statement: &Statement<'_>| !matches!(statement, Statement::Commands(_));
    let line_of = |statement: &Statement<'_>| {
        let span = match statement {
            Statement::Macro { span, .. } | Statement::Const { span, .. } => Some(*span),
            Statement::Commands(commands) => commands.first().map(|command| command.span),
        };
        lines.line_of(span.unwrap_or_default().start)
    };
    let heads: Vec<usize> = (0..found.len()).filter(|at| is_head(&found[*at])).collect();
    let folds = heads.iter().enumerate().filter_map(|(place, head)| {
        let end = heads.get(place + 1).copied().unwrap_or(found.len());
        let first = line_of(&found[*head]);
        let last = line_of(&found[end - 1]);
        (matches!(found[*head], Statement::Macro { .. }) && last > first).then_some(Fold { first, last })
    });
    debug_assert!(lines.line_of(u32::try_from(text.len()).unwrap_or(u32::MAX)) >= 1);
    folds.collect()
}

/// The pieces of a line in their order.
pub fn classes(line: &str) -> Vec<(Range<usize>, Class)> {
    let tokens = lexer::tokens(line, 0);
    let mut pieces: Vec<(Range<usize>, Class)> = Vec::new();
    let place = |span: Span| span.start as usize..span.end as usize;
    let mut before: Option<&str> = None;
    for token in &tokens {
        let range = place(token.span);
        match token.kind {
            Kind::Word => word(token, before, &mut pieces),
            Kind::Number => pieces.push((range, Class::Number)),
            Kind::Comma => pieces.push((range, Class::Punctuation)),
            Kind::Equals => pieces.push((range, Class::Operator)),
            Kind::Comment => pieces.push((range, Class::Comment)),
            Kind::Bad => pieces.push((range, Class::Wrong)),
        }
        before = (token.kind == Kind::Word).then_some(token.text);
    }
    pieces
}

/// A word begins a statement or a command, or is the name behind one.
fn word(token: &Token<'_>, before: Option<&str>, pieces: &mut Vec<(Range<usize>, Class)>) {
    let (start, end) = (token.span.start as usize, token.span.end as usize);
    if before.is_some_and(|before| is_call(before) || before.eq_ignore_ascii_case("macro")) {
        return pieces.push((start..end, Class::Label));
    }
    if before.is_some() {
        return pieces.push((start..end, Class::Name));
    }
    if is_word(token.text) {
        return pieces.push((start..end, Class::Type));
    }
    let (letters, number) = token.text.split_at(token.text.len().min(2));
    let is_number = number.bytes().all(|byte| byte.is_ascii_digit());
    match mnemonic(letters).filter(|_| is_number) {
        None => pieces.push((start..end, Class::Wrong)),
        Some(_) if number.is_empty() => pieces.push((start..end, Class::Command)),
        Some(_) => pieces.extend([(start..start + 2, Class::Command), (start + 2..end, Class::Number)]),
    }
}

fn mnemonic(letters: &str) -> Option<Mnemonic> {
    Mnemonic::from_letters(<[u8; 2]>::try_from(letters.as_bytes()).ok()?)
}

fn is_call(word: &str) -> bool {
    matches!(mnemonic(word), Some(Mnemonic::MC | Mnemonic::EM))
}

fn is_word(word: &str) -> bool {
    WORDS.iter().any(|(known, ..)| known.eq_ignore_ascii_case(word))
}

/// Words that no macro and no number may be called.
fn is_reserved(word: &str) -> bool {
    is_word(word) || mnemonic(word).is_some()
}

/// What a word of the language means, in any case.
pub fn help(word: &str) -> Option<Help> {
    if let Some((title, syntax, text)) = WORDS.iter().find(|(known, ..)| known.eq_ignore_ascii_case(word)) {
        let [title, syntax, text] = [title, syntax, text].map(|part| (*part).to_owned());
        return Some(Help { title, syntax, text, facts: Vec::new() });
    }
    mnemonic(word).map(|mnemonic| of_row(mnemonic.row()))
}

fn of_row(row: &CommandRow) -> Help {
    let mut text = format!("{}.", row.help);
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    let mut facts: Vec<String> = row.takes.iter().map(facts_of).collect();
    if row.effect.may_move() {
        facts.push("It may move the motor.".to_owned());
    } else if row.effect == Effect::Lasting {
        facts.push("It changes what lasts.".to_owned());
    }
    Help { title: format!("{}: {}", row.name, row.title), syntax: syntax(row), text, facts }
}

fn syntax(row: &CommandRow) -> String {
    row.takes.map_or_else(|| row.name.to_owned(), |takes| format!("{} {}", row.name, takes.name))
}

fn facts_of(takes: &Parameter) -> String {
    let unit = takes.unit.symbol();
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let range = if takes.only.is_empty() {
        format!("{} to {}{unit}", takes.low, takes.high)
    } else {
        let only: Vec<String> = takes.only.iter().map(ToString::to_string).collect();
        format!("{}{unit}", only.join(", "))
    };
    match takes.absent {
        Absent::Refused => range,
        Absent::Means(number) => format!("{range}; {number} if none is written"),
        Absent::All => format!("{range}; all if none is written"),
    }
}

/// What could be typed at byte `at` of `text`.
pub fn completions(index: &Index, text: &str, at: usize) -> Completions {
    let Some(before) = text.get(..at) else { return Completions::default() };
    let line = &before[before.rfind('\n').map_or(0, |found| found + 1)..];
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let typed = &line[line.trim_end_matches(is_part).len()..];
    if line.contains('#') || typed.starts_with(|letter: char| letter.is_ascii_digit()) {
        return Completions::default();
    }
    let whole = lexer::tokens(&line[..line.len() - typed.len()], 0);
    let starts = |word: &str| word.get(..typed.len()).is_some_and(|start| start.eq_ignore_ascii_case(typed));
    let named = |kind: SymbolKind, entry: EntryKind| {
        let found = index.symbols.iter().filter(move |symbol| symbol.kind == kind);
        found.map(move |symbol| Entry { word: symbol.name.clone(), kind: entry, detail: String::new() })
    };
    let entries: Vec<Entry> = match whole.last() {
        Some(Token { kind: Kind::Word, text, .. }) if is_word(text) => Vec::new(),
        Some(Token { kind: Kind::Word, text, .. }) if is_call(text) => {
            let macros = named(SymbolKind::Function, EntryKind::Label);
            macros.chain(named(SymbolKind::Constant, EntryKind::Constant)).collect()
        }
        Some(Token { kind: Kind::Word, .. }) => named(SymbolKind::Constant, EntryKind::Constant).collect(),
        Some(Token { kind: Kind::Number | Kind::Equals | Kind::Comment | Kind::Bad, .. }) => Vec::new(),
        Some(Token { kind: Kind::Comma, .. }) | None => {
            let commands = COMMANDS.iter().filter(|row| row.mnemonic != Mnemonic::MD).map(|row| Entry {
                word: row.name.to_owned(),
                kind: EntryKind::Command,
                detail: row.title.to_owned(),
            });
            let words = WORDS.iter().filter(|_| whole.is_empty()).map(|(word, syntax, _)| Entry {
                word: (*word).to_owned(),
                kind: EntryKind::Directive,
                detail: (*syntax).to_owned(),
            });
            words.chain(commands).collect()
        }
    };
    let entries = entries.into_iter().filter(|entry| starts(&entry.word)).collect();
    Completions { replaces: Span::new(at - typed.len(), at), entries }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_script::language::Language;

    const TEXT: &str = "\
# To and fro.
const FAR = 2000

macro shuttle = 3
    MA 0, WS 500
    MA FAR, WS500

macro twice
    MC shuttle, mc shuttle
    CN 5, HE 1x
";

    #[test]
    fn names_have_their_places_and_can_get_others() {
        let index = index(TEXT);
        let names: Vec<_> = index
            .symbols
            .iter()
            .map(|symbol| (symbol.name.as_str(), symbol.kind, symbol.uses.len()))
            .collect();
        use SymbolKind::{Constant, Function};
        assert_eq!(names, [("FAR", Constant, 1), ("shuttle", Function, 2), ("twice", Function, 0)]);
        let at = u32::try_from(TEXT.find("mc shuttle").unwrap() + 4).unwrap();
        let language = Language::Brought(&MACROS);
        assert_eq!(language.rename(&index, at, "to_and_fro").unwrap().len(), 3);
        for taken in ["far", "MA", "macro", "2x"] {
            assert!(language.rename(&index, at, taken).is_err(), "{taken}");
        }
        let folds: Vec<_> = index.folds.iter().map(|fold| (fold.first, fold.last)).collect();
        assert_eq!(folds, [(4, 6), (8, 9)], "a line that is wrong is no part of a macro");
        assert_eq!(index.diagnostics.len(), 1, "{:?}", index.diagnostics);
    }

    #[test]
    fn each_piece_of_a_line_has_its_colour() {
        let shown = |line: &'static str| -> Vec<(&str, Class)> {
            classes(line).into_iter().map(|(range, class)| (&line[range], class)).collect()
        };
        assert_eq!(
            shown("  MA5000, ws FAR, MC home # there"),
            [
                ("MA", Class::Command),
                ("5000", Class::Number),
                (",", Class::Punctuation),
                ("ws", Class::Command),
                ("FAR", Class::Name),
                (",", Class::Punctuation),
                ("MC", Class::Command),
                ("home", Class::Label),
                ("# there", Class::Comment),
            ]
        );
        assert_eq!(
            shown("macro home = 0"),
            [("macro", Class::Type), ("home", Class::Label), ("=", Class::Operator), ("0", Class::Number)]
        );
        assert_eq!(shown("QQ ö"), [("QQ", Class::Wrong), ("ö", Class::Wrong)]);
    }

    #[test]
    fn words_are_explained_and_offered_where_they_fit() {
        let help = help("ws").unwrap();
        assert_eq!(help.title, "WS: Wait for Stop");
        assert_eq!(help.facts, ["0 to 65535 ms; 1000 if none is written"]);
        assert!(super::help("MA").unwrap().facts.iter().any(|fact| fact.contains("move the motor")));
        assert!(super::help("shuttle").is_none());
        let index = index(TEXT);
        let offered = |typed: &str| -> Vec<String> {
            let text = format!("{TEXT}{typed}");
            let found = completions(&index, &text, text.len());
            found.entries.into_iter().map(|entry| entry.word).collect()
        };
        assert_eq!(offered("MC s"), ["shuttle"]);
        assert_eq!(offered("MA "), ["FAR"]);
        assert_eq!(offered("ma 5, W"), ["WS", "WN", "WF", "WA"]);
        assert_eq!(offered("mac"), ["macro"]);
        assert!(offered("# M").is_empty() && offered("MA 5").is_empty());
    }
}

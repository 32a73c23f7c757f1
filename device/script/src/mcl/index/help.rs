//! What a word of the language means, for hovering and for completion.

use super::whole::Index;
use crate::mcl::ast::Format;
use crate::mcl::lower::{Symbol, SymbolKind};
use crate::mcl::operators::Operator;
use crate::mcl::registers::{RegisterId, values};
use crate::mcl::types::{self, VarType};
use crate::mcl::words::{self, COMMANDS, FORMATS, Known, Word};

/// What there is to say about a word.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Help {
    /// The word as the manual writes it.
    pub title: String,
    /// How it is written; empty for registers and names.
    pub syntax: String,
    /// What it does or is, as a sentence.
    pub text: String,
    /// Facts of their own lines: type, unit, access, named values.
    pub facts: Vec<String>,
}

/// What a word of the language means, in any case; `None` for names of the program.
#[must_use]
pub fn help(word: &str) -> Option<Help> {
    if word.starts_with('#') {
        return directive(word);
    }
    Some(match words::known(word) {
        Some(Known::Command(row) | Known::Format(row)) => of_row(row),
        Some(Known::Operator(row)) => of_operator(row),
        Some(Known::Type(kind)) => of_type(kind),
        Some(Known::Table(kind)) => of_table(word, kind),
        Some(Known::Register(id)) => of_register(id),
        Some(Known::Misspelt(id)) => {
            let mut help = of_register(id);
            help.facts.push(format!("{} is a slip of the manual's table.", word.to_uppercase()));
            help
        }
        Some(Known::Can) => Help {
            title: word.to_uppercase(),
            text: "A word for the CAN bus whose syntax is not public. CAN is stream 1 of GETS and PUTS."
                .into(),
            ..Help::default()
        },
        Some(Known::OtherProduct) => Help {
            title: word.to_uppercase(),
            text: "A word of another product of the maker; controllers of this family do not have it.".into(),
            ..Help::default()
        },
        None => {
            let (format, _) = Format::of_word(word)?;
            of_row(FORMATS.iter().find(|row| row.name == format.word())?)
        }
    })
}

fn of_row(row: &Word) -> Help {
    Help {
        title: row.name.to_owned(),
        syntax: row.syntax.to_owned(),
        text: row.help.to_owned(),
        facts: Vec::new(),
    }
}

fn directive(word: &str) -> Option<Help> {
    let upper = word.to_ascii_uppercase();
    let names = ["#IF", "#ELSE", "#ELSEIF", "#ENDIF", "#IFDEF", "#IFNDEF", "#ELSEIFDEF", "#ELSEIFNDEF"];
    let at = names.iter().position(|name| *name == upper)?;
    let row = COMMANDS.iter().find(|row| row.name == if at < 4 { "#IF" } else { "#IFDEF" })?;
    Some(Help { title: upper, ..of_row(row) })
}

fn of_operator(row: &Operator) -> Help {
    Help {
        title: row.name.to_owned(),
        syntax: row.syntax.to_owned(),
        text: row.help.to_owned(),
        facts: vec![format!("Precedence {} of 9; 1 is worked out first.", row.order())],
    }
}

/// How many bits and which values.
fn extent(kind: VarType) -> String {
    let bits = kind.bits();
    match kind.range() {
        Some((least, most)) => format!("{bits} bit, {least} to {most}"),
        None => format!("{bits} bit floating point"),
    }
}

fn of_type(kind: VarType) -> Help {
    Help {
        title: kind.name().to_owned(),
        syntax: format!("name VAR {}{{(size)}}", kind.name()),
        text: "The type of a variable.".to_owned(),
        facts: vec![extent(kind)],
    }
}

fn of_table(word: &str, kind: VarType) -> Help {
    let name =
        types::TABLES.iter().find(|(name, _)| name.eq_ignore_ascii_case(word)).map_or(word, |row| row.0);
    Help {
        title: name.to_owned(),
        syntax: format!("name {name} value, ..."),
        text: "Defines a table of constants.".to_owned(),
        facts: vec![extent(kind)],
    }
}

fn of_register(id: RegisterId) -> Help {
    let row = id.row();
    let length = if row.length > 1 { format!("({})", row.length) } else { String::new() };
    let access = if row.writable { "read and write" } else { "read only" };
    let mut facts = vec![format!("{}{length}, {access}", row.kind.name())];
    if !row.unit.is_empty() {
        facts.push(format!("unit {}", row.unit));
    }
    facts.extend(values(id).iter().map(|(value, meaning)| format!("0x{value:04X} {meaning}")));
    let mut text = row.meaning.to_owned();
    text.replace_range(..1, &row.meaning[..1].to_uppercase());
    Help { title: row.name.to_owned(), syntax: String::new(), text: format!("{text}."), facts }
}

impl Index {
    /// What a name of the program is.
    #[must_use]
    pub fn describe(&self, text: &str, symbol: &Symbol) -> Help {
        let line = self.lines.line_of(symbol.defined.start);
        let kind = match symbol.kind {
            SymbolKind::Variable => "Variable",
            SymbolKind::Alias => "Another name for a variable",
            SymbolKind::Constant => "Constant",
            SymbolKind::Table => "Table of constants",
            SymbolKind::Label => "Label",
            SymbolKind::Function => "Function",
            SymbolKind::Handler => "Event handler",
        };
        let length = symbol.length.map(|length| format!("({length})")).unwrap_or_default();
        let mut facts = Vec::new();
        if let Some(kind) = symbol.value {
            facts.push(format!("{}{length}, {}", kind.name(), extent(kind)));
        }
        facts.push(format!("Line {line}, used {} times", symbol.uses.len()));
        Help {
            title: symbol.defined.of(text).to_owned(),
            syntax: self.lines.text_of(text, line).trim().to_owned(),
            text: format!("{kind}."),
            facts,
        }
    }
}

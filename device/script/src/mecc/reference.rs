//! The language reference, drawn from the tables that the compiler reads: as rows to serialise and as a page of text.

use super::assumed::ASSUMED;
use super::codes;
use super::events::{EVENTS, Event};
use super::words::{FORM_UNKNOWN, FUNCTIONS, OPERATORS, STATEMENTS, Source, Word};
use serde::Serialize;
use std::fmt::Write as _;

/// The whole reference.
#[derive(Clone, Debug, Serialize)]
pub struct Reference {
    /// Statements and declarations.
    pub statements: Vec<Word>,
    /// What gives a value.
    pub functions: Vec<Word>,
    /// Operators by rank, the tightest first.
    pub operators: Vec<Operators>,
    /// Events; their order is that in which they run.
    pub events: Vec<Event>,
    /// Words whose form is not known.
    pub form_unknown: Vec<&'static str>,
    /// What was taken where nothing is said.
    pub assumed: Vec<&'static str>,
    /// Errors and warnings.
    pub codes: Vec<Code>,
}

/// Operators of one rank.
#[derive(Clone, Debug, Serialize)]
pub struct Operators {
    /// As they are written.
    pub written: &'static str,
    /// What they give.
    pub help: &'static str,
    /// Where they are known from.
    pub source: Source,
}

/// An error or a warning.
#[derive(Clone, Debug, Serialize)]
pub struct Code {
    /// "E..." or "W...".
    pub code: &'static str,
    /// What it says.
    pub meaning: &'static str,
}

/// All of it.
#[must_use]
pub fn reference() -> Reference {
    let operators =
        OPERATORS.iter().map(|(written, help, source)| Operators { written, help, source: *source });
    Reference {
        statements: STATEMENTS.to_vec(),
        functions: FUNCTIONS.to_vec(),
        operators: operators.collect(),
        events: EVENTS.to_vec(),
        form_unknown: FORM_UNKNOWN.iter().map(|(word, _)| *word).collect(),
        assumed: ASSUMED.to_vec(),
        codes: codes::ALL.iter().map(|(code, meaning)| Code { code, meaning }).collect(),
    }
}

/// What a source is called behind a form; the manual's forms need no word.
fn mark(source: Source) -> &'static str {
    match source {
        Source::Manual => "",
        Source::Pages => " (from the maker's other pages)",
        Source::Assumed => " (assumed)",
    }
}

/// All of it as text.
#[must_use]
pub fn page() -> String {
    let mut page = "MeccCode, as Brushwork compiles it for its simulated boards\n".to_owned();
    let words = |page: &mut String, title: &str, rows: &[Word]| {
        let _ = writeln!(page, "\n{title}");
        for row in rows {
            let _ = writeln!(page, "  {}{}\n      {}", row.syntax, mark(row.source), row.help);
        }
    };
    words(&mut page, "Statements and declarations", &STATEMENTS);
    words(&mut page, "Functions", &FUNCTIONS);
    page += "\nOperators, those that are worked out first above\n";
    for (written, help, source) in OPERATORS {
        let _ = writeln!(page, "  {written}  {help}{}", mark(source));
    }
    page += "\nEvents, in the order in which they run where several wait\n";
    for event in EVENTS {
        let _ = writeln!(page, "  {}  {}", event.name, event.help);
    }
    page += "\nWords whose form no page shows\n";
    for (word, hint) in FORM_UNKNOWN {
        let _ = writeln!(page, "  {word}  {hint}");
    }
    page += "\nAssumed, since no page says it\n";
    for line in ASSUMED {
        let _ = writeln!(page, "  {line}");
    }
    page += "\nErrors and warnings\n";
    for (code, meaning) in codes::ALL {
        let _ = writeln!(page, "  {code}  {meaning}");
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_holds_every_row_of_every_table() {
        let page = page();
        for row in STATEMENTS.iter().chain(&FUNCTIONS) {
            assert!(page.contains(row.syntax) && page.contains(row.help), "{}", row.name);
        }
        assert!(EVENTS.iter().all(|event| page.contains(event.name)));
        assert!(codes::ALL.iter().all(|(code, _)| page.contains(code)));
    }
}

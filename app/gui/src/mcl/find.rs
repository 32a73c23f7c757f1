//! Find and replace: words, case, regular expressions. Matches are those of the whole program and are counted.

use crate::mcl::messages::PanelMessage;
use crate::messages::NameMessage;
use std::ops::Range;

use regex::{NoExpand, Regex, RegexBuilder};

use super::{Caret, Document, Kind};

/// What is looked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    pub text: String,
    pub case: bool,
    pub word: bool,
    pub regex: bool,
}

impl Query {
    /// The expression to look for; none for an empty query.
    ///
    /// # Errors
    /// What is no regular expression, in a sentence.
    fn expression(&self) -> Result<Option<Regex>, String> {
        if self.text.is_empty() {
            return Ok(None);
        }
        let text = if self.regex { self.text.clone() } else { regex::escape(&self.text) };
        let text = if self.word { format!(r"(?:\b|^)(?:{text})(?:\b|$)") } else { text };
        let built = RegexBuilder::new(&text).case_insensitive(!self.case).multi_line(true).build();
        built.map(Some).map_err(|error| {
            let why = error.to_string();
            let why = why.lines().last().unwrap_or_default().trim_start_matches("error: ").to_owned();
            PanelMessage::NoExpression { why }.to_string()
        })
    }
}

/// The bar for finding and replacing.
#[derive(Debug, Default)]
pub struct Find {
    pub open: bool,
    pub replaces: bool,
    pub query: Query,
    pub replacement: String,
    /// The keyboard goes to the field in the next frame.
    pub wants_focus: bool,
    found: Found,
}

/// Where the query is found, and in what.
#[derive(Debug, Default)]
struct Found {
    of: Option<(super::doc_id::DocId, u64, Query)>,
    matches: Vec<Range<usize>>,
    failure: Option<String>,
    expression: Option<Regex>,
}

impl Find {
    /// Looks again if text or query have changed.
    pub fn look(&mut self, document: &Document) {
        if !self.open {
            return;
        }
        let of = (document.id(), document.text.revision(), self.query.clone());
        if self.found.of.as_ref() == Some(&of) {
            return;
        }
        let (expression, failure) = match self.query.expression() {
            Ok(expression) => (expression, None),
            Err(failure) => (None, Some(failure)),
        };
        let text = document.text.text();
        let matches = expression.iter().flat_map(|expression| {
            expression.find_iter(&text).map(|found| found.range()).filter(|range| !range.is_empty())
        });
        let matches = matches.collect();
        self.found = Found { of: Some(of), matches, failure, expression };
    }

    /// Every place, in order.
    pub fn matches(&self) -> &[Range<usize>] {
        if self.open { &self.found.matches } else { &[] }
    }

    /// "3 of 17", "None", or why the query makes no sense.
    pub fn reported(&self, caret: Caret) -> String {
        if let Some(failure) = &self.found.failure {
            return failure.clone();
        }
        let count = self.found.matches.len();
        let here = self.found.matches.iter().position(|range| *range == caret.range());
        match (here, count) {
            _ if self.query.text.is_empty() => String::new(),
            (_, 0) => "None found".to_owned(),
            (Some(here), _) => NameMessage::Of { number: here + 1, all: count }.to_string(),
            (None, 1) => "1 found".to_owned(),
            (None, _) => NameMessage::Found { count }.to_string(),
        }
    }

    /// Opens the bar; what is selected on one line is looked for.
    pub fn show(&mut self, document: &Document, replaces: bool) {
        let selected = document.text.slice(document.caret.range());
        if !selected.is_empty() && !selected.contains('\n') {
            self.query.text = selected.into_owned();
        }
        self.open = true;
        self.replaces = replaces;
        self.wants_focus = true;
    }

    /// Selects the next place, or the one before; round at the ends.
    pub fn go(&mut self, document: &mut Document, forward: bool) {
        self.look(document);
        let range = document.caret.range();
        let matches = &self.found.matches;
        let next = if forward {
            // A match that begins at the bare caret is the next one.
            let from = if range.is_empty() { range.start } else { range.start + 1 };
            matches.iter().find(|found| found.start >= from).or(matches.first())
        } else {
            matches.iter().rev().find(|found| found.start < range.start).or(matches.last())
        };
        if let Some(next) = next.cloned() {
            document.go_to(Caret::selecting(next.start, next.end));
        }
    }

    /// Replaces the match that is selected, and goes to the next.
    pub fn replace(&mut self, document: &mut Document) {
        self.look(document);
        let range = document.caret.range();
        if self.found.matches.contains(&range) {
            let text = self.replaced(document, &range);
            let end = range.start + text.len();
            document.edit(Kind::Other, [(range, text)], |_| Caret::at(end));
        }
        self.go(document, true);
    }

    /// Replaces every match, as one step of undo. How many there were.
    pub fn replace_all(&mut self, document: &mut Document) -> usize {
        self.look(document);
        let edits: Vec<(Range<usize>, String)> = self
            .found
            .matches
            .iter()
            .rev()
            .map(|range| (range.clone(), self.replaced(document, range)))
            .collect();
        let (count, line) = (edits.len(), document.caret_line());
        document.edit(Kind::Other, edits, |text| Caret::at(text.line_start(line.min(text.line_count() - 1))));
        count
    }

    /// What comes in place of a match: `$1` is a group where the query is a regular expression.
    fn replaced(&self, document: &Document, range: &Range<usize>) -> String {
        let Some(expression) = &self.found.expression else { return String::new() };
        if !self.query.regex {
            let found = document.text.slice(range.clone());
            return expression.replace(&found, NoExpand(&self.replacement)).into_owned();
        }
        let text = document.text.text();
        let mut replaced = String::new();
        if let Some(captures) = expression.captures_at(&text, range.start) {
            captures.expand(&self.replacement, &mut replaced);
        }
        replaced
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mcl::doc_id::DocId;

    fn document(text: &str) -> Document {
        Document::new(DocId(1), "a".into(), text)
    }

    fn find(text: &str, set: impl Fn(&mut Query)) -> Find {
        let mut find = Find { open: true, ..Find::default() };
        find.query.text = text.to_owned();
        set(&mut find.query);
        find
    }

    fn count(find: &mut Find, text: &str) -> usize {
        find.look(&document(text));
        find.matches().len()
    }

    #[test]
    fn case_words_and_expressions_narrow_what_is_found() {
        let text = "speed Speed speeds\nget_speed a.b";
        assert_eq!(count(&mut find("speed", |_| ()), text), 4);
        assert_eq!(count(&mut find("speed", |query| query.case = true), text), 3);
        assert_eq!(count(&mut find("speed", |query| query.word = true), text), 2);
        assert_eq!(count(&mut find("a.b", |_| ()), "a.b acb"), 1);
        assert_eq!(count(&mut find("a.b", |query| query.regex = true), "a.b acb"), 2);
        assert_eq!(count(&mut find("^b$", |query| query.regex = true), "a\nb\nbb"), 1);
        assert_eq!(count(&mut find("x*", |query| query.regex = true), "aaa"), 0, "nothing is no match");
    }

    #[test]
    fn what_is_no_expression_is_said_and_finds_nothing() {
        let mut find = find("(", |query| query.regex = true);
        assert_eq!(count(&mut find, "(("), 0);
        let reported = find.reported(Caret::default());
        assert!(
            reported.starts_with("This is no regular expression:") && reported.ends_with('.'),
            "{reported}"
        );
    }

    #[test]
    fn going_on_comes_round_in_both_directions() {
        let mut document = document("x a x a x");
        let mut find = find("a", |_| ());
        let mut at = |forward| {
            find.go(&mut document, forward);
            (document.caret.range().start, find.reported(document.caret))
        };
        assert_eq!(at(true), (2, "1 of 2".into()));
        assert_eq!(at(true), (6, "2 of 2".into()));
        assert_eq!(at(true), (2, "1 of 2".into()));
        assert_eq!(at(false), (6, "2 of 2".into()));
    }

    #[test]
    fn all_are_replaced_in_one_step_and_groups_are_put_in() {
        let mut document = document("m1 = 2\nm3 = 4\n");
        let mut by_group = find(r"m(\d) = (\d)", |query| query.regex = true);
        by_group.replacement = "n$2 = $1".into();
        assert_eq!(by_group.replace_all(&mut document), 2);
        assert_eq!(document.text.text(), "n2 = 1\nn4 = 3\n");
        document.undo();
        assert_eq!(document.text.text(), "m1 = 2\nm3 = 4\n");
        let mut plain = find("m", |_| ());
        plain.replacement = "$1".into();
        assert_eq!(plain.replace_all(&mut document), 2);
        assert_eq!(document.text.text(), "$11 = 2\n$13 = 4\n");
    }

    #[test]
    fn replacing_one_takes_the_selected_match_and_goes_on() {
        let mut document = document("a b a");
        let mut find = find("a", |_| ());
        find.replacement = "cc".into();
        find.replace(&mut document);
        assert_eq!(document.text.text(), "a b a", "nothing was selected yet");
        find.replace(&mut document);
        assert_eq!(document.text.text(), "cc b a");
        find.replace(&mut document);
        assert_eq!(document.text.text(), "cc b cc");
    }
}

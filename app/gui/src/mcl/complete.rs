//! The list of words that could be typed: when it opens, what is chosen, and how it is taken over.

use brushwork_script::mcl::index::{Completions, Entry, Index};

use super::{Caret, Document, Kind};

/// Letters after which the list opens by itself.
const LETTERS: usize = 2;
/// Rows that are shown at once.
pub const ROWS: usize = 10;

/// The list while it is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// Where the word begins that is being typed.
    pub start: usize,
    pub entries: Vec<Entry>,
    pub chosen: usize,
}

impl Completion {
    /// What fits at the caret; `None` if nothing does or too little is typed. `wanted` opens it whatever is typed.
    pub fn of(document: &Document, wanted: bool) -> Option<Self> {
        if !document.caret.is_empty() {
            return None;
        }
        let line = document.caret_line();
        let start = document.text.line_start(line);
        let shown = document.text.line(line);
        let at = document.caret.head - start;
        let Completions { replaces, mut entries } = match &document.findings.checked {
            Some(checked) => document.language().completions(&checked.index, &shown, at),
            None => document.language().completions(&Index::of(""), &shown, at),
        };
        let from = replaces.start as usize;
        let typed = shown.get(from..at)?;
        let after_sign = shown[..from].ends_with('.') || typed.starts_with('#');
        if !wanted && typed.chars().count() < LETTERS && !after_sign {
            return None;
        }
        // The word that is typed is in the list of names as soon as it was checked.
        let is_done = |entry: &Entry| entry.word.eq_ignore_ascii_case(typed);
        if entries.iter().any(is_done) && !wanted {
            return None;
        }
        entries.dedup_by(|one, other| one.word == other.word);
        (!entries.is_empty()).then_some(Self { start: start + from, entries, chosen: 0 })
    }

    /// Goes up and down the list, round at its ends.
    pub fn step(&mut self, rows: isize) {
        let count = self.entries.len() as isize;
        self.chosen = (self.chosen as isize + rows).rem_euclid(count.max(1)) as usize;
    }

    /// Puts a word in place of what was typed of it.
    pub fn accept(self, document: &mut Document, index: usize) {
        let Some(entry) = self.entries.into_iter().nth(index) else { return };
        let (start, end) = (self.start, document.caret.head);
        let to = start + entry.word.len();
        document.edit(Kind::Other, [(start..end, entry.word)], |_| Caret::at(to));
    }
}

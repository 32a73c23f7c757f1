//! What the compiler knows, for the place of the caret or the pointer: meanings, definitions, other names, words that belong together.

use brushwork_link::Message;
use std::ops::Range;
use std::sync::Arc;

use brushwork_script::mcl::index::{self, Help, SyntaxHint};
use brushwork_script::text::Span;

use super::check::{Checked, check};
use super::moves::word_at;
use super::{Caret, Document, Kind};
use crate::messages::EditorMessage;

/// What is shown where the pointer rests.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hover {
    pub problems: Vec<String>,
    pub help: Option<Help>,
}

fn bytes(span: Span) -> Range<usize> {
    span.start as usize..span.end as usize
}

impl Document {
    /// All that is known of the text as it is now. Where the compiler is behind, it is asked at once.
    pub fn known(&mut self) -> Arc<Checked> {
        let revision = self.text.revision();
        if let Some(checked) = self.findings.fresh(revision) {
            return checked.clone();
        }
        let checked = Arc::new(check(self.id(), revision, self.text.text(), self.language()));
        self.take_checked(checked.clone());
        checked
    }

    /// Takes over what the compiler found, if it speaks of this text.
    pub fn take_checked(&mut self, checked: Arc<Checked>) {
        if checked.revision == self.text.revision() {
            self.findings.take(checked);
            let findings = &self.findings;
            self.folds.keep(|head| findings.last_of(head));
        }
    }

    /// The word at a byte; empty where there is none.
    pub fn word(&self, at: usize) -> Range<usize> {
        let range = word_at(&self.text, at);
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        if self.text.slice(range.clone()).chars().all(is_part) { range } else { at..at }
    }

    /// What the text at a byte means, and what is wrong with it.
    pub fn hover(&self, at: usize) -> Option<Hover> {
        let problems: Vec<String> = self.findings.at(at).iter().map(|problem| problem.in_full()).collect();
        let help = self.help_at(at);
        (help.is_some() || !problems.is_empty()).then_some(Hover { problems, help })
    }

    fn help_at(&self, at: usize) -> Option<Help> {
        let line = self.text.line_of(at);
        let start = self.text.line_start(line);
        let shown = self.text.line(line);
        let pieces = self.language().classes(&shown);
        let (range, class) = pieces.into_iter().find(|(range, _)| range.contains(&(at - start)))?;
        if matches!(class, index::Class::Comment | index::Class::Text | index::Class::Number) {
            return None;
        }
        let word = &shown[range];
        let own = || {
            let checked = self.findings.checked.as_ref()?;
            let symbol = checked.index.symbol(word)?;
            Some(checked.index.describe(&checked.text, symbol))
        };
        self.language().help(word).or_else(own)
    }

    /// The syntax of the command in which the caret stands, and which argument it is (MCP manual 3.4.1).
    pub fn syntax(&self) -> Option<SyntaxHint> {
        let line = self.caret_line();
        self.language().syntax_at(&self.text.line(line), self.caret.head - self.text.line_start(line))
    }

    /// Goes to where the name at the caret is defined.
    ///
    /// # Errors
    /// A sentence, where there is no name or no definition.
    pub fn go_to_definition(&mut self) -> Result<(), EditorMessage> {
        let checked = self.known();
        let at = self.caret.head;
        let word = self.text.slice(self.word(at)).into_owned();
        let symbol = checked.index.symbol_at(u32::try_from(at).unwrap_or(u32::MAX));
        match symbol {
            Some(symbol) => {
                let defined = bytes(symbol.defined);
                self.go_to(Caret::selecting(defined.start, defined.end));
                Ok(())
            }
            None if word.is_empty() => Err(EditorMessage::NoName),
            None => Err(match self.language().help(&word) {
                Some(_) => EditorMessage::OfTheLanguage { word, language: self.language().name() },
                None => EditorMessage::NotDefined { word },
            }),
        }
    }

    /// Gives the name at the caret another, in all its places, as one step. How many there were.
    ///
    /// # Errors
    /// A sentence, where it cannot be.
    pub fn rename(&mut self, new: &str) -> Result<usize, EditorMessage> {
        let checked = self.known();
        let at = u32::try_from(self.caret.head).unwrap_or(u32::MAX);
        let not_renamed =
            |error: index::RenameError| EditorMessage::NotRenamed { why: Message::error(error) };
        let places = self.language().rename(&checked.index, at, new).map_err(not_renamed)?;
        let line = self.caret_line();
        let edits = places.iter().rev().map(|span| (bytes(*span), new.to_owned()));
        let edits: Vec<_> = edits.collect();
        let before = places.iter().filter(|span| (span.end as usize) < self.caret.head).count();
        let start = places
            .iter()
            .map(|span| bytes(*span))
            .find(|range| range.contains(&self.caret.head) || range.end == self.caret.head);
        let old = start.as_ref().map_or(0, ExactSizeIterator::len);
        let head = start.map(|range| (range.start + before * new.len()).saturating_sub(before * old));
        self.edit(Kind::Other, edits, |text| {
            Caret::at(text.boundary(head.unwrap_or_else(|| text.line_start(line))))
        });
        Ok(places.len())
    }

    /// Goes to the next word of the block at the caret: from IF over ELSE to ENDIF and back.
    ///
    /// # Errors
    /// A sentence, where no such word stands.
    pub fn go_to_match(&mut self) -> Result<(), EditorMessage> {
        let checked = self.known();
        let at = self.caret.head;
        let block = checked.index.block_at(u32::try_from(at).unwrap_or(u32::MAX));
        let words = block.map(|block| block.words.as_slice()).unwrap_or_default();
        let here = words.iter().position(|span| bytes(*span).start <= at && at <= bytes(*span).end);
        let next = here.and_then(|here| words.get((here + 1) % words.len()));
        match next {
            Some(span) if words.len() > 1 => {
                self.go_to(Caret::at(bytes(*span).start));
                Ok(())
            }
            _ => Err(EditorMessage::NoBlock),
        }
    }

    /// The words that belong to the one at the caret, to be marked.
    pub fn matching(&self) -> Vec<Range<usize>> {
        let at = u32::try_from(self.caret.head).unwrap_or(u32::MAX);
        let checked = self.findings.fresh(self.text.revision());
        let block = checked.and_then(|checked| checked.index.block_at(at)).filter(|block| block.is_closed);
        block.map(|block| block.words.iter().map(|span| bytes(*span)).collect()).unwrap_or_default()
    }

    /// Folds the block in which the caret stands, or opens it.
    pub fn toggle_fold(&mut self, line: usize) {
        let around = self.findings.folds.iter().filter(|(first, last)| *first <= line && line <= *last);
        let Some((head, last)) = around.copied().max_by_key(|(first, last)| (*first, usize::MAX - last))
        else {
            return;
        };
        if self.folds.is_closed(head) {
            self.folds.open(head);
        } else {
            self.folds.close(head, last);
            self.leave_fold();
        }
    }

    pub fn fold_all(&mut self) {
        // The widest ones take in those within them.
        for (head, last) in self.findings.folds.clone() {
            if !self.folds.is_closed(head) {
                self.folds.close(head, last);
            }
        }
        self.leave_fold();
    }

    /// The caret does not stay in a line that is hidden.
    fn leave_fold(&mut self) {
        let shown = self.folds.line_at(self.folds.row_of(self.caret_line()));
        if shown != self.caret_line() {
            self.caret = Caret::at(self.text.line_end(shown));
        }
    }
}

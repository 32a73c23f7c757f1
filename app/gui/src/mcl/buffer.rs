//! The text of a program: edits, undo and redo, lines. Places are bytes of the text, as in the compiler's spans.
//!
//! The text is a rope: an edit costs the same at the first and at the last of many lines, and a copy for the thread that
//! checks costs nothing.

use std::borrow::Cow;
use std::ops::Range;

use ropey::{Rope, RopeSlice};

use super::caret::Caret;

/// One replacement of a stretch of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Byte at which the stretch began.
    pub at: usize,
    pub removed: String,
    pub inserted: String,
    /// The line of `at`, from 0.
    pub line: usize,
    /// Whether `at` is where its line begins.
    pub at_line_start: bool,
}

impl Edit {
    fn inverse(&self) -> Self {
        Self { removed: self.inserted.clone(), inserted: self.removed.clone(), ..self.clone() }
    }

    /// Lines taken away and lines put in.
    pub fn line_change(&self) -> (usize, usize) {
        let ends = |text: &str| text.bytes().filter(|byte| *byte == b'\n').count();
        (ends(&self.removed), ends(&self.inserted))
    }

    /// Where a place in the text before the edit is after it.
    pub fn moved(&self, place: usize) -> usize {
        if place <= self.at {
            place
        } else if place >= self.at + self.removed.len() {
            place - self.removed.len() + self.inserted.len()
        } else {
            self.at + self.inserted.len().min(place - self.at)
        }
    }
}

/// What an edit is for: edits of one kind in a row are undone together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Typing,
    Erasing,
    /// Undone by itself.
    Other,
}

/// Edits that are undone together.
#[derive(Clone, Debug)]
struct Group {
    kind: Kind,
    edits: Vec<Edit>,
    before: Caret,
    after: Caret,
}

/// A text that remembers what was done to it.
#[derive(Clone, Debug)]
pub struct Buffer {
    rope: Rope,
    done: Vec<Group>,
    undone: Vec<Group>,
    /// How many groups were done when the text was saved; `None` when that state cannot be reached any more.
    saved_at: Option<usize>,
    /// The last group takes no more edits.
    closed: bool,
    revision: u64,
}

impl Default for Buffer {
    fn default() -> Self {
        Self::new("")
    }
}

impl Buffer {
    /// A text that counts as saved.
    pub fn new(text: &str) -> Self {
        Self {
            rope: Rope::from_str(text),
            done: Vec::new(),
            undone: Vec::new(),
            saved_at: Some(0),
            closed: true,
            revision: 0,
        }
    }

    /// Changes with each edit, undo and redo.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// A copy that costs nothing.
    pub fn snapshot(&self) -> Rope {
        self.rope.clone()
    }

    pub fn text(&self) -> String {
        self.rope.to_string()
    }

    /// Bytes.
    pub fn len(&self) -> usize {
        self.rope.len_bytes()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How many lines there are; an empty text has one.
    pub fn line_count(&self) -> usize {
        self.rope.len_lines()
    }

    /// The line, from 0, that holds a byte.
    pub fn line_of(&self, at: usize) -> usize {
        self.rope.byte_to_line(at.min(self.len()))
    }

    /// Where a line begins; lines after the last begin at the end.
    pub fn line_start(&self, line: usize) -> usize {
        if line >= self.line_count() { self.len() } else { self.rope.line_to_byte(line) }
    }

    /// Where a line ends, before its line end.
    pub fn line_end(&self, line: usize) -> usize {
        let next = self.line_start(line + 1);
        if line + 1 >= self.line_count() { next } else { next - 1 }
    }

    /// A line without its end.
    pub fn line(&self, line: usize) -> Cow<'_, str> {
        self.slice(self.line_start(line)..self.line_end(line))
    }

    /// A stretch of the text; what lies outside or within a character is moved to where it can be.
    pub fn slice(&self, range: Range<usize>) -> Cow<'_, str> {
        let range = self.sound(range);
        self.rope.byte_slice(range).into()
    }

    /// A stretch that lies in the text and cuts no character.
    fn sound(&self, range: Range<usize>) -> Range<usize> {
        let start = self.boundary(range.start);
        start..self.boundary(range.end).max(start)
    }

    /// The place itself, or where the character begins in which it lies.
    pub fn boundary(&self, at: usize) -> usize {
        let at = at.min(self.len());
        self.rope.char_to_byte(self.rope.byte_to_char(at))
    }

    /// Characters before a place of its line.
    pub fn column(&self, at: usize) -> usize {
        let at = self.boundary(at);
        let start = self.line_start(self.line_of(at));
        self.rope.byte_to_char(at) - self.rope.byte_to_char(start)
    }

    pub fn as_slice(&self) -> RopeSlice<'_> {
        self.rope.slice(..)
    }

    /// Does several edits as one step of undo. Places of later ones are those of the text as the earlier ones left it.
    /// Hands back what was done.
    pub fn edit(
        &mut self,
        kind: Kind,
        before: Caret,
        edits: impl IntoIterator<Item = (Range<usize>, String)>,
        after: impl FnOnce(&Self) -> Caret,
    ) -> Vec<Edit> {
        let done: Vec<Edit> =
            edits.into_iter().filter_map(|(range, text)| self.replace(range, text)).collect();
        if done.is_empty() {
            return done;
        }
        let after = after(self);
        self.undone.clear();
        if self.saved_at.is_some_and(|saved| saved > self.done.len()) {
            self.saved_at = None;
        }
        match self.done.last_mut().filter(|group| !self.closed && goes_on(group, kind, &done)) {
            Some(group) => {
                group.edits.extend(done.iter().cloned());
                group.after = after;
            }
            None => self.done.push(Group { kind, edits: done.clone(), before, after }),
        }
        self.closed = kind == Kind::Other;
        done
    }

    fn replace(&mut self, range: Range<usize>, inserted: String) -> Option<Edit> {
        let range = self.sound(range);
        let removed = self.slice(range.clone()).into_owned();
        if removed == inserted {
            return None;
        }
        let line = self.line_of(range.start);
        let at_line_start = self.line_start(line) == range.start;
        let edit = Edit { at: range.start, removed, inserted, line, at_line_start };
        self.apply(&edit);
        Some(edit)
    }

    fn apply(&mut self, edit: &Edit) {
        let start = self.rope.byte_to_char(edit.at);
        let end = self.rope.byte_to_char(edit.at + edit.removed.len());
        self.rope.remove(start..end);
        self.rope.insert(start, &edit.inserted);
        self.revision += 1;
    }

    /// The next edit begins a step of undo of its own: the caret was moved, or time has passed.
    pub fn close_group(&mut self) {
        self.closed = true;
    }

    pub fn can_undo(&self) -> bool {
        !self.done.is_empty()
    }

    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Takes the last step back: what was done to the text, and the caret as it was.
    pub fn undo(&mut self) -> Option<(Vec<Edit>, Caret)> {
        let group = self.done.pop()?;
        let edits: Vec<Edit> = group.edits.iter().rev().map(Edit::inverse).collect();
        edits.iter().for_each(|edit| self.apply(edit));
        let caret = group.before;
        self.undone.push(group);
        self.closed = true;
        Some((edits, caret))
    }

    /// Does the step again that was taken back last.
    pub fn redo(&mut self) -> Option<(Vec<Edit>, Caret)> {
        let group = self.undone.pop()?;
        group.edits.iter().for_each(|edit| self.apply(edit));
        let (edits, caret) = (group.edits.clone(), group.after);
        self.done.push(group);
        self.closed = true;
        Some((edits, caret))
    }

    /// Whether the text differs from what was saved.
    pub fn is_modified(&self) -> bool {
        self.saved_at != Some(self.done.len())
    }

    pub fn set_saved(&mut self) {
        self.saved_at = Some(self.done.len());
        self.closed = true;
    }

    /// The text is not what any file holds.
    pub fn set_unsaved(&mut self) {
        self.saved_at = None;
        self.closed = true;
    }
}

/// Whether an edit belongs to the step before it: the same kind, at the place where that one ended, on one line.
fn goes_on(group: &Group, kind: Kind, next: &[Edit]) -> bool {
    let ([next], Some(last)) = (next, group.edits.last()) else { return false };
    if group.kind != kind || next.inserted.contains('\n') || next.removed.contains('\n') {
        return false;
    }
    match kind {
        // A word and the space after it are one step, the next word is another.
        Kind::Typing => {
            let begins_word = last.inserted.ends_with(' ') && !next.inserted.starts_with(' ');
            next.removed.is_empty() && next.at == last.at + last.inserted.len() && !begins_word
        }
        Kind::Erasing => next.at + next.removed.len() == last.at || next.at == last.at,
        Kind::Other => false,
    }
}

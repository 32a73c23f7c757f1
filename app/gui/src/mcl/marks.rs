//! Marks on lines that move with the text: bookmarks, breakpoints.

use std::collections::BTreeSet;

use super::buffer::Edit;

/// A set of lines, from 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    lines: BTreeSet<usize>,
}

impl Marks {
    pub fn contains(&self, line: usize) -> bool {
        self.lines.contains(&line)
    }

    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// In order.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        self.lines.iter().copied()
    }

    /// Sets a mark, or takes it away. True if it is set now.
    pub fn toggle(&mut self, line: usize) -> bool {
        if self.lines.remove(&line) { false } else { self.lines.insert(line) }
    }

    pub fn clear(&mut self) {
        self.lines.clear();
    }

    pub fn set(&mut self, lines: impl IntoIterator<Item = usize>) {
        self.lines = lines.into_iter().collect();
    }

    /// The next one after a line, round at the end.
    pub fn next(&self, line: usize) -> Option<usize> {
        self.lines.range(line + 1..).next().or_else(|| self.lines.first()).copied()
    }

    /// The one before a line, round at the beginning.
    pub fn previous(&self, line: usize) -> Option<usize> {
        self.lines.range(..line).next_back().or_else(|| self.lines.last()).copied()
    }

    /// Follows an edit of the text. Marks on lines that went away stay where the edit was.
    pub fn follow(&mut self, edit: &Edit) {
        let (removed, inserted) = edit.line_change();
        if removed == inserted || self.lines.is_empty() {
            return;
        }
        let moved = |line: usize| moved_line(edit, removed, inserted, line);
        self.lines = self.lines.iter().map(|line| moved(*line)).collect();
    }
}

/// Where a line is after an edit.
fn moved_line(edit: &Edit, removed: usize, inserted: usize, line: usize) -> usize {
    // Whole lines put in before a line push it down.
    let stays = if edit.at_line_start && removed == 0 { line < edit.line } else { line <= edit.line };
    if stays {
        line
    } else if line <= edit.line + removed && removed > 0 {
        edit.line + inserted.min(line - edit.line)
    } else {
        line - removed + inserted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mcl::buffer::{Buffer, Kind};
    use crate::mcl::caret::Caret;

    fn after(text: &str, marked: &[usize], range: std::ops::Range<usize>, with: &str) -> Vec<usize> {
        let mut buffer = Buffer::new(text);
        let mut marks = Marks::default();
        marks.set(marked.iter().copied());
        let edits =
            buffer.edit(Kind::Other, Caret::default(), [(range, with.to_owned())], |_| Caret::default());
        edits.iter().for_each(|edit| marks.follow(edit));
        marks.iter().collect()
    }

    #[test]
    fn marks_stay_on_their_lines_when_lines_come_and_go_before_them() {
        assert_eq!(after("a\nb\nc\n", &[1, 2], 0..0, "x\ny\n"), [3, 4]);
        assert_eq!(after("a\nb\nc\n", &[2], 0..2, ""), [1]);
        // A line broken in two: the mark stays with its beginning.
        assert_eq!(after("ab\nc\n", &[0, 1], 1..1, "\n"), [0, 2]);
        // Enter at the very beginning pushes the line down with its mark.
        assert_eq!(after("ab\nc\n", &[0], 0..0, "\n"), [1]);
        assert_eq!(after("a\nb\nc\n", &[0, 1, 2], 0..5, ""), [0]);
    }

    #[test]
    fn the_next_mark_goes_round() {
        let mut marks = Marks::default();
        marks.set([3, 7]);
        assert_eq!((marks.next(3), marks.next(7), marks.previous(3)), (Some(7), Some(3), Some(7)));
        assert_eq!(Marks::default().next(0), None);
    }
}

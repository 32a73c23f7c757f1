//! How keys move the caret: by characters as people see them, words, lines.

use std::ops::Range;

use unicode_segmentation::{GraphemeCursor, UnicodeSegmentation as _};

use super::{Buffer, Caret};

/// A way to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    Left,
    Right,
    WordLeft,
    WordRight,
    Up,
    Down,
    PageUp(usize),
    PageDown(usize),
    LineStart,
    LineEnd,
    Start,
    End,
}

/// Where text in a line stands: tabs go to the next stop.
pub const TAB_CELLS: usize = 4;

/// Where a caret is after a move. `step` tells which line lies so many visible lines further on: folded ones are passed over.
pub fn moved(
    text: &Buffer,
    caret: Caret,
    way: Move,
    extend: bool,
    step: impl Fn(usize, isize) -> usize,
) -> Caret {
    let selected = !caret.is_empty() && !extend;
    let to = match way {
        Move::Left if selected => caret.range().start,
        Move::Right if selected => caret.range().end,
        Move::Left => before(text, caret.head),
        Move::Right => after(text, caret.head),
        Move::WordLeft => word_left(text, caret.head),
        Move::WordRight => word_right(text, caret.head),
        Move::LineStart => line_start(text, caret.head),
        Move::LineEnd => text.line_end(text.line_of(caret.head)),
        Move::Start => 0,
        Move::End => text.len(),
        Move::Up => return vertical(text, caret, -1, extend, step),
        Move::Down => return vertical(text, caret, 1, extend, step),
        Move::PageUp(lines) => return vertical(text, caret, -(lines as isize), extend, step),
        Move::PageDown(lines) => return vertical(text, caret, lines as isize, extend, step),
    };
    caret.to(to, extend)
}

fn vertical(
    text: &Buffer,
    caret: Caret,
    lines: isize,
    extend: bool,
    step: impl Fn(usize, isize) -> usize,
) -> Caret {
    let line = text.line_of(caret.head);
    let goal = caret.goal.unwrap_or_else(|| cell_of(&text.line(line), caret.head - text.line_start(line)));
    let target = step(line, lines);
    let head = if target == line {
        if lines < 0 { text.line_start(line) } else { text.line_end(line) }
    } else {
        text.line_start(target) + byte_at_cell(&text.line(target), goal)
    };
    Caret { goal: Some(goal), ..caret.to(head, extend) }
}

/// The place one character, as a person sees it, further left.
pub fn before(text: &Buffer, at: usize) -> usize {
    let line = text.line_of(at);
    let start = text.line_start(line);
    if at <= start {
        return start.saturating_sub(1);
    }
    let shown = text.line(line);
    let mut cursor = GraphemeCursor::new(at - start, shown.len(), true);
    start + cursor.prev_boundary(&shown, 0).ok().flatten().unwrap_or(0)
}

/// The place one character further right.
pub fn after(text: &Buffer, at: usize) -> usize {
    let line = text.line_of(at);
    let (start, end) = (text.line_start(line), text.line_end(line));
    if at >= end {
        return (end + 1).min(text.len());
    }
    let shown = text.line(line);
    let mut cursor = GraphemeCursor::new(at - start, shown.len(), true);
    start + cursor.next_boundary(&shown, 0).ok().flatten().unwrap_or(shown.len())
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Space,
    Word,
    Sign,
}

fn class(letter: char) -> Class {
    if letter.is_whitespace() {
        Class::Space
    } else if letter.is_alphanumeric() || letter == '_' {
        Class::Word
    } else {
        Class::Sign
    }
}

fn word_left(text: &Buffer, at: usize) -> usize {
    let line = text.line_of(at);
    let start = text.line_start(line);
    if at <= start {
        return start.saturating_sub(1);
    }
    let shown = text.slice(start..at);
    let trimmed = shown.trim_end();
    let Some(last) = trimmed.chars().next_back().map(class) else { return start };
    start + trimmed.trim_end_matches(|letter| class(letter) == last).len()
}

fn word_right(text: &Buffer, at: usize) -> usize {
    let end = text.line_end(text.line_of(at));
    if at >= end {
        return (end + 1).min(text.len());
    }
    let shown = text.slice(at..end);
    let Some(first) = shown.chars().next().map(class) else { return end };
    let rest = shown.trim_start_matches(|letter| class(letter) == first);
    end - rest.trim_start().len()
}

/// Where the line's text begins, or the line itself when the caret is there already.
fn line_start(text: &Buffer, at: usize) -> usize {
    let line = text.line_of(at);
    let start = text.line_start(line);
    let indented = start + indent_of(&text.line(line)).len();
    if at == indented { start } else { indented }
}

/// The spaces and tabs that a line begins with.
pub fn indent_of(line: &str) -> &str {
    &line[..line.len() - line.trim_start_matches([' ', '\t']).len()]
}

/// What a double click takes: the word, the spaces or the signs around a place.
pub fn word_at(text: &Buffer, at: usize) -> Range<usize> {
    let line = text.line_of(at);
    let start = text.line_start(line);
    let shown = text.line(line);
    let inside = at - start;
    let kind = |letter: Option<char>| letter.map(class);
    let (right, left) = (kind(shown[inside..].chars().next()), kind(shown[..inside].chars().next_back()));
    let Some(wanted) = right
        .filter(|class| *class == Class::Word)
        .or(left.filter(|class| *class == Class::Word))
        .or(right)
        .or(left)
    else {
        return at..at;
    };
    let from = shown[..inside].trim_end_matches(|letter| class(letter) == wanted).len();
    let to = shown.len() - shown[inside..].trim_start_matches(|letter| class(letter) == wanted).len();
    start + from..start + to
}

/// The cell at which a byte of a line stands.
pub fn cell_of(line: &str, byte: usize) -> usize {
    let mut cell = 0;
    for (at, piece) in line.grapheme_indices(true) {
        if at >= byte {
            break;
        }
        cell = next_cell(cell, piece);
    }
    cell
}

/// The byte of a line that stands at a cell, or the nearest before it.
pub fn byte_at_cell(line: &str, wanted: usize) -> usize {
    let mut cell = 0;
    for (at, piece) in line.grapheme_indices(true) {
        let next = next_cell(cell, piece);
        if next > wanted {
            return at;
        }
        cell = next;
    }
    line.len()
}

fn next_cell(cell: usize, piece: &str) -> usize {
    if piece == "\t" { (cell / TAB_CELLS + 1) * TAB_CELLS } else { cell + 1 }
}

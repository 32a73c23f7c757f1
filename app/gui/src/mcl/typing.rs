//! What keys do to a program's text: typing, Enter with its indent, erasing, indenting, comments, whole lines.

use std::ops::Range;

use super::moves::{self, Move, TAB_CELLS, indent_of, moved};
use super::{Caret, Document, Kind};

/// One step of indent.
const INDENT: &str = "    ";
/// Words after which the next line stands further right.
const OPENING: [&str; 8] = ["while", "do", "repeat", "for", "else", "elseif", "#if", "#else"];
/// Words that stand further left than the line before.
const CLOSING: [&str; 8] = ["wend", "until", "next", "endif", "else", "elseif", "#endif", "#else"];

impl Document {
    /// Puts text in place of what is selected.
    pub fn insert(&mut self, kind: Kind, text: &str) {
        let range = self.caret.range();
        let end = range.start + text.len();
        self.edit(kind, [(range, text.to_owned())], |_| Caret::at(end));
    }

    /// Types a letter, or several.
    pub fn type_text(&mut self, text: &str) {
        self.insert(Kind::Typing, text);
        self.undent_closing();
    }

    /// A line that has just become a word that closes a block goes back under the word that opened it.
    fn undent_closing(&mut self) {
        let line = self.caret_line();
        let (start, shown) = (self.text.line_start(line), self.text.line(line).into_owned());
        let indent = indent_of(&shown);
        let word = shown[indent.len()..].to_ascii_lowercase();
        let at_end = self.caret.head == start + shown.len();
        if line == 0 || !at_end || !CLOSING.contains(&word.as_str()) {
            return;
        }
        let above = (0..line).rev().map(|line| self.text.line(line)).find(|line| !line.trim().is_empty());
        let Some(above) = above else { return };
        let opens = opens_block(&above);
        let wanted = indent_of(&above);
        let wanted = if opens { wanted.to_owned() } else { one_less(wanted) };
        if wanted.len() < indent.len() {
            let cut = indent.len() - wanted.len();
            let head = self.caret.head - cut;
            let edit = (start..start + indent.len(), wanted);
            self.edit(Kind::Other, [edit], |_| Caret::at(head));
        }
    }

    /// Enter: a new line that stands as far right as the one before, or further within a block.
    pub fn new_line(&mut self) {
        let range = self.caret.range();
        let line = self.text.line_of(range.start);
        let before = self.text.slice(self.text.line_start(line)..range.start).into_owned();
        let mut indent = indent_of(&before).to_owned();
        if opens_block(&before) {
            indent.push_str(INDENT);
        }
        let text = format!("\n{indent}");
        let end = range.start + text.len();
        self.edit(Kind::Other, [(range, text)], |_| Caret::at(end));
    }

    /// Takes away what is selected, or what lies between the caret and where a move would bring it.
    pub fn erase(&mut self, way: Move) {
        let range = if self.caret.is_empty() {
            let lines = self.text.line_count();
            let step = |line: usize, rows: isize| line.saturating_add_signed(rows).min(lines - 1);
            let to = moved(&self.text, self.caret, way, false, step).head;
            let to = self.indent_before(way).unwrap_or(to);
            self.caret.head.min(to)..self.caret.head.max(to)
        } else {
            self.caret.range()
        };
        let start = range.start;
        self.edit(Kind::Erasing, [(range, String::new())], |_| Caret::at(start));
    }

    /// Backspace within the indent takes a whole step of it.
    fn indent_before(&self, way: Move) -> Option<usize> {
        let start = self.text.line_start(self.caret_line());
        let before = self.text.slice(start..self.caret.head);
        let only_spaces = way == Move::Left && !before.is_empty() && before.bytes().all(|byte| byte == b' ');
        only_spaces.then(|| start + (before.len() - 1) / TAB_CELLS * TAB_CELLS)
    }

    /// Tab: the selected lines go right, or spaces up to the next stop.
    pub fn indent(&mut self) {
        let lines = self.selected_lines();
        if lines.len() > 1 {
            return self.change_lines(lines, |line| {
                if line.is_empty() { String::new() } else { format!("{INDENT}{line}") }
            });
        }
        let at = self.caret.range().start;
        let line = self.text.line_of(at);
        let cell = moves::cell_of(&self.text.line(line), at - self.text.line_start(line));
        self.insert(Kind::Other, &" ".repeat(TAB_CELLS - cell % TAB_CELLS));
    }

    /// Shift+Tab: the selected lines go left.
    pub fn unindent(&mut self) {
        self.change_lines(self.selected_lines(), |line| {
            let indent = indent_of(line);
            format!("{}{}", one_less(indent), &line[indent.len()..])
        });
    }

    /// Makes comments of the selected lines, or code again if all of them are comments.
    pub fn toggle_comment(&mut self) {
        let lines = self.selected_lines();
        let written: Vec<String> = lines
            .clone()
            .map(|line| self.text.line(line).into_owned())
            .filter(|line| !line.trim().is_empty())
            .collect();
        let all = !written.is_empty() && written.iter().all(|line| line.trim_start().starts_with(';'));
        let least = written.iter().map(|line| indent_of(line).len()).min().unwrap_or(0);
        self.change_lines(lines, |line| {
            if line.trim().is_empty() {
                line.to_owned()
            } else if all {
                let at = indent_of(line).len();
                let rest = &line[at + 1..];
                format!("{}{}", &line[..at], rest.strip_prefix(' ').unwrap_or(rest))
            } else {
                format!("{}; {}", &line[..least], &line[least..])
            }
        });
    }

    /// The lines that are selected or hold the caret. A selection that ends at the beginning of a line ends before it.
    pub fn selected_lines(&self) -> Range<usize> {
        let range = self.caret.range();
        let (first, last) = (self.text.line_of(range.start), self.text.line_of(range.end));
        let only_begun = last > first && range.end == self.text.line_start(last);
        first..if only_begun { last } else { last + 1 }
    }

    /// Writes lines anew, as one step; the selection stays on them.
    pub fn change_lines(&mut self, lines: Range<usize>, change: impl Fn(&str) -> String) {
        let edits: Vec<(Range<usize>, String)> = lines
            .clone()
            .rev()
            .map(|line| {
                let range = self.text.line_start(line)..self.text.line_end(line);
                let changed = change(&self.text.line(line));
                (range, changed)
            })
            .collect();
        let before = self.caret;
        let from_end = |at: usize| {
            let line = self.text.line_of(at);
            (line, self.text.line_end(line) - at)
        };
        let (anchor, head) = (from_end(before.anchor), from_end(before.head));
        self.edit(Kind::Other, edits, |text| {
            let place = |(line, rest): (usize, usize)| {
                text.line_end(line).saturating_sub(rest).max(text.line_start(line))
            };
            Caret::selecting(place(anchor), place(head))
        });
    }

    /// Puts a copy of the selected lines below them.
    pub fn duplicate_lines(&mut self) {
        let lines = self.selected_lines();
        let end = self.text.line_end(lines.end - 1);
        let copy = format!("\n{}", self.text.slice(self.text.line_start(lines.start)..end));
        let (caret, shift) = (self.caret, copy.len());
        self.edit(Kind::Other, [(end..end, copy)], |_| {
            Caret::selecting(caret.anchor + shift, caret.head + shift)
        });
    }

    /// Takes the selected lines away.
    pub fn delete_lines(&mut self) {
        let lines = self.selected_lines();
        let (start, end) = (self.text.line_start(lines.start), self.text.line_start(lines.end));
        // The last line takes the line end before it along.
        let from = if end == self.text.len() && self.text.line_end(lines.end - 1) == end {
            start.saturating_sub(1)
        } else {
            start
        };
        self.edit(Kind::Other, [(from..end, String::new())], |text| {
            Caret::at(text.line_start(lines.start.min(text.line_count() - 1)))
        });
    }

    /// Moves the selected lines over the line above or below.
    pub fn move_lines(&mut self, down: bool) {
        let lines = self.selected_lines();
        let last = self.text.line_count();
        if down && lines.end >= last || !down && lines.start == 0 {
            return;
        }
        let (first, end) = if down { (lines.start, lines.end + 1) } else { (lines.start - 1, lines.end) };
        let mut texts: Vec<String> = (first..end).map(|line| self.text.line(line).into_owned()).collect();
        if down {
            texts.rotate_right(1);
        } else {
            texts.rotate_left(1);
        }
        let passed = if down { texts[0].len() } else { texts[texts.len() - 1].len() } as isize + 1;
        let shift = if down { passed } else { -passed };
        let range = self.text.line_start(first)..self.text.line_end(end - 1);
        let caret = self.caret;
        self.edit(Kind::Other, [(range, texts.join("\n"))], |text| {
            // A selection that reached to the start of the passed line ends behind the last line now.
            let moved = |at: usize| at.saturating_add_signed(shift).min(text.len());
            Caret::selecting(moved(caret.anchor), moved(caret.head))
        });
    }

    /// Writes the program anew in the usual form; the caret stays in its line.
    pub fn tidy(&mut self) {
        let text = self.text.text();
        let tidied = self.language().format(&text);
        if tidied != text {
            self.replace_all(&tidied);
        }
    }

    /// What is copied or cut: the selection, or the whole line without one.
    pub fn copied(&self) -> String {
        if !self.caret.is_empty() {
            return self.text.slice(self.caret.range()).into_owned();
        }
        format!("{}\n", self.text.line(self.caret_line()))
    }

    /// Cuts what [`Document::copied`] gives.
    pub fn cut(&mut self) -> String {
        let copied = self.copied();
        if self.caret.is_empty() {
            self.delete_lines();
        } else {
            self.insert(Kind::Other, "");
        }
        copied
    }

    /// Pastes; line ends of any kind become those of the text.
    pub fn paste(&mut self, text: &str) {
        let text = text.replace("\r\n", "\n").replace('\r', "\n");
        self.insert(Kind::Other, &text);
    }
}

/// Whether the next line belongs further right.
fn opens_block(line: &str) -> bool {
    let code = line.split(';').next().unwrap_or("").trim().to_ascii_lowercase();
    let first =
        code.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '#').next().unwrap_or("");
    match first {
        // `if x then label` is whole on one line.
        "if" => code.ends_with("then"),
        // The foot of a DO loop opens nothing, but a WHILE of its own does; the former is rarer.
        "#ifdef" | "#ifndef" | "#elseif" | "#elseifdef" | "#elseifndef" => true,
        word => OPENING.contains(&word),
    }
}

/// An indent that is one step less.
fn one_less(indent: &str) -> String {
    if let Some(rest) = indent.strip_suffix('\t') {
        return rest.to_owned();
    }
    let spaces = indent.len() - indent.trim_end_matches(' ').len();
    let step = if spaces.is_multiple_of(TAB_CELLS) { TAB_CELLS } else { spaces % TAB_CELLS };
    indent[..indent.len() - step.min(spaces)].to_owned()
}

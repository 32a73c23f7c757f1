//! What a compiler says about a program: a code, a place, a sentence and, where there is one, a hint.

use crate::mcl::codes;
use crate::text::{Lines, Place, Span};
use serde::Serialize;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// There is no program to run.
    Error,
    /// There is one, but it may not do what was meant.
    Warning,
}

/// One thing said about a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// "E..." for errors, "W..." for warnings; see [`crate::mcl::codes`].
    pub code: &'static str,
    /// Where.
    pub span: Span,
    /// What is wrong, as a sentence.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

/// A diagnostic with its line and column, for lists and JSON.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlacedDiagnostic {
    /// Its code.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// Where it begins.
    #[serde(flatten)]
    pub place: Place,
    /// Where it ends.
    pub end: Place,
    /// What is wrong.
    pub message: String,
    /// What to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

fn severity_of(code: &str) -> Severity {
    if code.starts_with('E') { Severity::Error } else { Severity::Warning }
}

impl Diagnostic {
    /// Error or warning, by the first letter of the code.
    #[must_use]
    pub fn severity(&self) -> Severity {
        severity_of(self.code)
    }

    /// With line and column.
    #[must_use]
    pub fn placed(&self, text: &str, lines: &Lines) -> PlacedDiagnostic {
        PlacedDiagnostic {
            code: self.code,
            severity: self.severity(),
            place: lines.place(text, self.span.start),
            end: lines.place(text, self.span.end),
            message: self.message.clone(),
            hint: self.hint.clone(),
        }
    }

    /// As compilers print it: place, message, the line with a mark under the spot, the hint.
    #[must_use]
    pub fn render(&self, name: &str, text: &str, lines: &Lines) -> String {
        let Place { line, column } = lines.place(text, self.span.start);
        let severity = match self.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let (shown, before) = self.shown(lines.text_of(text, line), column, lines.start_of(line));
        let wide = self.span.of(text).chars().take(MOST_SHOWN).take_while(|letter| *letter != '\n').count();
        let left = shown.chars().count().saturating_sub(before);
        let mark = "^".repeat(wide.min(left).max(1));
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let indent = " ".repeat(before);
        let mut page = format!("{name}:{line}:{column}: {severity} {}: {}\n", self.code, self.message);
        page += &format!("{number} | {shown}\n{margin} | {indent}{mark}\n");
        if let Some(hint) = &self.hint {
            page += &format!("{margin} = {hint}\n");
        }
        page
    }

    /// What is shown of the line, which begins at byte `start` of the text, and how many characters of that stand before the spot.
    fn shown(&self, line: &str, column: u32, start: u32) -> (String, usize) {
        let visible = |letter: char| match letter {
            '\t' => ' ',
            '\0'..='\u{1F}' => char::from_u32(0x2400 + u32::from(letter)).unwrap_or(' '),
            letter if letter.is_control() => char::REPLACEMENT_CHARACTER,
            letter => letter,
        };
        if line.len() <= MOST_SHOWN {
            return (line.chars().map(visible).collect(), column as usize - 1);
        }
        let at = (self.span.start.saturating_sub(start) as usize).min(line.len());
        let (before, after) = line.split_at_checked(at).unwrap_or((line, ""));
        let from = before.char_indices().rev().take(MOST_SHOWN / 2).last().map_or(at, |(from, _)| from);
        let to = after.char_indices().nth(MOST_SHOWN / 2).map_or(line.len(), |(to, _)| at + to);
        let (head, tail) = (if from > 0 { "…" } else { "" }, if to < line.len() { "…" } else { "" });
        let middle: String = line[from..to].chars().map(visible).collect();
        let before = head.chars().count() + line[from..at].chars().count();
        (format!("{head}{middle}{tail}"), before)
    }
}

/// Lines of more bytes are shown around the spot alone: about three rows of a terminal.
const MOST_SHOWN: usize = 256;

/// The beginning of a piece of a program, for a message.
#[must_use]
pub fn excerpt(piece: &str) -> Cow<'_, str> {
    match piece.char_indices().nth(MOST_QUOTED) {
        Some((end, _)) => format!("{}…", &piece[..end]).into(),
        None => piece.into(),
    }
}

/// Characters of the program that a message repeats; a name that a person writes is shorter.
const MOST_QUOTED: usize = 64;

/// How many errors, and how many warnings, are told of one program. Microsoft's compiler stops at as many errors (its C1003), Clang at 20.
pub const MOST_TOLD: usize = 100;

/// Everything said of a program while it is compiled: the first [`MOST_TOLD`] errors and warnings in the order of the text, and of the rest
/// how many there are. What is said twice counts once.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    errors: Reported,
    warnings: Reported,
}

#[derive(Clone, Debug, Default)]
struct Reported {
    /// By place and code.
    list: BTreeMap<(u32, &'static str), Vec<Diagnostic>>,
    count: usize,
    /// The places of the others, and the figures of their codes.
    others: HashSet<(u32, u16)>,
}

impl Reported {
    /// `told` is only asked for what is listed.
    fn push(&mut self, key: (u32, &'static str), reported: impl FnOnce() -> Diagnostic) {
        let is_late = self.list.last_key_value().is_none_or(|(last, _)| key > *last);
        if self.count >= MOST_TOLD && is_late {
            return self.pass_over(key);
        }
        let said = reported();
        let same = self.list.entry(key).or_default();
        if same.contains(&said) {
            return;
        }
        same.push(said);
        self.count += 1;
        if self.count > MOST_TOLD
            && let Some(mut last) = self.list.last_entry()
        {
            let key = *last.key();
            last.get_mut().pop();
            if last.get().is_empty() {
                last.remove();
            }
            self.count -= 1;
            self.pass_over(key);
        }
    }

    fn pass_over(&mut self, (start, code): (u32, &'static str)) {
        self.others.insert((start, code[1..].parse().unwrap_or(0)));
    }

    /// "There are 12 more errors than are listed here." at the first of them.
    fn more(&self, code: &'static str, what: &str) -> Option<Diagnostic> {
        let start = self.others.iter().map(|(start, _)| *start).min()?;
        let message = match self.others.len() {
            1 => format!("There is 1 more {what} than the {MOST_TOLD} that are listed."),
            more => format!("There are {more} more {what}s than the {MOST_TOLD} that are listed."),
        };
        let hint = Some("Mend those first; the rest is listed then.".to_owned());
        Some(Diagnostic { code, span: Span { start, end: start }, message, hint })
    }
}

impl Diagnostics {
    /// Notes one.
    pub fn push(&mut self, said: Diagnostic) {
        self.note(said.span.start, said.code, || said);
    }

    /// Notes one at byte `start`; what it says is only asked if it is listed.
    pub fn note(&mut self, start: u32, code: &'static str, reported: impl FnOnce() -> Diagnostic) {
        match severity_of(code) {
            Severity::Error => self.errors.push((start, code), reported),
            Severity::Warning => self.warnings.push((start, code), reported),
        }
    }

    /// Whether there is an error among them.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors.count > 0
    }

    /// Those that are kept, errors first.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.errors.list.values().chain(self.warnings.list.values()).flatten()
    }

    /// All that is told, in the order of the text; at last how much more there is.
    #[must_use]
    pub fn finish(self) -> Vec<Diagnostic> {
        let more = [
            self.errors.more(codes::MORE_ERRORS, "error"),
            self.warnings.more(codes::MORE_WARNINGS, "warning"),
        ];
        let lists = self.errors.list.into_values().chain(self.warnings.list.into_values());
        let mut reported: Vec<Diagnostic> = lists.flatten().collect();
        reported.sort_by_key(|said| (said.span.start, said.code));
        reported.extend(more.into_iter().flatten());
        reported
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_stands_under_the_spot() {
        let text = "main\n\tgoto mian\n";
        let diagnostic = Diagnostic {
            code: "E301",
            span: Span::new(11, 15),
            message: "There is no label `mian`.".into(),
            hint: Some("Did you mean `main`?".into()),
        };
        let page = diagnostic.render("a.mcl", text, &Lines::of(text));
        let expected = "a.mcl:2:7: error E301: There is no label `mian`.\n2 |  goto mian\n  |       ^^^^\n  = Did you mean `main`?\n";
        assert_eq!(page, expected);
    }
}

//! What a compiler says about a program: a code, a place, a sentence and, where there is one, a hint.

use crate::text::{Lines, Place, Span};
use serde::Serialize;

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

impl Diagnostic {
    /// Error or warning, by the first letter of the code.
    #[must_use]
    pub fn severity(&self) -> Severity {
        if self.code.starts_with('E') { Severity::Error } else { Severity::Warning }
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
        let shown = lines.text_of(text, line).replace('\t', " ");
        let left = shown.chars().count() as u32 + 1 - column.min(shown.chars().count() as u32 + 1);
        let wide = self.span.of(text).chars().take_while(|letter| *letter != '\n').count() as u32;
        let mark = "^".repeat(wide.clamp(1, left.max(1)) as usize);
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let indent = " ".repeat(column as usize - 1);
        let mut page = format!("{name}:{line}:{column}: {severity} {}: {}\n", self.code, self.message);
        page += &format!("{number} | {shown}\n{margin} | {indent}{mark}\n");
        if let Some(hint) = &self.hint {
            page += &format!("{margin} = {hint}\n");
        }
        page
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

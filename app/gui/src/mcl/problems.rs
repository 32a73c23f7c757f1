//! What the compiler said about a program, held where it belongs while the text is typed on: problems, foldable lines, parts left out.

use std::ops::Range;
use std::sync::Arc;

use brushwork_script::diagnostic::Severity;
use brushwork_script::mcl::codes;
use brushwork_script::mcl::index::Index;

use super::buffer::Edit;
use super::check::Checked;

/// An error or a warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub severity: Severity,
    pub code: &'static str,
    /// Bytes of the text as it is now.
    pub range: Range<usize>,
    pub message: String,
    pub hint: Option<String>,
}

impl Problem {
    /// Message and hint.
    pub fn in_full(&self) -> String {
        let hint = self.hint.as_ref().map(|hint| format!("\n{hint}")).unwrap_or_default();
        format!("{} {}: {}{hint}", self.word(), self.code, self.message)
    }

    pub const fn word(&self) -> &'static str {
        match self.severity {
            Severity::Error => "Error",
            Severity::Warning => "Warning",
        }
    }
}

/// What is known of a program.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// The newest answer of the compiler.
    pub checked: Option<Arc<Checked>>,
    pub problems: Vec<Problem>,
    /// First and last lines, from 0, of what can be folded, in order.
    pub folds: Vec<(usize, usize)>,
    /// Bytes that directives leave out.
    pub left_out: Vec<Range<usize>>,
}

impl Findings {
    /// Takes over what was found.
    pub fn take(&mut self, checked: Arc<Checked>) {
        let bytes = |span: brushwork_script::text::Span| span.start as usize..span.end as usize;
        let problem = |diagnostic: &brushwork_script::diagnostic::Diagnostic| Problem {
            severity: diagnostic.severity(),
            code: diagnostic.code,
            range: bytes(diagnostic.span),
            message: diagnostic.message.clone(),
            hint: diagnostic.hint.clone(),
        };
        let Index { diagnostics, folds, left_out, .. } = &checked.index;
        self.problems = diagnostics.iter().map(problem).collect();
        self.problems.sort_by_key(|problem| problem.range.start);
        self.folds = folds.iter().map(|fold| (fold.first as usize - 1, fold.last as usize - 1)).collect();
        self.folds.sort_unstable();
        self.left_out = left_out.iter().map(|span| bytes(*span)).collect();
        self.checked = Some(checked);
    }

    /// The index, if it is that of this text.
    pub fn fresh(&self, revision: u64) -> Option<&Arc<Checked>> {
        self.checked.as_ref().filter(|checked| checked.revision == revision)
    }

    /// Follows an edit until the compiler has spoken again.
    pub fn follow(&mut self, edit: &Edit) {
        for problem in &mut self.problems {
            problem.range = edit.moved(problem.range.start)..edit.moved(problem.range.end);
        }
        for range in &mut self.left_out {
            *range = edit.moved(range.start)..edit.moved(range.end);
        }
        let (removed, inserted) = edit.line_change();
        if removed != inserted {
            let moved =
                |line: usize| if line > edit.line { (line + inserted).saturating_sub(removed) } else { line };
            for fold in &mut self.folds {
                *fold = (moved(fold.0), moved(fold.1).max(moved(fold.0)));
            }
        }
    }

    /// Where the block ends that begins at a line.
    pub fn last_of(&self, head: usize) -> Option<usize> {
        let folds = self.folds.iter().filter(|(first, last)| *first == head && last > first);
        folds.map(|(_, last)| *last).max()
    }

    /// Errors and warnings.
    pub fn counts(&self) -> (usize, usize) {
        let listed = || self.problems.iter().filter(|problem| !codes::is_count(problem.code));
        let of = |severity| listed().filter(|problem| problem.severity == severity).count();
        (of(Severity::Error), of(Severity::Warning))
    }

    /// The problems at a byte, errors first.
    pub fn at(&self, byte: usize) -> Vec<&Problem> {
        let touches = |range: &Range<usize>| range.start <= byte && byte <= range.end.max(range.start + 1);
        let mut found: Vec<&Problem> =
            self.problems.iter().filter(|problem| touches(&problem.range)).collect();
        found.sort_by_key(|problem| problem.severity == Severity::Warning);
        found
    }
}

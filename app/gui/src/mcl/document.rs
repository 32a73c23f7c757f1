//! One open program: its text, caret, marks, and what the compiler says about it.

use std::path::PathBuf;

use brushwork_script::diagnostic::Severity;
use brushwork_script::language::Language;
use egui::Vec2;

use super::composing::Composing;
use super::disk::{Format, LineEnds, Stamp};
use super::fold::Folds;
use super::marks::Marks;
use super::problems::Findings;
use super::{Buffer, Caret, DocId, Edit, Kind};

/// One open program.
#[derive(Debug)]
pub struct Document {
    id: DocId,
    /// Its file; none before it was saved.
    pub path: Option<PathBuf>,
    /// What it is called while it has no file.
    pub untitled: String,
    pub text: Buffer,
    pub caret: Caret,
    pub bookmarks: Marks,
    /// Lines, from 0, at which a run is to halt.
    pub breakpoints: Marks,
    pub folds: Folds,
    /// What an input method has put into the text and not committed.
    pub composing: Option<Composing>,
    pub run: RunMarks,
    pub view: View,
    /// What the compiler says.
    pub findings: Findings,
    /// Encoding and line ends of the file.
    pub format: Format,
    /// The file as it was when it was read or written here.
    pub(super) stamp: Option<Stamp>,
    pub on_disk: OnDisk,
    pub(super) is_saving: bool,
    /// The revision seen last, and when it came, seconds.
    pub(super) seen: (u64, f64),
    /// The revision that is kept against a crash.
    pub(super) kept: u64,
}

/// Whether the file is as it was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnDisk {
    #[default]
    Same,
    /// Another program has written it, while there is unsaved text here.
    Changed,
    Gone,
}

/// What a run of this program shows beside its lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunMarks {
    /// The line, from 0, at which the machine halts.
    pub halted_at: Option<usize>,
    /// How often each line, from 0, was run; empty without a run that counts.
    pub counts: Vec<u64>,
}

/// How the program is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// How far it is scrolled, in points.
    pub offset: Vec2,
    /// What of it is in view, in points.
    pub size: Vec2,
    /// The widest line seen so far, in points.
    pub widest: f32,
    /// The caret is to come into view.
    pub reveal: Reveal,
}

/// Whether and how the caret is brought into view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reveal {
    #[default]
    No,
    /// By as little as need be.
    Nearest,
    /// In the middle, as after a jump.
    Middle,
}

impl Document {
    pub fn new(id: DocId, untitled: String, text: &str) -> Self {
        Self {
            id,
            path: None,
            untitled,
            text: Buffer::new(text),
            caret: Caret::default(),
            bookmarks: Marks::default(),
            breakpoints: Marks::default(),
            folds: Folds::default(),
            composing: None,
            run: RunMarks::default(),
            view: View::default(),
            findings: Findings::default(),
            format: Format::default(),
            stamp: None,
            on_disk: OnDisk::Same,
            is_saving: false,
            seen: (0, 0.0),
            kept: 0,
        }
    }

    pub fn id(&self) -> DocId {
        self.id
    }

    /// As the tab shows it.
    pub fn title(&self) -> String {
        let name = self.path.as_ref().and_then(|path| path.file_name());
        name.map_or_else(|| self.untitled.clone(), |name| name.to_string_lossy().into_owned())
    }

    /// The language that it is in, by the end of its name.
    pub fn language(&self) -> Language {
        Language::of_file(&self.title())
    }

    /// The line of the caret, from 0.
    pub fn caret_line(&self) -> usize {
        self.text.line_of(self.caret.head)
    }

    /// Replaces stretches of the text as one step of undo. `after` tells where the caret is then.
    pub fn edit(
        &mut self,
        kind: Kind,
        edits: impl IntoIterator<Item = (std::ops::Range<usize>, String)>,
        after: impl FnOnce(&Buffer) -> Caret,
    ) {
        let mut caret = self.caret;
        let done = self.text.edit(kind, self.caret, edits, |text| {
            caret = after(text);
            caret
        });
        if !done.is_empty() {
            self.follow(&done);
            self.caret = caret;
            self.folds.show(self.text.line_of(caret.head));
        }
        self.view.reveal = Reveal::Nearest;
    }

    pub fn undo(&mut self) {
        if let Some((edits, caret)) = self.text.undo() {
            self.follow(&edits);
            self.caret = caret;
            self.view.reveal = Reveal::Nearest;
        }
    }

    pub fn redo(&mut self) {
        if let Some((edits, caret)) = self.text.redo() {
            self.follow(&edits);
            self.caret = caret;
            self.view.reveal = Reveal::Nearest;
        }
    }

    /// Marks go along with the text.
    fn follow(&mut self, edits: &[Edit]) {
        for edit in edits {
            self.bookmarks.follow(edit);
            self.breakpoints.follow(edit);
            self.folds.follow(edit);
            self.findings.follow(edit);
        }
        // Counts and the place of a halt are those of the program that runs, not of this text.
        self.run = RunMarks::default();
    }

    /// Puts another text in place of the whole, as one step of undo.
    pub fn replace_all(&mut self, text: &str) {
        let line = self.caret_line();
        let whole = 0..self.text.len();
        self.edit(Kind::Other, [(whole, text.to_owned())], |text| {
            Caret::at(text.line_start(line.min(text.line_count() - 1)))
        });
    }

    /// Puts the caret at a place and brings it into view.
    pub fn go_to(&mut self, caret: Caret) {
        let bound = |at| self.text.boundary(at);
        self.caret = Caret { anchor: bound(caret.anchor), head: bound(caret.head), goal: caret.goal };
        self.text.close_group();
        self.folds.show(self.text.line_of(self.caret.head));
        self.view.reveal = Reveal::Middle;
    }

    /// Puts the caret at the beginning of a line, from 0.
    pub fn go_to_line(&mut self, line: usize) {
        let line = line.min(self.text.line_count() - 1);
        self.go_to(Caret::at(self.text.line_start(line)));
    }

    /// Goes to the next problem after the caret, or the one before; round at the ends.
    pub fn go_to_problem(&mut self, forward: bool) {
        let at = self.caret.range().start;
        let problems = &self.findings.problems;
        let next = match forward {
            true => problems.iter().find(|problem| problem.range.start > at).or(problems.first()),
            false => problems.iter().rev().find(|problem| problem.range.start < at).or(problems.last()),
        };
        if let Some(range) = next.map(|problem| problem.range.clone()) {
            self.go_to(Caret::at(range.start));
        }
    }

    /// Goes to the first error.
    pub fn go_to_first_error(&mut self) {
        let error = self.findings.problems.iter().find(|problem| problem.severity == Severity::Error);
        if let Some(start) = error.map(|problem| problem.range.start) {
            self.go_to(Caret::at(start));
        }
    }

    /// Lines are to end otherwise in the file. Mixed ends in the text become one kind.
    pub fn set_line_ends(&mut self, ends: LineEnds) {
        if self.format.ends == LineEnds::Mixed {
            let text = self.text.text().replace("\r\n", "\n").replace('\r', "\n");
            self.replace_all(&text);
        }
        self.format.ends = ends;
        self.text.set_unsaved();
    }

    /// Shows where the machine halts, or that it does not.
    pub fn show_halt(&mut self, line: Option<usize>) {
        if self.run.halted_at != line {
            self.run.halted_at = line;
            if let Some(line) = line {
                self.go_to_line(line);
            }
        }
    }
}

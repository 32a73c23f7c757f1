//! What the wishes of a person do to the open programs.

use egui::{Context, ViewportCommand};

use super::caret::Caret;
use super::complete::Completion;
use super::document::Document;
use super::editor::Editor;
use super::examples::EXAMPLES;
use super::panel::Tab;
use super::sheet::{PathField, Sheet};
use super::wish::MclWish;
use crate::model::message::Gravity;

impl Editor {
    /// Does what was wished.
    pub fn act(&mut self, wish: MclWish, ctx: &Context) {
        let front = self.front().id();
        match wish {
            MclWish::New => {
                self.open_new("");
            }
            MclWish::Example(index) => {
                if let Some(example) = EXAMPLES.get(index) {
                    self.open_named(example.title, example.text);
                }
            }
            MclWish::Open => self.open_sheet(Sheet::Open(PathField::default())),
            MclWish::Save => self.save(front),
            MclWish::SaveAs => self.save_as(front),
            MclWish::Print => self.print(front),
            MclWish::SendToPrinter => self.send_to_printer(ctx),
            MclWish::Front(id) => self.bring_to_front(id),
            MclWish::Close(id) => self.close(id),
            MclWish::AcceptSheet => self.accept_sheet(),
            MclWish::DismissSheet => self.dismiss_sheet(),
            MclWish::CloseUnsaved => self.close_unsaved(),
            MclWish::SettleChange { id, load } => self.settle_change(id, load),
            MclWish::SettleLeft { restore } => self.settle_left(restore),
            MclWish::ChooseImage => self.open_sheet(Sheet::Image(PathField::default())),
            other => self.act_on_view(other, ctx),
        }
    }

    fn act_on_view(&mut self, wish: MclWish, ctx: &Context) {
        match wish {
            MclWish::ToggleHidden => self.options.hidden = !self.options.hidden,
            MclWish::ToggleCurrentLine => self.options.current_line = !self.options.current_line,
            MclWish::ToggleFolding => self.toggle_folding(),
            MclWish::Zoom(percent) => self.options.set_zoom(percent),
            MclWish::ShowPanel(tab) => self.panel.press(tab),
            MclWish::HidePanel => self.panel.open = false,
            MclWish::Check => self.check_now(),
            MclWish::GoToLine => self.open_sheet(Sheet::GoToLine(String::new())),
            MclWish::Rename => self.ask_rename(),
            MclWish::Find | MclWish::Replace => {
                let front = &self.documents[self.front];
                self.find.show(front, wish == MclWish::Replace);
                self.find.look(front);
            }
            MclWish::ReplaceAll => {
                let count = self.find.replace_all(&mut self.documents[self.front]);
                self.say(Gravity::Note, format!("Replaced {count} places."));
            }
            MclWish::CloseFind => {
                self.find.open = false;
                self.wants_focus = true;
            }
            MclWish::FindNext | MclWish::FindPrevious | MclWish::ReplaceOne => self.find(wish),
            other => {
                self.wants_focus = true;
                self.completion = None;
                self.act_on_lines(other, ctx);
            }
        }
    }

    fn act_on_lines(&mut self, wish: MclWish, ctx: &Context) {
        let document = self.front_mut();
        match wish {
            MclWish::Undo => document.undo(),
            MclWish::Redo => document.redo(),
            MclWish::Cut => ctx.copy_text(document.cut()),
            MclWish::Copy => ctx.copy_text(document.copied()),
            // Only the window system knows what is in the clipboard; it comes back as typed text does.
            MclWish::Paste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
            MclWish::SelectAll => document.caret = Caret::selecting(0, document.text.len()),
            MclWish::ToggleComment => document.toggle_comment(),
            MclWish::DuplicateLines => document.duplicate_lines(),
            MclWish::DeleteLines => document.delete_lines(),
            MclWish::MoveLines { down } => document.move_lines(down),
            MclWish::Indent { further: true } => document.indent(),
            MclWish::Indent { further: false } => document.unindent(),
            MclWish::SetEncoding(encoding) if encoding != document.format.encoding => {
                document.format.encoding = encoding;
                document.text.set_unsaved();
            }
            MclWish::SetLineEnds(ends) if ends != document.format.ends => document.set_line_ends(ends),
            MclWish::Select(anchor, head) => document.go_to(Caret::selecting(anchor, head)),
            MclWish::Definition => self.tell(Document::go_to_definition),
            MclWish::Matching => self.tell(Document::go_to_match),
            MclWish::Complete => self.completion = Completion::of(self.front(), true),
            MclWish::Tidy => document.tidy(),
            other => self.act_on_marks(other),
        }
    }

    fn act_on_marks(&mut self, wish: MclWish) {
        let document = self.front_mut();
        let line = document.caret_line();
        match wish {
            MclWish::ToggleFold(line) => document.toggle_fold(line),
            MclWish::ToggleFoldHere => document.toggle_fold(line),
            MclWish::FoldAll => document.fold_all(),
            MclWish::UnfoldAll => document.folds.open_all(),
            MclWish::ToggleBookmark => {
                document.bookmarks.toggle(line);
            }
            MclWish::NextBookmark => {
                let next = document.bookmarks.next(line);
                next.into_iter().for_each(|line| document.go_to_line(line));
            }
            MclWish::PreviousBookmark => {
                let previous = document.bookmarks.previous(line);
                previous.into_iter().for_each(|line| document.go_to_line(line));
            }
            MclWish::ClearBookmarks => document.bookmarks.clear(),
            MclWish::ToggleBreakpoint(line) => {
                document.breakpoints.toggle(line);
            }
            MclWish::NextProblem => document.go_to_problem(true),
            MclWish::PreviousProblem => document.go_to_problem(false),
            _ => {}
        }
    }

    /// Does something that may not be possible; why not is told.
    fn tell(&mut self, act: impl FnOnce(&mut Document) -> Result<(), String>) {
        if let Err(why) = act(self.front_mut()) {
            self.say(Gravity::Warning, why);
        }
    }

    fn find(&mut self, wish: MclWish) {
        if !self.find.open {
            self.find.show(&self.documents[self.front], false);
        }
        let document = &mut self.documents[self.front];
        match wish {
            MclWish::ReplaceOne => self.find.replace(document),
            _ => self.find.go(document, wish == MclWish::FindNext),
        }
    }

    fn ask_rename(&mut self) {
        let document = self.front();
        let word = document.text.slice(document.word(document.caret.head)).into_owned();
        if word.is_empty() {
            return self.say(Gravity::Warning, "Put the caret on a name of the program first.");
        }
        self.open_sheet(Sheet::Rename(word));
    }

    /// Checks the program in front, shows what was found and tells the outcome.
    fn check_now(&mut self) {
        self.wants_focus = true;
        let document = self.front_mut();
        let title = document.title();
        document.known();
        let (errors, warnings) = document.findings.counts();
        let many = |count: usize, what: &str| match count {
            1 => format!("1 {what}"),
            _ => format!("{count} {what}s"),
        };
        let (gravity, text) = match (errors, warnings) {
            (0, 0) => (Gravity::Note, format!("{title} is free of errors.")),
            (0, _) => (Gravity::Warning, format!("{title} has no errors and {}.", many(warnings, "warning"))),
            _ => (
                Gravity::Error,
                format!("{title} has {} and {}.", many(errors, "error"), many(warnings, "warning")),
            ),
        };
        if errors > 0 {
            document.go_to_first_error();
        }
        if errors + warnings > 0 {
            self.panel = super::panel::Panel { open: true, tab: Tab::Problems };
        }
        self.say(gravity, text);
    }

    /// Without folding lines nothing stays hidden.
    fn toggle_folding(&mut self) {
        self.options.folding = !self.options.folding;
        if !self.options.folding {
            self.documents_mut().iter_mut().for_each(|document| document.folds.open_all());
        }
    }
}

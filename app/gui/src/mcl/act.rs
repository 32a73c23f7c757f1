//! What the actions of a person do to the open programs.

use crate::messages::{EditorMessage, WindowStatusMessage};
use brushwork_link::Message;
use egui::{Context, ViewportCommand};

use super::examples::EXAMPLES;
use super::sheet::PathField;
use super::{Caret, Completion, Document, Editor, MclAction, Sheet, Tab};
use crate::model::message::Gravity;

impl Editor {
    /// Does what was asked.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn act(&mut self, action: MclAction, ctx: &Context) {
        let front = self.front().id();
        match action {
            MclAction::New => self.open_new_like_front(),
            MclAction::Example(index) => {
                if let Some(example) = EXAMPLES.get(index) {
                    self.open_named(example.title, example.text);
                }
            }
            MclAction::Open => self.open_sheet(Sheet::Open(PathField::default())),
            MclAction::Save => self.save(front),
            MclAction::SaveAs => self.save_as(front),
            MclAction::Print => self.print(front),
            MclAction::SendToPrinter => self.send_to_printer(ctx),
            MclAction::Front(id) => self.bring_to_front(id),
            MclAction::Close(id) => self.close(id),
            MclAction::AcceptSheet => self.accept_sheet(),
            MclAction::DismissSheet => self.dismiss_sheet(),
            MclAction::CloseUnsaved => self.close_unsaved(),
            MclAction::SettleChange { id, load } => self.settle_change(id, load),
            MclAction::SettleLeft { restore } => self.settle_left(restore),
            MclAction::ChooseImage => self.open_sheet(Sheet::Image(PathField::default())),
            other => self.act_on_view(other, ctx),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn act_on_view(&mut self, action: MclAction, ctx: &Context) {
        match action {
            MclAction::ToggleHidden => self.options.hidden = !self.options.hidden,
            MclAction::ToggleCurrentLine => self.options.current_line = !self.options.current_line,
            MclAction::ToggleFolding => self.toggle_folding(),
            MclAction::Zoom(percent) => self.options.set_zoom(percent),
            MclAction::ShowPanel(tab) => self.panel.press(tab),
            MclAction::Check => self.check_now(),
            MclAction::GoToLine => self.open_sheet(Sheet::GoToLine(String::new())),
            MclAction::Rename => self.ask_rename(),
            MclAction::Find | MclAction::Replace => {
                let front = &self.documents[self.front];
                self.find.show(front, action == MclAction::Replace);
                self.find.look(front);
            }
            MclAction::ReplaceAll => {
                let count = self.find.replace_all(&mut self.documents[self.front]);
                self.say(Gravity::Note, WindowStatusMessage::Replaced { count });
            }
            MclAction::CloseFind => {
                self.find.open = false;
                self.wants_focus = true;
            }
            MclAction::FindNext | MclAction::FindPrevious | MclAction::ReplaceOne => self.find(action),
            other => {
                self.wants_focus = true;
                self.completion = None;
                self.act_on_lines(other, ctx);
            }
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn act_on_lines(&mut self, action: MclAction, ctx: &Context) {
        let document = self.front_mut();
        match action {
            MclAction::Undo => document.undo(),
            MclAction::Redo => document.redo(),
            MclAction::Cut => ctx.copy_text(document.cut()),
            MclAction::Copy => ctx.copy_text(document.copied()),
            // Only the window system knows what is in the clipboard; it comes back as typed text does.
            MclAction::Paste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
            MclAction::SelectAll => document.caret = Caret::selecting(0, document.text.len()),
            MclAction::ToggleComment => document.toggle_comment(),
            MclAction::DuplicateLines => document.duplicate_lines(),
            MclAction::DeleteLines => document.delete_lines(),
            MclAction::MoveLines { down } => document.move_lines(down),
            MclAction::Indent { further: true } => document.indent(),
            MclAction::Indent { further: false } => document.unindent(),
            MclAction::SetEncoding(encoding) if encoding != document.format.encoding => {
                document.format.encoding = encoding;
                document.text.set_unsaved();
            }
            MclAction::SetLineEnds(ends) if ends != document.format.ends => document.set_line_ends(ends),
            MclAction::Select(anchor, head) => document.go_to(Caret::selecting(anchor, head)),
            MclAction::Definition => self.tell(Document::go_to_definition),
            MclAction::Matching => self.tell(Document::go_to_match),
            MclAction::Complete => self.completion = Completion::of(self.front(), true),
            MclAction::Tidy => document.tidy(),
            other => self.act_on_marks(other),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn act_on_marks(&mut self, action: MclAction) {
        let document = self.front_mut();
        let line = document.caret_line();
        match action {
            MclAction::ToggleFold(line) => document.toggle_fold(line),
            MclAction::ToggleFoldHere => document.toggle_fold(line),
            MclAction::FoldAll => document.fold_all(),
            MclAction::UnfoldAll => document.folds.open_all(),
            MclAction::ToggleBookmark => {
                document.bookmarks.toggle(line);
            }
            MclAction::NextBookmark => {
                let next = document.bookmarks.next(line);
                next.into_iter().for_each(|line| document.go_to_line(line));
            }
            MclAction::PreviousBookmark => {
                let previous = document.bookmarks.previous(line);
                previous.into_iter().for_each(|line| document.go_to_line(line));
            }
            MclAction::ClearBookmarks => document.bookmarks.clear(),
            MclAction::ToggleBreakpoint(line) => {
                document.breakpoints.toggle(line);
            }
            MclAction::NextProblem => document.go_to_problem(true),
            MclAction::PreviousProblem => document.go_to_problem(false),
            _ => {}
        }
    }

    /// Does something that may not be possible; why not is told.
    fn tell(&mut self, act: impl FnOnce(&mut Document) -> Result<(), EditorMessage>) {
        if let Err(why) = act(self.front_mut()) {
            self.say(Gravity::Warning, why);
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn find(&mut self, action: MclAction) {
        if !self.find.open {
            self.find.show(&self.documents[self.front], false);
        }
        let document = &mut self.documents[self.front];
        match action {
            MclAction::ReplaceOne => self.find.replace(document),
            _ => self.find.go(document, action == MclAction::FindNext),
        }
    }

    fn ask_rename(&mut self) {
        let document = self.front();
        let word = document.text.slice(document.word(document.caret.head)).into_owned();
        if word.is_empty() {
            return self.say(Gravity::Warning, WindowStatusMessage::NoNameAtCaret);
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
        let warned: Message = match warnings {
            1 => EditorMessage::OneWarning.into(),
            count => EditorMessage::Warnings { count }.into(),
        };
        let found: Message = match errors {
            1 => EditorMessage::OneError.into(),
            count => EditorMessage::Errors { count }.into(),
        };
        let (gravity, text) = match (errors, warnings) {
            (0, 0) => (Gravity::Note, EditorMessage::Free { title }),
            (0, _) => (Gravity::Warning, EditorMessage::Warned { title, warned }),
            _ => (Gravity::Error, EditorMessage::Found { title, found, warned }),
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

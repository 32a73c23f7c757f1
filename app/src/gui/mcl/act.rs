//! What the wishes of a person do to the open programs. What needs a controller or a file is done by the window.

use egui::{Context, ViewportCommand};

use super::caret::Caret;
use super::editor::Editor;
use super::wish::MclWish;

impl Editor {
    /// Does what was wished.
    pub fn act(&mut self, wish: MclWish, ctx: &Context) {
        match wish {
            MclWish::New => {
                self.open_new("");
            }
            MclWish::Front(id) => self.bring_to_front(id),
            MclWish::Close(id) => self.close(id),
            MclWish::ToggleHidden => self.options.hidden = !self.options.hidden,
            MclWish::ToggleCurrentLine => self.options.current_line = !self.options.current_line,
            MclWish::ToggleFolding => self.toggle_folding(),
            MclWish::Zoom(percent) => self.options.set_zoom(percent),
            MclWish::ShowPanel(tab) => self.panel.press(tab),
            other => self.act_on_text(&other, ctx),
        }
    }

    fn act_on_text(&mut self, wish: &MclWish, ctx: &Context) {
        self.wants_focus = true;
        let document = self.front_mut();
        let line = document.caret_line();
        match wish {
            MclWish::Undo => document.undo(),
            MclWish::Redo => document.redo(),
            MclWish::Cut => ctx.copy_text(document.cut()),
            MclWish::Copy => ctx.copy_text(document.copied()),
            // Only the window system knows what is in the clipboard; it comes back as typed text does.
            MclWish::Paste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
            MclWish::SelectAll => document.caret = Caret::selecting(0, document.text.len()),
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
                document.breakpoints.toggle(*line);
            }
            MclWish::Select(anchor, head) => document.go_to(Caret::selecting(*anchor, *head)),
            _ => {}
        }
    }

    /// Without folding lines nothing stays hidden.
    fn toggle_folding(&mut self) {
        self.options.folding = !self.options.folding;
        if !self.options.folding {
            self.documents_mut().iter_mut().for_each(|document| document.folds.open_all());
        }
    }
}

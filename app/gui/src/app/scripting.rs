//! Programs and scripts, as far as the window's one place for change has to do with them.

use crate::messages::WindowStatusMessage;
use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::Message;
use std::path::Path;

use brushwork_link::{ArmScope, Failure, Request};
use brushwork_script::image;
use brushwork_script::language::Language;
use brushwork_script::mcl::compile;
use egui::{Context, ViewportCommand};

use super::App;
use crate::mcl::MclAction;
use crate::model::script::Source;
use crate::model::{Owner, Screen};
use brushwork_link::bounded;

impl App {
    /// Does what is asked of the MCL editor. What opens or asks something shows its screen.
    pub(super) fn edit_mcl(&mut self, action: MclAction) {
        let shows = matches!(
            action,
            MclAction::New
                | MclAction::Open
                | MclAction::Example(_)
                | MclAction::SaveAs
                | MclAction::Check
                | MclAction::ChooseImage
        );
        let asks = action == MclAction::Save && self.model.mcl.front().path.is_none();
        if shows || asks {
            self.show(Screen::MclEditor);
        }
        let ctx = self.ctx.clone();
        self.model.mcl.act(action, &ctx);
    }

    /// Takes in what the editor's threads have done.
    pub(super) fn look_after_programs(&mut self, ctx: &Context) {
        let now_s = ctx.input(|input| input.time);
        let shown = self.model.screen == Screen::MclEditor;
        for (gravity, text) in self.model.mcl.update(ctx, now_s, shown) {
            self.model.messages.say(gravity, text);
        }
        if let Some(path) = self.model.mcl.image.take() {
            self.download_image(&path);
        }
    }

    /// Keeps the window open while programs have unsaved text, and asks what is to become of it.
    pub(super) fn hold_unsaved(&mut self, ctx: &Context) {
        if self.model.mcl.may_exit() {
            self.closing = true;
        }
        let asked = self.closing || ctx.input(|input| input.viewport().close_requested());
        if !asked || self.model.mcl.may_exit() {
            return;
        }
        if self.model.mcl.ask_exit() {
            self.model.mcl.end();
            return;
        }
        self.closing = false;
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        self.show(Screen::MclEditor);
    }

    /// Compiles the program in front and sends it to the controller.
    pub(super) fn download_mcl(&mut self) {
        self.show(Screen::MclEditor);
        if self.model.mcl.front().language() == Language::Mecc {
            return self.model.messages.fail(WindowStatusMessage::RunsOnBoardsAlone);
        }
        let simulated = self.model.front.link.identity().is_some_and(|identity| identity.simulated);
        if !simulated {
            self.model.messages.fail(WindowStatusMessage::CodeIsNotPublic);
            return self.edit_mcl(MclAction::ChooseImage);
        }
        let document = self.model.mcl.front_mut();
        document.known();
        if document.findings.counts().0 > 0 {
            return self.edit_mcl(MclAction::Check);
        }
        let title = document.title();
        let text = Some((document.id(), document.text.revision()));
        let Some(program) = compile(&document.text.text()).program else {
            return self.edit_mcl(MclAction::Check);
        };
        self.send_image(&image::encode(&program), Source { title, text });
    }

    /// Downloads a file that the maker's own compiler has written.
    fn download_image(&mut self, path: &Path) {
        let title = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        match bounded::read_file(path) {
            Ok(bytes) => self.send_image(&bytes, Source { title, text: None }),
            Err(error) => {
                let (on, error) = (path.display().to_string(), Message::error(error));
                let remedy = WindowRemedyMessage::CheckPath;
                let failure = Failure::new(WindowActMessage::ReadFile, on, error, remedy);
                self.model.messages.fail(failure.message());
            }
        }
    }

    fn send_image(&mut self, bytes: &[u8], source: Source) {
        let download = match self.model.front.family().download(bytes) {
            Ok(download) => download,
            Err(error) => {
                let error = WindowCauseMessage::Said { text: error };
                let remedy = WindowRemedyMessage::ChooseAnother;
                let failure = Failure::new(WindowActMessage::Download, source.title, error, remedy);
                return self.model.messages.fail(failure.message());
            }
        };
        match self.model.front.script.begin(download, source) {
            Some(job) => {
                if !self.start_for(self.model.front.id(), Owner::Script, job) {
                    self.model.front.script.forget();
                }
            }
            None => self.model.messages.warn(WindowStatusMessage::DownloadRuns),
        }
    }

    /// Starts the stored script. It may move motors, so it needs the armed screen.
    pub(super) fn start_script(&mut self) {
        if !self.model.front.link.arming.is_armed_for(ArmScope::Script) {
            return self.model.messages.warn(WindowStatusMessage::ArmEditorFirst);
        }
        if self.request(Request::StartScript) {
            self.model.front.watch.note_script(true);
        }
    }

    pub(super) fn stop_script(&mut self) {
        if self.request(Request::StopScript) {
            self.model.front.watch.note_script(false);
        }
    }
}

//! Programs and scripts, as far as the window's one place for change has to do with them.

use crate::messages::WindowStatusMessage;
use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::Message;
use std::path::Path;
use std::sync::Arc;

use brushwork_link::{ArmScope, Failure, Request};
use brushwork_script::image;
use brushwork_script::language::Language;
use brushwork_script::mcl::compile;
use brushwork_script::mecc;
use brushwork_script::program::Program;
use egui::{Context, ViewportCommand};

use super::App;
use crate::mcl::MclAction;
use crate::model::message::Gravity;
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
            return self.run_on_board();
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

    /// Compiles the MeccCode in front, puts it into the memory of the simulated board in front, past the wire, and starts it there.
    pub(super) fn run_on_board(&mut self) {
        self.show(Screen::MclEditor);
        if !self.model.front.debug.takes_mecc {
            return self.model.messages.fail(WindowStatusMessage::RunsOnBoardsAlone);
        }
        let document = self.model.mcl.front_mut();
        document.known();
        let Some(program) = mecc::compile(&document.text.text()).program else {
            return self.edit_mcl(MclAction::Check);
        };
        let said = WindowStatusMessage::RunsOnBoard { title: document.title() };
        self.model.front.debug.renew_breakpoints();
        self.put_on_board(program, said);
    }

    /// Lets the simulated board in front run the host library again, so that the window drives it.
    pub(super) fn run_library(&mut self) {
        if let Some(program) = self.model.front.family().library() {
            self.model.front.debug.leave_breakpoints();
            self.put_on_board(program, WindowStatusMessage::LibraryRunsAgain);
        }
    }

    fn put_on_board(&mut self, program: Program, said: WindowStatusMessage) {
        let ctx = self.ctx.clone();
        self.ask_debugger(&ctx);
        let front = &self.model.front;
        let world = self.links.get(front.id()).and_then(|link| link.world.as_ref());
        let Some(world) = world else { return };
        match world.run_program(front.world_unit, Arc::new(program)) {
            Ok(()) => self.model.messages.say(Gravity::Note, said),
            Err(failure) => self.model.messages.fail(failure.message()),
        }
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

//! The MCL debugger, as far as the window's one place for change has to do with it: looks at the script are asked for and taken in,
//! the editor is followed and shown where the script stands.

use std::time::Duration;

use brushwork_link::device::DeviceHandle;
use brushwork_script::debug::{Reason, Request};
use brushwork_script::language::Language;
use egui::Context;

use super::App;
use crate::debugger::DebugAction;
use crate::debugger::names::TextId;
use crate::debugger::state::Source;
use crate::graph::MarkKind;
use crate::graph::messages::MarkMessage;
use crate::mcl::{DocId, Document, MclAction};
use crate::model::{ConnectionId, Screen};

/// The answer to an action comes within some milliseconds; the frame that shows it is drawn then, not with the next samples.
const SOON: Duration = Duration::from_millis(12);

impl App {
    /// Takes in the newest look at a link's script, and asks for the next one while the debugger is in view.
    pub(super) fn look_at_script(&mut self, id: ConnectionId, ctx: &Context) {
        let now_s = self.links.device(id).map_or(0.0, |device: &DeviceHandle| device.now().as_secs_f64());
        let world = self.links.get(id).and_then(|link| link.world.as_ref());
        let Some(connection) = self.model.connection_mut(id) else { return };
        let Some(world) = world else { return connection.debug.forget() };
        connection.debug.pace = world.pace();
        connection.debug.takes_mecc = world.runs(Language::Mecc);
        let mut stopped = false;
        if let Some(view) = world.script() {
            let was_paused = connection.debug.is_paused();
            if let Some(text) = connection.debug.take(view) {
                connection.graph.mark(now_s, MarkKind::Note, text);
            }
            stopped = connection.debug.is_paused() && !was_paused;
        }
        if id != self.model.front.id() || self.model.screen != Screen::MclEditor {
            return;
        }
        self.follow_editor();
        self.show_in_editor(stopped);
        self.ask_debugger(ctx);
    }

    /// Tells the debugger of the text in front and of its breakpoints.
    fn follow_editor(&mut self) {
        let debug = &mut self.model.front.debug;
        let front = self.model.mcl.front();
        let of_script = debug.loaded().map(|loaded| DocId(loaded.text.program));
        let debugged = of_script.and_then(|id| self.model.mcl.document(id)).unwrap_or(front);
        let breakpoints = debugged.breakpoints.iter().map(|line| line as u32 + 1).collect();
        let id = text_id(front);
        let (language, text) = (front.language(), || front.text.text());
        debug.follow(&Source { id, language, text: &text, breakpoints });
    }

    /// Marks the line where the script stands, and how often each line was run.
    fn show_in_editor(&mut self, just_stopped: bool) {
        let debug = &self.model.front.debug;
        let (Some(loaded), Some(view)) = (debug.loaded(), &debug.view) else { return };
        let id = DocId(loaded.text.program);
        let stands = view.is_paused || matches!(view.reason, Reason::Faulted(_));
        let line = stands.then(|| (view.line as usize).saturating_sub(1));
        let counts =
            if debug.shows_counts { view.counts.get(1..).unwrap_or_default().to_vec() } else { Vec::new() };
        let is_same = self.model.mcl.document(id).is_some_and(|document| text_id(document) == loaded.text);
        if just_stopped && is_same && self.model.mcl.front().id() != id {
            self.model.mcl.bring_to_front(id);
        }
        if let Some(document) = self.model.mcl.document_mut(id).filter(|_| is_same) {
            document.show_halt(line);
            document.run.counts = counts;
        }
    }

    /// Hands over what is to be asked, with the next look.
    pub(super) fn ask_debugger(&mut self, ctx: &Context) {
        let front = &mut self.model.front;
        let is_shown = self.model.screen == Screen::MclEditor;
        let Some(world) = self.links.get(front.id()).and_then(|link| link.world.as_ref()) else { return };
        front.debug.shown(is_shown);
        if !is_shown && !front.debug.has_requests() {
            return;
        }
        let hurry = front.debug.has_requests();
        let (requests, wanted) = front.debug.look();
        if world.debug(front.world_unit, requests.clone(), wanted).is_err() {
            // A full queue takes them in the next frame.
            front.debug.ask_again(requests);
        }
        if hurry || front.debug.is_stepping {
            ctx.request_repaint_after(SOON);
        }
        front.debug.is_stepping = hurry;
    }

    /// Does what is asked of the debugger.
    pub(super) fn debug(&mut self, action: DebugAction) {
        let debug = &mut self.model.front.debug;
        match action {
            DebugAction::Run if debug.is_paused() => debug.ask(Request::Continue),
            DebugAction::Run if self.model.mcl.front().language() == Language::Mecc => self.run_on_board(),
            DebugAction::Run => self.start_script(),
            DebugAction::Pause => debug.ask(Request::Pause),
            DebugAction::Step(kind) => debug.ask(Request::Step(kind)),
            DebugAction::RunToCursor => {
                let line = self.model.mcl.front().caret_line() as u32 + 1;
                debug.ask(Request::RunTo(line));
            }
            DebugAction::StopAtEntry(on) => {
                debug.stops_at_entry = on;
                debug.ask(Request::StopAtEntry(on));
            }
            DebugAction::FreezeWorld(on) => {
                debug.freezes_world = on;
                debug.ask(Request::FreezeWorld(on));
            }
            DebugAction::Pace(pace) => self.set_pace(pace),
            DebugAction::ShowCounts(on) => debug.shows_counts = on,
            DebugAction::ClearCounts => debug.ask(Request::ClearCounts),
            DebugAction::Send => debug.send_typed(),
            DebugAction::SetValue => debug.set(),
            DebugAction::ToggleBreakpoint => {
                let line = self.model.mcl.front().caret_line();
                self.edit_mcl(MclAction::ToggleBreakpoint(line));
            }
            DebugAction::ClearBreakpoints => self.debugged().breakpoints.clear(),
            DebugAction::RemoveBreakpoint(line) => {
                let (document, line) = (self.debugged(), line as usize - 1);
                if document.breakpoints.contains(line) {
                    document.breakpoints.toggle(line);
                }
            }
            DebugAction::ShowLine(line) => {
                let id = self.debugged().id();
                self.model.mcl.bring_to_front(id);
                self.debugged().go_to_line((line as usize).saturating_sub(1));
            }
        }
    }

    /// The program that the debugger is about: the one in the controller if its text is open, else the one in front.
    fn debugged(&mut self) -> &mut Document {
        let loaded = self.model.front.debug.loaded().map(|loaded| DocId(loaded.text.program));
        let id = loaded.filter(|id| self.model.mcl.document(*id).is_some());
        let id = id.unwrap_or(self.model.mcl.front().id());
        if self.model.mcl.front().id() != id && self.model.mcl.document(id).is_some() {
            return self.model.mcl.document_mut(id).expect("it was there a line above");
        }
        self.model.mcl.front_mut()
    }

    fn set_pace(&mut self, pace: brushwork_plant::server::Pace) {
        let id = self.model.front.id();
        let now_s = self.links.device(id).map_or(0.0, |device| device.now().as_secs_f64());
        if let Some(world) = self.links.get(id).and_then(|link| link.world.as_ref()) {
            world.set_pace(pace);
            self.model.front.graph.mark(
                now_s,
                MarkKind::Note,
                MarkMessage::Pace { pace: pace.name() }.to_string(),
            );
        }
    }
}

fn text_id(document: &Document) -> TextId {
    TextId { program: document.id().0, revision: document.text.revision() }
}

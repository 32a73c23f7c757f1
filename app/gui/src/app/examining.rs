//! The examination of a controller: its steps one after the other, its report on the disk.

use std::path::Path;

use super::App;
use crate::messages::{ExaminationMessage, WindowStatusMessage};
use crate::model::examination::ExaminationAction;
use crate::model::{Effect, Gravity, Owner};
use brushwork_core::keep::{TrialKeeper, UnitId};
use brushwork_core::messages::{EndedMessage, ProfilePlanMessage};
use brushwork_link::files::write_new_file;
use brushwork_link::{Message, WriteOptions};

impl App {
    pub(super) fn examine(&mut self, action: ExaminationAction) {
        let done = match action {
            ExaminationAction::Begin => self.begin_examination(),
            ExaminationAction::Cancel => {
                self.model.front.examination.cancel(Gravity::Note, EndedMessage::Cancelled);
                Ok(())
            }
            ExaminationAction::Save => self.save_examination(),
        };
        if let Err(sentence) = done {
            self.model.messages.fail(sentence);
        }
    }

    fn begin_examination(&mut self) -> Result<(), Message> {
        let ports = self.model.devices.ports.clone();
        let store = self.parts.keeping.store().clone();
        let front = &mut self.model.front;
        let Some(identity) = front.link.identity().cloned().filter(|_| front.settings.keeper().is_some())
        else {
            return Err(ExaminationMessage::NotBegun.into());
        };
        if front.is_guided() {
            return Err(ProfilePlanMessage::JobRuns.into());
        }
        if front.is_turned_elsewhere() {
            return Err(WindowStatusMessage::AssistantWorks.into());
        }
        let options =
            WriteOptions { own_stream: front.link.stream, simulated: identity.simulated, as_read: true };
        let raw_writes = store.raw_writes(&UnitId::new(&identity, &ports)).map_err(Message::error)?;
        front.examination.begin(&identity, options, raw_writes)
    }

    /// Asks for what comes next in each examination that goes on, on whatever connection it is.
    pub(super) fn go_on_examining(&mut self) {
        for id in self.links.ids() {
            let Some(connection) = self.model.connection_mut(id) else { continue };
            let refused = !connection.link.refusals.is_empty();
            let settings = &connection.settings;
            let keeper = || Some(TrialKeeper::new(settings.keeper()?));
            let next = connection.examination.next(connection.link.arming, refused, keeper);
            if let Some(next) = next
                && !self.ask_next(id, Owner::Examination, next)
                && let Some(connection) = self.model.connection_mut(id)
            {
                connection.examination.not_begun();
            }
            let Some(connection) = self.model.connection_mut(id) else { continue };
            for effect in connection.examination.end() {
                if let Effect::Say(gravity, text) = effect {
                    self.say(id, gravity, text);
                }
            }
        }
    }

    fn save_examination(&mut self) -> Result<(), Message> {
        let panel = &self.model.front.examination;
        let path = panel.path.trim().to_owned();
        let Some(found) = panel.found().filter(|_| !path.is_empty()) else {
            return Err(ExaminationMessage::NoPath.into());
        };
        let is_json = Path::new(&path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let content = if is_json { found.json() } else { found.text() };
        match write_new_file(Path::new(&path), content.as_bytes()) {
            Ok(()) => self.model.messages.note(WindowStatusMessage::ReportIsIn { path }),
            Err(error) => {
                return Err(ExaminationMessage::NotSaved { path, error: error.to_string() }.into());
            }
        }
        Ok(())
    }
}

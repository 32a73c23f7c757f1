//! Guided tuning: its jobs one after the other, its gains into RAM and back, its reports on the disk.

use super::App;
use crate::messages::{TuningMessage, WindowStatusMessage};
use crate::model::loop_settings::key;
use crate::model::{Arming, ConnectionId, Owner, Tab};
use crate::tune::registers::image;
use crate::tune::{Loop, Next, Origin, TuneAction, files};
use brushwork_core::keep::TrialKeeper;
use brushwork_core::messages::{EndedMessage, ProfilePlanMessage};
use brushwork_core::tune::file;
use brushwork_core::tune::law::AnyRegisters;
use brushwork_link::{Message, Request, SettingValue, SettingsImage};
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_values::Motor;

impl App {
    pub(super) fn tune(&mut self, action: TuneAction) {
        let Some(which) = Loop::of(self.model.screen) else { return };
        if matches!(action, TuneAction::Start(_))
            && self.model.front.open_tab(which.screen()) != Some(Tab::Tune)
        {
            self.model.front.drawers.press(which.screen(), Tab::Tune);
        }
        let front = &mut self.model.front;
        let stream = front.link.stream;
        let reported = match action {
            TuneAction::Start(_) | TuneAction::Verify if front.is_guided() => {
                Err(ProfilePlanMessage::JobRuns.into())
            }
            TuneAction::Start(motor) => front.tune.start(which, motor, stream).map_err(Message::from),
            TuneAction::Verify => front.tune.verify(which, stream).map_err(Message::from),
            TuneAction::Cancel => {
                front.tune.cancel(EndedMessage::Cancelled);
                Ok(())
            }
            TuneAction::Apply => self.apply_gains(which),
            TuneAction::Undo => self.undo_gains(which),
            TuneAction::ClearWinding => self.clear_winding(which),
            TuneAction::PutWindingBack => {
                front.tune.want_winding_back();
                Ok(())
            }
            TuneAction::Adjust(motor, registers) => self.adjust(which, motor, registers),
            TuneAction::SaveReport { path, replaces } => match front.tune.front(which).run() {
                Some(run) => file::write(&run.report, &path, replaces).map(|()| {
                    self.model
                        .messages
                        .note(WindowStatusMessage::ReportIsIn { path: path.display().to_string() });
                }),
                None => Ok(()),
            },
            TuneAction::OpenReport(path) => self.open_report(&path),
        };
        if let Err(sentence) = reported {
            self.model.messages.fail(sentence);
        }
    }

    /// Asks for what comes next in each run that goes on, on whatever connection it is.
    pub(super) fn go_on_tuning(&mut self) {
        for id in self.links.ids() {
            let Some(connection) = self.model.connection_mut(id) else { continue };
            if let Some(identity) = connection.link.identity() {
                let identity = identity.clone();
                connection.tune.meet(&identity);
                connection.tune.settle_debts();
            }
            connection.tune.adopt_methods(connection.family());
            for (motor, travel) in Motor::BOTH.into_iter().zip(connection.travels()) {
                connection.tune.adopt_travel(motor, travel);
                let unit = connection.settings.unit();
                connection.tune.adopt_encoder(motor, unit.and_then(|unit| unit.encoder(motor)));
            }
            if let Some(action) = connection.tune.take_waiting() {
                self.settings_of(id, action);
            }
            let Some(connection) = self.model.connection_mut(id) else { continue };
            let refused = !connection.link.refusals.is_empty();
            let settings = &connection.settings;
            let origin = || {
                let subject = *settings.unit()?.table().subject();
                Some(Origin { subject, keeper: TrialKeeper::new(settings.keeper()?) })
            };
            if let Some(next) = connection.tune.next(connection.link.arming, refused, origin) {
                let is_taken = self.ask_next(id, Owner::Tune, next);
                if let Some(connection) = self.model.connection_mut(id).filter(|_| !is_taken) {
                    connection.tune.not_begun();
                }
            }
            self.put_winding_back(id);
            self.follow_run(id);
        }
    }

    /// L and R to 0, with the user's word, so that a duty is a duty.
    fn clear_winding(&mut self, which: Loop) -> Result<(), Message> {
        let front = &self.model.front;
        let motor = front.tune.motor(which);
        let (mut before, mut cleared) = (SettingsImage::default(), SettingsImage::default());
        for name in ["inductance_henries", "resistance_ohms"] {
            let Some(value) = front.settings.unit().and_then(|unit| unit.held(motor, name)) else {
                return Err(TuningMessage::WindingUnread.into());
            };
            before.set(&key(motor, name), SettingValue::Number(value));
            cleared.set(&key(motor, name), SettingValue::Number(0.0));
        }
        self.write_ram(cleared)?;
        self.model.front.tune.winding_cleared(motor, before);
        Ok(())
    }

    /// Asks for the next part of a run that has several; whether the device thread took it.
    pub(super) fn ask_next(&mut self, id: ConnectionId, owner: Owner, next: Next) -> bool {
        let scope = match next {
            Next::Arm(scope) => scope,
            Next::Job(job) => return self.start_for(id, owner, job),
        };
        if let Some(connection) = self.model.connection_mut(id) {
            connection.link.refusals.clear();
        }
        let is_taken = self.request_of(id, Request::Arm(scope));
        if let Some(connection) = self.model.connection_mut(id).filter(|_| is_taken) {
            connection.link.arming = Arming::Asked(scope);
        }
        is_taken
    }

    fn apply_gains(&mut self, which: Loop) -> Result<(), Message> {
        let front = &mut self.model.front;
        let motor = front.tune.motor(which);
        let shown = front.tune.front(which).run().and_then(|run| run.shown.as_ref());
        let Some(registers) = shown.map(|shown| shown.registers) else {
            return Err(TuningMessage::NothingToApply.into());
        };
        let held = front.held_gains(motor, registers.raw("position.p").is_some());
        if held.is_none() && registers.is_one_set() {
            return Err(TuningMessage::RegistersUnread.into());
        }
        self.write_ram(image(&registers, motor))?;
        self.model.front.tune.front_mut(which).undo = held.map(|held| image(&held, motor));
        Ok(())
    }

    /// Writes what was turned by hand, and nothing else.
    fn adjust(&mut self, which: Loop, motor: Motor, registers: AnyRegisters) -> Result<(), Message> {
        let held =
            self.model.front.held_gains(motor, which == Loop::Position).map(|held| image(&held, motor));
        let wanted = image(&registers, motor);
        let changed =
            wanted.iter().filter(|(key, value)| held.as_ref().and_then(|held| held.get(key)) != Some(*value));
        let image: SettingsImage = changed.map(|(key, value)| (key.to_owned(), value)).collect();
        if image.is_empty() {
            return Err(TuningMessage::AtItsEnd.into());
        }
        self.write_ram(image)
    }

    fn undo_gains(&mut self, which: Loop) -> Result<(), Message> {
        let Some(image) = self.model.front.tune.front(which).undo.clone() else {
            return Err(TuningMessage::NothingToUndo.into());
        };
        self.write_ram(image)?;
        self.model.front.tune.front_mut(which).undo = None;
        Ok(())
    }

    /// Writes values to RAM of the controller in front, unless it holds them all.
    pub(super) fn write_ram(&mut self, wanted: SettingsImage) -> Result<(), Message> {
        let front = &self.model.front;
        let unit = front.settings.unit().ok_or(TuningMessage::NotConnected)?;
        if wanted.iter().all(|(key, value)| unit.confirmed(key) == Some(value)) {
            return Err(TuningMessage::HeldAlready.into());
        }
        self.write_ram_of(front.id(), wanted)
    }

    pub(super) fn open_report(&mut self, path: &std::path::Path) -> Result<(), Message> {
        let report = file::read(path)?;
        let which = files::loop_of(&report);
        let motor = if report.request.guard.motor == 1 { Motor::M2 } else { Motor::M1 };
        let tuning = &mut self.model.front.tune;
        tuning.panel_mut(which, motor).add(report);
        tuning.look_at(which, motor);
        let screen = which.screen().title();
        self.model.messages.note(WindowStatusMessage::ReportShown { motor, screen });
        Ok(())
    }
}

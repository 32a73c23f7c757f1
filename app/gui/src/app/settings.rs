//! Work with settings that the window asks of the device threads: whole, of the control loops, of inputs, and command by
//! command. Whatever writes has a backup made first.

use crate::messages::{TuningMessage, WindowStatusMessage};
use brushwork_link::{Message, Request, SettingsImage};

use super::App;
use crate::model::traffic::Transact;
use crate::model::{Column, ConnectionId, Owner, Screen, SettingsAction, UnitSettings};

impl App {
    /// Starts or ends work with the settings, on the device thread.
    pub(super) fn settings(&mut self, action: SettingsAction) {
        self.settings_of(self.model.front.id(), action);
    }

    pub(super) fn settings_of(&mut self, id: ConnectionId, action: SettingsAction) {
        let Some(connection) = self.model.connection_mut(id) else { return };
        // What is to be read is asked for again when the unit is there to stay.
        if action == SettingsAction::Read && connection.is_turned_elsewhere() {
            return;
        }
        if connection.tune.is_running() && !matches!(action, SettingsAction::Cancel | SettingsAction::Read) {
            connection.tune.waiting = Some(action);
            self.model.messages.note(WindowStatusMessage::WaitsForRun);
            return;
        }
        let stream = connection.link.stream;
        if let Some(job) = connection.general_view().begin(action, stream)
            && !self.start_for(id, Owner::Settings, job)
            && let Some(connection) = self.model.connection_mut(id)
        {
            connection.general_view().not_begun();
        }
    }

    pub(super) fn shows_settings_of(&self, id: ConnectionId) -> bool {
        self.model.screen == Screen::GeneralSettings && id == self.model.front.id()
    }

    /// The settings of the controller in front are read once it is connected and nothing else is at work: the window is to
    /// say what is saved and what is not, and what an act that was cut short has left.
    pub(super) fn look_for_settings(&mut self) {
        let front = &mut self.model.front;
        if !front.is_connected() || !front.settings.wants_reading() {
            return;
        }
        if front.settings.has_unfinished() {
            return self.settings(SettingsAction::Read);
        }
        if front.is_idle()
            && let Some(job) = front.settings.begin_quietly()
        {
            let (id, job_id) = (front.id(), job.id());
            match self.links.device(id).map(|device| device.request(Request::Job(job))) {
                Some(Ok(())) => front.jobs.begun(job_id, Owner::Settings),
                Some(Err(_)) | None => front.settings.not_begun(),
            }
        }
    }

    /// Puts an input back whose calibration has ended or was left.
    pub(super) fn end_calibrations(&mut self) {
        for id in self.links.ids() {
            let is_shown = self.shows_settings_of(id);
            let Some(connection) = self.model.connection_mut(id) else { continue };
            if !is_shown {
                connection.general.cancel_calibration();
            }
            if connection.general.wants_closing() && connection.settings.running().is_none() {
                self.settings_of(id, SettingsAction::CloseInput);
            }
        }
    }

    /// Turns a direction round: what was seen of it before is no longer so.
    pub(super) fn reverse(&mut self, image: SettingsImage) {
        match self.write_ram(image) {
            Ok(()) => self.model.front.path.turning.forget_direction(),
            Err(why) => self.model.messages.fail(why),
        }
    }

    pub(super) fn clamp_test(&mut self) {
        if let Some(job) = self.model.front.general_view().begin_clamp_test()
            && !self.start_for(self.model.front.id(), Owner::ClampTest, job)
        {
            self.model.front.general.clamp.forget_job();
        }
    }

    /// Reads what the screen in front shows of the settings, as far as it is not known or in doubt.
    pub(super) fn read_loops(&mut self) {
        let front = &mut self.model.front;
        let is_here = front.is_connected() && !front.is_turned_elsewhere();
        let has_loops = self.model.screen.has_loops() && front.family().has_loops() && is_here;
        let keys = front.settings.unit().filter(|_| has_loops).map(UnitSettings::loop_keys);
        if let Some(job) = keys.and_then(|keys| front.settings.read(&keys, false))
            && !self.start_for(self.model.front.id(), Owner::Settings, job)
        {
            self.model.front.settings.not_begun();
        }
    }

    /// Has the settings that the screens that drive show read anew.
    pub(super) fn read_loops_again(&mut self) {
        if let Some(unit) = self.model.front.settings.unit_mut() {
            unit.doubt_keys(&unit.loop_keys());
        }
    }

    pub(super) fn apply_loops(&mut self, columns: &[Column]) {
        let front = &mut self.model.front;
        let Some(edits) = front.settings.unit().map(|unit| unit.loop_edits(columns)) else { return };
        // Nothing to write, or another write: the button is there again.
        let _ = self.write_ram_of(self.model.front.id(), edits);
    }

    /// Writes values to a unit's RAM, whatever screen they come from and whatever its family: with a backup before, and read back.
    pub(super) fn write_ram_of(&mut self, id: ConnectionId, wanted: SettingsImage) -> Result<(), Message> {
        let busy = || Message::from(TuningMessage::SettingsBusy);
        let none = TuningMessage::NotConnected;
        let connection =
            self.model.connection_mut(id).filter(|connection| connection.is_connected()).ok_or(none)?;
        let stream = connection.link.stream;
        let job = connection.settings.apply(wanted, stream).ok_or_else(busy)?;
        if self.start_for(id, Owner::Settings, job) {
            return Ok(());
        }
        if let Some(connection) = self.model.connection_mut(id) {
            connection.settings.not_begun();
        }
        Err(busy())
    }

    /// Sends a command that was put together by hand; one that changes settings once a backup of them is kept.
    pub(super) fn transact(&mut self, transact: Transact) {
        let front = &mut self.model.front;
        let saves = front.link.identity().and_then(|unit| front.family().saves(transact.command, unit));
        if front.tune.is_running() && saves.is_some() {
            self.model.messages.fail(WindowStatusMessage::RunHoldsSettings);
            return;
        }
        let identity = front.link.identity().cloned();
        let (Some(saves), Some(identity), Some(keeper)) = (saves, identity, front.settings.keeper()) else {
            return self.send_transact(self.model.front.id(), transact);
        };
        let job = front.traffic.kept.keep_first(transact, saves, &identity, keeper);
        if !job.is_some_and(|job| self.request(Request::Job(job))) {
            self.model.front.traffic.kept.forget();
            self.model.front.own.iter_mut().for_each(|own| own.not_transacted());
        }
    }

    /// Sends a command whose backup is kept by now.
    pub(super) fn send_kept_command(&mut self, id: ConnectionId) {
        match self.model.connection_mut(id).and_then(|connection| connection.traffic.kept.ready()) {
            Some(Ok(transact)) => {
                self.send_transact(id, transact);
            }
            Some(Err((number, failure))) => {
                if let Some(connection) = self.model.connection_mut(id) {
                    connection.own.iter_mut().for_each(|own| own.refused(number, failure.clone()));
                }
            }
            None => {}
        }
    }

    fn send_transact(&mut self, id: ConnectionId, transact: Transact) {
        let is_sent = self.request_of(id, transact.request());
        if !is_sent && let Some(connection) = self.model.connection_mut(id) {
            connection.own.iter_mut().for_each(|own| own.not_transacted());
        }
    }
}

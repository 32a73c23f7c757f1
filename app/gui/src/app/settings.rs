//! Work with settings that the window asks of the device threads: whole, of the control loops, of inputs, and command by
//! command. Whatever writes has a backup made first.

use brushwork_link::device::Request;

use super::App;
use crate::model::DeskId;
use crate::model::general::SettingsWish;
use crate::model::jobs::Owner;
use crate::model::loop_settings::Column;
use crate::model::screen::Screen;
use crate::model::traffic::Transact;

impl App {
    /// Starts or ends work with the settings, on the device thread.
    pub(super) fn settings(&mut self, wish: SettingsWish) {
        self.settings_of(self.model.front.id(), wish);
    }

    pub(super) fn settings_of(&mut self, id: DeskId, wish: SettingsWish) {
        let Some(desk) = self.model.desk_mut(id) else { return };
        if desk.tune.is_running() && !matches!(wish, SettingsWish::Cancel | SettingsWish::Read) {
            desk.tune.waiting = Some(wish);
            self.model.messages.note(
                "That waits for the end of the tuning run, so that the time-out and the gains of before are written, not those of \
                 the run.",
            );
            return;
        }
        let stream = desk.link.stream;
        if let Some(job) = desk.general.begin(wish, stream)
            && !self.start_for(id, Owner::Settings, job)
            && let Some(desk) = self.model.desk_mut(id)
        {
            desk.general.not_begun();
        }
    }

    pub(super) fn shows_settings_of(&self, id: DeskId) -> bool {
        self.model.screen == Screen::GeneralSettings && id == self.model.front.id()
    }

    /// The settings of the controller in front are read once it is connected and nothing else is at work: the window is to
    /// say what is saved and what is not, and what an act that was cut short has left.
    pub(super) fn look_for_settings(&mut self) {
        let front = &mut self.model.front;
        let Some(identity) = front.link.identity() else { return };
        front.general.look_at(identity);
        if !front.general.wants_reading() {
            return;
        }
        if front.general.has_unfinished() {
            return self.settings(SettingsWish::Read);
        }
        if front.is_idle()
            && let Some(job) = front.general.begin_quietly()
        {
            let (id, job_id) = (front.id(), job.id());
            match self.links.device(id).map(|device| device.request(Request::Job(job))) {
                Some(Ok(())) => front.jobs.begun(job_id, Owner::Settings),
                Some(Err(_)) | None => front.general.not_begun(),
            }
        }
    }

    /// Puts an input back whose calibration has ended or was left.
    pub(super) fn end_calibrations(&mut self) {
        for id in self.links.ids() {
            let is_shown = self.shows_settings_of(id);
            let Some(desk) = self.model.desk_mut(id) else { continue };
            if !is_shown {
                desk.general.cancel_calibration();
            }
            if let Some(wish) = desk.general.next_wish() {
                self.settings_of(id, wish);
            }
        }
    }

    pub(super) fn clamp_test(&mut self) {
        if let Some(job) = self.model.front.general.begin_clamp_test()
            && !self.start_for(self.model.front.id(), Owner::ClampTest, job)
        {
            self.model.front.general.clamp_test_not_begun();
        }
    }

    /// Reads the settings of the control loops when a screen that shows them wants them.
    pub(super) fn read_loops(&mut self) {
        let has_loops = self.model.screen.has_loops() && self.model.front.family().has_loops();
        if !has_loops || !self.model.front.loops.wants_reading() {
            return;
        }
        let Some(identity) = self.model.front.link.identity().cloned() else { return };
        if let Some(job) = self.model.front.loops.read(&identity)
            && !self.start_for(self.model.front.id(), Owner::Loops, job)
        {
            self.model.front.loops.not_begun();
        }
    }

    pub(super) fn apply_loops(&mut self, columns: &[Column]) {
        let Some(identity) = self.model.front.link.identity().cloned() else { return };
        let stream = self.model.front.link.stream;
        // Whoever is connected is looked at, so there is one.
        let Some(keeper) = self.model.front.general.keeper() else { return };
        if let Some(job) = self.model.front.loops.apply(columns, &identity, stream, keeper)
            && !self.start_for(self.model.front.id(), Owner::Loops, job)
        {
            self.model.front.loops.not_begun();
        }
    }

    /// Sends a command that was put together by hand; one that changes settings once a backup of them is kept.
    pub(super) fn transact(&mut self, transact: Transact) {
        let front = &mut self.model.front;
        if front.tune.is_running()
            && front.link.identity().is_some_and(|identity| transact.changes_settings(identity))
        {
            let told =
                "A tuning run is at work, and this command changes settings. Send it when the run has ended.";
            self.model.messages.fail(told.to_owned());
            return;
        }
        let identity = front.link.identity().cloned().filter(|identity| transact.changes_settings(identity));
        let Some((identity, keeper)) = identity.zip(front.general.keeper()) else {
            return self.send_transact(self.model.front.id(), transact);
        };
        let job = front.traffic.kept.keep_first(transact, &identity, keeper);
        if !job.is_some_and(|job| self.request(Request::Job(job))) {
            self.model.front.traffic.kept.forget();
            self.model.front.traffic.composer.forget_waiting();
        }
    }

    /// Sends a command whose backup is kept by now.
    pub(super) fn send_kept_command(&mut self, id: DeskId) {
        match self.model.desk_mut(id).and_then(|desk| desk.traffic.kept.ready()) {
            Some(Ok(transact)) => {
                self.send_transact(id, transact);
                if let Some(desk) = self.model.desk_mut(id) {
                    desk.general.ram_changes();
                    desk.loops.want_reading();
                }
            }
            Some(Err((number, failure))) => {
                if let Some(desk) = self.model.desk_mut(id) {
                    desk.traffic.composer.answered(number, &Err(failure));
                }
            }
            None => {}
        }
    }

    fn send_transact(&mut self, id: DeskId, transact: Transact) {
        let is_sent = self.request_of(id, transact.request());
        let Some(desk) = self.model.desk_mut(id) else { return };
        if is_sent {
            // It may have changed a setting.
            desk.watch.want_reading();
        } else {
            desk.traffic.composer.forget_waiting();
        }
    }
}

//! The debugger of a unit's script, past the wire: what it is asked for, what it shows, and the world that may stand still meanwhile.
//!
//! A world that stands still does so for the unit too: its clock, its time-outs and its motors stop in mid-motion. The wire goes on, so that
//! a client is answered and sees readings that do not change.

use super::Controller;
use brushwork_script::debug::{Reason, Request, StopCause, View, Wanted};
use std::time::Duration;

impl Controller {
    /// Asks the debugger for things, one after the other, and looks at the script.
    pub fn debug(&mut self, requests: Vec<Request>, wanted: &Wanted) -> View {
        let mut left = requests.into_iter();
        let view = self.with_script(|debugger, mut machine, host| {
            left.by_ref().for_each(|request| debugger.ask(request, machine.as_deref_mut(), host));
            debugger.view(machine, host, wanted)
        });
        view.unwrap_or_else(|| {
            left.for_each(|request| self.debugger.ask_alone(request, None));
            self.debugger.stopped(StopCause::PowerLost);
            View { now: self.unit_now(), reason: Reason::Stopped(StopCause::PowerLost), ..View::default() }
        })
    }

    /// Time for the unit and its world, which can stand still.
    pub(super) fn unit_now(&self) -> Duration {
        self.now.saturating_sub(self.frozen_for)
    }

    /// Whether unit and world stand still now.
    pub(super) fn is_frozen(&self) -> bool {
        self.debugger.holds_world()
            && self.firmware.as_ref().is_some_and(|firmware| firmware.script.is_running())
    }

    /// Lets time pass on the wire alone.
    pub(super) fn stand_still(&mut self, to: Duration) {
        self.frozen_for += to.saturating_sub(self.now);
        self.now = self.now.max(to);
    }

    /// Whether a debugged script stands or has ended, so that there is something to look at.
    pub(super) fn has_something_to_see(&self) -> bool {
        let runs = self.firmware.as_ref().is_some_and(|firmware| firmware.script.is_running());
        self.debugger.is_attached() && (self.debugger.is_paused() || !runs)
    }
}

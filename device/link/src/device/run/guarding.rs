//! Who stops the motors when this program dies is told what may move, and by which bytes it stops.

use super::state::DeviceLoop;
use crate::device::event::DisarmReason;
use crate::messages::GuardMessage;
use brushwork_values::Message;

impl DeviceLoop {
    /// Has a guard for the line before anything may move. Where it cannot be had, that is a warning of arming.
    pub(super) fn have_guard(&mut self) -> Option<Message> {
        let guardian = self.options.guardian.clone()?;
        if self.signals.is_guarded() {
            return None;
        }
        let started = self.exchange.second_way().and_then(|line| guardian.start(&self.exchange.port(), line));
        match started {
            Ok(guard) => {
                self.signals.set_guard(Some(guard));
                self.held.clear();
                None
            }
            Err(error) => Some(GuardMessage::Missing { detail: error.to_string() }.into()),
        }
    }

    /// Tells the guard what would have to be stopped, when that has changed.
    pub(super) fn tend_guard(&mut self) {
        if self.options.guardian.is_none() {
            return;
        }
        let armed = self.armed.map(|_| (true, true));
        let units = self.units.iter().map(|unit| (unit.moved, unit.script_started));
        let held: Vec<_> = std::iter::once(armed.unwrap_or_default()).chain(units).collect();
        if held == self.held {
            return;
        }
        let may_move = self.armed.is_some() || self.units.iter().any(|unit| unit.moved);
        let bytes = self.stop_bytes(&DisarmReason::Closing);
        self.signals.with_guard(|guard| if may_move { guard.hold(&bytes) } else { guard.release() });
        self.held = held;
    }

    /// The link ends. A guard that still holds something, and has the port, writes its bytes once more, which harms nothing.
    pub(super) fn dismiss_guard(&mut self) {
        self.signals.set_guard(None);
    }
}

//! Leaving for the firmware loader: motors first, and nothing else on this link afterwards.

use super::state::{DeviceLoop, Phase};
use crate::device::controller::Line;
use crate::device::event::{DisarmReason, Event};
use crate::exchange::Permit;
use crate::failure::Failure;
use std::time::Duration;

const TRIED: &str = "enter the firmware loader";

impl DeviceLoop {
    /// Stops every motor of the link, has that confirmed, and sends the selected unit into its loader.
    pub(super) fn enter_loader(&mut self, asked_at: Duration, overtaken: bool) {
        if overtaken {
            return self.tell_not_sent(TRIED, "Stop was pressed after it");
        }
        if self.units.len() > 1 {
            // The others would take the image's bytes for packets.
            let remedy = "Connect the controller alone, over its USB port";
            return self.refuse_loader("other controllers share this line", remedy);
        }
        if !self.halt_and_confirm(DisarmReason::Stop) {
            if self.phase != Phase::Ended {
                self.refuse_loader(
                    "the motors did not confirm that they stand",
                    "Cut the motor power, then try again",
                );
            }
            return;
        }
        let permit = Permit { loader: true, guesses: self.options.simulated, ..Permit::default() };
        let mut line = Line::new(&mut self.exchange, &self.guard, permit, asked_at);
        match self.units[self.selected].controller.enter_loader(&mut line) {
            Ok(()) => {
                self.outbox.send(Event::LoaderEntered);
                self.end(Event::Closed);
            }
            Err(error) => self.tell(TRIED, &error),
        }
    }

    fn refuse_loader(&mut self, came_back: &str, remedy: &str) {
        let failure = Failure::new(TRIED, self.name_of(self.selected), came_back, remedy);
        self.outbox.send(Event::Failure(failure));
    }
}

//! Leaving for the firmware loader: motors first, and nothing else on this link afterwards.

use super::state::{DeviceLoop, Phase};
use crate::device::controller::Line;
use crate::device::event::{DisarmReason, Event};
use crate::exchange::Permit;
use crate::failure::Failure;
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use std::time::Duration;

impl DeviceLoop {
    /// Stops every motor of the link, has that confirmed, and sends the selected unit into its loader.
    pub(super) fn enter_loader(&mut self, asked_at: Duration, overtaken: bool) {
        if overtaken {
            return self.tell_not_sent(ActMessage::EnterLoader, CauseMessage::Stopped);
        }
        if self.units.len() > 1 {
            // The others would take the image's bytes for packets.
            return self.refuse_loader(CauseMessage::LineIsShared, RemedyMessage::ConnectAlone);
        }
        if !self.halt_and_confirm(DisarmReason::Stop) {
            if self.phase != Phase::Ended {
                self.refuse_loader(CauseMessage::NotStanding, RemedyMessage::CutPowerFirst);
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
            Err(error) => self.tell(ActMessage::EnterLoader, &error),
        }
    }

    fn refuse_loader(&mut self, came_back: CauseMessage, remedy: RemedyMessage) {
        let failure = Failure::new(ActMessage::EnterLoader, self.name_of(self.selected), came_back, remedy);
        self.outbox.send(Event::Failure(failure));
    }
}

//! One Motion Mind, and what is known of it from one act to the next.

use crate::controller::borrowed::{Borrowed, Ramp};
use crate::controller::facts::MotionMindFacts;
use crate::controller::speaker::Speaker;
use brushwork_link::device::Identity;
use brushwork_link::device::controller::Line;
use brushwork_motion_mind_wire::{Command, Mode, Protocol};

/// One Motion Mind 3.
pub struct MotionMind {
    pub(super) speaker: Speaker,
    pub(super) identity: Identity,
    /// Registers in RAM that a stop has changed, with the values to put back.
    pub(super) borrowed: Vec<Borrowed>,
    /// What a stop may change for a while, with the value that is to be there again; known once the unit was found fit to be armed.
    pub(super) lends: Option<Borrowed>,
    /// VELOCITYLIMIT and TIMER as last read: how steep a ramp is.
    pub(super) ramp: Ramp,
}

impl MotionMind {
    pub(super) fn new(speaker: Speaker, identity: Identity) -> Self {
        Self { speaker, identity, borrowed: Vec::new(), lends: None, ramp: Ramp::default() }
    }

    pub(super) fn facts(&self) -> MotionMindFacts {
        let unknown = MotionMindFacts { mode: Mode::FactoryTest, protocol: Protocol::Binary };
        MotionMindFacts::of(&self.identity).unwrap_or(unknown)
    }

    pub(super) fn mode(&self) -> Mode {
        self.facts().mode
    }

    /// The unit and its port, for sentences.
    pub(super) fn name(&self, line: &mut Line<'_>) -> String {
        format!("{} at {}", self.identity.place(), line.exchange().port())
    }

    /// What a command that was carried out changes in what is known of the unit.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(super) fn note(&mut self, command: &Command) {
        match *command {
            Command::Write { register, value } | Command::WriteStore { register, value } => {
                self.borrowed.retain(|borrowed| borrowed.register != register);
                self.lends = self.lends.filter(|lends| lends.register != register);
                self.speaker.note_write(register, value);
                self.ramp.note_write(register, value);
            }
            Command::Restore | Command::Reset => {
                self.borrowed.clear();
                self.lends = None;
                self.speaker.returns = None;
                self.ramp = Ramp::default();
            }
            _ => {}
        }
    }
}

//! A controller's status at one moment.

use brushwork_protocol::packet_serial::status::{Condition, Conditions, Lamp, Severity};
use std::time::Duration;

/// What a status word says at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusReport {
    /// The unit.
    pub address: u8,
    /// Host time of the reply.
    pub at: Duration,
    /// The word as it came.
    pub word: u32,
    /// What is set in it.
    pub conditions: Conditions,
    /// Bits that mean nothing in the unit's generation.
    pub unknown_bits: u32,
}

impl StatusReport {
    /// The conditions for which the controller stops motors. Any of them disarms.
    pub fn faults(&self) -> impl Iterator<Item = Condition> {
        self.conditions.iter().filter(|condition| condition.severity() == Severity::Error)
    }

    /// How bad what a lamp shows is; `None` if it is dark.
    #[must_use]
    pub fn lamp(&self, lamp: Lamp) -> Option<Severity> {
        lamp.lit_by(self.conditions)
    }
}

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
    /// The unit's running time in ticks of its own, where it comes with the status (command 73).
    pub running_ticks: Option<u32>,
}

/// A running time that is smaller than the one before has begun anew, unless the one before was this close to its end.
const WRAP_MARGIN_TICKS: u32 = 1 << 24;

impl StatusReport {
    /// Whether the unit has started anew since an earlier report: it has forgotten every setting that was not saved.
    #[must_use]
    pub fn has_restarted_since(&self, earlier: &Self) -> bool {
        let (Some(now), Some(then)) = (self.running_ticks, earlier.running_ticks) else { return false };
        now < then && then < u32::MAX - WRAP_MARGIN_TICKS
    }

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

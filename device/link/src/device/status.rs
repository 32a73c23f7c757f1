//! A controller's status at one moment.

use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions, Lamp, Severity};
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
    /// What is set in it, in a family whose status is that of packet serial.
    pub conditions: Conditions,
    /// What its bits mean in a family with a status of its own; empty for packet serial.
    pub signs: &'static [Sign],
    /// Bits that mean nothing in the unit's generation.
    pub unknown_bits: u32,
    /// The unit's running time in ticks of its own, where it comes with the status (command 73).
    pub running_ticks: Option<u32>,
}

/// One bit of a status word in a family with a status of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sign {
    /// The bit, as a mask.
    pub mask: u32,
    /// Name in files and JSON: snake_case.
    pub key: &'static str,
    /// Name in the manual.
    pub short: &'static str,
    /// What it means when it is set, in words.
    pub title: &'static str,
    /// How grave it is.
    pub severity: Severity,
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

    /// What the controller stops motors for, in words. Any of it disarms.
    pub fn faults(&self) -> impl Iterator<Item = &'static str> {
        let conditions = self.conditions.iter().filter(|condition| condition.severity() == Severity::Error);
        let signs = self.lit().filter(|sign| sign.severity == Severity::Error);
        conditions.map(Condition::title).chain(signs.map(|sign| sign.title))
    }

    /// The signs that are set, in a family with a status of its own.
    pub fn lit(&self) -> impl Iterator<Item = &'static Sign> {
        let word = self.word;
        self.signs.iter().filter(move |sign| word & sign.mask != 0)
    }

    /// How bad what a lamp shows is; `None` if it is dark.
    #[must_use]
    pub fn lamp(&self, lamp: Lamp) -> Option<Severity> {
        lamp.lit_by(self.conditions)
    }
}

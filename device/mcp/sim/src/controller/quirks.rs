//! What one firmware does otherwise than its model and generation say, so that a unit can be imitated whose owner has sent a report.

use brushwork_mcp_wire::packet_serial::Generation;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// The differences of one unit. By default there are none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Quirks {
    /// Commands that it never answers.
    pub silent: BTreeSet<u8>,
    /// Commands whose replies have the layout of another generation.
    pub layouts: BTreeMap<u8, Generation>,
    /// What it takes longer for some commands.
    pub slow: BTreeMap<u8, Duration>,
    /// How late every reply is: the line to it, rather than the unit.
    pub late: Duration,
}

impl Quirks {
    /// What a reply to a command takes longer than it has to.
    pub(super) fn delay_of(&self, command: u8) -> Duration {
        self.late + self.slow.get(&command).copied().unwrap_or_default()
    }
}

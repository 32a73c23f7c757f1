//! Half a board, and what is known of it from one act to the next.

use crate::controller::speaker::Speaker;
use crate::family::Half;
use brushwork_link::device::Identity;
use brushwork_link::device::controller::Line;

/// Half of a MotorVator.
pub struct Board {
    pub(super) speaker: Speaker,
    pub(super) half: Half,
    pub(super) identity: Identity,
    /// The display's characters and the inputs that have changed, as they were last told.
    pub(super) display: ([u8; 2], u8),
}

impl Board {
    pub(super) fn new(speaker: Speaker, half: Half, identity: Identity) -> Self {
        Self { speaker, half, identity, display: (*b"  ", 0) }
    }

    /// The unit and its port, for sentences.
    pub(super) fn name(&self, line: &mut Line<'_>) -> String {
        format!("{} at {}", self.identity.place(), line.exchange().port())
    }
}

//! Runs the tuner again on the record of a report.

use crate::law_probe::LawProbe;
use crate::record::Player;
use crate::report::Report;
use crate::tune::tune;

impl<L: LawProbe> Report<L> {
    /// Runs the tuner again on the record. The gains come out the same to the last bit; `None` if the record does not belong
    /// to this version of the tuner.
    #[must_use]
    pub fn replay(&self) -> Option<Self> {
        self.replay_or_stray().ok()
    }

    /// The same; an error says at which entry of the record, from 0, the tuner asked for something else than the record holds.
    pub fn replay_or_stray(&self) -> Result<Self, usize> {
        let mut player = Player::new(self.record.clone());
        let report = tune(&mut player, &self.request);
        player.strayed_at().map_or(Ok(report), Err)
    }
}

//! What is on its way out of one board.

use brushwork_plant::pacing::byte_time;
use std::collections::VecDeque;
use std::time::Duration;

/// Replies and echoes, each with when it leaves.
#[derive(Clone, Debug, Default)]
pub struct Outbox {
    waiting: VecDeque<(Duration, Vec<u8>)>,
    /// When the last bit of what was said so far is through.
    free_at: Duration,
}

impl Outbox {
    /// Says something at a moment, or after what is said before it. What leaves at the same moment leaves together.
    pub fn put(&mut self, at: Duration, bytes: &[u8], bits_per_second: u32) {
        let at = self.waiting.back().map_or(at, |(last, _)| at.max(*last));
        let took = byte_time(bits_per_second) * u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        self.free_at = self.free_at.max(at) + took;
        match self.waiting.back_mut() {
            Some((last, together)) if *last == at => together.extend_from_slice(bytes),
            Some(_) | None => self.waiting.push_back((at, bytes.to_vec())),
        }
    }

    /// Whether something is still on the wire: a line of commands says no more meanwhile.
    pub fn is_busy(&self, now: Duration) -> bool {
        now < self.free_at
    }

    /// When the next leaves.
    pub fn next_at(&self) -> Option<Duration> {
        self.waiting.front().map(|(at, _)| *at)
    }

    /// Takes what has left by now.
    pub fn take(&mut self, now: Duration) -> Option<(Duration, Vec<u8>)> {
        self.waiting.pop_front_if(|(at, _)| *at <= now)
    }
}

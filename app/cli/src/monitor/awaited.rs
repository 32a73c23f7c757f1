//! Replies that are due, oldest first, and what has come of each.

use std::collections::VecDeque;
use std::time::Duration;

use super::record::{Direction, Record};

/// A request whose reply is due, and what has come of it.
pub struct Awaited<R> {
    pub request: R,
    pub sent_at: Duration,
    pub bytes: Vec<u8>,
    pub first_at: Duration,
    pub last_at: Duration,
}

impl<R> Awaited<R> {
    /// Nothing has come yet.
    pub fn new(request: R, now: Duration) -> Self {
        Self { request, sent_at: now, bytes: Vec::new(), first_at: now, last_at: now }
    }

    /// Whether nothing more will come: nothing did within a limit, or what came has stopped for longer than a gap.
    pub fn is_over(&self, now: Duration, limit: Duration, gap: Duration) -> bool {
        match self.bytes.is_empty() {
            true => now.saturating_sub(self.sent_at) > limit,
            false => now.saturating_sub(self.last_at) > gap,
        }
    }
}

/// Adds what the controller sent to the oldest reply; a record of it where none is due.
pub fn take<R>(due: &mut VecDeque<Awaited<R>>, bytes: &[u8], now: Duration) -> Option<Record> {
    let Some(awaited) = due.front_mut() else {
        let text = "answer to nothing".to_owned();
        return Some(Record::new(now, Direction::FromController, bytes.to_vec(), text));
    };
    if awaited.bytes.is_empty() {
        awaited.first_at = now;
    }
    awaited.bytes.extend(bytes);
    awaited.last_at = now;
    None
}

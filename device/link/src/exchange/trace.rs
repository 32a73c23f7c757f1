//! The bytes of a link, kept on request for a traffic view.

use std::collections::VecDeque;
use std::time::Duration;

/// How many records are kept until somebody takes them; the oldest go first.
const CAPACITY: usize = 4096;

/// Bytes of the same way that come within this time are one record.
const JOINED_WITHIN: Duration = Duration::from_millis(10);

/// Bytes that went one way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// Host time of the write, or of the read that brought the first of the bytes.
    pub at: Duration,
    /// Host time of the write, or of the read that brought the last of the bytes.
    pub until: Duration,
    /// Whether this program sent them.
    pub sent: bool,
    /// The bytes: of one request, or of what came in answer to it.
    pub bytes: Vec<u8>,
}

/// A ring of traffic records; empty and free of cost while it is off.
#[derive(Debug, Default)]
pub struct Trace {
    on: bool,
    records: VecDeque<Traffic>,
}

impl Trace {
    /// Switches recording on or off; switching it off forgets what was recorded.
    pub fn switch(&mut self, on: bool) {
        self.on = on;
        if !on {
            self.records.clear();
        }
    }

    /// Records bytes that went one way; those that follow bytes of the same way within 10 ms are joined to them.
    pub fn record(&mut self, at: Duration, sent: bool, bytes: &[u8]) {
        if !self.on || bytes.is_empty() {
            return;
        }
        if let Some(last) = self.records.back_mut()
            && !sent
            && !last.sent
            && at.saturating_sub(last.until) < JOINED_WITHIN
        {
            last.bytes.extend(bytes);
            last.until = at;
            return;
        }
        if self.records.len() == CAPACITY {
            self.records.pop_front();
        }
        self.records.push_back(Traffic { at, until: at, sent, bytes: bytes.to_vec() });
    }

    /// Takes all records but one that may still grow at `now`.
    pub fn take(&mut self, now: Duration) -> impl Iterator<Item = Traffic> + '_ {
        let may_grow = |last: &Traffic| !last.sent && now.saturating_sub(last.until) < JOINED_WITHIN;
        let growing = usize::from(self.records.back().is_some_and(may_grow));
        let ready = self.records.len() - growing;
        self.records.drain(..ready)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reply_that_comes_in_pieces_is_one_record_and_is_given_when_the_next_request_ends_it() {
        let ms = Duration::from_millis;
        let mut trace = Trace::default();
        trace.record(ms(0), true, &[1]);
        assert_eq!(trace.take(ms(0)).count(), 0, "nothing is recorded while it is off");
        trace.switch(true);
        trace.record(ms(1), true, &[0x80, 21]);
        trace.record(ms(2), false, &[1]);
        trace.record(ms(3), false, &[2, 3]);
        assert_eq!(trace.take(ms(3)).count(), 1);
        trace.record(ms(4), true, &[0x80, 90]);
        let rest: Vec<_> = trace.take(ms(4)).collect();
        assert_eq!(rest[0], Traffic { at: ms(2), until: ms(3), sent: false, bytes: vec![1, 2, 3] });
        assert_eq!(rest[1].bytes, [0x80, 90]);
    }

    #[test]
    fn the_last_reply_is_given_when_it_cannot_grow_any_more() {
        let ms = Duration::from_millis;
        let mut trace = Trace::default();
        trace.switch(true);
        trace.record(ms(1), false, &[1]);
        assert_eq!(trace.take(ms(5)).count(), 0);
        assert_eq!(trace.take(ms(11)).count(), 1);
    }

    #[test]
    fn the_oldest_records_go_when_nobody_takes_them() {
        let mut trace = Trace::default();
        trace.switch(true);
        for index in 0..CAPACITY + 10 {
            trace.record(Duration::from_secs(index as u64), true, &[index as u8]);
        }
        let kept: Vec<_> = trace.take(Duration::ZERO).collect();
        assert_eq!(kept.len(), CAPACITY);
        assert_eq!(kept[0].at, Duration::from_secs(10));
    }
}

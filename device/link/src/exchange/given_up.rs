//! Requests whose replies were given up: what may still come, and when it cannot any more.
//!
//! A controller answers in order. So a reply that is certainly the answer to a later request puts an end to all earlier ones.

use std::collections::VecDeque;
use std::time::Duration;

/// After this long nothing comes any more: three of the longest replies (453 bytes, command 144) one behind the other at 2400 bit/s, the
/// slowest rate of a RoboClaw, take 5.7 s.
const LATEST: Duration = Duration::from_secs(6);
/// More are not told apart; the oldest are dropped.
const MOST: usize = 64;

/// Requests without their replies, oldest first.
#[derive(Clone, Debug, Default)]
pub struct GivenUp {
    requests: VecDeque<Unanswered>,
}

#[derive(Clone, Debug)]
struct Unanswered {
    request: Vec<u8>,
    reply_length: usize,
    at: Duration,
    /// Its time was over; otherwise something more urgent broke in, and the reply is just on its way.
    timed_out: bool,
}

impl GivenUp {
    /// Takes note that nobody waits for the reply to `request` any more.
    pub fn note(&mut self, request: &[u8], reply_length: usize, now: Duration, timed_out: bool) {
        self.requests.retain(|unanswered| now < unanswered.at + LATEST);
        if self.requests.len() == MOST {
            self.requests.pop_front();
        }
        self.requests.push_back(Unanswered { request: request.to_vec(), reply_length, at: now, timed_out });
    }

    /// Whether one of the replies may still come.
    pub fn may_come(&self, now: Duration) -> bool {
        self.requests.iter().any(|unanswered| now < unanswered.at + LATEST)
    }

    /// Whether one may still come although its time was over.
    pub fn timed_out(&self, now: Duration) -> bool {
        self.requests.iter().any(|unanswered| unanswered.timed_out && now < unanswered.at + LATEST)
    }

    /// Whether the reply to this very request may still come.
    pub fn holds(&self, request: &[u8]) -> bool {
        self.requests.iter().any(|unanswered| unanswered.request == request)
    }

    /// Bytes of all the replies that may still come, at least.
    pub fn reply_bytes(&self) -> usize {
        self.requests.iter().map(|unanswered| unanswered.reply_length).sum()
    }

    /// Takes note that a reply that fits `request` alone has come. If the same was asked before in vain, it may be the reply to that one;
    /// then the later one may still come.
    pub fn answered(&mut self, request: &[u8]) {
        match self.requests.iter().position(|unanswered| unanswered.request == request) {
            None => self.requests.clear(),
            Some(index) => {
                self.requests.drain(..index);
                self.requests.rotate_left(1);
            }
        }
    }

    /// Nothing of it can come any more.
    pub fn forget(&mut self) {
        self.requests.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn of(requests: &[u8]) -> GivenUp {
        let mut given_up = GivenUp::default();
        requests.iter().for_each(|request| given_up.note(&[*request], 10, SECOND, true));
        given_up
    }

    #[test]
    fn the_reply_to_another_request_ends_all() {
        let mut given_up = of(b"abc");
        assert!(given_up.may_come(SECOND));
        assert_eq!(given_up.reply_bytes(), 30);
        given_up.answered(b"d");
        assert!(!given_up.may_come(SECOND));
    }

    #[test]
    fn the_reply_to_a_request_made_twice_ends_what_was_before_the_first_only() {
        let mut given_up = of(b"abc");
        given_up.answered(b"b");
        assert!(!given_up.holds(b"a") && given_up.holds(b"b") && given_up.holds(b"c"));
        // The next one is that of the second request.
        given_up.answered(b"b");
        assert!(!given_up.holds(b"c") && given_up.may_come(SECOND));
        given_up.answered(b"d");
        assert!(!given_up.may_come(SECOND));
    }

    #[test]
    fn nothing_comes_after_the_latest_time_and_the_memory_is_bounded() {
        let mut given_up = of(b"a");
        assert!(!given_up.may_come(SECOND + LATEST));
        (0..1000).for_each(|_| given_up.note(b"x", 1, SECOND, false));
        assert_eq!(given_up.reply_bytes(), MOST);
        assert!(
            given_up.may_come(SECOND) && !given_up.timed_out(SECOND),
            "those broken into are not late yet"
        );
    }
}

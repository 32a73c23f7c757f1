//! Whoever is at the other end of the CAN stream of a script.
//!
//! Assumed: the stream carries bytes. How a script's bytes lie in frames is not public (the CAN words of the language have no
//! public syntax), so that the two ends here speak in bytes.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::time::Duration;

/// Bytes that a peer remembers having heard.
const HEARD_BYTES: usize = 256;
/// Bytes that may be on their way to the unit.
const SENT_BYTES: usize = 1024;
/// How long an echo takes: about a frame there and one back at 250 kbit/s.
const ECHO_TIME: Duration = Duration::from_millis(1);

/// What the peer does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CanPeer {
    /// Nobody is there.
    #[default]
    Absent,
    /// It listens.
    Listening,
    /// It sends back what it hears.
    Echoing,
}

/// The CAN stream's other end.
#[derive(Clone, Debug, Default)]
pub struct CanLine {
    peer: CanPeer,
    heard: VecDeque<u8>,
    sent: VecDeque<(Duration, u8)>,
}

impl CanLine {
    /// Changes the peer.
    pub fn set_peer(&mut self, peer: CanPeer) {
        self.peer = peer;
        if peer == CanPeer::Absent {
            self.sent.clear();
        }
    }

    /// What the peer does.
    pub fn peer(&self) -> CanPeer {
        self.peer
    }

    /// A byte from the unit.
    pub fn hear(&mut self, byte: u8, now: Duration) {
        if self.peer == CanPeer::Absent {
            return;
        }
        if self.heard.len() == HEARD_BYTES {
            self.heard.pop_front();
        }
        self.heard.push_back(byte);
        if self.peer == CanPeer::Echoing {
            self.push(byte, now + ECHO_TIME);
        }
    }

    /// The peer sends bytes; an absent one sends none.
    pub fn send(&mut self, bytes: &[u8], now: Duration) {
        if self.peer != CanPeer::Absent {
            bytes.iter().for_each(|byte| self.push(*byte, now));
        }
    }

    /// When the next byte arrives at the unit.
    pub fn next_at(&self) -> Option<Duration> {
        self.sent.front().map(|(at, _)| *at)
    }

    /// The next byte that has arrived by `now`.
    pub fn take(&mut self, now: Duration) -> Option<(Duration, u8)> {
        self.sent.pop_front_if(|(at, _)| *at <= now)
    }

    /// What the peer heard last.
    pub fn heard(&self) -> Vec<u8> {
        self.heard.iter().copied().collect()
    }

    fn push(&mut self, byte: u8, at: Duration) {
        if self.sent.len() < SENT_BYTES {
            let last = self.sent.back().map_or(at, |(last, _)| *last);
            self.sent.push_back((at.max(last), byte));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_echo_comes_back_a_moment_later() {
        let mut line = CanLine::default();
        line.hear(1, Duration::ZERO);
        assert_eq!((line.heard(), line.next_at()), (vec![], None), "nobody is there");
        line.set_peer(CanPeer::Echoing);
        line.hear(2, Duration::ZERO);
        assert_eq!(line.take(Duration::from_micros(999)), None);
        assert_eq!(line.take(ECHO_TIME), Some((ECHO_TIME, 2)));
        assert_eq!(line.heard(), [2]);
    }
}

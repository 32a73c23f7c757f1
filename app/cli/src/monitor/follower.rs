//! Whoever follows the traffic of a line and puts it into words. No clock, no IO: bytes and times in, records out.

use std::time::Duration;

use super::record::Record;

/// Follows a conversation.
pub trait Follower: Send {
    /// Takes bytes of the client.
    fn client_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record>;

    /// Takes bytes of the controller.
    fn controller_sent(&mut self, bytes: &[u8], now: Duration) -> Vec<Record>;

    /// Whether an answer is due.
    fn awaits_reply(&self) -> bool;

    /// Whether a command is open that further bytes may complete.
    fn may_become_whole(&self) -> bool;

    /// Tells the time while nothing comes.
    fn silence(&mut self, now: Duration) -> Vec<Record>;

    /// Tells the time while nothing comes from the client.
    fn client_silence(&mut self, now: Duration) -> Vec<Record>;

    /// The client has gone: what it left half done is over.
    fn client_left(&mut self, now: Duration) -> Vec<Record>;

    /// What stands the units that were told to move and not to stand since.
    fn stops(&self) -> Vec<Stop>;
}

/// What stands one unit that the client had told to move.
pub struct Stop {
    /// Who, for sentences.
    pub who: String,
    /// One write each, with a pause before each.
    pub writes: Vec<Vec<u8>>,
    /// An acknowledge begins so.
    pub acknowledge: &'static [u8],
}

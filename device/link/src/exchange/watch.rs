//! What may break into an exchange while it waits for bytes.

use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// Something more urgent than the exchange at hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Interruption {
    /// Stop was asked for.
    Stop,
    /// The window did not renew the motion in time.
    DeadMan,
    /// Disarming was asked for.
    Disarm,
    /// The link is being closed.
    Closing,
    /// The job was cancelled.
    Cancelled,
    /// The job ran out of its time.
    TimeLimit,
}

impl fmt::Display for Interruption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stop => "Stop came first",
            Self::DeadMan => {
                "this computer answered late: the program did not renew the motion within 250 ms. Try again with fewer programs running"
            }
            Self::Disarm => "the motors were disarmed first",
            Self::Closing => "the link is being closed",
            Self::Cancelled => "it was cancelled",
            Self::TimeLimit => "it took longer than its time limit",
        })
    }
}

/// Looked at before each request and at every slice of waiting.
pub trait Watch {
    /// What must come first at `now`, if anything.
    fn interruption(&self, now: Duration) -> Option<Interruption>;

    /// The next moment at which that could change by time alone, so that waiting ends exactly there.
    fn next(&self) -> Option<Duration> {
        None
    }
}

/// Nothing breaks in.
pub struct Unwatched;

impl Watch for Unwatched {
    fn interruption(&self, _now: Duration) -> Option<Interruption> {
        None
    }
}

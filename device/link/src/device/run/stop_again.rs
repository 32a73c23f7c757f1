//! A stop that waits to be repeated until a unit confirms it.

use std::time::Duration;

/// A stop that nobody confirmed, although this program may have set motors in motion.
#[derive(Clone, Copy, Debug)]
pub struct StopAgain {
    /// When it is tried next.
    pub at: Duration,
    /// When it was first tried.
    pub since: Duration,
}

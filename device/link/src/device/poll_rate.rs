//! How often the signals of a unit are read.

use std::time::Duration;

/// How often the signals are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PollRate {
    /// Not at all, except while something is armed.
    Off,
    /// One sweep in each such time.
    Every(Duration),
    /// As fast as the link allows.
    Fastest,
}

impl PollRate {
    /// The rate of Ion Studio: ten sweeps a second.
    pub const DEFAULT: Self = Self::Every(Duration::from_millis(100));
}

impl Default for PollRate {
    fn default() -> Self {
        Self::DEFAULT
    }
}

//! Waiting for what really happens: threads, files, processes. However slow the machine is, a test only gives up when
//! there is no hope left, and then says what it waited for and what was there instead.

use std::time::{Duration, Instant};

/// How long something may take that a healthy machine has done in no time.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Time between two looks.
const INTERVAL: Duration = Duration::from_millis(3);

/// The same where each look draws a frame, which takes the processor from what is waited for.
const FRAME_INTERVAL: Duration = Duration::from_millis(25);

/// Looks until `look` finds something. `there` tells what was there instead when it never does.
pub fn until_some<T>(what: &str, mut look: impl FnMut() -> Option<T>, there: impl FnOnce() -> String) -> T {
    let mut wait = Wait::new();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(wait.goes_on(), "waited {PATIENCE:?} for {what}, but: {}", there());
    }
}

/// Looks until something holds.
pub fn until(what: &str, mut holds: impl FnMut() -> bool, there: impl FnOnce() -> String) {
    until_some(what, || holds().then_some(()), there);
}

/// A wait under way, for those who have something to do between two looks.
#[derive(Debug)]
pub struct Wait {
    began: Instant,
    interval: Duration,
}

impl Wait {
    /// Begins now.
    pub fn new() -> Self {
        Self { began: Instant::now(), interval: INTERVAL }
    }

    /// Begins now, with a frame drawn at each look.
    pub fn with_frames() -> Self {
        Self { interval: FRAME_INTERVAL, ..Self::new() }
    }

    /// Waits a moment; false when the time is up.
    pub fn goes_on(&mut self) -> bool {
        std::thread::sleep(self.interval);
        self.began.elapsed() < PATIENCE
    }

    /// How long it has taken so far.
    pub fn passed(&self) -> Duration {
        self.began.elapsed()
    }
}

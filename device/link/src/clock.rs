//! Where the time comes from: the system clock, or one that a test turns by hand.
//!
//! Nothing else in this crate asks the operating system for the time. All times are durations since
//! the clock's own epoch, so that hours can be run through in virtual time.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, SystemTime};

#[cfg(not(target_family = "wasm"))]
pub use std::time::Instant;
/// A web page asks the browser.
#[cfg(target_family = "wasm")]
pub use web_time::Instant;

/// A source of monotonic time, shared by the device thread and by those who talk to it.
pub trait Clock: Send + Sync {
    /// Time since the clock's epoch. Never runs backwards.
    fn now(&self) -> Duration;

    /// Waits for `time`. A virtual clock moves on by that much instead.
    fn sleep(&self, time: Duration);

    /// The device thread does not look at it before `until`, unless it is woken. A clock that is shared with a simulated machine stands
    /// still for whoever is overdue.
    fn rest_until(&self, _until: Duration) {}
}

/// The date and time that the computer shows.
#[must_use]
pub fn today() -> SystemTime {
    #[cfg(not(target_family = "wasm"))]
    return SystemTime::now();
    #[cfg(target_family = "wasm")]
    return SystemTime::UNIX_EPOCH
        + web_time::SystemTime::now().duration_since(web_time::SystemTime::UNIX_EPOCH).unwrap_or_default();
}

/// The machine's monotonic clock; its epoch is the moment it was made.
#[derive(Clone, Copy, Debug)]
pub struct SystemClock {
    epoch: Instant,
}

impl SystemClock {
    /// A clock that reads zero now.
    #[must_use]
    pub fn new() -> Self {
        Self { epoch: Instant::now() }
    }

    /// The same, ready to be handed to a device thread.
    #[must_use]
    pub fn shared() -> Arc<dyn Clock> {
        Arc::new(Self::new())
    }
}

impl Default for SystemClock {
    fn default() -> Self {
        Self::new()
    }
}

impl Clock for SystemClock {
    fn now(&self) -> Duration {
        self.epoch.elapsed()
    }

    fn sleep(&self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// A clock that moves only when somebody waits on it or turns it. Clones show the same time.
#[derive(Clone, Debug, Default)]
pub struct VirtualClock {
    nanoseconds: Arc<AtomicU64>,
}

impl VirtualClock {
    /// A clock that reads zero.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Turns the clock on by `time`.
    pub fn advance(&self, time: Duration) {
        self.nanoseconds.fetch_add(nanoseconds(time), Ordering::SeqCst);
    }

    /// Turns the clock on to `time`; a time already past changes nothing.
    pub fn advance_to(&self, time: Duration) {
        self.nanoseconds.fetch_max(nanoseconds(time), Ordering::SeqCst);
    }
}

impl Clock for VirtualClock {
    fn now(&self) -> Duration {
        Duration::from_nanos(self.nanoseconds.load(Ordering::SeqCst))
    }

    fn sleep(&self, time: Duration) {
        self.advance(time);
    }
}

/// Whole nanoseconds of a time, for the atomics; 584 years fit.
pub(crate) fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_virtual_clock_moves_only_when_told_and_is_shared_by_its_clones() {
        let clock = VirtualClock::new();
        let other = clock.clone();
        clock.sleep(Duration::from_millis(3));
        other.advance(Duration::from_millis(4));
        assert_eq!(clock.now(), Duration::from_millis(7));
        clock.advance_to(Duration::from_millis(5));
        assert_eq!(other.now(), Duration::from_millis(7), "a clock never runs backwards");
    }

    #[test]
    fn the_system_clock_starts_near_zero_and_runs() {
        let clock = SystemClock::new();
        let before = clock.now();
        clock.sleep(Duration::from_millis(2));
        assert!(clock.now() >= before + Duration::from_millis(2));
    }
}

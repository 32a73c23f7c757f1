//! Waiting for a descriptor with the precision the system has.

use std::time::Duration;

/// What became of a descriptor that was waited for.
#[cfg(unix)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ready {
    /// There is something to read.
    pub readable: bool,
    /// The other side is closed.
    pub hung_up: bool,
}

/// Waits until one of the descriptors can be read or is hung up, at most `timeout`.
#[cfg(unix)]
pub fn wait_for<const N: usize>(
    descriptors: [rustix::fd::BorrowedFd<'_>; N],
    timeout: Duration,
) -> [Ready; N] {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let mut waited = descriptors.map(|descriptor| PollFd::from_borrowed_fd(descriptor, PollFlags::IN));
    let limit = Timespec { tv_sec: timeout.as_secs().min(60) as i64, tv_nsec: timeout.subsec_nanos().into() };
    if poll(&mut waited, Some(&limit)).is_err() {
        // Interrupted by a signal, most likely: the caller comes back.
        return [Ready::default(); N];
    }
    waited.map(|waited| {
        let flags = waited.revents();
        Ready {
            readable: flags.contains(PollFlags::IN),
            hung_up: flags.intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL),
        }
    })
}

/// Asks the system to wake this thread as exactly as it can; replies on a paced line must not be late.
pub fn wake_exactly() {
    #[cfg(target_os = "linux")]
    {
        const SLACK_NANOSECONDS: std::num::NonZeroU64 =
            std::num::NonZeroU64::new(1_000).expect("a thousand is not zero");
        // Without it waits are up to 50 us longer, nothing worse.
        let _ = rustix::thread::set_current_timer_slack(Some(SLACK_NANOSECONDS));
    }
}

/// Sleeps in place of a wait where there is nothing to wait for.
pub fn pause(timeout: Duration, longest: Duration) {
    std::thread::sleep(timeout.min(longest));
}

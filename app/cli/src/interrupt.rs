//! Ctrl-C, SIGTERM and SIGHUP as a flag that a command looks at, and what a command that something broke into ends with.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use brushwork_link::exchange::Interruption;

use super::exit::Exit;

/// The exit code of work that something broke into: a signal's own only if a signal was the reason.
#[must_use]
pub fn exit_of_interruption(cause: Interruption, by_signal: bool) -> Exit {
    match cause {
        Interruption::Stop | Interruption::Cancelled if by_signal => Exit::Interrupted,
        Interruption::Closing => Exit::NoLink,
        Interruption::TimeLimit => Exit::Failed,
        // The motion's dead-man and what disarms are rules for safety, as is a Stop that nobody here has asked for.
        Interruption::DeadMan | Interruption::Disarm | Interruption::Stop | Interruption::Cancelled => {
            Exit::Refused
        }
    }
}

/// Set once a signal has asked the program to end.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Takes over Ctrl-C, SIGTERM and SIGHUP for the rest of the program's life.
    ///
    /// # Errors
    /// When the system refuses the handler, or another one is set already.
    pub fn install() -> Result<Self, ctrlc::Error> {
        let interrupt = Self::default();
        let flag = interrupt.clone();
        ctrlc::set_handler(move || flag.raise())?;
        Ok(interrupt)
    }

    /// Whether the program was asked to end.
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// Asks the program to end.
    pub fn raise(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// Sleeps, but no longer than until the program is asked to end. Returns whether it was.
    pub fn sleep(&self, time: Duration) -> bool {
        const SLICE: Duration = Duration::from_millis(10);
        let end = Instant::now() + time;
        while !self.is_raised() {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            std::thread::sleep(left.min(SLICE));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_but_a_signal_ends_with_the_code_of_a_signal() {
        use Interruption as I;
        for cause in [I::Stop, I::DeadMan, I::Disarm, I::Closing, I::Cancelled, I::TimeLimit] {
            assert_ne!(exit_of_interruption(cause, false), Exit::Interrupted, "{cause:?}");
        }
        for cause in [I::Stop, I::Cancelled] {
            assert_eq!(exit_of_interruption(cause, true), Exit::Interrupted, "{cause:?}");
        }
        // A late computer is one, whatever was pressed afterwards.
        assert_eq!(exit_of_interruption(I::DeadMan, true), Exit::Refused);
    }
}

//! Ctrl-C, SIGTERM and SIGHUP as a flag that a command looks at, and what a command that something broke into ends with.
//!
//! Reading input, and opening what a path names, can wait for ever and cannot be called off. A command that holds no line to a controller then has
//! nothing to put in order, and is ended a moment after the signal; one that holds a line waits on another thread ([`meanwhile`]).

use brushwork_link::work::receive_within;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use brushwork_link::exchange::Interruption;
use crossbeam_channel::{RecvTimeoutError, bounded};

use super::exit::Exit;
use super::output;
use crate::messages::CliLinkMessage;

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

/// How long a command that holds no line may take to see that it was asked to end.
const GRACE: Duration = Duration::from_millis(250);
/// How often a command that waits looks at what else there is.
const LOOK: Duration = Duration::from_millis(10);

/// Set once a signal has asked the program to end.
#[derive(Debug, Clone, Default)]
pub struct Interrupt {
    raised: Arc<AtomicBool>,
    /// Whether the command may have a controller that it has to leave in order.
    holds_line: Arc<AtomicBool>,
}

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

    /// The same for a command. One that is still there a quarter of a second after the signal and holds no line waits for its input, its
    /// output or the system, and is ended.
    ///
    /// # Errors
    /// As [`Interrupt::install`].
    pub fn install_for_command() -> Result<Self, ctrlc::Error> {
        let interrupt = Self::of_process();
        let own = interrupt.clone();
        ctrlc::set_handler(move || {
            own.raise();
            std::thread::sleep(GRACE);
            // Nor can a write to a pipe that is full be called off. Whoever is held by it has renewed no motion for as long, so that the dead-man
            // has stopped the motors; the guardian stops them again.
            while own.holds_line.load(Ordering::SeqCst) && output::held_for() < GRACE {
                std::thread::sleep(LOOK);
            }
            std::process::exit(Exit::Interrupted as i32);
        })?;
        Ok(interrupt)
    }

    /// The one that a signal to this program sets, for what is far below a command.
    #[must_use]
    pub fn of_process() -> Self {
        static OWN: OnceLock<Interrupt> = OnceLock::new();
        OWN.get_or_init(Self::default).clone()
    }

    /// From now on the command has a controller, and ends by itself when it is asked to.
    pub fn hold_line(&self) {
        self.holds_line.store(true, Ordering::SeqCst);
    }

    /// Whether the program was asked to end.
    #[must_use]
    pub fn is_raised(&self) -> bool {
        self.raised.load(Ordering::SeqCst)
    }

    /// Asks the program to end.
    pub fn raise(&self) {
        self.raised.store(true, Ordering::SeqCst);
    }

    /// Fails once the program is asked to end; otherwise after a moment.
    ///
    /// # Errors
    /// It was.
    pub fn breathe(&self) -> Result<(), Exit> {
        if self.sleep(LOOK) { Err(Exit::Interrupted) } else { Ok(()) }
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

/// Does what may wait for ever and cannot be called off, such as reading what somebody types, on a thread of its own. `breathe` is called meanwhile
/// and can end the waiting. `None` if the work failed.
///
/// # Errors
/// What `breathe` said, or that there is no thread.
pub fn meanwhile<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
    breathe: &dyn Fn() -> Result<(), Exit>,
) -> Result<Option<T>, Exit> {
    let (sender, receiver) = bounded(1);
    // Nobody may be left to hear it.
    let run = move || drop(sender.send(work()));
    if let Err(error) = std::thread::Builder::new().name("waits".to_owned()).spawn(run) {
        return Err(Exit::Failed.saying(CliLinkMessage::NoThread { error: error.to_string() }));
    }
    loop {
        match receive_within(&receiver, LOOK) {
            Ok(done) => return Ok(Some(done)),
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) => breathe()?,
        }
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

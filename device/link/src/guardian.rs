//! Who stops the motors when this program dies: a second process, which the program that runs here starts for each line that it arms.
//!
//! The device thread tells it what bytes stop what may move, that it lives, and when nothing moves any more. What the second process is and
//! how it is told stands where processes may be started; this crate knows the two traits.

use crate::device::StopBytes;
use crate::transport::SecondWay;
use std::fmt;

/// Starts guards.
pub trait Guardian: Send + Sync + fmt::Debug {
    /// Starts one for the line that `port` names; `line` is its way to it.
    ///
    /// # Errors
    /// What the system said.
    fn start(&self, port: &str, line: SecondWay) -> std::io::Result<Box<dyn LineGuard>>;
}

/// The guard of one line. Dropping it without [`release`](LineGuard::release) is a death to it. Telling it something never waits.
pub trait LineGuard: Send + Sync + fmt::Debug {
    /// From now on these bytes are written when this program dies, in place of earlier ones.
    fn hold(&self, stop: &StopBytes);

    /// Nothing that this program has moved may move any more.
    fn release(&self);

    /// Whether a motion command may be in effect: only then is a program that stands still as good as dead.
    fn moving(&self, moving: bool);

    /// Whether it watches still.
    fn is_there(&self) -> bool;

    /// This program lives. Called often; what is sent of it is little.
    fn lives(&self);
}

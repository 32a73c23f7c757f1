//! What a job holds of the device thread: the wire to the selected unit, progress, and the question whether to go on.

use super::channel::Sample;
use super::drive::Drive;
use super::identity::Facts;
use super::inquiry::{Heard, Inquiry};
use crate::capability::CapabilityMap;
use crate::exchange::{ExchangeError, Interruption, Lateness, Reply};
use crate::wire::Wire;
use std::time::Duration;

/// The device thread, as a job sees it. Use it as a [`Wire`].
pub type JobContext<'a> = dyn JobHost + 'a;

/// What the device thread does for a job.
pub trait JobHost: Wire {
    /// Tells how far the job is: 0 to 1 where it knows, and what it does at the moment.
    fn progress(&mut self, fraction: Option<f32>, text: &str);

    /// Why the job should end now, if it should. Asked between exchanges by work that computes for long.
    /// Motors are stopped here too, before the job hears of it.
    fn interruption(&mut self) -> Option<Interruption>;

    /// As [`Wire::transact`], with the host times of the exchange: for experiments.
    fn transact_timed(&mut self, command: u8, values: &[i64]) -> Result<Reply, ExchangeError>;

    /// Moves motors, as [`Request::Drive`](super::Request::Drive) does. Refused unless something is armed; a job that uses it
    /// is made by [`Job::moving`](super::Job::moving). After an error nobody knows what the motors do, so the job
    /// should end.
    fn drive(&mut self, drive: &Drive) -> Result<(), ExchangeError>;

    /// Asks the firmware something in bytes, for an examination. Refused while anything is armed.
    fn inquire(&mut self, inquiry: &Inquiry<'_>) -> Result<Heard, ExchangeError>;

    /// What the unit's firmware is known to answer.
    fn answers(&mut self) -> CapabilityMap;

    /// How late the line has shown itself; `None` before the first reply.
    fn lateness(&self) -> Option<Lateness>;

    /// How long, since this was last asked, waits and replies had to wait for a processor of this computer.
    fn take_stolen(&mut self) -> Duration;

    /// What the unit's family knows of it.
    fn facts(&self) -> Facts;

    /// How long a byte takes on the wire, where that is known.
    fn byte_time(&self) -> Option<Duration>;

    /// What the controller's own time-out has to be at least on this line, where that is late.
    fn needed_timeout(&self) -> Option<Duration>;

    /// Shows the window a reading that the job made itself.
    fn sample(&mut self, sample: Sample);

    /// Whether the thread goes on reading signals between the job's exchanges, as it does at first. An experiment that
    /// needs even spacing, or a save that restarts the unit, switches it off.
    fn set_polling(&mut self, on: bool);
}

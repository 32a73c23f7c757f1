//! What a job holds of the device thread: the wire to the selected unit, progress, and the question whether to go on.

use super::channel::Sample;
use super::drive::Drive;
use super::identity::Facts;
use crate::exchange::{ExchangeError, Interruption, Reply};
use crate::unit::{FirmwareGeneration, UnitAddress};
use crate::wire::{HiddenSettings, Wire};
use brushwork_values::{Value, Values};
use std::time::Duration;

/// What the device thread does for a job.
pub(super) trait JobHost {
    fn transact(&mut self, command: u8, values: Vec<Value>) -> Result<Reply, ExchangeError>;
    fn drive(&mut self, drive: &Drive) -> Result<(), ExchangeError>;
    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError>;
    fn interruption(&mut self) -> Option<Interruption>;
    fn progress(&mut self, fraction: Option<f32>, text: &str);
    fn sample(&mut self, sample: Sample);
    fn set_polling(&mut self, on: bool);
    fn address(&self) -> UnitAddress;
    fn generation(&self) -> FirmwareGeneration;
    fn facts(&self) -> Facts;
    fn is_simulated(&self) -> bool;
    fn now(&self) -> Duration;
    fn port(&self) -> String;
    fn set_address(&mut self, address: UnitAddress) -> bool;
    fn hidden_settings(&self) -> Option<&dyn HiddenSettings>;
    fn byte_time(&self) -> Option<Duration>;
}

/// The device thread, as a job sees it. Use it as a [`Wire`].
pub struct JobContext<'a> {
    host: &'a mut dyn JobHost,
}

impl<'a> JobContext<'a> {
    pub(super) fn new(host: &'a mut dyn JobHost) -> Self {
        Self { host }
    }

    /// Tells how far the job is: 0 to 1 where it knows, and what it does at the moment.
    pub fn progress(&mut self, fraction: Option<f32>, text: &str) {
        self.host.progress(fraction, text);
    }

    /// Why the job should end now, if it should. Asked between exchanges by work that computes for long.
    /// Motors are stopped here too, before the job hears of it.
    pub fn interruption(&mut self) -> Option<Interruption> {
        self.host.interruption()
    }

    /// As [`Wire::transact`], with the host times of the exchange: for experiments.
    pub fn transact_timed(&mut self, command: u8, values: &[i64]) -> Result<Reply, ExchangeError> {
        self.host.transact(command, values.iter().map(|&value| Value::Int(value)).collect())
    }

    /// Moves motors, as [`Request::Drive`](super::Request::Drive) does. Refused unless something is armed; a job that uses it
    /// is made by [`Job::moving`](super::Job::moving). After an error nobody knows what the motors do, so the job
    /// should end.
    pub fn drive(&mut self, drive: &Drive) -> Result<(), ExchangeError> {
        self.host.drive(drive)
    }

    /// What the unit's family knows of it.
    #[must_use]
    pub fn facts(&self) -> Facts {
        self.host.facts()
    }

    /// How long a byte takes on the wire, where that is known.
    #[must_use]
    pub fn byte_time(&self) -> Option<Duration> {
        self.host.byte_time()
    }

    /// Shows the window a reading that the job made itself.
    pub fn sample(&mut self, sample: Sample) {
        self.host.sample(sample);
    }

    /// Whether the thread goes on reading signals between the job's exchanges, as it does at first. An experiment that
    /// needs even spacing, or a save that restarts the unit, switches it off.
    pub fn set_polling(&mut self, on: bool) {
        self.host.set_polling(on);
    }
}

impl Wire for JobContext<'_> {
    fn transact_values(&mut self, command: u8, values: Vec<Value>) -> Result<Values, ExchangeError> {
        self.host.transact(command, values).map(|reply| reply.values)
    }

    fn address(&self) -> UnitAddress {
        self.host.address()
    }

    fn generation(&self) -> FirmwareGeneration {
        self.host.generation()
    }

    fn is_simulated(&self) -> bool {
        self.host.is_simulated()
    }

    fn now(&self) -> Duration {
        self.host.now()
    }

    fn sleep(&mut self, time: Duration) -> Result<(), ExchangeError> {
        self.host.sleep(time)
    }

    fn port(&self) -> String {
        self.host.port()
    }

    fn set_address(&mut self, address: UnitAddress) -> bool {
        self.host.set_address(address)
    }

    fn hidden_settings(&self) -> Option<&dyn HiddenSettings> {
        self.host.hidden_settings()
    }

    fn report_progress(&mut self, done: usize, of: usize, what: &str) {
        let fraction = if of == 0 { None } else { Some(done as f32 / of as f32) };
        self.host.progress(fraction, what);
    }

    fn set_quiet(&mut self, quiet: bool) {
        self.host.set_polling(!quiet);
    }
}

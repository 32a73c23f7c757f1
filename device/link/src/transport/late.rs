//! A line of which the user says how late its replies may be.

use super::byte_stream::{Transport, TransportError};
use std::time::Duration;

/// A transport with another latency than its kind has.
pub struct Late {
    inner: Box<dyn Transport>,
    latency: Duration,
}

impl Late {
    /// The same line with this latency.
    pub fn new(inner: Box<dyn Transport>, latency: Duration) -> Self {
        Self { inner, latency }
    }
}

impl Transport for Late {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.inner.write(bytes)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.inner.read(buffer, timeout)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.inner.discard_input()
    }

    fn describe(&self) -> String {
        self.inner.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.inner.byte_time()
    }

    fn set_baud(&mut self, baud: u32) -> Result<bool, TransportError> {
        self.inner.set_baud(baud)
    }

    fn latency(&self) -> Duration {
        self.latency
    }

    fn second_way(&self) -> std::io::Result<super::SecondWay> {
        self.inner.second_way()
    }
}

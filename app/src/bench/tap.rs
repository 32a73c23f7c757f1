//! A transport that notes what passes: each write with its time, and how many bytes came back before the next.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use brushwork_link::{Transport, TransportError};

/// One write and what answered it.
#[derive(Clone, Debug)]
pub struct Noted {
    /// When the write began.
    pub begun_at: Instant,
    /// When the system had taken all its bytes.
    pub written_at: Instant,
    /// The bytes.
    pub request: Vec<u8>,
    /// How many bytes were read before the next write.
    pub reply_bytes: usize,
    /// When the last of them were read.
    pub replied_at: Option<Instant>,
}

/// What has passed. Clones are the same.
#[derive(Clone, Debug, Default)]
pub struct Log(Arc<Mutex<Vec<Noted>>>);

impl Log {
    /// Forgets everything.
    pub fn clear(&self) {
        self.lock().clear();
    }

    /// Everything so far.
    pub fn all(&self) -> Vec<Noted> {
        self.lock().clone()
    }

    /// How many writes there were.
    pub fn writes(&self) -> usize {
        self.lock().len()
    }

    /// The first write, counted from `from`, that `wanted` says yes to.
    pub fn find(&self, from: usize, wanted: impl Fn(&Noted) -> bool) -> Option<(usize, Noted)> {
        let log = self.lock();
        let found = log.iter().enumerate().skip(from).find(|(_, noted)| wanted(noted));
        found.map(|(index, noted)| (index, noted.clone()))
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Noted>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The transport underneath with its log.
pub struct Tap {
    inner: Box<dyn Transport>,
    log: Log,
}

impl Tap {
    /// Taps `inner`.
    pub fn new(inner: Box<dyn Transport>, log: Log) -> Self {
        Self { inner, log }
    }
}

impl Transport for Tap {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let begun_at = Instant::now();
        self.inner.write(bytes)?;
        let written_at = Instant::now();
        let request = bytes.to_vec();
        self.log.lock().push(Noted { begun_at, written_at, request, reply_bytes: 0, replied_at: None });
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let count = self.inner.read(buffer, timeout)?;
        if count > 0
            && let Some(noted) = self.log.lock().last_mut()
        {
            noted.reply_bytes += count;
            noted.replied_at = Some(Instant::now());
        }
        Ok(count)
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

    fn latency(&self) -> Duration {
        self.inner.latency()
    }
}

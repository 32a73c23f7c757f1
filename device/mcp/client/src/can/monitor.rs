//! Listening to the bus on the way: boot-ups, heartbeats and emergencies in what a transport reads, and this program's own heartbeat
//! and commands.

use crate::can::master::{MASTER, MASTER_LIMIT};
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::bus::Monitor;
use brushwork_canopen::nmt::State;
use brushwork_link::clock::Clock;
use brushwork_link::transport::{Transport, TransportError};
use std::sync::Arc;
use std::time::Duration;

/// How often this program's heartbeat goes out while a node watches it.
const BEAT: Duration = Duration::from_millis(100);
/// A transport whose traffic is listened to.
pub struct BusTransport {
    inner: Box<dyn Transport>,
    clock: Arc<dyn Clock>,
    decoder: Decoder,
    form: Form,
    monitor: Monitor,
}

impl BusTransport {
    /// Listens to what `inner` reads, and sends this program's heartbeat over it when `monitor` is told to.
    #[must_use]
    pub fn new(inner: Box<dyn Transport>, clock: Arc<dyn Clock>, form: Form, monitor: Monitor) -> Self {
        Self { inner, clock, decoder: Decoder::new(form), form, monitor }
    }

    fn listen(&mut self, bytes: &[u8]) {
        let now = self.clock.now();
        self.monitor.listened(now);
        for byte in bytes {
            if let Some(frame) = self.decoder.feed(*byte) {
                self.monitor.hear(&frame, now);
            }
        }
    }

    /// Sends what this program has to say as the bus's master.
    fn speak(&mut self) -> Result<(), TransportError> {
        for frame in self.monitor.take_commands() {
            if let Some(bytes) = self.form.encode(&frame) {
                self.inner.write(&bytes)?;
            }
        }
        if !self.monitor.is_beat_due(self.clock.now(), BEAT) {
            return Ok(());
        }
        match self.form.encode(&State::Operational.heartbeat(MASTER)) {
            Some(bytes) => self.inner.write(&bytes),
            None => Ok(()),
        }
    }
}

impl Transport for BusTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        // What is to be written goes first: it may be a stop.
        self.inner.write(bytes)?;
        self.speak()
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.speak()?;
        let count = self.inner.read(buffer, timeout)?;
        self.listen(&buffer[..count]);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let mut buffer = [0; 512];
        let mut discarded = 0;
        loop {
            let count = self.inner.read(&mut buffer, Duration::ZERO)?;
            if count == 0 || discarded > 65_536 {
                return Ok(discarded + count);
            }
            self.listen(&buffer[..count]);
            discarded += count;
        }
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

/// The heartbeat is sent often enough for the nodes that watch it.
const _: () = assert!(BEAT.as_millis() * 3 < MASTER_LIMIT.as_millis());

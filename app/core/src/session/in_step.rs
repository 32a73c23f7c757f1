//! Line and clock of a client whose simulated machine runs in this program: a busy computer holds up both or neither.

use std::sync::Arc;
use std::time::Duration;

use brushwork_link::Clock;
use brushwork_link::transport::{ChannelTransport, Transport, TransportError};
use brushwork_plant::server::{ClientTime, SharedTime};

/// A line and the clock that goes with it.
pub type InStep = (Box<dyn Transport>, Arc<dyn Clock>);

/// A line to the machine that takes part in its time, and the clock that goes with it. The clock shows `from` now.
pub fn pair(inner: ChannelTransport, time: &SharedTime, from: Duration) -> InStep {
    let time = time.join();
    let clock = InStepClock { from, since: time.now(), time: time.clone() };
    (Box::new(InStepTransport { inner, time }), Arc::new(clock))
}

/// The line.
struct InStepTransport {
    inner: ChannelTransport,
    time: ClientTime,
}

impl Transport for InStepTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        // Told first: the machine may have answered before this thread goes on.
        self.time.wrote();
        self.inner.write(bytes)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.time.listens(timeout);
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

    fn latency(&self) -> Duration {
        self.inner.latency()
    }
}

impl Drop for InStepTransport {
    fn drop(&mut self) {
        self.time.leave();
    }
}

/// The clock.
struct InStepClock {
    from: Duration,
    since: Duration,
    time: ClientTime,
}

impl Clock for InStepClock {
    fn now(&self) -> Duration {
        self.from + self.time.now().saturating_sub(self.since)
    }

    fn sleep(&self, time: Duration) {
        self.time.sleep(time);
    }

    fn rest_until(&self, until: Duration) {
        self.time.rests_until(self.since + until.saturating_sub(self.from));
    }
}

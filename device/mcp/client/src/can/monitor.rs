//! Listening to the bus on the way: boot-ups, heartbeats and emergencies in what a transport reads, and this program's own heartbeat.

use crate::can::master::{MASTER, MASTER_LIMIT};
use brushwork_canopen::adapter::{Decoder, Form};
use brushwork_canopen::nmt::State;
use brushwork_canopen::{Emergency, Frame, NodeId};
use brushwork_link::clock::Clock;
use brushwork_link::transport::{Transport, TransportError};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often this program's heartbeat goes out while a node watches it.
const BEAT: Duration = Duration::from_millis(100);
/// A node whose heartbeat stays away for this many of its intervals is lost.
const MISSED_BEATS: u32 = 3;

/// What has been heard of the nodes. Clones are the same.
#[derive(Clone, Default)]
pub struct Monitor(Arc<Mutex<Heard>>);

#[derive(Default)]
struct Heard {
    nodes: BTreeMap<NodeId, Sight>,
    emergencies: Vec<Emergency>,
    /// Whether this program's heartbeat is to be sent.
    beats: bool,
    beaten_at: Option<Duration>,
}

#[derive(Clone, Copy, Default)]
struct Sight {
    state: Option<State>,
    last_beat_at: Option<Duration>,
    interval: Option<Duration>,
    boots: u32,
    booted_at: Option<Duration>,
}

impl Monitor {
    /// Sends this program's heartbeat from now on, or no more.
    pub fn beat(&self, on: bool) {
        let mut heard = self.lock();
        heard.beats = on;
        heard.beaten_at = None;
    }

    /// Whether this program's heartbeat is being sent.
    #[must_use]
    pub fn is_beating(&self) -> bool {
        self.lock().beats
    }

    /// The nodes whose boot-up or heartbeat was heard.
    #[must_use]
    pub fn nodes(&self) -> Vec<NodeId> {
        self.lock().nodes.keys().copied().collect()
    }

    /// The state that a node last told.
    #[must_use]
    pub fn state(&self, node: NodeId) -> Option<State> {
        self.lock().nodes.get(&node)?.state
    }

    /// How often a node was heard to start, and when it last did.
    #[must_use]
    pub fn boots(&self, node: NodeId) -> (u32, Option<Duration>) {
        self.lock().nodes.get(&node).map_or((0, None), |sight| (sight.boots, sight.booted_at))
    }

    /// How long a node's heartbeat has been away, if that is too long: it has told its interval before, and the line was read up
    /// to `now`.
    #[must_use]
    pub fn lost_for(&self, node: NodeId, now: Duration) -> Option<Duration> {
        let sight = *self.lock().nodes.get(&node)?;
        let away = now.saturating_sub(sight.last_beat_at?);
        (away > sight.interval? * MISSED_BEATS).then_some(away)
    }

    /// The emergencies that a node has told since the last call.
    pub fn take_emergencies(&self, node: NodeId) -> Vec<Emergency> {
        let mut heard = self.lock();
        let (mine, others) = heard.emergencies.drain(..).partition(|emergency| emergency.node == node);
        heard.emergencies = others;
        mine
    }

    fn hear(&self, frame: &Frame, now: Duration) {
        /// Emergencies that are kept for somebody to take.
        const KEPT: usize = 64;
        let mut heard = self.lock();
        if let Some(emergency) = Emergency::read(frame) {
            if heard.emergencies.len() < KEPT {
                heard.emergencies.push(emergency);
            }
        } else if let Some((node, state)) = State::read(frame) {
            heard.nodes.entry(node).or_default().hear(state, now);
        }
    }

    /// Whether the heartbeat is due; takes note that it goes out.
    fn is_due(&self, now: Duration) -> bool {
        let mut heard = self.lock();
        let due = heard.beats && heard.beaten_at.is_none_or(|at| now >= at + BEAT);
        if due {
            heard.beaten_at = Some(now);
        }
        due
    }

    fn lock(&self) -> MutexGuard<'_, Heard> {
        // Whoever panicked with the lock left whole entries behind.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sight {
    fn hear(&mut self, state: State, now: Duration) {
        self.state = Some(state);
        if state == State::BootUp {
            *self =
                Self { boots: self.boots + 1, booted_at: Some(now), state: Some(state), ..Self::default() };
            return;
        }
        if let Some(last) = self.last_beat_at {
            let between = now.saturating_sub(last);
            // Bytes that waited in a buffer come close together and tell nothing of the interval.
            self.interval = Some(self.interval.unwrap_or_default().max(between));
        }
        self.last_beat_at = Some(now);
    }
}

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
        for byte in bytes {
            if let Some(frame) = self.decoder.feed(*byte) {
                self.monitor.hear(&frame, now);
            }
        }
    }

    fn beat_if_due(&mut self) -> Result<(), TransportError> {
        if !self.monitor.is_due(self.clock.now()) {
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
        self.beat_if_due()
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.beat_if_due()?;
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

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_heartbeat_that_stays_away_for_three_intervals_is_lost() {
        let (monitor, node) = (Monitor::default(), NodeId::new(3).unwrap());
        let beat = State::Operational.heartbeat(node);
        monitor.hear(&beat, ms(0));
        assert_eq!(monitor.lost_for(node, ms(60_000)), None, "one beat tells no interval");
        monitor.hear(&beat, ms(1000));
        assert_eq!(monitor.lost_for(node, ms(4000)), None);
        assert_eq!(monitor.lost_for(node, ms(4001)), Some(ms(3001)));
    }

    #[test]
    fn a_boot_up_is_counted_and_begins_anew() {
        let (monitor, node) = (Monitor::default(), NodeId::new(3).unwrap());
        monitor.hear(&State::Operational.heartbeat(node), ms(0));
        monitor.hear(&State::Operational.heartbeat(node), ms(100));
        monitor.hear(&State::BootUp.heartbeat(node), ms(200));
        assert_eq!(monitor.boots(node), (1, Some(ms(200))));
        assert_eq!(
            monitor.lost_for(node, ms(9000)),
            None,
            "a node that starts has not told its interval yet"
        );
        assert_eq!((monitor.nodes(), monitor.state(node)), (vec![node], Some(State::BootUp)));
    }
}

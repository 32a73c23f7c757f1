//! A simulated machine whose bridge is watched: when each byte came to it, and when its motors were off.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};

/// How finely the bridge is looked at.
const LOOK_EVERY: Duration = Duration::from_micros(100);

/// What was seen, in the machine's own time. Clones are the same.
#[derive(Clone, Debug, Default)]
pub struct Bridge(Arc<Mutex<Seen>>);

#[derive(Debug, Default)]
struct Seen {
    heard: Vec<Duration>,
    duty: f64,
    off_at: Option<Duration>,
}

impl Bridge {
    /// The highest duty of the motors now, 0 to 1.
    pub fn duty(&self) -> f64 {
        self.lock().duty
    }

    /// When a byte that was sent to the machine had come whole, counted from 0; none if it has not come.
    pub fn heard_at(&self, index: usize) -> Option<Duration> {
        self.lock().heard.get(index).copied()
    }

    /// When the motors were off for the first time since this was asked last; none while they run.
    pub fn take_off_at(&self) -> Option<Duration> {
        self.lock().off_at.take()
    }

    fn lock(&self) -> MutexGuard<'_, Seen> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The machine, and what sees it.
pub struct Watched {
    machine: Box<dyn Machine>,
    bridge: Bridge,
}

impl Watched {
    /// Watches the first unit of a machine.
    pub fn new(machine: Box<dyn Machine>, bridge: Bridge) -> Self {
        Self { machine, bridge }
    }

    fn look(&self) {
        let duty =
            self.machine.views().first().map_or(0.0, |unit| {
                unit.axes.iter().map(|axis| axis.output.duty().abs()).fold(0.0, f64::max)
            });
        let mut seen = self.bridge.lock();
        if seen.duty > 0.0 && duty == 0.0 {
            seen.off_at = Some(self.machine.now());
        }
        seen.duty = duty;
    }
}

impl Machine for Watched {
    fn now(&self) -> Duration {
        self.machine.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        let now = self.machine.now();
        self.bridge.lock().heard.extend(bytes.iter().map(|_| now));
        self.machine.receive(stream, bytes);
        self.look();
    }

    fn advance(&mut self, to: Duration) {
        while self.machine.now() < to {
            self.machine.advance((self.machine.now() + LOOK_EVERY).min(to));
            self.look();
        }
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.machine.next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.machine.take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.machine.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.machine.units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.machine.apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.machine.views()
    }

    fn plugged(&self) -> bool {
        self.machine.plugged()
    }

    fn silence(&self) -> Duration {
        self.machine.silence()
    }
}

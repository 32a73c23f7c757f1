//! How fast a machine runs in virtual time.

use crate::machine::Machine;
use std::time::{Duration, Instant};

/// A measured speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualSpeed {
    /// Simulated time that passed.
    pub simulated: Duration,
    /// Time that it took.
    pub took: Duration,
}

impl VirtualSpeed {
    /// Simulated seconds per second.
    pub fn times_real_time(&self) -> f64 {
        self.simulated.as_secs_f64() / self.took.as_secs_f64().max(1e-9)
    }
}

/// Runs a machine for `simulated` of its own time as fast as it goes on one core. `each` is called every `every` of simulated
/// time, first at the start, to send it requests and take its replies; its time counts.
pub fn measure_speed<M: Machine>(
    machine: &mut M,
    simulated: Duration,
    every: Duration,
    mut each: impl FnMut(&mut M),
) -> VirtualSpeed {
    let (begin, started) = (machine.now(), Instant::now());
    let every = every.max(Duration::from_micros(1));
    let mut passed = Duration::ZERO;
    while passed < simulated {
        each(machine);
        passed = (passed + every).min(simulated);
        machine.advance(begin + passed);
    }
    VirtualSpeed { simulated, took: started.elapsed() }
}

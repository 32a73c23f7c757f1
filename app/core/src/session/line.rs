//! The simulated machines of one line, of whichever family: what the server in this program drives.

use std::any::Any;
use std::time::Duration;

use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};

/// One or more simulated units on one wire.
pub struct SimulatedLine(Box<dyn Machine>);

impl SimulatedLine {
    /// Any machine.
    #[must_use]
    pub fn new(machine: Box<dyn Machine>) -> Self {
        Self(machine)
    }

    /// The machine as what it is, for those who know; `None` where another is.
    pub fn get<M: Machine>(&mut self) -> Option<&mut M> {
        let machine: &mut dyn Any = &mut *self.0;
        machine.downcast_mut()
    }

    /// Whatever it is.
    pub fn machine_mut(&mut self) -> &mut dyn Machine {
        &mut *self.0
    }
}

impl Machine for SimulatedLine {
    fn now(&self) -> Duration {
        self.0.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.0.receive(stream, bytes);
    }

    fn advance(&mut self, to: Duration) {
        self.0.advance(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.0.next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.0.take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.0.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.0.units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.0.apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.0.views()
    }

    fn plugged(&self) -> bool {
        self.0.plugged()
    }

    fn silence(&self) -> Duration {
        self.0.silence()
    }

    fn wants_real_time(&self) -> bool {
        self.0.wants_real_time()
    }
}

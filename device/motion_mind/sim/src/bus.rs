//! Several units on one wire.

use super::unit::MotionMind;
use brushwork_motion_mind_wire::BYTE_GAP;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use std::time::Duration;

/// Units that share a wire: each hears everything, each answers to its own address. Time is common.
#[derive(Clone, Debug)]
pub struct MotionMindBus {
    units: Vec<MotionMind>,
    /// The stream that stands for the wire: the one that was last written to.
    wire: StreamIndex,
}

impl MotionMindBus {
    /// One unit or more; none makes a wire on which nobody answers.
    pub fn new(units: Vec<MotionMind>) -> Self {
        Self { units, wire: StreamIndex::Usb }
    }

    /// The units.
    pub fn motion_minds(&self) -> &[MotionMind] {
        &self.units
    }

    /// Sends bytes now and gives back what has come within `timeout`, as soon as the first reply is there: a client that waits.
    pub fn exchange(&mut self, bytes: &[u8], timeout: Duration) -> Vec<u8> {
        let deadline = self.now() + timeout;
        self.receive(StreamIndex::Usb, bytes);
        match self.next_output_at() {
            Some(at) if at <= deadline => {
                self.advance(at);
                self.take_output(StreamIndex::Usb).unwrap_or_default()
            }
            _ => {
                self.advance(deadline);
                Vec::new()
            }
        }
    }
}

/// A unit has one wire, whatever the stream is called that it is driven by.
impl Machine for MotionMindBus {
    fn now(&self) -> Duration {
        self.units.first().map_or(Duration::ZERO, MotionMind::now)
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.wire = stream;
        self.units.iter_mut().for_each(|unit| unit.receive(bytes));
    }

    fn advance(&mut self, to: Duration) {
        self.units.iter_mut().for_each(|unit| unit.advance(to));
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.units.iter().filter_map(MotionMind::next_output_at).min()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        if stream != self.wire {
            return None;
        }
        self.units.iter_mut().find_map(MotionMind::take_output)
    }

    fn bits_per_second(&self, _: StreamIndex) -> u32 {
        self.units.first().map_or(0, MotionMind::bits_per_second)
    }

    fn units(&self) -> usize {
        self.units.len()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        if let Some(unit) = self.units.get_mut(unit) {
            unit.apply(action);
        }
    }

    fn views(&self) -> Vec<WorldView> {
        self.units.iter().map(MotionMind::view).collect()
    }

    fn plugged(&self) -> bool {
        self.units.iter().any(MotionMind::plugged)
    }

    fn silence(&self) -> Duration {
        BYTE_GAP
    }
}

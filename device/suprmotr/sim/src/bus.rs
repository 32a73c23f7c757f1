//! Several boards on one wire.

use super::unit::SuprMotr;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use std::collections::VecDeque;
use std::time::Duration;

/// Boards that share a wire: each hears everything, those that are selected answer. Time is common.
///
/// What two of them say from the same moment on collides. Assumed: a 0 of any of them is a 0 on the wire, so that the bytes are ANDed; what the
/// longer one says behind the end of the shorter comes through.
#[derive(Clone, Debug)]
pub struct SuprMotrBus {
    units: Vec<SuprMotr>,
    said: VecDeque<(Duration, Vec<u8>)>,
    /// The stream that stands for the wire: the one that was last written to.
    wire: StreamIndex,
}

impl SuprMotrBus {
    /// One board or more; none makes a wire on which nobody answers.
    pub fn new(units: Vec<SuprMotr>) -> Self {
        Self { units, said: VecDeque::new(), wire: StreamIndex::Usb }
    }

    /// The boards.
    pub fn suprmotrs(&self) -> &[SuprMotr] {
        &self.units
    }

    /// Sends bytes now and gives back all that comes within a time.
    pub fn exchange(&mut self, bytes: &[u8], time: Duration) -> Vec<u8> {
        let until = self.now() + time;
        self.receive(StreamIndex::Usb, bytes);
        self.advance(until);
        std::iter::from_fn(|| self.take_output(StreamIndex::Usb)).flatten().collect()
    }

    /// Lets what the boards say meet on the wire.
    fn collect(&mut self) {
        let mut said: Vec<(Duration, Vec<u8>)> = Vec::new();
        for unit in &mut self.units {
            said.extend(std::iter::from_fn(|| unit.take_output()));
        }
        // What began first is heard first; the sort keeps the order of what one board said.
        said.sort_by_key(|(at, _)| *at);
        for (at, bytes) in said {
            match self.said.back_mut() {
                Some((began, together)) if *began == at => collide(together, &bytes),
                Some(_) | None => self.said.push_back((at, bytes)),
            }
        }
    }
}

fn collide(together: &mut Vec<u8>, bytes: &[u8]) {
    let common = together.len().min(bytes.len());
    together.iter_mut().zip(bytes).for_each(|(one, other)| *one &= other);
    together.extend_from_slice(&bytes[common..]);
}

/// A board has one wire, whatever the stream is called that it is driven by.
impl Machine for SuprMotrBus {
    fn now(&self) -> Duration {
        self.units.first().map_or(Duration::ZERO, SuprMotr::now)
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.wire = stream;
        self.units.iter_mut().for_each(|unit| unit.receive(bytes));
        self.collect();
    }

    fn advance(&mut self, to: Duration) {
        self.units.iter_mut().for_each(|unit| unit.advance(to));
        self.collect();
    }

    fn next_output_at(&self) -> Option<Duration> {
        let waiting = self.said.front().map(|(at, _)| *at);
        waiting.or_else(|| self.units.iter().filter_map(SuprMotr::next_output_at).min())
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        if stream != self.wire {
            return None;
        }
        self.said.pop_front().map(|(_, bytes)| bytes)
    }

    fn bits_per_second(&self, _: StreamIndex) -> u32 {
        self.units.first().map_or(0, SuprMotr::bits_per_second)
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
        self.units.iter().map(SuprMotr::view).collect()
    }

    fn plugged(&self) -> bool {
        self.units.iter().any(SuprMotr::plugged)
    }
}

//! Several controllers on one wire.

use super::Controller;
use super::canbus::{CanBus, OtherNode};
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use std::time::Duration;

/// Controllers that share the wire of one stream: each hears everything, each answers to its own address.
///
/// Time is common. Two units with one address both answer, one after the other. Assumed: the wire works whether or not the units
/// are in multi-unit mode, which real ones must be (MCP manual 2.2.11).
#[derive(Clone, Debug)]
pub struct Bus {
    units: Vec<Controller>,
    stream: StreamIndex,
    /// The CAN bus with its adapter, where the wire is one.
    can: Option<CanBus>,
}

/// Why controllers cannot be put on one wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BusError {
    /// A wire without a controller.
    #[error("a bus needs at least one controller")]
    Empty,
    /// USB and RS-232 connect two ends.
    #[error("{} connects one controller only: put several on ttl1, ttl2 or ttl3", .0.key())]
    NotABus(StreamIndex),
}

impl Bus {
    /// One controller on a stream.
    pub fn single(unit: Controller, stream: StreamIndex) -> Self {
        Self { units: vec![unit], stream, can: None }
    }

    /// Controllers on one wire.
    ///
    /// # Errors
    /// If there is none, or several on a stream that connects two ends only.
    pub fn new(units: Vec<Controller>, stream: StreamIndex) -> Result<Self, BusError> {
        match units.len() {
            0 => Err(BusError::Empty),
            1 => Ok(Self { units, stream, can: None }),
            _ if matches!(stream, StreamIndex::Usb | StreamIndex::Uart0) => Err(BusError::NotABus(stream)),
            _ => Ok(Self { units, stream, can: None }),
        }
    }

    /// Controllers on a CAN bus, reached through an adapter on a serial port. Each is the node of its settings.
    ///
    /// # Errors
    /// If there is none.
    pub fn on_can(units: Vec<Controller>, form: Form) -> Result<Self, BusError> {
        if units.is_empty() {
            return Err(BusError::Empty);
        }
        let mut can = CanBus::new(form, units.len());
        let mut units = units;
        can.run(&mut units, Duration::ZERO);
        Ok(Self { units, stream: StreamIndex::Usb, can: Some(can) })
    }

    /// Sets how often a node sends its heartbeat, 0 for never, as a write to its object 0x1017 would; does nothing elsewhere.
    pub fn set_producer_heartbeat(&mut self, unit: usize, milliseconds: u16) {
        if let Some(can) = &mut self.can {
            can.set_producer_heartbeat(unit, milliseconds);
        }
    }

    /// Puts a node of another maker on the CAN bus; does nothing elsewhere.
    pub fn add_other_node(&mut self, node: NodeId) {
        if let Some(can) = &mut self.can {
            can.others.push(OtherNode::new(node));
        }
    }

    /// The nodes of other makers on the CAN bus.
    pub fn other_nodes(&self) -> &[OtherNode] {
        self.can.as_ref().map_or(&[], |can| &can.others)
    }

    /// The stream the wire is on.
    pub fn stream(&self) -> StreamIndex {
        self.stream
    }

    /// The units.
    pub fn controllers(&self) -> &[Controller] {
        &self.units
    }

    /// The units, to do something to them.
    pub fn controllers_mut(&mut self) -> &mut [Controller] {
        &mut self.units
    }

    /// Sends bytes now and gives back what has come within `timeout`, as soon as the first reply is there: a client that waits.
    pub fn exchange(&mut self, bytes: &[u8], timeout: Duration) -> Vec<u8> {
        let deadline = self.now() + timeout;
        self.receive(self.stream, bytes);
        match self.next_output_at() {
            Some(at) if at <= deadline => {
                self.advance(at);
                self.take_output(self.stream).unwrap_or_default()
            }
            _ => {
                self.advance(deadline);
                Vec::new()
            }
        }
    }
}

impl Bus {
    /// Moves time on without a look at what happens on the CAN bus on the way.
    fn advance_units(&mut self, to: Duration) {
        self.units.iter_mut().for_each(|unit| unit.advance(to));
        let now = self.now();
        if let Some(can) = &mut self.can {
            can.run(&mut self.units, now);
        }
    }
}

impl Machine for Bus {
    fn now(&self) -> Duration {
        self.units.first().map_or(Duration::ZERO, Controller::now)
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        let now = self.now();
        match &mut self.can {
            Some(can) => can.receive(bytes, &mut self.units, now),
            None => self.units.iter_mut().for_each(|unit| unit.receive(stream, bytes)),
        }
    }

    fn advance(&mut self, to: Duration) {
        while let Some(at) = self.can.as_ref().and_then(CanBus::next_event_at).filter(|at| *at < to) {
            self.advance_units(at.max(self.now()));
        }
        self.advance_units(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        match &self.can {
            Some(can) => [can.next_output_at(), can.next_event_at()].into_iter().flatten().min(),
            None => self.units.iter().filter_map(Controller::next_output_at).min(),
        }
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        let now = self.now();
        match &mut self.can {
            Some(can) => can.take_output(now),
            None => self.units.iter_mut().find_map(|unit| unit.take_output(stream)),
        }
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.units.first().map_or(0, |unit| unit.bits_per_second(stream))
    }

    fn units(&self) -> usize {
        self.units.len()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        if let Some(unit) = self.units.get_mut(unit) {
            // The trait has no word for a hidden setting that is not there; `Controller::apply` has.
            let _ = unit.apply(action);
        }
        let now = self.now();
        let plugged = self.plugged();
        if let Some(can) = &mut self.can {
            if !plugged {
                can.unplug();
            }
            can.run(&mut self.units, now);
        }
    }

    fn views(&self) -> Vec<WorldView> {
        self.units.iter().map(Controller::view).collect()
    }

    fn plugged(&self) -> bool {
        self.units.iter().any(|unit| unit.world().plugged())
    }

    fn wants_real_time(&self) -> bool {
        self.units.iter().any(Controller::has_something_to_see)
    }
}

//! A CAN bus with simulated nodes, behind an adapter on a serial port.
//!
//! [`CanBus`] takes and gives the adapter's bytes; each controller is a [`Node`](node::Node) with an object dictionary. Codecs are those of
//! `brushwork_mcp_wire::canopen`.
//!
//! Assumed: that a node speaks its heartbeat once a second, that it takes a consumer heartbeat and stops its motors when that is
//! lost, its device type, identity and answering time, and that a new node id or rate counts from the next start on. The manual
//! names nothing of all this.

mod dictionary;
mod node;
mod other;
mod rate;

use super::Controller;
use brushwork_canopen::Frame;
use brushwork_canopen::adapter::{Decoder, Form};
use node::Node;
pub use other::OtherNode;
use rate::on_the_bus;
use std::collections::VecDeque;
use std::time::Duration;

/// Time from a request to its answer beyond the frames' own. Assumed.
const ANSWER_TIME: Duration = Duration::from_micros(200);

/// The adapter and the nodes of the bus, one for each controller.
#[derive(Clone, Debug)]
pub(super) struct CanBus {
    form: Form,
    decoder: Decoder,
    nodes: Vec<Node>,
    /// Nodes of other makers.
    pub others: Vec<OtherNode>,
    outbox: VecDeque<(Duration, Vec<u8>)>,
}

impl CanBus {
    /// A bus for that many controllers.
    pub fn new(form: Form, units: usize) -> Self {
        Self {
            form,
            decoder: Decoder::new(form),
            nodes: (0..units).map(|_| Node::default()).collect(),
            others: Vec::new(),
            outbox: VecDeque::new(),
        }
    }

    /// Takes bytes from the host.
    pub fn receive(&mut self, bytes: &[u8], units: &mut [Controller], now: Duration) {
        for frame in self.decoder.feed_all(bytes) {
            // The host's frame takes its time on the bus before a node has it.
            let heard_at = now + on_the_bus(&frame);
            self.deliver(&frame, None, units, heard_at);
        }
        self.run(units, now);
    }

    /// When a node next does something by itself.
    pub fn next_event_at(&self) -> Option<Duration> {
        self.nodes.iter().filter_map(Node::next_event_at).min()
    }

    /// Lets nodes notice power and time.
    pub fn run(&mut self, units: &mut [Controller], now: Duration) {
        for index in 0..self.nodes.len() {
            let Some(unit) = units.get_mut(index) else { continue };
            let frames = self.nodes[index].run(unit, now);
            for frame in frames {
                self.send(&frame, now + on_the_bus(&frame));
                self.deliver(&frame, Some(index), units, now);
            }
        }
    }

    /// When the next bytes go to the host.
    pub fn next_output_at(&self) -> Option<Duration> {
        self.outbox.front().map(|(at, _)| *at)
    }

    /// The next bytes for the host, if they have left by now.
    pub fn take_output(&mut self, now: Duration) -> Option<Vec<u8>> {
        if self.next_output_at()? > now {
            return None;
        }
        self.outbox.pop_front().map(|(_, bytes)| bytes)
    }

    /// Sets how often a node sends its heartbeat.
    pub fn set_producer_heartbeat(&mut self, unit: usize, milliseconds: u16) {
        if let Some(node) = self.nodes.get_mut(unit) {
            node.set_producer_heartbeat(milliseconds);
        }
    }

    /// The host's cable is out.
    pub fn unplug(&mut self) {
        self.decoder.reset();
        self.outbox.clear();
    }

    /// Gives a frame to every node but its sender.
    fn deliver(&mut self, frame: &Frame, from: Option<usize>, units: &mut [Controller], at: Duration) {
        let answers: Vec<Frame> = self.others.iter_mut().filter_map(|other| other.take(frame)).collect();
        for answer in answers {
            self.send(&answer, at + ANSWER_TIME + on_the_bus(&answer));
        }
        for index in 0..self.nodes.len() {
            let Some(unit) = units.get_mut(index).filter(|_| Some(index) != from) else { continue };
            if let Some(answer) = self.nodes[index].take(frame, unit, at) {
                self.send(&answer, at + ANSWER_TIME + on_the_bus(&answer));
            }
        }
    }

    fn send(&mut self, frame: &Frame, at: Duration) {
        let Some(bytes) = self.form.encode(frame) else { return };
        let at = self.outbox.back().map_or(at, |(last, _)| at.max(*last));
        self.outbox.push_back((at, bytes));
    }
}

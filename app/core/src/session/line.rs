//! The simulated machines of one line, of whichever family: what the server in this program drives.

use std::time::Duration;

use brushwork_mcp_sim::controller::Bus;
use brushwork_motion_mind_sim::MotionMindBus;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};

/// One or more simulated units on one wire.
pub enum SimulatedLine {
    /// MCP and RoboClaw.
    Packets(Box<Bus>),
    /// Motion Minds.
    MotionMinds(Box<MotionMindBus>),
}

impl SimulatedLine {
    /// The units of packet serial; `None` where others are.
    pub fn packets(&self) -> Option<&Bus> {
        match self {
            Self::Packets(bus) => Some(bus),
            Self::MotionMinds(_) => None,
        }
    }

    /// The same, to do something to them.
    pub fn packets_mut(&mut self) -> Option<&mut Bus> {
        match self {
            Self::Packets(bus) => Some(bus),
            Self::MotionMinds(_) => None,
        }
    }

    /// The Motion Minds; `None` where others are.
    pub fn motion_minds(&self) -> Option<&MotionMindBus> {
        match self {
            Self::Packets(_) => None,
            Self::MotionMinds(bus) => Some(bus),
        }
    }

    fn machine(&self) -> &dyn Machine {
        match self {
            Self::Packets(bus) => bus.as_ref(),
            Self::MotionMinds(bus) => bus.as_ref(),
        }
    }

    fn machine_mut(&mut self) -> &mut dyn Machine {
        match self {
            Self::Packets(bus) => bus.as_mut(),
            Self::MotionMinds(bus) => bus.as_mut(),
        }
    }
}

impl Machine for SimulatedLine {
    fn now(&self) -> Duration {
        self.machine().now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.machine_mut().receive(stream, bytes);
    }

    fn advance(&mut self, to: Duration) {
        self.machine_mut().advance(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.machine().next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.machine_mut().take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.machine().bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.machine().units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.machine_mut().apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.machine().views()
    }

    fn plugged(&self) -> bool {
        self.machine().plugged()
    }

    fn silence(&self) -> Duration {
        self.machine().silence()
    }

    fn wants_real_time(&self) -> bool {
        self.machine().wants_real_time()
    }
}

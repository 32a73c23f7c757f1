//! Network management: commands of the master, states and heartbeats of the nodes (CiA 301).

use super::{CanId, Frame, Function, NodeId};
use serde::Serialize;
use std::fmt;

/// What the master tells one node or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Become operational.
    Start,
    /// Stop all communication but network management.
    Stop,
    /// Become pre-operational.
    EnterPreOperational,
    /// Restart the whole node.
    ResetNode,
    /// Restart its communication.
    ResetCommunication,
}

/// A node's state, as its heartbeat says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It has just started.
    BootUp,
    /// Objects can be accessed, process data are off.
    PreOperational,
    /// Everything works.
    Operational,
    /// Only network management works.
    Stopped,
}

/// How a node's objects say that it is watched and how often it speaks.
pub mod objects {
    /// Device type, u32.
    pub const DEVICE_TYPE: u16 = 0x1000;
    /// Error register, u8.
    pub const ERROR_REGISTER: u16 = 0x1001;
    /// The manufacturer's name of the device, a string.
    pub const DEVICE_NAME: u16 = 0x1008;
    /// Version of the software, a string.
    pub const SOFTWARE_VERSION: u16 = 0x100A;
    /// Whose heartbeat the node listens for: bits 16 to 22 the other node, low word the time in ms.
    pub const CONSUMER_HEARTBEAT: u16 = 0x1016;
    /// How often the node sends its heartbeat, u16 in ms, 0 for never.
    pub const PRODUCER_HEARTBEAT: u16 = 0x1017;
    /// Vendor, product, revision and serial number, u32 at subindexes 1 to 4.
    pub const IDENTITY: u16 = 0x1018;
}

impl Command {
    const ALL: [(Self, u8); 5] = [
        (Self::Start, 1),
        (Self::Stop, 2),
        (Self::EnterPreOperational, 128),
        (Self::ResetNode, 129),
        (Self::ResetCommunication, 130),
    ];

    /// The frame; no node means all of them.
    #[must_use]
    pub fn frame(self, node: Option<NodeId>) -> Frame {
        let number = Self::ALL.iter().find(|(command, _)| *command == self).map_or(0, |(_, number)| *number);
        let data = [number, node.map_or(0, NodeId::get), 0, 0, 0, 0, 0, 0];
        Frame::data(Function::Nmt.id(), &data[..2]).unwrap_or_else(|| Frame::full(Function::Nmt.id(), data))
    }

    /// Reads the master's frame: the command and whom it is for.
    #[must_use]
    pub fn read(frame: &Frame) -> Option<(Self, Option<NodeId>)> {
        let ([number, node], CanId::Standard(0)) = (frame.bytes(), frame.id()) else { return None };
        let (command, _) = Self::ALL.iter().find(|(_, known)| known == number)?;
        match node {
            0 => Some((*command, None)),
            node => Some((*command, Some(NodeId::new(*node)?))),
        }
    }
}

impl State {
    const ALL: [(Self, u8); 4] =
        [(Self::BootUp, 0), (Self::Stopped, 4), (Self::Operational, 5), (Self::PreOperational, 127)];

    /// The byte of the heartbeat.
    #[must_use]
    pub fn byte(self) -> u8 {
        Self::ALL.iter().find(|(state, _)| *state == self).map_or(0, |(_, byte)| *byte)
    }

    /// The state in a heartbeat's byte; bit 7 toggles in node guarding and is left out.
    #[must_use]
    pub fn of(byte: u8) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == byte & 0x7F).map(|(state, _)| *state)
    }

    /// The node's heartbeat.
    #[must_use]
    pub fn heartbeat(self, node: NodeId) -> Frame {
        let id = Function::Heartbeat(node).id();
        Frame::data(id, &[self.byte()]).unwrap_or_else(|| Frame::full(id, [0; 8]))
    }

    /// Reads a heartbeat: whose it is and what it says.
    #[must_use]
    pub fn read(frame: &Frame) -> Option<(NodeId, Self)> {
        match (Function::of(frame.id())?, frame.bytes()) {
            (Function::Heartbeat(node), [byte]) => Some((node, Self::of(*byte)?)),
            _ => None,
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BootUp => "boot-up",
            Self::PreOperational => "pre-operational",
            Self::Operational => "operational",
            Self::Stopped => "stopped",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THREE: Option<NodeId> = NodeId::new(3);

    #[test]
    fn commands_are_those_of_cia_301() {
        for (command, node, bytes) in [
            (Command::Start, THREE, [0x01, 0x03]),               // start, node 3
            (Command::Stop, None, [0x02, 0x00]),                 // stop, all
            (Command::EnterPreOperational, THREE, [0x80, 0x03]), // enter pre-operational, node 3
            (Command::ResetNode, THREE, [0x81, 0x03]),           // reset node, node 3
            (Command::ResetCommunication, None, [0x82, 0x00]),   // reset communication, all
        ] {
            let frame = command.frame(node);
            assert_eq!((frame.id(), frame.bytes()), (CanId::Standard(0), &bytes[..]));
            assert_eq!(Command::read(&frame), Some((command, node)));
        }
    }

    #[test]
    fn heartbeats_are_those_of_cia_301() {
        let three = NodeId::new(3).unwrap();
        for (state, byte) in [
            (State::BootUp, 0x00),
            (State::Stopped, 0x04),
            (State::Operational, 0x05),
            (State::PreOperational, 0x7F),
        ] {
            let frame = state.heartbeat(three);
            assert_eq!((frame.id(), frame.bytes()), (CanId::Standard(0x703), &[byte][..]));
            assert_eq!(State::read(&frame), Some((three, state)));
        }
        assert_eq!(State::of(0x85), Some(State::Operational), "a toggled bit 7 changes nothing");
        assert_eq!(State::of(1), None);
    }

    #[test]
    fn other_frames_are_no_commands_and_no_heartbeats() {
        let frame = |id: u16, bytes: &[u8]| Frame::data(CanId::Standard(id), bytes).unwrap();
        for frame in [frame(0, &[1]), frame(0, &[9, 1]), frame(0, &[1, 200]), frame(1, &[1, 1])] {
            assert_eq!(Command::read(&frame), None, "{frame:?}");
        }
        for frame in [frame(0x700, &[5]), frame(0x703, &[]), frame(0x703, &[1]), frame(0x703, &[5, 5])] {
            assert_eq!(State::read(&frame), None, "{frame:?}");
        }
    }
}

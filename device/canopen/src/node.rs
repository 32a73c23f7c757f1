//! Node ids and the identifiers that belong to them (CiA 301, predefined connection set).

use super::CanId;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A node's number on the bus, 1 to 127 (MCP manual 1.9.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct NodeId(u8);

impl NodeId {
    /// The node that an MCP is when it leaves the factory (MCP manual 1.9.4, the picture).
    pub const DEFAULT: Self = Self(1);
    /// The highest.
    pub const MAX: u8 = 127;

    /// A node id; `None` for 0 and above 127.
    #[must_use]
    pub const fn new(id: u8) -> Option<Self> {
        if id >= 1 && id <= Self::MAX { Some(Self(id)) } else { None }
    }

    /// Its number.
    #[must_use]
    pub const fn get(self) -> u8 {
        self.0
    }

    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        (1..=Self::MAX).map(Self)
    }
}

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node {}", self.0)
    }
}

impl TryFrom<u8> for NodeId {
    type Error = String;

    fn try_from(id: u8) -> Result<Self, String> {
        Self::new(id).ok_or_else(|| format!("{id} is no node id: use 1 to 127"))
    }
}

impl From<NodeId> for u8 {
    fn from(node: NodeId) -> Self {
        node.0
    }
}

/// What a frame of the predefined connection set is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// A command of the network's master to one node or to all.
    Nmt,
    /// Synchronisation.
    Sync,
    /// A node reports a fault.
    Emergency(NodeId),
    /// Time of day.
    Time,
    /// Process data, number 1 to 4, sent by the node.
    TransmitPdo(u8, NodeId),
    /// Process data, number 1 to 4, for the node.
    ReceivePdo(u8, NodeId),
    /// A node's answer to an access to its objects.
    SdoResponse(NodeId),
    /// An access to a node's objects.
    SdoRequest(NodeId),
    /// Boot-up and heartbeat.
    Heartbeat(NodeId),
}

impl Function {
    /// Its identifier. PDO numbers above 4 count as 4.
    #[must_use]
    pub fn id(self) -> CanId {
        let pdo = |base: u16, number: u8, node: NodeId| {
            base + 0x100 * u16::from(number.clamp(1, 4) - 1) + u16::from(node.0)
        };
        CanId::Standard(match self {
            Self::Nmt => 0x000,
            Self::Sync => 0x080,
            Self::Time => 0x100,
            Self::Emergency(node) => 0x080 + u16::from(node.0),
            Self::TransmitPdo(number, node) => pdo(0x180, number, node),
            Self::ReceivePdo(number, node) => pdo(0x200, number, node),
            Self::SdoResponse(node) => 0x580 + u16::from(node.0),
            Self::SdoRequest(node) => 0x600 + u16::from(node.0),
            Self::Heartbeat(node) => 0x700 + u16::from(node.0),
        })
    }

    /// What an identifier stands for; `None` if it belongs to nothing of the predefined set.
    #[must_use]
    pub fn of(id: CanId) -> Option<Self> {
        let CanId::Standard(id) = id else { return None };
        let node = || NodeId::new((id & 0x7F) as u8);
        Some(match id & 0x780 {
            0x000 if id == 0 => Self::Nmt,
            0x080 if id == 0x080 => Self::Sync,
            0x080 => Self::Emergency(node()?),
            0x100 if id == 0x100 => Self::Time,
            base @ (0x180 | 0x280 | 0x380 | 0x480) => Self::TransmitPdo((base >> 8) as u8, node()?),
            base @ (0x200 | 0x300 | 0x400 | 0x500) => Self::ReceivePdo((base >> 8) as u8 - 1, node()?),
            0x580 => Self::SdoResponse(node()?),
            0x600 => Self::SdoRequest(node()?),
            0x700 => Self::Heartbeat(node()?),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_those_of_the_predefined_connection_set() {
        let three = NodeId::new(3).unwrap();
        for (function, id) in [
            (Function::Nmt, 0x000),
            (Function::Sync, 0x080),
            (Function::Time, 0x100),
            (Function::Emergency(three), 0x083),
            (Function::TransmitPdo(1, three), 0x183),
            (Function::ReceivePdo(1, three), 0x203),
            (Function::TransmitPdo(4, three), 0x483),
            (Function::ReceivePdo(4, three), 0x503),
            (Function::SdoResponse(three), 0x583),
            (Function::SdoRequest(three), 0x603),
            (Function::Heartbeat(three), 0x703),
        ] {
            assert_eq!(function.id(), CanId::Standard(id));
            assert_eq!(Function::of(CanId::Standard(id)), Some(function));
        }
    }

    #[test]
    fn every_identifier_is_one_thing_or_none_and_comes_back() {
        for id in 0..=CanId::MAX_STANDARD {
            let id = CanId::Standard(id);
            if let Some(function) = Function::of(id) {
                assert_eq!(function.id(), id);
            }
        }
        assert_eq!(Function::of(CanId::Extended(0x601)), None);
        assert_eq!(Function::of(CanId::Standard(0x600)), None, "there is no node 0");
    }

    #[test]
    fn node_ids_are_1_to_127() {
        assert_eq!(NodeId::new(0), None);
        assert_eq!(NodeId::new(128), None);
        assert_eq!(NodeId::all().count(), 127);
    }
}

//! What is known of one unit beyond what all units have.

use crate::controller::channels::CHANNELS;
use crate::controller::indicators::status_row;
use crate::controller::{describe_sent, preview};
use brushwork_link::device::{Capabilities, Channel, Described, Drive, StatusPlace, StatusReport, UnitFacts};
use brushwork_mcp_wire::packet_serial::{Address, Generation};

/// The widths that a unit's packets have, and how it is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct McpFacts {
    /// The firmware's generation.
    pub generation: Generation,
    /// Whether it is an MCP rather than a RoboClaw.
    pub is_mcp: bool,
    /// Whether it is a node of a CAN bus.
    pub is_node: bool,
    /// Motors it drives, 1 or 2.
    pub motors: u8,
}

/// MCP and RoboClaw. What differs between those two, their models and generations tell.
const CAPABILITIES: Capabilities = Capabilities {
    motors: 2,
    duty: true,
    speed: true,
    position: true,
    ramps: true,
    queued_moves: true,
    scripts: true,
    estop: true,
    pins: true,
    batteries: true,
    serial_timeout: true,
    firmware_loader: true,
    reload: true,
    registers: false,
};

impl UnitFacts for McpFacts {
    fn capabilities(&self) -> Capabilities {
        Capabilities { motors: self.motors, ..CAPABILITIES }
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn status_row(&self, report: Option<&StatusReport>, homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        status_row(report, self.generation, self.is_mcp, homed)
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes, self.generation)
    }

    fn preview(&self, drive: &Drive, address: u8) -> Vec<Vec<u8>> {
        preview(drive, Address::new(address).unwrap_or_default(), self.generation)
    }

    fn place(&self, address: u8) -> String {
        if self.is_node { format!("node {address}") } else { format!("0x{address:02X}") }
    }

    fn named_place(&self, address: u8) -> String {
        if self.is_node { self.place(address) } else { format!("address {}", self.place(address)) }
    }

    fn is_node(&self) -> bool {
        self.is_node
    }
}

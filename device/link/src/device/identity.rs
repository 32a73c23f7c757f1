//! Who a unit is.

use brushwork_protocol::packet_serial::Generation;
use serde::Serialize;

/// The family's name of units on a CAN bus.
pub const CANOPEN: &str = "CANopen";

/// A unit that answered, and what was found out about it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Identity {
    /// Its address on the bus; on a CAN bus its node id.
    pub address: u8,
    /// Protocol family: "packet serial" or "CANopen".
    pub family: &'static str,
    /// Its version text as it came: "MCP266 2x60A v1.0.0".
    pub version_text: String,
    /// The model, "MCP266", where the text names one that is known.
    pub model: Option<&'static str>,
    /// The firmware version: "1.0.0"; empty if the text has none.
    pub firmware: String,
    /// The firmware's generation, which decides the widths of packets.
    pub generation: Generation,
    /// The other addresses it answers to, as over USB.
    pub also_answers: Vec<u8>,
    /// Whether it is simulated in this program.
    pub simulated: bool,
    /// The port as a person would name it.
    pub port: String,
    /// What was odd: signs of different generations, commands that it does not answer.
    pub notes: Vec<String>,
}

impl Identity {
    /// Whether it is an MCP rather than a RoboClaw.
    #[must_use]
    pub fn is_mcp(&self) -> bool {
        self.model.is_some_and(|model| model.starts_with("MCP"))
    }

    /// Whether it is a node of a CAN bus.
    #[must_use]
    pub fn is_node(&self) -> bool {
        self.family == CANOPEN
    }

    /// Where it is on its bus: "0x80", or "node 3".
    #[must_use]
    pub fn place(&self) -> String {
        if self.is_node() { format!("node {}", self.address) } else { format!("0x{:02X}", self.address) }
    }

    /// The same with its kind: "address 0x80", or "node 3".
    #[must_use]
    pub fn named_place(&self) -> String {
        if self.is_node() { self.place() } else { format!("address {}", self.place()) }
    }

    /// The model, or what the unit calls itself.
    #[must_use]
    pub fn title(&self) -> &str {
        self.model.unwrap_or(&self.version_text)
    }
}

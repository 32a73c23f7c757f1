//! Who a unit is.

use super::channel::Channel;
use super::described::Described;
use super::drive::Drive;
use super::mcp::channels::CHANNELS as MCP_CHANNELS;
use super::mcp::indicators::status_row as mcp_status_row;
use super::mcp::{describe_sent as describe_packets, preview as preview_packets};
use super::motion_mind::channels::CHANNELS as MOTION_MIND_CHANNELS;
use super::motion_mind::indicators::status_row as motion_mind_status_row;
use super::motion_mind::{
    MotionMindFacts, describe_sent as describe_commands, objection, preview as preview_command,
};
use super::status::{StatusPlace, StatusReport};
use crate::settings::Subject;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_mcp_wire::models;
use brushwork_motion_mind_wire::Mode;
use serde::Serialize;

/// The family's name of units on a CAN bus.
pub const CANOPEN: &str = "CANopen";
/// The family's name of Motion Minds.
pub const MOTION_MIND: &str = "Motion Mind";

/// What a unit has and takes. Screens and commands for what it lacks are not offered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Capabilities {
    /// Motors, 1 or 2.
    pub motors: u8,
    /// Takes duties now.
    pub duty: bool,
    /// Takes speeds now.
    pub speed: bool,
    /// Takes positions and distances now.
    pub position: bool,
    /// A drive says how fast its duty, speed or move may change; else settings of the controller do.
    pub ramps: bool,
    /// Moves can wait behind each other.
    pub queued_moves: bool,
    /// Runs scripts.
    pub scripts: bool,
    /// Has an emergency stop that software can reset.
    pub estop: bool,
    /// Has input pins, streams and outputs to be configured.
    pub pins: bool,
    /// Has batteries that it measures.
    pub batteries: bool,
    /// Stops its motors by itself after a silence on the serial line.
    pub serial_timeout: bool,
    /// Takes firmware over its serial line from this program.
    pub firmware_loader: bool,
    /// Can load EEPROM into RAM without a restart.
    pub reload: bool,
    /// Has registers with numbers, shown as such.
    pub registers: bool,
}

impl Capabilities {
    /// MCP and RoboClaw. What differs between those two, their models and generations tell.
    pub const PACKET_SERIAL: Self = Self {
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

    /// A Motion Mind in a mode that serial commands do not move.
    pub const MOTION_MIND: Self = Self {
        motors: 1,
        duty: false,
        speed: false,
        position: false,
        ramps: false,
        queued_moves: false,
        scripts: false,
        estop: false,
        pins: false,
        batteries: false,
        serial_timeout: false,
        firmware_loader: false,
        reload: false,
        registers: true,
    };
}

/// A unit that answered, and what was found out about it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Identity {
    /// Its address on the bus; on a CAN bus its node id.
    pub address: u8,
    /// Protocol family: "packet serial", "CANopen" or "Motion Mind".
    pub family: &'static str,
    /// Its version text as it came: "MCP266 2x60A v1.0.0".
    pub version_text: String,
    /// The model, "MCP266", where the text names one that is known.
    pub model: Option<&'static str>,
    /// The firmware version: "1.0.0"; empty if the text has none.
    pub firmware: String,
    /// The firmware's generation, which decides the widths of packets; the REVISION of a Motion Mind.
    pub generation: FirmwareGeneration,
    /// What the switches of a Motion Mind say; `None` for other families.
    pub motion_mind: Option<MotionMindFacts>,
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
    /// Its address as settings and profiles carry it. A node of a CAN bus has that of packet serial.
    #[must_use]
    pub fn unit_address(&self) -> UnitAddress {
        let address = if self.is_node() { None } else { UnitAddress::new(self.address) };
        address.unwrap_or_default()
    }

    /// What its settings table is made for; `None` for a model that is not known.
    #[must_use]
    pub fn subject(&self) -> Option<Subject> {
        Some(Subject::new(models::identify(&self.version_text)?, self.generation))
    }

    /// What it has and takes, for screens and commands that do not apply to every family.
    #[must_use]
    pub fn capabilities(&self) -> Capabilities {
        let Some(facts) = self.motion_mind else { return Capabilities::PACKET_SERIAL };
        Capabilities {
            duty: facts.mode == Mode::Serial,
            speed: facts.mode == Mode::SerialPid,
            position: matches!(facts.mode, Mode::SerialPid | Mode::AnalogPid),
            ..Capabilities::MOTION_MIND
        }
    }

    /// The signals that it can tell, in order.
    #[must_use]
    pub fn channels(&self) -> &'static [Channel] {
        if self.is_motion_mind() { MOTION_MIND_CHANNELS } else { MCP_CHANNELS }
    }

    /// The places of its status row, in order. `homed` is what its pins say of home and limit switches, where they are known.
    #[must_use]
    pub fn status_row(&self, report: Option<&StatusReport>, homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        if self.is_motion_mind() {
            return motion_mind_status_row(report);
        }
        mcp_status_row(report, self.generation.layout(), self.is_mcp(), homed)
    }

    /// The requests that a write holds, in words.
    #[must_use]
    pub fn describe_sent(&self, bytes: &[u8]) -> Described {
        match self.motion_mind {
            Some(facts) => describe_commands(bytes, facts.protocol),
            None => describe_packets(bytes, self.generation.layout()),
        }
    }

    /// Why it does not take a drive as it is now, as a clause; `None` where it does, or where only asking tells.
    #[must_use]
    pub fn objection(&self, drive: &Drive) -> Option<String> {
        self.motion_mind.and_then(|facts| objection(facts.mode, drive))
    }

    /// The bytes of a drive, command by command, as they would be sent.
    #[must_use]
    pub fn preview(&self, drive: &Drive) -> Vec<Vec<u8>> {
        match self.motion_mind {
            Some(facts) => preview_command(drive, self.address, facts),
            None => {
                let address = self.unit_address().packets().unwrap_or_default();
                preview_packets(drive, address, self.generation.layout())
            }
        }
    }

    /// Whether it is a Motion Mind.
    #[must_use]
    pub fn is_motion_mind(&self) -> bool {
        self.motion_mind.is_some()
    }

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

    /// What it says of its firmware, with the generation where the text does not hold it.
    #[must_use]
    pub fn version(&self) -> String {
        let generation = self.generation.to_string();
        if self.version_text.ends_with(&generation) {
            return self.version_text.clone();
        }
        format!("{}, {generation}", self.version_text)
    }

    /// Where it is on its bus: "0x80", "node 3", or "unit 1".
    #[must_use]
    pub fn place(&self) -> String {
        match (self.is_node(), self.is_motion_mind()) {
            (true, _) => format!("node {}", self.address),
            (_, true) => format!("unit {}", self.address),
            _ => format!("0x{:02X}", self.address),
        }
    }

    /// The same with its kind: "address 0x80", "node 3", or "unit 1".
    #[must_use]
    pub fn named_place(&self) -> String {
        let says_its_kind = self.is_node() || self.is_motion_mind();
        if says_its_kind { self.place() } else { format!("address {}", self.place()) }
    }

    /// The model, or what the unit calls itself.
    #[must_use]
    pub fn title(&self) -> &str {
        self.model.unwrap_or(&self.version_text)
    }
}

//! Who a unit is.

use super::channel::Channel;
use super::described::Described;
use super::drive::Drive;
use super::status::{StatusPlace, StatusReport};
use crate::family::{FamilyRef, families};
use crate::settings::Subject;
use crate::unit::{FirmwareGeneration, UnitAddress};
use brushwork_values::Message;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::any::Any;
use std::fmt;
use std::sync::Arc;

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

/// What a family knows of one unit beyond what all units have, and what follows from it.
pub trait UnitFacts: Any + fmt::Debug + Send + Sync {
    /// What the unit has and takes now.
    fn capabilities(&self) -> Capabilities;

    /// The signals that it can tell, in the order in which they are shown.
    fn channels(&self) -> &'static [Channel];

    /// The places of its status row, in order.
    fn status_row(&self, report: Option<&StatusReport>, homed: Option<[bool; 2]>) -> Vec<StatusPlace>;

    /// The requests that a write holds, in words.
    fn describe_sent(&self, bytes: &[u8]) -> Described;

    /// Why it does not take a drive as it is now, as a clause; `None` where it does, or where only asking tells.
    fn objection(&self, _drive: &Drive) -> Option<Message> {
        None
    }

    /// The bytes of a drive, command by command, as they would be sent to this address.
    fn preview(&self, drive: &Drive, address: u8) -> Vec<Vec<u8>>;

    /// Where a unit of this address is on its bus: "0x80", "node 3", or "unit 1".
    fn place(&self, address: u8) -> String;

    /// The same with its kind: "address 0x80", "node 3", or "unit 1".
    fn named_place(&self, address: u8) -> String {
        self.place(address)
    }

    /// Whether it is a node of a bus that has ids of its own.
    fn is_node(&self) -> bool {
        false
    }

    /// What stands in JSON under the family's [`Family::facts_key`](crate::family::Family::facts_key).
    fn json(&self) -> serde_json::Value {
        serde_json::Value::Null
    }
}

/// The facts of one unit, shared by all who hold its identity.
#[derive(Clone, Debug)]
pub struct Facts(Arc<dyn UnitFacts>);

impl Facts {
    /// Shares them.
    pub fn new(facts: impl UnitFacts) -> Self {
        Self(Arc::new(facts))
    }

    /// As the family's own type; `None` for a unit of another family.
    #[must_use]
    pub fn get<T: UnitFacts>(&self) -> Option<&T> {
        (&*self.0 as &dyn Any).downcast_ref()
    }
}

impl PartialEq for Facts {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

impl Eq for Facts {}

/// A unit that answered, and what was found out about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Its family.
    pub family: FamilyRef,
    /// Its number on the bus: its address, or on a CAN bus its node id.
    pub address: u8,
    /// How it is spoken to: "packet serial", "CANopen" or "Motion Mind".
    pub protocol: &'static str,
    /// Its version text as it came: "MCP266 2x60A v1.0.0".
    pub version_text: String,
    /// The model, "MCP266", where the text names one that is known.
    pub model: Option<&'static str>,
    /// The firmware version: "1.0.0"; empty if the text has none.
    pub firmware: String,
    /// What decides which commands and settings it has.
    pub generation: FirmwareGeneration,
    /// What its family knows of it.
    pub facts: Facts,
    /// The other addresses it answers to, as over USB.
    pub also_answers: Vec<u8>,
    /// Whether it is simulated in this program.
    pub simulated: bool,
    /// The port as a person would name it.
    pub port: String,
    /// What was odd: signs of different generations, commands that it does not answer.
    pub notes: Vec<Message>,
}

/// Its members by name. Each family of the program that has facts to tell has a member for them, null in the units of others, so that all units
/// have the same members.
impl Serialize for Identity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("address", &self.address)?;
        map.serialize_entry("family", self.protocol)?;
        map.serialize_entry("version_text", &self.version_text)?;
        map.serialize_entry("model", &self.model)?;
        map.serialize_entry("firmware", &self.firmware)?;
        map.serialize_entry("generation", &self.generation)?;
        for family in families() {
            if let Some(key) = family.facts_key() {
                let own = (*family == self.family).then(|| self.facts.0.json());
                map.serialize_entry(key, &own)?;
            }
        }
        map.serialize_entry("also_answers", &self.also_answers)?;
        map.serialize_entry("simulated", &self.simulated)?;
        map.serialize_entry("port", &self.port)?;
        map.serialize_entry("notes", &self.notes)?;
        map.end()
    }
}

impl Identity {
    /// Its address as settings and profiles carry it. A node of a CAN bus has that of a unit from the factory.
    #[must_use]
    pub fn unit_address(&self) -> UnitAddress {
        UnitAddress::new(self.family, self.address).unwrap_or(UnitAddress::factory(self.family))
    }

    /// What its settings table is made for; `None` for a model that is not known.
    #[must_use]
    pub fn subject(&self) -> Option<Subject> {
        Some(Subject::new(self.family.identify(&self.version_text)?, self.generation))
    }

    /// What it has and takes, for screens and commands that do not apply to every family.
    #[must_use]
    pub fn capabilities(&self) -> Capabilities {
        self.facts.0.capabilities()
    }

    /// The signals that it can tell, in the order in which they are shown.
    #[must_use]
    pub fn channels(&self) -> &'static [Channel] {
        self.facts.0.channels()
    }

    /// The places of its status row, in order. `homed` is what its pins say of home and limit switches, where they are known.
    #[must_use]
    pub fn status_row(&self, report: Option<&StatusReport>, homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        self.facts.0.status_row(report, homed)
    }

    /// The requests that a write holds, in words.
    #[must_use]
    pub fn describe_sent(&self, bytes: &[u8]) -> Described {
        self.facts.0.describe_sent(bytes)
    }

    /// Why it does not take a drive as it is now, as a clause; `None` where it does, or where only asking tells.
    #[must_use]
    pub fn objection(&self, drive: &Drive) -> Option<Message> {
        self.facts.0.objection(drive)
    }

    /// The bytes of a drive, command by command, as they would be sent.
    #[must_use]
    pub fn preview(&self, drive: &Drive) -> Vec<Vec<u8>> {
        self.facts.0.preview(drive, self.address)
    }

    /// Whether it is a node of a CAN bus.
    #[must_use]
    pub fn is_node(&self) -> bool {
        self.facts.0.is_node()
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
        self.facts.0.place(self.address)
    }

    /// The same with its kind: "address 0x80", "node 3", or "unit 1".
    #[must_use]
    pub fn named_place(&self) -> String {
        self.facts.0.named_place(self.address)
    }

    /// The model, or what the unit calls itself.
    #[must_use]
    pub fn title(&self) -> &str {
        self.model.unwrap_or(&self.version_text)
    }
}

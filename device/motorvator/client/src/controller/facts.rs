//! What is known of half a board beyond what all units have.

use super::channels::CHANNELS;
use super::driving::{objection, preview};
use super::indicators::status_row;
use super::traffic::describe_sent;
use crate::family::Half;
use brushwork_link::Message;
use brushwork_link::device::{
    Capabilities, Channel, Described, Drive, Identity, StatusPlace, StatusReport, UnitFacts,
};

/// Half a board as it was when it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotorvatorFacts {
    /// Which half.
    pub half: Half,
    /// The version of the host library that ran, if it did.
    pub library: Option<u8>,
}

/// Duties and nothing else; the library's dead-man is the time-out.
const CAPABILITIES: Capabilities = Capabilities {
    motors: 2,
    duty: true,
    speed: false,
    position: false,
    ramps: false,
    queued_moves: false,
    scripts: false,
    estop: false,
    pins: false,
    batteries: false,
    serial_timeout: true,
    firmware_loader: false,
    reload: false,
    registers: false,
};

impl MotorvatorFacts {
    /// Those of a unit; `None` for a unit of another family.
    #[must_use]
    pub fn of(identity: &Identity) -> Option<Self> {
        identity.facts.get().copied()
    }
}

impl UnitFacts for MotorvatorFacts {
    fn capabilities(&self) -> Capabilities {
        CAPABILITIES
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn status_row(&self, report: Option<&StatusReport>, _homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        status_row(report)
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes)
    }

    fn objection(&self, drive: &Drive) -> Option<Message> {
        objection(drive)
    }

    fn preview(&self, drive: &Drive, address: u8) -> Vec<Vec<u8>> {
        preview(drive, address)
    }

    fn place(&self, address: u8) -> String {
        Half::of(address)
            .map_or_else(|| format!("unit {address}"), |half| format!("motors {}", half.letters()))
    }

    fn json(&self) -> serde_json::Value {
        serde_json::json!({ "motors": self.half.letters(), "host_library": self.library })
    }
}

//! The mode and the protocol of a Motion Mind, which its switches choose.

use super::channels::CHANNELS;
use super::driving::{objection, preview};
use super::indicators;
use super::traffic::describe_sent;
use brushwork_link::Message;
use brushwork_link::device::{
    Capabilities, Channel, Described, Drive, Identity, StatusPlace, StatusReport, UnitFacts, status_row,
};
use brushwork_motion_mind_wire::{Mode, Protocol};
use serde::Serialize;

/// What the switches of a Motion Mind say, as far as they can be found out over the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MotionMindFacts {
    /// What moves its motor, from switches 2 to 4 at power-up.
    pub mode: Mode,
    /// Which protocol it speaks, switch 6.
    pub protocol: Protocol,
}

/// A unit in a mode that serial commands do not move.
const CAPABILITIES: Capabilities = Capabilities {
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

impl MotionMindFacts {
    /// Those of a unit; `None` for a unit of another family.
    #[must_use]
    pub fn of(identity: &Identity) -> Option<Self> {
        identity.facts.get().copied()
    }
}

impl UnitFacts for MotionMindFacts {
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            duty: self.mode == Mode::Serial,
            speed: self.mode == Mode::SerialPid,
            position: matches!(self.mode, Mode::SerialPid | Mode::AnalogPid),
            ..CAPABILITIES
        }
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn status_row(&self, report: Option<&StatusReport>, _homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        status_row(report, indicators::in_mode(Some(self.mode)))
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes, self.protocol)
    }

    fn objection(&self, drive: &Drive) -> Option<Message> {
        objection(self.mode, drive)
    }

    fn preview(&self, drive: &Drive, address: u8) -> Vec<Vec<u8>> {
        preview(drive, address, self.mode, self.protocol)
    }

    fn place(&self, address: u8) -> String {
        format!("unit {address}")
    }

    fn json(&self) -> serde_json::Value {
        serde_json::to_value(self).unwrap_or_default()
    }
}

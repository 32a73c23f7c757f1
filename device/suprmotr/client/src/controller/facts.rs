//! What is known of a SuprMotr beyond what all units have.

use super::channels::CHANNELS;
use super::driving::{objection, preview};
use super::indicators::INDICATORS;
use super::traffic::describe_sent;
use brushwork_link::Message;
use brushwork_link::device::{
    Capabilities, Channel, Described, Drive, Identity, StatusPlace, StatusReport, UnitFacts, status_row,
};
use brushwork_suprmotr_wire::{Address, Radix, Status, operation};

/// How a SuprMotr was set up when it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SuprMotrFacts {
    /// Its status then.
    pub status: Status,
}

/// The loop takes places alone. A move takes its speed from the settings.
const CAPABILITIES: Capabilities = Capabilities {
    motors: 1,
    duty: false,
    speed: false,
    position: true,
    ramps: false,
    queued_moves: false,
    scripts: false,
    estop: false,
    pins: false,
    batteries: false,
    serial_timeout: false,
    firmware_loader: false,
    reload: false,
    registers: false,
};

impl SuprMotrFacts {
    /// Those of a unit; `None` for a unit of another family.
    #[must_use]
    pub fn of(identity: &Identity) -> Option<Self> {
        identity.facts.get().copied()
    }

    /// Whether received characters come back.
    #[must_use]
    pub fn has_echo(self) -> bool {
        self.status.operation & operation::ECHO != 0
    }

    /// How its numbers are written.
    #[must_use]
    pub fn radix(self) -> Radix {
        if self.status.operation & operation::HEXADECIMAL != 0 { Radix::Hexadecimal } else { Radix::Decimal }
    }
}

impl UnitFacts for SuprMotrFacts {
    fn capabilities(&self) -> Capabilities {
        CAPABILITIES
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn status_row(&self, report: Option<&StatusReport>, _homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        status_row(report, INDICATORS)
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        describe_sent(bytes, self.radix())
    }

    fn objection(&self, drive: &Drive) -> Option<Message> {
        objection(drive)
    }

    fn preview(&self, drive: &Drive, address: u8) -> Vec<Vec<u8>> {
        preview(drive, address, self.radix())
    }

    fn place(&self, address: u8) -> String {
        Address::new(address).map_or_else(|| format!("unit {address}"), |address| address.to_string())
    }

    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "echo": self.has_echo(),
            "numbers": if self.radix() == Radix::Decimal { "decimal" } else { "hexadecimal" },
            "motor_on": self.status.is_motor_on(),
        })
    }
}

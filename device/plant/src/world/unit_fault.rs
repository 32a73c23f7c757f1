//! Faults of the unit's own electronics that a person can bring about.

use serde::{Deserialize, Serialize};

brushwork_values::listed! {
    /// A fault inside the controller. A unit whose status word has no bit for it (MCP manual 1.2.5) still stops its motors.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum UnitFault {
        /// The bridge of motor 1 says it is broken or shorted.
        M1Driver "M1 driver fault",
        /// That of motor 2.
        M2Driver "M2 driver fault",
        /// More current through motor 1 than the board stands, as in a short circuit.
        M1Current "M1 short circuit",
        /// Through motor 2.
        M2Current "M2 short circuit",
        /// Something that is only wrong at start-up: it shows from the next start on.
        Boot "Fault at start-up",
        /// Errors on the CAN bus.
        Can "CAN bus fault",
    }
    /// What a person would call it.
    fn title;
}

/// Which of them are there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct UnitFaults([bool; UnitFault::ALL.len()]);

impl UnitFaults {
    /// Whether a fault is there.
    pub const fn has(self, fault: UnitFault) -> bool {
        self.0[fault as usize]
    }

    /// Brings a fault about or ends it.
    pub const fn set(&mut self, fault: UnitFault, on: bool) {
        self.0[fault as usize] = on;
    }
}

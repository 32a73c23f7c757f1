//! What a controller holds before a run, and the axis whose loops a run writes.

use crate::axis::{Axis, AxisError, EncoderClass};
use crate::law::Law;
use serde::{Deserialize, Serialize};

/// What the controller holds before a run: the registers that are put back, and the limits that hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Setup<L: Law> {
    /// Of its loops.
    #[serde(flatten)]
    pub held: L::Held,
    /// Highest current, 10 mA; 0 = none.
    pub max_current_raw: u32,
    /// Highest braking current, 10 mA, negative; 0 = as for driving.
    #[serde(default)]
    pub min_current_raw: i32,
    /// Lowest main battery voltage that the controller accepts, 0.1 V.
    pub min_volts_raw: u16,
    /// Inductance and resistance: both non-zero make duty a current command.
    pub inductance_resistance_raw: [u32; 2],
    /// Time-out of the stream, ms; 0 = none, `None` = not reported by this firmware.
    pub stream_timeout_ms: Option<u32>,
    /// The encoder.
    pub encoder: EncoderClass,
}

impl<L: Law> Setup<L> {
    /// Whether duty is a current command: inductance and resistance are both set (MCP manual 1.2.11).
    #[must_use]
    pub fn is_torque_mode(&self) -> bool {
        self.inductance_resistance_raw.iter().all(|&raw| raw != 0)
    }

    /// The same with what another law makes of the loops.
    #[must_use]
    pub fn with_held<J: Law>(self, held: impl FnOnce(L::Held) -> J::Held) -> Setup<J> {
        Setup {
            held: held(self.held),
            max_current_raw: self.max_current_raw,
            min_current_raw: self.min_current_raw,
            min_volts_raw: self.min_volts_raw,
            inductance_resistance_raw: self.inductance_resistance_raw,
            stream_timeout_ms: self.stream_timeout_ms,
            encoder: self.encoder,
        }
    }
}

/// An axis with the loops of a law.
pub trait LoopAxis<L: Law>: Axis {
    /// Reads what the run must know and put back.
    fn read_setup(&mut self) -> Result<Setup<L>, AxisError>;
    /// Writes registers to RAM.
    fn write(&mut self, write: L::Write) -> Result<(), AxisError>;
}

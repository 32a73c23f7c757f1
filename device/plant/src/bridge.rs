//! What a motor bridge can be told to do: the one thing the control side hands to the plant.

use serde::{Deserialize, Serialize};

/// State of one full bridge, held until the next one is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum BridgeOutput {
    /// Mean bridge voltage as a fraction of the bus voltage, -1 to 1, forward positive. 0 holds both motor leads at the
    /// same potential, so that the motor brakes.
    Duty(f64),
    /// Motor leads shorted.
    Brake,
    /// All switches open: the motor freewheels.
    Coast,
}

impl BridgeOutput {
    /// The duty, -1 to 1; 0 while braking or coasting.
    #[must_use]
    pub fn duty(self) -> f64 {
        match self {
            BridgeOutput::Duty(duty) => duty,
            BridgeOutput::Brake | BridgeOutput::Coast => 0.0,
        }
    }
}

//! What a motor bridge can be told to do: all that the control side hands to the plant.

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

/// How a bridge makes a mean voltage out of the two ends of the link (MCP manual 2.3.1, command 148). The mean is the same; the
/// ripple of the current about its mean, which warms winding and bridge and is paid for by the supply, is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PwmMode {
    /// The winding sees the link one way and then the other, at duty 0 for half the time each.
    LockedAntiphase,
    /// The winding sees the link for the share of the duty and is shorted for the rest.
    SignMagnitude,
}

/// Periods of the PWM in a second. Assumed: just beyond hearing; no source gives it.
const PWM_HZ: f64 = 20_000.0;

impl PwmMode {
    /// Mean square of the current's ripple, in A^2, at a duty of -1 to 1. The ripple is a triangle, as long as a period is short
    /// beside the winding's time constant; where it is not, the current cannot swing further than the resistance lets it.
    pub(crate) fn ripple_amps_squared(self, duty: f64, bus_volts: f64, ohms: f64, henries: f64) -> f64 {
        let share = match self {
            Self::LockedAntiphase => (1.0 - duty * duty) / 2.0,
            Self::SignMagnitude => duty.abs() * (1.0 - duty.abs()),
        };
        let swing_amps = (bus_volts * share / (henries * PWM_HZ)).min(2.0 * bus_volts / ohms);
        swing_amps * swing_amps / 12.0
    }
}

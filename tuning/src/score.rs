//! The one yardstick for a response, predicted or true: time-weighted error to a setpoint step and to a load step, and overshoot.

use serde::{Deserialize, Serialize};

/// Load step, as a share of the stall torque: duty 0.15.
pub const LOAD_STEP_DUTY: f64 = 0.15;
/// The velocity step, as shares of the full speed.
pub const VELOCITY_STEP: (f64, f64) = (0.15, 0.45);
/// Overshoot at which the velocity cost has doubled.
pub const VELOCITY_OVERSHOOT: f64 = 0.20;
/// Overshoot at which the position cost has doubled.
pub const POSITION_OVERSHOOT: f64 = 0.05;

/// Time over which one half of the test is judged, s.
#[must_use]
pub fn horizon_s(tau_s: f64) -> f64 {
    (6.0 * tau_s).clamp(0.35, 6.0)
}

/// The position step in counts.
#[must_use]
pub fn position_step(gain_counts_per_s: f64, tau_s: f64) -> f64 {
    (0.3 * gain_counts_per_s * tau_s.max(0.05)).max(40.0).round()
}

/// What a response was worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Time-weighted error after the setpoint step over step and horizon squared.
    pub setpoint: f64,
    /// The same after the load step.
    pub load: f64,
    /// Overshoot over the step.
    pub overshoot: f64,
    /// Time to stay within 5 % (velocity) or 2 % (position), s; the horizon if it never does.
    pub settling_s: f64,
}

impl Score {
    /// Judges the errors (setpoint less value) after the setpoint step and after the load step, `dt` apart. `band` is the
    /// settling band over the step.
    #[must_use]
    pub fn of(after_step: &[f64], after_load: &[f64], dt: f64, step: f64, band: f64) -> Self {
        let horizon = after_step.len() as f64 * dt;
        let weighted = |errors: &[f64]| {
            let sum: f64 = errors.iter().enumerate().map(|(n, e)| (n as f64 + 0.5) * dt * e.abs()).sum();
            sum * dt / (step.abs() * horizon * horizon)
        };
        let over = after_step.iter().map(|e| -e / step).fold(0.0, f64::max);
        let outside = after_step.iter().rposition(|e| e.abs() > band * step.abs());
        Self {
            setpoint: weighted(after_step),
            load: weighted(after_load),
            overshoot: over,
            settling_s: outside.map_or(0.0, |n| (n + 1) as f64 * dt),
        }
    }

    /// The cost: both errors, dearer with overshoot.
    #[must_use]
    pub fn cost(&self, overshoot_scale: f64) -> f64 {
        (self.setpoint + self.load) * (1.0 + (self.overshoot / overshoot_scale).powi(2))
    }
}

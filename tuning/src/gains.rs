//! The gains of a loop in physical terms.

use serde::{Deserialize, Serialize};

/// One controller: `P e + I int(e dt) + D de/dt`, its output in counts/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pid {
    /// Proportional.
    pub p: f64,
    /// Integral, per second.
    pub i: f64,
    /// Derivative, s.
    pub d: f64,
}

/// The gains of an axis in physical terms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// Velocity loop: speeds in, speeds out. All zero in position modes that act on the duty directly.
    pub velocity: Pid,
    /// On the sum of the position's errors under a speed command, per s^2, an integral of the integral: where one loop on the position
    /// makes both kinds of moves.
    #[serde(default)]
    pub velocity_sum: f64,
    /// Position loop: counts in, counts/s out.
    pub position: Option<Pid>,
    /// Bound of the position integral, counts x s.
    pub max_integral: f64,
    /// Position errors up to this many counts count as none.
    pub deadzone_counts: f64,
}

impl Gains {
    /// The gain by which the speed acts on the duty: the proportional part of a velocity loop, the derivative of a loop on the position that acts on the duty directly.
    #[must_use]
    pub fn speed_gain(&self) -> f64 {
        if self.velocity == Pid::default() {
            self.position.map_or(0.0, |position| position.d)
        } else {
            self.velocity.p
        }
    }
}

//! Dry friction, locked shafts and hard stops as torques that may take any value within bounds.
//!
//! A shaft at rest is held as long as what it needs to stay so lies within the bounds of its breakaway torque, and does not move
//! at all. A turning shaft meets Coulomb friction: over a step it would reach the speed `free` without it, and each newton metre
//! held over the step changes that by `gain`. If a torque within bounds brings it to exactly zero, that is taken and the shaft is
//! at rest; otherwise the bound is taken. So there is no chatter at zero speed.

use super::params::FrictionParams;

/// The torques a shaft may take over a step.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub low: f64,
    pub high: f64,
}

impl Bounds {
    /// Dry friction of up to `newton_metres` either way.
    pub fn friction(newton_metres: f64) -> Self {
        Self { low: -newton_metres, high: newton_metres }
    }

    /// The same, with a stop that keeps the shaft from turning to lower (`at_lower`) or to higher positions.
    pub fn with_stops(self, at_lower: bool, at_upper: bool) -> Self {
        Self {
            low: if at_upper { f64::NEG_INFINITY } else { self.low },
            high: if at_lower { f64::INFINITY } else { self.high },
        }
    }

    pub fn contains(self, torque: f64) -> bool {
        self.low <= torque && torque <= self.high
    }

    fn nearest(self, torque: f64) -> f64 {
        torque.max(self.low).min(self.high)
    }
}

/// A shaft's dry friction: what holds it at rest and what brakes it while it turns.
#[derive(Clone, Copy, Debug)]
pub struct DryFriction {
    coulomb: f64,
    breakaway: f64,
}

impl DryFriction {
    pub fn new(params: &FrictionParams) -> Self {
        Self { coulomb: params.coulomb_newton_metres, breakaway: params.breakaway_newton_metres() }
    }

    /// Bounds for a shaft at rest.
    pub fn at_rest(&self) -> Bounds {
        Bounds::friction(self.breakaway)
    }

    /// Bounds for a shaft that turns, or has just broken away.
    pub fn sliding(&self) -> Bounds {
        Bounds::friction(self.coulomb)
    }
}

/// The torque on one turning shaft and whether the shaft ends the step at rest.
pub fn slide_one(free: f64, gain: f64, bounds: Bounds) -> (f64, bool) {
    let needed = -free / gain;
    (bounds.nearest(needed), bounds.contains(needed))
}

/// The torques on two coupled shafts that turn, with `gain[a][b]` the speed of shaft `a` per torque on shaft `b`.
pub fn slide_two(free: [f64; 2], gain: &[[f64; 2]; 2], bounds: [Bounds; 2]) -> ([f64; 2], [bool; 2]) {
    let determinant = gain[0][0] * gain[1][1] - gain[0][1] * gain[1][0];
    if determinant > 0.0 {
        let both = [
            -(gain[1][1] * free[0] - gain[0][1] * free[1]) / determinant,
            -(gain[0][0] * free[1] - gain[1][0] * free[0]) / determinant,
        ];
        if bounds[0].contains(both[0]) && bounds[1].contains(both[1]) {
            return (both, [true, true]);
        }
    }
    let mut torque = [0.0; 2];
    let mut rest = [false; 2];
    // Each shaft in turn against the other's latest torque; the coupling over one step is weak, so a few rounds settle it.
    for _ in 0..4 {
        for a in 0..2 {
            let other = 1 - a;
            let seen = free[a] + gain[a][other] * torque[other];
            (torque[a], rest[a]) = slide_one(seen, gain[a][a], bounds[a]);
        }
    }
    (torque, rest)
}

//! Travel end stops of the output shaft.

use super::params::{StopKind, TravelParams};

/// A shaft this close to a hard stop rests on it; covers the rounding between motor and output angles.
const TOUCH_RADIANS: f64 = 1e-9;

/// The stops of one axis, or none.
#[derive(Clone, Copy, Debug)]
pub struct Travel(Option<TravelParams>);

impl Travel {
    pub fn new(params: Option<TravelParams>) -> Self {
        Self(params)
    }

    /// Whether the shaft rests on a hard stop: (at the lower end, at the upper end).
    pub fn on_hard_stop(&self, radians: f64) -> (bool, bool) {
        match self.0 {
            Some(TravelParams { lower_radians, upper_radians, stop: StopKind::Hard }) => {
                (radians <= lower_radians + TOUCH_RADIANS, radians >= upper_radians - TOUCH_RADIANS)
            }
            _ => (false, false),
        }
    }

    /// The position a hard stop holds the shaft at, when it would be beyond it.
    pub fn beyond_hard_stop(&self, radians: f64) -> Option<f64> {
        match self.0 {
            Some(TravelParams { lower_radians, upper_radians, stop: StopKind::Hard }) => {
                let inside = radians.clamp(lower_radians, upper_radians);
                (inside != radians).then_some(inside)
            }
            _ => None,
        }
    }

    /// Torque of a springy stop on a shaft at rest.
    pub fn resting_torque(&self, radians: f64) -> f64 {
        let Some(TravelParams { lower_radians, upper_radians, stop: StopKind::Spring { .. } }) = self.0
        else {
            return 0.0;
        };
        if (lower_radians..=upper_radians).contains(&radians) {
            return 0.0;
        }
        // Without motion there is nothing for the damper or the step to do.
        self.spring_torque(radians, 0.0, 0.0, 0.0)
    }

    /// Torque of a springy stop over a step of `dt_s`, for a shaft that would end it at `free` radians per second and gains
    /// `gain` radians per second for each newton metre held. Taken from the end of the step (implicit), so no stiffness
    /// makes it unstable. A stop only pushes.
    pub fn spring_torque(&self, radians: f64, free: f64, gain: f64, dt_s: f64) -> f64 {
        let Some(TravelParams { lower_radians, upper_radians, stop }) = self.0 else { return 0.0 };
        let StopKind::Spring {
            stiffness_newton_metres_per_radian: stiffness,
            damping_newton_metre_seconds_per_radian: damping,
        } = stop
        else {
            return 0.0;
        };
        let end = radians + free * dt_s;
        let beyond = |limit: f64| {
            let slope = stiffness * dt_s + damping;
            -(stiffness * (radians - limit) + slope * free) / (1.0 + slope * gain)
        };
        if end > upper_radians {
            beyond(upper_radians).min(0.0)
        } else if end < lower_radians {
            beyond(lower_radians).max(0.0)
        } else {
            0.0
        }
    }
}

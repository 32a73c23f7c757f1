//! The trapezoid that a motor follows: how fast it may be told to go, and to change that, so that its loop is never out of duty.
//!
//! At a speed v and an acceleration a the motor takes `v + tau a` of speed over its gain, and friction and load beside it. A reserve of duty is left
//! for the loop, which has loads and a tired battery to make up for. Of the rest three quarters go into speed and one into acceleration, so that the
//! top speed is reached in three time constants at the latest: a motor that is told to be quicker saturates, winds its integral up and overshoots.

use crate::model::PlantModel;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// What a trajectory leaves in reserve.
    TRAJECTORY: Thresholds {
        /// Duty that stays with the loop, as a share of full: the load step by which responses are judged.
        reserve_duty: f64 = crate::score::LOAD_STEP_DUTY,
        /// Share of the duty that is then left which goes into speed.
        speed_share: f64 = 0.75,
        /// Share of a current limit that a trajectory may use: it is a wall that nothing makes up for.
        limit_share: f64 = 0.8,
    }
}

/// A trapezoid of speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    /// Its top speed, counts/s.
    pub speed_counts_per_s: f64,
    /// Acceleration and deceleration, counts/s²: friction helps to brake, so that what suits the one suits the other.
    pub accel_counts_per_s2: f64,
}

impl Trajectory {
    /// What a motor follows; `None` where friction and load leave nothing.
    #[must_use]
    pub fn of(model: &PlantModel) -> Option<Self> {
        let held = model.coulomb_duty + model.load_duty.abs();
        let most = 1.0 - TRAJECTORY.reserve_duty;
        // The battery sags by the current of the duty itself.
        let left = most * (1.0 - model.sag * most * most) - held;
        if left <= 0.0 {
            return None;
        }
        let speed_duty = TRAJECTORY.speed_share * left;
        let limit = [model.drive_limit, model.brake_limit].into_iter().flatten().reduce(f64::min);
        let push = limit.map_or(left - speed_duty, |limit| {
            (left - speed_duty).min(TRAJECTORY.limit_share * limit - held)
        });
        (push > 0.0).then_some(Self {
            speed_counts_per_s: model.gain_counts_per_s * speed_duty,
            accel_counts_per_s2: model.gain_counts_per_s * push / model.tau_s,
        })
    }

    /// What both motors of a drive follow, so that a vehicle goes straight.
    #[must_use]
    pub fn of_both(self, other: Self) -> Self {
        Self {
            speed_counts_per_s: self.speed_counts_per_s.min(other.speed_counts_per_s),
            accel_counts_per_s2: self.accel_counts_per_s2.min(other.accel_counts_per_s2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: PlantModel = PlantModel {
        gain_counts_per_s: 10_000.0,
        tau_s: 0.1,
        coulomb_duty: 0.05,
        load_duty: 0.0,
        drive_limit: None,
        brake_limit: None,
        sag: 0.0,
    };

    #[test]
    fn speed_and_acceleration_take_the_duty_that_the_reserve_leaves() {
        // 0.85 - 0.05 = 0.8: 0.6 for the speed, 0.2 for the acceleration.
        let found = Trajectory::of(&MOTOR).unwrap();
        assert!((found.speed_counts_per_s - 6_000.0).abs() < 1e-6, "{found:?}");
        assert!((found.accel_counts_per_s2 - 20_000.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_current_limit_takes_from_the_acceleration_and_friction_that_eats_all_leaves_none() {
        let limited = Trajectory::of(&PlantModel { drive_limit: Some(0.1), ..MOTOR }).unwrap();
        assert!((limited.accel_counts_per_s2 - 3_000.0).abs() < 1e-6, "0.8 x 0.1 - 0.05: {limited:?}");
        for stuck in [
            PlantModel { coulomb_duty: 0.9, ..MOTOR },
            PlantModel { load_duty: -0.85, ..MOTOR },
            PlantModel { brake_limit: Some(0.06), ..MOTOR },
        ] {
            assert_eq!(Trajectory::of(&stuck), None, "{stuck:?}");
        }
    }
}

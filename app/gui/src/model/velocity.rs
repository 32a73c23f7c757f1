//! The Velocity screen's state: what speed is asked for, and how fast it may change.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_tuning::trajectory::Trajectory;
use brushwork_values::Motor;

use super::setpoints::{Direction, Setpoints};

/// Acceleration that the screen offers, counts/s².
pub const ACCEL_RANGE_COUNTS_PER_S2: std::ops::RangeInclusive<f64> = 0.0..=10_000_000.0;

/// The state of the Velocity screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Asked for, counts/s.
    pub setpoints: Setpoints,
    /// 0 leaves it to the controller.
    pub accel_counts_per_s2: f64,
    /// What a jog button asks for.
    pub jog_counts_per_s: f64,
}

impl Default for Velocity {
    fn default() -> Self {
        Self { setpoints: Setpoints::default(), accel_counts_per_s2: 20_000.0, jog_counts_per_s: 2000.0 }
    }
}

impl Velocity {
    /// Changes speeds no quicker than a motor follows.
    pub fn follow(&mut self, trajectory: &Trajectory) {
        let (least, most) = ACCEL_RANGE_COUNTS_PER_S2.into_inner();
        self.accel_counts_per_s2 = trajectory.accel_counts_per_s2.round().clamp(least, most);
    }

    /// Asks for a speed within -`qpps` to `qpps` of each motor; with sync, of both motors.
    pub fn set_speed(&mut self, motor: Motor, counts_per_s: f64, qpps: [f64; 2]) {
        let asked = if counts_per_s.is_finite() { counts_per_s } else { 0.0 };
        let reach = if self.setpoints.sync { qpps[0].min(qpps[1]) } else { qpps[motor.index()] };
        self.setpoints.set(motor, asked.clamp(-reach, reach));
    }

    /// What the jog buttons ask for in this frame: a speed while one is held, then none.
    pub fn jog(&mut self, motor: Motor, held: Option<Direction>, qpps: [f64; 2]) {
        if let Some(begun) = self.setpoints.jog(motor, held) {
            let speed = begun.map_or(0.0, |direction| direction.sign() * self.jog_counts_per_s);
            self.set_speed(motor, speed, qpps);
        }
    }

    /// What has to be sent, if anything.
    pub fn to_send(&self) -> Option<Drive> {
        let accel = self.accel_counts_per_s2.round();
        let accel_counts_per_s2 = (accel > 0.0).then_some(accel as u32);
        self.setpoints.to_send(|_, counts_per_s| {
            let speed_counts_per_s = counts_per_s.round() as i32;
            Some(DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2 })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_stays_within_the_top_speed_of_its_motor() {
        let mut velocity = Velocity { accel_counts_per_s2: 0.0, ..Velocity::default() };
        velocity.set_speed(Motor::M2, -90_000.0, [44_000.0, 12_000.0]);
        let wanted = DriveCommand::Speed { speed_counts_per_s: -12_000, accel_counts_per_s2: None };
        assert_eq!(velocity.to_send(), Some(Drive::one(Motor::M2, wanted)));
    }

    #[test]
    fn a_jog_keeps_to_the_top_speed_too() {
        let mut velocity = Velocity { jog_counts_per_s: 50_000.0, ..Velocity::default() };
        velocity.jog(Motor::M1, Some(Direction::Forward), [44_000.0; 2]);
        assert_eq!(velocity.setpoints.values, [44_000.0, 0.0]);
        velocity.jog(Motor::M1, None, [44_000.0; 2]);
        assert_eq!(velocity.setpoints.values, [0.0; 2]);
    }

    #[test]
    fn synchronised_motors_keep_to_the_slower_one() {
        let mut velocity = Velocity::default();
        velocity.setpoints.set_sync(true);
        velocity.set_speed(Motor::M1, 40_000.0, [44_000.0, 12_000.0]);
        assert_eq!(velocity.setpoints.values, [12_000.0; 2]);
    }
}

//! The Position screen's state: where each motor is to go, and how.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_tuning::trajectory::Trajectory;
use brushwork_values::Motor;

use super::setpoints::{Direction, Setpoints};

/// What the screen offers for speed (counts/s), acceleration and deceleration (counts/s²).
pub const PACE_RANGE: std::ops::RangeInclusive<f64> = 1.0..=10_000_000.0;

/// Age of a reading and of a command on its way: how far ahead of the newest reading a motor already is.
const DELAY_S: f64 = 0.1;

/// Lowest and highest position of each motor, counts; none where it has no travel.
pub type Travels = [Option<(f64, f64)>; 2];

/// Where a motor was seen last and how fast it went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    pub counts: f64,
    pub counts_per_s: f64,
}

/// The state of the Position screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Asked for, counts.
    pub setpoints: Setpoints,
    pub accel_counts_per_s2: f64,
    pub decel_counts_per_s2: f64,
    pub speed_counts_per_s: f64,
}

impl Default for Position {
    fn default() -> Self {
        Self {
            setpoints: Setpoints::default(),
            accel_counts_per_s2: 20_000.0,
            decel_counts_per_s2: 20_000.0,
            speed_counts_per_s: 5_000.0,
        }
    }
}

impl Position {
    /// Moves no quicker than a motor follows.
    pub fn follow(&mut self, trajectory: &Trajectory) {
        let (least, most) = PACE_RANGE.into_inner();
        let within = |value: f64| value.round().clamp(least, most);
        self.speed_counts_per_s = within(trajectory.speed_counts_per_s);
        self.accel_counts_per_s2 = within(trajectory.accel_counts_per_s2);
        self.decel_counts_per_s2 = self.accel_counts_per_s2;
    }

    /// Asks for a position within each motor's travel; with sync, of both motors.
    pub fn set_position(&mut self, motor: Motor, counts: f64, travels: Travels) {
        for each in self.coupled(motor) {
            self.set_one(each, counts, travels);
        }
    }

    /// What the jog buttons ask for in this frame: the end of the travel while one is held. When it is let go the motor is
    /// sent to where it can stop with its deceleration, so that it neither overshoots nor comes back, and is held there.
    pub fn jog(&mut self, motor: Motor, held: Option<Direction>, travels: Travels, seen: [Seen; 2]) {
        let Some(begun) = self.setpoints.jog(motor, held) else { return };
        for each in self.coupled(motor) {
            let Some((low, high)) = travels[each.index()] else { continue };
            let target = match begun {
                Some(Direction::Backward) => low,
                Some(Direction::Forward) => high,
                None => self.rest_point(seen[each.index()]),
            };
            self.set_one(each, target, travels);
        }
    }

    /// What has to be sent, if anything.
    pub fn to_send(&self) -> Option<Drive> {
        // A conversion saturates.
        let whole = |value: f64| value.round() as u32;
        self.setpoints.to_send(|_, counts| {
            Some(DriveCommand::Position {
                position_counts: counts.round() as i32,
                speed_counts_per_s: whole(self.speed_counts_per_s),
                accel_counts_per_s2: whole(self.accel_counts_per_s2),
                decel_counts_per_s2: whole(self.decel_counts_per_s2),
                queued: false,
            })
        })
    }

    fn rest_point(&self, seen: Seen) -> f64 {
        let speed = seen.counts_per_s;
        let braking = speed * speed.abs() / (2.0 * self.decel_counts_per_s2);
        seen.counts + speed * DELAY_S + braking
    }

    fn coupled(&self, motor: Motor) -> impl Iterator<Item = Motor> + use<> {
        let sync = self.setpoints.sync;
        Motor::BOTH.into_iter().filter(move |each| *each == motor || sync)
    }

    fn set_one(&mut self, motor: Motor, counts: f64, travels: Travels) {
        if let Some((low, high)) = travels[motor.index()].filter(|_| counts.is_finite()) {
            self.setpoints.set_one(motor, counts.clamp(low, high));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRAVELS: Travels = [Some((-1000.0, 1000.0)), Some((0.0, 300.0))];

    #[test]
    fn each_motor_stays_within_its_own_travel() {
        let mut position = Position::default();
        position.setpoints.sync = true;
        position.set_position(Motor::M1, 5000.0, TRAVELS);
        assert_eq!(position.setpoints.values, [1000.0, 300.0]);
        position.set_position(Motor::M1, f64::NAN, TRAVELS);
        assert_eq!(position.setpoints.values, [1000.0, 300.0]);
    }

    #[test]
    fn a_motor_without_travel_is_not_told_to_move() {
        let mut position = Position::default();
        position.setpoints.sync = true;
        position.set_position(Motor::M1, 500.0, [TRAVELS[0], None]);
        let drive = position.to_send().unwrap();
        assert!(drive.m1.is_some() && drive.m2.is_none());
    }

    #[test]
    fn a_jog_goes_to_the_end_of_the_travel_and_is_let_go_where_the_motor_can_stop() {
        let mut position = Position { decel_counts_per_s2: 1000.0, ..Position::default() };
        position.jog(Motor::M1, Some(Direction::Backward), TRAVELS, [Seen::default(); 2]);
        assert_eq!(position.setpoints.values, [-1000.0, 0.0]);
        let seen = Seen { counts: -200.0, counts_per_s: -400.0 };
        position.jog(Motor::M1, None, TRAVELS, [seen; 2]);
        // 40 counts of delay, 80 counts of braking.
        assert_eq!(position.setpoints.values, [-320.0, 0.0]);
    }
}

//! The PWM screen's state: what duty is asked for, and how fast it may change.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_values::Motor;

use super::setpoints::{Direction, Setpoints};

/// Percent of full duty per second at which a duty may change; what the screen offers.
pub const ACCEL_RANGE_PERCENT_PER_S: std::ops::RangeInclusive<f64> = 0.0..=2000.0;

/// The state of the PWM screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pwm {
    /// Asked for, percent of full duty.
    pub setpoints: Setpoints,
    /// 0 changes the duty at once.
    pub accel_percent_per_s: f64,
    /// What a jog button asks for.
    pub jog_percent: f64,
}

impl Default for Pwm {
    fn default() -> Self {
        Self { setpoints: Setpoints::default(), accel_percent_per_s: 100.0, jog_percent: 20.0 }
    }
}

impl Pwm {
    /// Asks for a duty; with sync, of both motors.
    pub fn set_duty(&mut self, motor: Motor, percent: f64) {
        let percent = if percent.is_finite() { percent.clamp(-100.0, 100.0) } else { 0.0 };
        self.setpoints.set(motor, percent);
    }

    /// What the jog buttons ask for in this frame: the duty while one is held, then none.
    pub fn jog(&mut self, motor: Motor, held: Option<Direction>) {
        if let Some(begun) = self.setpoints.jog(motor, held) {
            self.set_duty(motor, begun.map_or(0.0, |direction| direction.sign() * self.jog_percent));
        }
    }

    /// What has to be sent, if anything.
    pub fn to_send(&self) -> Option<Drive> {
        let accel = self.accel_percent_per_s;
        let accel_duty_per_s = (accel > 0.0).then_some(accel / 100.0);
        self.setpoints
            .to_send(|_, percent| Some(DriveCommand::Duty { duty: percent / 100.0, accel_duty_per_s }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duty_is_sent_as_a_fraction_with_its_acceleration() {
        let mut pwm = Pwm::default();
        pwm.set_duty(Motor::M2, 12.5);
        let wanted = DriveCommand::Duty { duty: 0.125, accel_duty_per_s: Some(1.0) };
        assert_eq!(pwm.to_send(), Some(Drive::one(Motor::M2, wanted)));
    }

    #[test]
    fn a_jog_runs_while_it_is_held() {
        let mut pwm = Pwm { jog_percent: 15.0, ..Pwm::default() };
        pwm.jog(Motor::M1, Some(Direction::Backward));
        assert_eq!(pwm.setpoints.values, [-15.0, 0.0]);
        pwm.set_duty(Motor::M2, 40.0);
        pwm.jog(Motor::M1, None);
        assert_eq!(pwm.setpoints.values, [0.0, 40.0]);
    }

    #[test]
    fn an_acceleration_of_zero_changes_the_duty_at_once() {
        let mut pwm = Pwm { accel_percent_per_s: 0.0, ..Pwm::default() };
        pwm.set_duty(Motor::M1, 500.0);
        assert_eq!(pwm.to_send(), Some(Drive::one(Motor::M1, DriveCommand::duty(1.0))));
    }
}

//! The PWM screen's state: what duty is asked for, and how fast it may change.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_protocol::packet_serial::Motor;

/// Percent of full duty per second at which a duty may change; what the screen offers.
pub const ACCEL_RANGE_PERCENT_PER_S: std::ops::RangeInclusive<f64> = 0.0..=2000.0;

/// The state of the PWM screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pwm {
    /// Asked for, percent of full duty, by motor.
    pub duty_percent: [f64; 2],
    /// Both sliders move together.
    pub sync: bool,
    /// 0 changes the duty at once.
    pub accel_percent_per_s: f64,
    /// Motors whose duty was changed and not yet handed to the device thread.
    changed: [bool; 2],
}

impl Default for Pwm {
    fn default() -> Self {
        Self { duty_percent: [0.0; 2], sync: false, accel_percent_per_s: 100.0, changed: [false; 2] }
    }
}

impl Pwm {
    /// Asks for a duty; with sync, of both motors.
    pub fn set_duty(&mut self, motor: Motor, percent: f64) {
        let percent = if percent.is_finite() { percent.clamp(-100.0, 100.0) } else { 0.0 };
        for each in Motor::BOTH {
            if each == motor || self.sync {
                self.duty_percent[each.index()] = percent;
                self.changed[each.index()] = true;
            }
        }
    }

    /// Couples the sliders; motor 2 takes over motor 1's duty.
    pub fn set_sync(&mut self, sync: bool) {
        let coupled_now = sync && !self.sync;
        self.sync = sync;
        if coupled_now && self.duty_percent[0] != self.duty_percent[1] {
            self.set_duty(Motor::M1, self.duty_percent[0]);
        }
    }

    /// Both sliders to zero, with nothing left to send: the motors were or are being stopped by other means.
    pub fn stop(&mut self) {
        self.duty_percent = [0.0; 2];
        self.changed = [false; 2];
    }

    /// What has to be sent, if anything.
    pub fn to_send(&self) -> Option<Drive> {
        let accel = self.accel_percent_per_s;
        let accel_duty_per_s = (accel > 0.0).then_some(accel / 100.0);
        let command = |motor: Motor| {
            let duty = self.duty_percent[motor.index()] / 100.0;
            self.changed[motor.index()].then_some(DriveCommand::Duty { duty, accel_duty_per_s })
        };
        let drive = Drive { m1: command(Motor::M1), m2: command(Motor::M2) };
        (drive.m1.is_some() || drive.m2.is_some()).then_some(drive)
    }

    /// The device thread has taken what [`Pwm::to_send`] gave.
    pub fn sent(&mut self) {
        self.changed = [false; 2];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_offered_until_it_was_taken() {
        let mut pwm = Pwm::default();
        assert_eq!(pwm.to_send(), None);
        pwm.set_duty(Motor::M2, 12.5);
        let wanted = DriveCommand::Duty { duty: 0.125, accel_duty_per_s: Some(1.0) };
        assert_eq!(pwm.to_send(), Some(Drive::one(Motor::M2, wanted)));
        assert!(pwm.to_send().is_some());
        pwm.sent();
        assert_eq!(pwm.to_send(), None);
    }

    #[test]
    fn synchronised_sliders_move_together_and_join_at_motor_1() {
        let mut pwm = Pwm::default();
        pwm.set_duty(Motor::M1, 30.0);
        pwm.sent();
        pwm.set_sync(true);
        assert_eq!(pwm.duty_percent, [30.0, 30.0]);
        pwm.set_duty(Motor::M2, -5.0);
        assert_eq!(pwm.duty_percent, [-5.0, -5.0]);
    }

    #[test]
    fn after_a_stop_nothing_is_left_to_send() {
        let mut pwm = Pwm::default();
        pwm.set_duty(Motor::M1, 80.0);
        pwm.stop();
        assert_eq!((pwm.duty_percent, pwm.to_send()), ([0.0; 2], None));
    }

    #[test]
    fn an_acceleration_of_zero_changes_the_duty_at_once() {
        let mut pwm = Pwm { accel_percent_per_s: 0.0, ..Pwm::default() };
        pwm.set_duty(Motor::M1, 500.0);
        assert_eq!(pwm.to_send(), Some(Drive::one(Motor::M1, DriveCommand::duty(1.0))));
    }
}

//! What the two sliders of a screen that drives ask for, and when it is sent.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_protocol::packet_serial::Motor;

/// Two setpoints, in the unit of their screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoints {
    /// Asked for, by motor.
    pub values: [f64; 2],
    /// Both sliders move together.
    pub sync: bool,
    /// Nothing is sent while a slider is held.
    pub on_release: bool,
    held: [bool; 2],
    /// Motors whose setpoint was changed and not yet handed to the device thread.
    changed: [bool; 2],
}

impl Setpoints {
    /// Asks for a value; with sync, of both motors.
    pub fn set(&mut self, motor: Motor, value: f64) {
        for each in Motor::BOTH {
            if each == motor || self.sync {
                self.values[each.index()] = value;
                self.changed[each.index()] = true;
            }
        }
    }

    /// Couples the sliders; motor 2 takes over motor 1's setpoint.
    pub fn set_sync(&mut self, sync: bool) {
        let coupled_now = sync && !self.sync;
        self.sync = sync;
        if coupled_now && self.values[0] != self.values[1] {
            self.set(Motor::M1, self.values[0]);
        }
    }

    /// Whether the hand is on a motor's slider.
    pub fn hold(&mut self, motor: Motor, held: bool) {
        self.held[motor.index()] = held;
    }

    /// Shows values without asking for them.
    pub fn show(&mut self, motor: Motor, value: f64) {
        self.values[motor.index()] = value;
    }

    /// Both sliders to zero, with nothing left to send: the motors were or are being stopped by other means.
    pub fn stop(&mut self) {
        *self = Self { sync: self.sync, on_release: self.on_release, ..Self::default() };
    }

    /// What has to be sent, if anything; `command` turns a motor's setpoint into what its controller is told.
    pub fn to_send(&self, command: impl Fn(Motor, f64) -> Option<DriveCommand>) -> Option<Drive> {
        if self.waits() {
            return None;
        }
        let of = |motor: Motor| {
            let index = motor.index();
            if self.changed[index] { command(motor, self.values[index]) } else { None }
        };
        let drive = Drive { m1: of(Motor::M1), m2: of(Motor::M2) };
        (drive.m1.is_some() || drive.m2.is_some()).then_some(drive)
    }

    /// Counts both as changed, whoever holds them: to see what they stand for.
    pub fn touch(&mut self) {
        (self.changed, self.held) = ([true; 2], [false; 2]);
    }

    /// The device thread has taken what [`Setpoints::to_send`] gave.
    pub fn sent(&mut self) {
        self.changed = [false; 2];
    }

    fn waits(&self) -> bool {
        self.on_release && self.held.contains(&true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(_: Motor, value: f64) -> Option<DriveCommand> {
        Some(DriveCommand::Speed { speed_counts_per_s: value as i32, accel_counts_per_s2: None })
    }

    #[test]
    fn a_change_is_offered_until_it_was_taken() {
        let mut setpoints = Setpoints::default();
        assert_eq!(setpoints.to_send(speed), None);
        setpoints.set(Motor::M2, 1250.0);
        let wanted = DriveCommand::Speed { speed_counts_per_s: 1250, accel_counts_per_s2: None };
        assert_eq!(setpoints.to_send(speed), Some(Drive::one(Motor::M2, wanted)));
        assert!(setpoints.to_send(speed).is_some());
        setpoints.sent();
        assert_eq!(setpoints.to_send(speed), None);
    }

    #[test]
    fn synchronised_sliders_move_together_and_join_at_motor_1() {
        let mut setpoints = Setpoints::default();
        setpoints.set(Motor::M1, 30.0);
        setpoints.sent();
        setpoints.set_sync(true);
        assert_eq!(setpoints.values, [30.0, 30.0]);
        setpoints.set(Motor::M2, -5.0);
        assert_eq!(setpoints.values, [-5.0, -5.0]);
    }

    #[test]
    fn after_a_stop_nothing_is_left_to_send() {
        let mut setpoints = Setpoints { sync: true, ..Setpoints::default() };
        setpoints.set(Motor::M1, 80.0);
        setpoints.stop();
        assert_eq!((setpoints.values, setpoints.to_send(speed)), ([0.0; 2], None));
        assert!(setpoints.sync, "what a person has ticked stays");
    }

    #[test]
    fn on_release_a_held_slider_sends_nothing_until_it_is_let_go() {
        let mut setpoints = Setpoints { on_release: true, ..Setpoints::default() };
        setpoints.hold(Motor::M1, true);
        setpoints.set(Motor::M1, 100.0);
        assert_eq!(setpoints.to_send(speed), None);
        setpoints.hold(Motor::M1, false);
        assert!(setpoints.to_send(speed).is_some());
    }
}

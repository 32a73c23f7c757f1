//! What the two sliders of a screen that drives ask for, and when it is sent.

use brushwork_link::device::{Drive, DriveCommand};
use brushwork_values::Motor;

/// Which way a motor is jogged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Backward,
    Forward,
}

impl Direction {
    pub const fn sign(self) -> f64 {
        match self {
            Self::Backward => -1.0,
            Self::Forward => 1.0,
        }
    }
}

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
    /// Motors that were asked for something since the last rest.
    asked: [bool; 2],
    /// The jog button that is held.
    jogging: [Option<Direction>; 2],
}

impl Setpoints {
    /// Asks for a value; with sync, of both motors.
    pub fn set(&mut self, motor: Motor, value: f64) {
        for each in Motor::BOTH {
            if each == motor || self.sync {
                self.set_one(each, value);
            }
        }
    }

    /// Asks for a value of one motor, coupled or not.
    pub fn set_one(&mut self, motor: Motor, value: f64) {
        let index = motor.index();
        (self.values[index], self.changed[index], self.asked[index]) = (value, true, true);
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

    /// Shows where a motor is, as long as nothing was asked of it.
    pub fn show(&mut self, motor: Motor, value: f64) {
        if !self.asked[motor.index()] {
            self.values[motor.index()] = value;
        }
    }

    /// Takes note of the jog button that is held in this frame. Tells what is new: a jog that begins or, as `None` inside,
    /// one that ends.
    pub fn jog(&mut self, motor: Motor, held: Option<Direction>) -> Option<Option<Direction>> {
        let before = std::mem::replace(&mut self.jogging[motor.index()], held);
        (before != held).then_some(held)
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
    fn what_a_slider_shows_by_itself_is_not_sent_and_ends_with_the_first_action() {
        let mut setpoints = Setpoints::default();
        setpoints.show(Motor::M1, 5000.0);
        assert_eq!((setpoints.values[0], setpoints.to_send(speed)), (5000.0, None));
        setpoints.set(Motor::M1, 5001.0);
        setpoints.show(Motor::M1, 0.0);
        assert_eq!(setpoints.values[0], 5001.0);
        setpoints.stop();
        setpoints.show(Motor::M1, 7.0);
        assert_eq!(setpoints.values[0], 7.0);
    }

    #[test]
    fn a_jog_is_told_once_when_it_begins_and_once_when_it_ends() {
        let mut setpoints = Setpoints::default();
        let forward = Some(Direction::Forward);
        assert_eq!(setpoints.jog(Motor::M1, forward), Some(forward));
        assert_eq!(setpoints.jog(Motor::M1, forward), None);
        assert_eq!(setpoints.jog(Motor::M2, None), None);
        assert_eq!(setpoints.jog(Motor::M1, None), Some(None));
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

//! What the sliders of a Motion Mind's screens reach, and what they ask of the unit.

use std::ops::RangeInclusive;

use brushwork_link::device::{ArmScope, Drive, DriveCommand};
use brushwork_values::Motor;

use super::registers;
use crate::gui::model::desk::Desk;
use crate::gui::model::setpoints::{Direction, Setpoints};

/// Loops of the PID in a second (Motion Mind manual 3.15: 5 ms).
pub const LOOPS_PER_S: f64 = 200.0;
/// Velocities that the velocity command takes, counts per loop.
pub const VELOCITY_RANGE: RangeInclusive<f64> = 1.0..=1023.0;
/// Counts of an analog feedback.
pub const ANALOG_FULL: f64 = 1023.0;
/// Counts of a pulse feedback over its whole width (Motion Mind manual 4.7).
pub const PULSE_FULL: f64 = 18_875.0;

/// What was set on the screens that drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// End of the velocity slider, counts per loop.
    pub top_counts_per_loop: f64,
    /// Velocity of a held jog button, counts per loop.
    pub jog_counts_per_loop: f64,
    /// How far the position slider goes either way where nothing limits the travel, counts.
    pub span_counts: f64,
    /// What one press of a step button moves, counts.
    pub step_counts: f64,
}

impl Default for Reach {
    fn default() -> Self {
        Self {
            top_counts_per_loop: 50.0,
            jog_counts_per_loop: 10.0,
            span_counts: 20_000.0,
            step_counts: 500.0,
        }
    }
}

impl Desk {
    /// Where a position may be asked for: the scale of an analog or pulse feedback, the virtual limits, or what was set.
    pub fn mind_travel(&self) -> (f64, f64) {
        let span = self.motion_mind.reach.span_counts;
        let has_encoder = self.has_bit(registers::FUNCTION, "RCPOS-ENCFDBCK");
        if self.mode() == Some(5) && !has_encoder {
            return (0.0, ANALOG_FULL);
        }
        if self.mode() == Some(4) && self.has_bit(registers::FUNCTION2, "PULSEFB") {
            return (0.0, PULSE_FULL);
        }
        self.virtual_travel().unwrap_or((-span, span))
    }

    /// The virtual limits, where they act.
    pub fn virtual_travel(&self) -> Option<(f64, f64)> {
        let of_register = |name| self.register(name).map(|value| value as f64);
        let limits = of_register("VNLIMIT").zip(of_register("VPLIMIT"))?;
        (self.has_bit(registers::FUNCTION, "VIRTLIMIT") && limits.0 < limits.1).then_some(limits)
    }

    /// Asks for a position within the travel.
    pub fn ask_position(&mut self, counts: f64) {
        let (low, high) = self.mind_travel();
        if counts.is_finite() {
            self.position.setpoints.set_one(Motor::M1, counts.clamp(low, high));
        }
    }

    /// Asks for a position so far from the one asked for last, or from where the motor is.
    pub fn ask_step(&mut self, counts: f64) {
        let from = self.position.setpoints.values[0];
        self.ask_position(from + counts);
    }

    /// Asks for a velocity, counts per loop.
    pub fn ask_velocity(&mut self, counts_per_loop: f64) {
        let top = self.motion_mind.reach.top_counts_per_loop;
        if counts_per_loop.is_finite() {
            let whole = counts_per_loop.round().clamp(-top, top);
            self.velocity.setpoints.set_one(Motor::M1, whole);
        }
    }

    /// What the jog buttons of the velocity screen ask for in this frame.
    pub fn jog_velocity(&mut self, held: Option<Direction>) {
        if let Some(begun) = self.velocity.setpoints.jog(Motor::M1, held) {
            let speed = self.motion_mind.reach.jog_counts_per_loop;
            self.ask_velocity(begun.map_or(0.0, |direction| direction.sign() * speed));
        }
    }
}

/// What a Motion Mind has to be told for a screen that is armed and whose slider stands so, if anything.
pub fn to_send(scope: ArmScope, setpoints: Setpoints) -> Option<Drive> {
    setpoints.to_send(|_, value| {
        Some(match scope {
            ArmScope::Pwm => DriveCommand::duty(value / 100.0),
            ArmScope::Velocity => DriveCommand::Speed {
                speed_counts_per_s: (value * LOOPS_PER_S).round() as i32,
                accel_counts_per_s2: None,
            },
            // The unit has its own speeds on the way: VELOCITYLIMIT, or none.
            ArmScope::Position => DriveCommand::Position {
                position_counts: value.round() as i32,
                speed_counts_per_s: 0,
                accel_counts_per_s2: 0,
                decel_counts_per_s2: 0,
                queued: false,
            },
            _ => return None,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_goes_out_in_whole_counts_per_loop() {
        let mut desk = Desk::default();
        desk.ask_velocity(-12.4);
        let wanted = DriveCommand::Speed { speed_counts_per_s: -2400, accel_counts_per_s2: None };
        assert_eq!(to_send(ArmScope::Velocity, desk.velocity.setpoints), Some(Drive::one(Motor::M1, wanted)));
        desk.ask_velocity(5000.0);
        assert_eq!(desk.velocity.setpoints.values[0], 50.0, "the slider's end");
    }

    #[test]
    fn a_jog_runs_while_it_is_held() {
        let mut desk = Desk::default();
        desk.jog_velocity(Some(Direction::Backward));
        assert_eq!(desk.velocity.setpoints.values[0], -10.0);
        desk.jog_velocity(None);
        assert_eq!(desk.velocity.setpoints.values[0], 0.0);
    }

    #[test]
    fn steps_add_up_and_stay_in_the_travel() {
        let mut desk = Desk::default();
        desk.ask_step(15_000.0);
        desk.ask_step(15_000.0);
        assert_eq!(desk.position.setpoints.values[0], 20_000.0);
    }
}

//! What the sliders of a Motion Mind's screens reach, and what they ask of the unit.

use std::ops::RangeInclusive;

use brushwork_link::device::{ArmScope, Drive, DriveCommand};

use crate::model::setpoints::Setpoints;

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
            ArmScope::ClampTest | ArmScope::Tuning | ArmScope::Script | ArmScope::CommandLine => return None,
        })
    })
}

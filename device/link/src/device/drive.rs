//! What a screen can be armed for, and how motors are told to move.

use brushwork_values::Motor;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The screen, or other place, that may move motors while it is armed. Going to another disarms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArmScope {
    /// The PWM screen: open loop.
    Pwm,
    /// The velocity screen.
    Velocity,
    /// The position screen.
    Position,
    /// The test of the voltage clamp, which a job runs.
    ClampTest,
    /// Tuning: experiments that a job runs.
    Tuning,
    /// The script screen: starting a script and nothing else.
    Script,
    /// The command line.
    CommandLine,
}

impl ArmScope {
    /// Whether driving commands are allowed.
    #[must_use]
    pub fn allows_motion(self) -> bool {
        self != Self::Script
    }

    /// Whether a script may be started.
    #[must_use]
    pub fn allows_scripts(self) -> bool {
        matches!(self, Self::Script | Self::CommandLine)
    }
}

impl fmt::Display for ArmScope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pwm => "the PWM screen",
            Self::Velocity => "the velocity screen",
            Self::Position => "the position screen",
            Self::ClampTest => "the voltage clamp test",
            Self::Tuning => "tuning",
            Self::Script => "the script screen",
            Self::CommandLine => "the command line",
        })
    }
}

/// What one motor is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DriveCommand {
    /// Open loop.
    Duty {
        /// -1 to 1.
        duty: f64,
        /// Change of duty per second, as a fraction of full duty; `None` changes at once.
        accel_duty_per_s: Option<f64>,
    },
    /// Closed speed loop.
    Speed {
        /// Signed.
        speed_counts_per_s: i32,
        /// `None` takes the controller's own.
        accel_counts_per_s2: Option<u32>,
    },
    /// A speed for a distance, from where the motor is. Never sent twice.
    Distance {
        /// Signed: the sign is the direction.
        speed_counts_per_s: i32,
        /// `None` takes the controller's own.
        accel_counts_per_s2: Option<u32>,
        /// How far.
        distance_counts: u32,
        /// Wait behind the moves already given, or drop those and go now.
        queued: bool,
    },
    /// A move to a position. Never sent twice, since it can be queued.
    Position {
        /// Where to.
        position_counts: i32,
        /// The greatest speed on the way.
        speed_counts_per_s: u32,
        /// Gathering speed.
        accel_counts_per_s2: u32,
        /// Losing speed.
        decel_counts_per_s2: u32,
        /// Wait behind the moves already given, or drop those and go now.
        queued: bool,
    },
}

impl DriveCommand {
    /// Open loop with the change of duty at once.
    #[must_use]
    pub fn duty(duty: f64) -> Self {
        Self::Duty { duty, accel_duty_per_s: None }
    }

    /// What a graph shows as the setpoint: duty in %, speed in counts/s, position in counts.
    #[must_use]
    pub fn setpoint(&self) -> f64 {
        match *self {
            Self::Duty { duty, .. } => duty * 100.0,
            Self::Speed { speed_counts_per_s, .. } | Self::Distance { speed_counts_per_s, .. } => {
                f64::from(speed_counts_per_s)
            }
            Self::Position { position_counts, .. } => f64::from(position_counts),
        }
    }

    /// Whether a later command of the same motor makes this one pointless if it has not been sent yet.
    #[must_use]
    pub fn is_overtaken_by_later(&self) -> bool {
        matches!(self, Self::Duty { .. } | Self::Speed { .. })
    }
}

/// Commands for one or both motors, sent together where the protocol can.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Motor 1; `None` leaves it as it is.
    pub m1: Option<DriveCommand>,
    /// Motor 2; `None` leaves it as it is.
    pub m2: Option<DriveCommand>,
}

impl Drive {
    /// One motor.
    #[must_use]
    pub fn one(motor: Motor, command: DriveCommand) -> Self {
        match motor {
            Motor::M1 => Self { m1: Some(command), m2: None },
            Motor::M2 => Self { m1: None, m2: Some(command) },
        }
    }

    /// The same for both motors.
    #[must_use]
    pub fn both(command: DriveCommand) -> Self {
        Self { m1: Some(command), m2: Some(command) }
    }

    /// The command for a motor.
    #[must_use]
    pub fn of(&self, motor: Motor) -> Option<DriveCommand> {
        match motor {
            Motor::M1 => self.m1,
            Motor::M2 => self.m2,
        }
    }

    /// Whether `later` replaces all of this, so that this one need not be sent.
    #[must_use]
    pub fn is_replaced_by(&self, later: &Self) -> bool {
        Motor::BOTH.into_iter().all(|motor| match (self.of(motor), later.of(motor)) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(mine), Some(theirs)) => mine.is_overtaken_by_later() && theirs.is_overtaken_by_later(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_duty_replaces_an_earlier_one_of_the_same_motors_only() {
        let slow = DriveCommand::duty(0.1);
        let fast = DriveCommand::duty(0.9);
        assert!(Drive::one(Motor::M1, slow).is_replaced_by(&Drive::one(Motor::M1, fast)));
        assert!(Drive::one(Motor::M1, slow).is_replaced_by(&Drive::both(fast)));
        assert!(!Drive::both(slow).is_replaced_by(&Drive::one(Motor::M1, fast)));
    }

    #[test]
    fn a_move_is_never_replaced() {
        let step = DriveCommand::Distance {
            speed_counts_per_s: 100,
            accel_counts_per_s2: None,
            distance_counts: 50,
            queued: true,
        };
        assert!(!Drive::one(Motor::M1, step).is_replaced_by(&Drive::one(Motor::M1, DriveCommand::duty(0.0))));
        assert!(!Drive::one(Motor::M1, step).is_replaced_by(&Drive::one(Motor::M1, step)));
    }
}

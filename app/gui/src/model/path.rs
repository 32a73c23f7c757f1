//! How far a controller is on its way to an axis that is tuned, saved and backed up: judged by what it holds and by what was seen of its
//! motors, so that it is true for one that was set up elsewhere.

use std::collections::BTreeSet;

use brushwork_link::Message;
use brushwork_link::device::{Channel, Sample};
use brushwork_values::Motor;

use super::IndicatorState;
use crate::family::path::{PathStep, Step};

/// How a step stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    Done,
    ToDo,
    /// Not every axis needs it, or it was left out.
    NotNeeded,
    /// The settings have not been read.
    NotKnown,
    /// Something is wrong that the next steps would suffer from.
    Wrong,
}

impl Standing {
    pub const fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::ToDo => "to do",
            Self::NotNeeded => "not needed",
            Self::NotKnown => "not known yet",
            Self::Wrong => "wrong",
        }
    }

    pub const fn mark(self) -> IndicatorState {
        match self {
            Self::Done => IndicatorState::Ok,
            Self::ToDo => IndicatorState::Active,
            Self::NotNeeded => IndicatorState::NotApplicable,
            Self::NotKnown => IndicatorState::Unknown,
            Self::Wrong => IndicatorState::Error,
        }
    }

    /// Whether something is left to do.
    pub const fn is_open(self) -> bool {
        matches!(self, Self::ToDo | Self::Wrong)
    }
}

/// A step, how it stands, and what that was seen by.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    pub step: PathStep,
    pub standing: Standing,
    pub note: Message,
}

/// What the path holds of one unit.
#[derive(Debug, Default)]
pub struct Path {
    /// The step that is looked at, if not the first one that is left.
    pub chosen: Option<Step>,
    /// The keyboard is to go to what leads to the step that is shown.
    pub wants_focus: bool,
    /// Steps that were left out.
    left_out: BTreeSet<Step>,
    pub turning: Turning,
    /// The newest backup and the settings that it was compared with, and whether it holds them.
    pub(super) compared: Option<(String, u64, bool)>,
}

impl Path {
    /// Leaves a step out, or takes it up again.
    pub fn leave_out(&mut self, step: Step, is_left_out: bool) {
        if is_left_out {
            self.left_out.insert(step);
            self.chosen = None;
        } else {
            self.left_out.remove(&step);
        }
    }

    pub fn is_left_out(&self, step: Step) -> bool {
        self.left_out.contains(&step)
    }
}

/// What was seen of the motors since the connection.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turning {
    motors: [Turns; 2],
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Turns {
    first_count: Option<f64>,
    counts: bool,
    /// So many samples in a row said the same.
    alike: u8,
    says: bool,
    /// Whether the encoder counted up while the motor was driven forward.
    agrees: Option<bool>,
}

/// A duty that turns a motor, percent.
const LEAST_DUTY: f64 = 3.0;
/// A speed that is one, counts per second.
const LEAST_SPEED: f64 = 20.0;
/// A motor that was just reversed still turns the other way for some samples.
const ALIKE: u8 = 5;
/// Fewer counts may be a shaft that trembles.
const LEAST_COUNTS: f64 = 10.0;

const DUTIES: [Channel; 2] = [Channel::M1_PWM, Channel::M2_PWM];
const SPEEDS: [Channel; 2] = [Channel::M1_VELOCITY, Channel::M2_VELOCITY];
const COUNTS: [Channel; 2] = [Channel::M1_POSITION, Channel::M2_POSITION];

impl Turning {
    pub fn note_sample(&mut self, sample: &Sample) {
        for motor in Motor::BOTH {
            let at = motor.index();
            let turns = &mut self.motors[at];
            if let Some(count) = sample.get(COUNTS[at]) {
                let first = *turns.first_count.get_or_insert(count);
                turns.counts |= (count - first).abs() >= LEAST_COUNTS;
            }
            if let (Some(duty), Some(speed)) = (sample.get(DUTIES[at]), sample.get(SPEEDS[at])) {
                turns.note(duty, speed);
            }
        }
    }

    /// Whether the encoder was seen to count the way its motor is driven.
    pub fn agrees(&self, motor: Motor) -> Option<bool> {
        self.motors[motor.index()].agrees
    }

    pub fn counts(&self, motor: Motor) -> bool {
        self.motors[motor.index()].counts
    }

    /// A direction was changed: what was seen of it is no longer so.
    pub fn forget_direction(&mut self) {
        for turns in &mut self.motors {
            (turns.alike, turns.agrees) = (0, None);
        }
    }
}

impl Turns {
    fn note(&mut self, duty_percent: f64, speed_counts_per_s: f64) {
        if duty_percent.abs() < LEAST_DUTY || speed_counts_per_s.abs() < LEAST_SPEED {
            self.alike = 0;
            return;
        }
        let says = (duty_percent > 0.0) == (speed_counts_per_s > 0.0);
        self.alike = if says == self.says { self.alike.saturating_add(1) } else { 1 };
        self.says = says;
        if self.alike >= ALIKE {
            self.agrees = Some(says);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn sample(duty_percent: f64, speed_counts_per_s: f64, count: f64) -> Sample {
        let mut sample = Sample::new(0x80);
        let at = Duration::ZERO;
        let values = [(DUTIES[0], duty_percent), (SPEEDS[0], speed_counts_per_s), (COUNTS[0], count)];
        values.into_iter().for_each(|(channel, value)| sample.set(channel, value, at, at));
        sample
    }

    #[test]
    fn a_direction_is_known_after_some_samples_that_say_the_same() {
        let mut turning = Turning::default();
        for _ in 0..ALIKE - 1 {
            turning.note_sample(&sample(12.0, 900.0, 0.0));
        }
        assert_eq!(turning.agrees(Motor::M1), None);
        turning.note_sample(&sample(12.0, 900.0, 0.0));
        assert_eq!(turning.agrees(Motor::M1), Some(true));
        assert_eq!(turning.agrees(Motor::M2), None);
        turning.forget_direction();
        for _ in 0..ALIKE {
            turning.note_sample(&sample(-12.0, 900.0, 0.0));
        }
        assert_eq!(turning.agrees(Motor::M1), Some(false));
    }

    #[test]
    fn a_motor_that_runs_down_against_its_new_duty_says_nothing_yet() {
        let mut turning = Turning::default();
        for speed in [900.0, 600.0, 300.0, 10.0, -300.0, -600.0, -700.0] {
            turning.note_sample(&sample(-20.0, speed, 0.0));
        }
        assert_eq!(turning.agrees(Motor::M1), None);
    }

    #[test]
    fn a_count_that_trembles_is_not_one_that_follows_the_shaft() {
        let mut turning = Turning::default();
        for count in [100.0, 101.0, 99.0, 105.0] {
            turning.note_sample(&sample(0.0, 0.0, count));
        }
        assert!(!turning.counts(Motor::M1));
        turning.note_sample(&sample(0.0, 0.0, 140.0));
        assert!(turning.counts(Motor::M1) && !turning.counts(Motor::M2));
    }
}

//! The profile generator of the screens that drive: what is set, what runs, and the figures of its last steps.

use crate::model::messages::MeasuredMessage;
use brushwork_core::messages::ProfilePlanMessage;
use brushwork_link::device::{ArmScope, Event, QueuedJob};
use brushwork_values::Motor;

use super::watched::{Unfinished, Watched};
use brushwork_core::motion::player::{self, JudgedStep, Played};
use brushwork_core::motion::profile::{Leg, Mode, Pace, Profile, Reach, Shape, legs, total_time};

/// The generator of one link.
#[derive(Debug)]
pub struct Generator {
    /// By screen, since each has its own unit.
    profiles: [Profile; 3],
    /// Which motors play.
    pub motors: [bool; 2],
    pub job: Watched<Played>,
    /// What was played last, and where.
    played: Option<(Mode, Played)>,
    mode: Mode,
}

/// The unit of a screen's setpoints; none for a screen that has no generator.
pub fn mode_of(scope: ArmScope) -> Option<Mode> {
    match scope {
        ArmScope::Pwm => Some(Mode::Duty),
        ArmScope::Velocity => Some(Mode::Speed),
        ArmScope::Position => Some(Mode::Position),
        ArmScope::ClampTest | ArmScope::Tuning | ArmScope::Script | ArmScope::CommandLine => None,
    }
}

impl Default for Generator {
    fn default() -> Self {
        let profile =
            |to, rate| Profile { shape: Shape::default(), from: 0.0, to, rate, dwell_s: 1.0, count: 3 };
        Self {
            profiles: [profile(30.0, 20.0), profile(5000.0, 2000.0), profile(1000.0, 0.0)],
            motors: [true, false],
            job: Watched::default(),
            played: None,
            mode: Mode::Duty,
        }
    }
}

impl Generator {
    pub fn profile(&self, mode: Mode) -> &Profile {
        &self.profiles[mode as usize]
    }

    pub fn profile_mut(&mut self, mode: Mode) -> &mut Profile {
        &mut self.profiles[mode as usize]
    }

    pub fn chosen_motors(&self) -> Vec<Motor> {
        Motor::BOTH.into_iter().filter(|motor| self.motors[motor.index()]).collect()
    }

    /// The legs of what is set, or why there are none: a sentence.
    pub fn plan(
        &self,
        mode: Mode,
        pace: Pace,
        reaches: [Option<Reach>; 2],
    ) -> Result<Vec<Leg>, ProfilePlanMessage> {
        let motors = self.chosen_motors();
        if motors.is_empty() {
            return Err(ProfilePlanMessage::NoMotor);
        }
        let mut common: Option<Reach> = None;
        for motor in motors {
            let Some(reach) = reaches[motor.index()] else {
                return Err(ProfilePlanMessage::NoReach { motor });
            };
            common = Some(match common {
                None => reach,
                Some(other) => Reach {
                    low: reach.low.max(other.low),
                    high: reach.high.min(other.high),
                    qpps: reach.qpps.min(other.qpps),
                },
            });
        }
        let reach = common.ok_or(ProfilePlanMessage::NoMotor)?;
        legs(mode, self.profile(mode), pace, reach)
    }

    /// What to ask of the device thread to play what is set.
    pub fn begin(
        &mut self,
        mode: Mode,
        pace: Pace,
        reaches: [Option<Reach>; 2],
    ) -> Result<QueuedJob, ProfilePlanMessage> {
        let legs = self.plan(mode, pace, reaches)?;
        let motors = self.chosen_motors();
        let job = self.job.begin(player::job(player::Task { mode, motors, legs }));
        let job = job.ok_or(ProfilePlanMessage::Plays)?;
        (self.mode, self.played) = (mode, None);
        Ok(job)
    }

    /// Another unit, or none.
    pub fn forget(&mut self) {
        self.job.forget();
        self.played = None;
    }

    /// The last two steps of each motor, if the screen's profile was the last that was played.
    pub fn last_steps(&self, mode: Mode) -> Vec<&JudgedStep> {
        let Some((_, played)) = self.played.as_ref().filter(|(of, _)| *of == mode) else { return Vec::new() };
        let of = |motor: Motor| {
            let steps: Vec<_> = played.steps.iter().filter(|step| step.motor == motor).collect();
            steps[steps.len().saturating_sub(2)..].to_vec()
        };
        Motor::BOTH.into_iter().flat_map(of).collect()
    }

    /// Takes in an event of its job; at the end whether it was played to its end.
    pub fn take(&mut self, event: Event) -> Option<Result<(), Unfinished>> {
        let result = self.job.take_result(event)?;
        Some(result.map(|played| self.played = Some((self.mode, played))))
    }
}

/// "12.5 s", and "at least 3.0 s" where the motors decide.
pub fn duration_text(legs: &[Leg]) -> String {
    let seconds = total_time(legs).as_secs_f64();
    let is_open = legs.iter().any(|leg| !matches!(leg, Leg::Hold { .. }));
    if is_open {
        MeasuredMessage::TakesAtLeast { seconds }.to_string()
    } else {
        MeasuredMessage::Takes { seconds }.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PACE: Pace = Pace { accel: 1000.0, decel: 1000.0, speed: 1000.0 };

    fn reach(high: f64) -> Option<Reach> {
        Some(Reach { low: -high, high, qpps: high })
    }

    #[test]
    fn two_motors_keep_to_what_both_can_do() {
        let mut generator = Generator::default();
        assert!(generator.plan(Mode::Speed, PACE, [reach(9000.0), reach(4000.0)]).is_ok());
        generator.motors = [true, true];
        let refused =
            generator.plan(Mode::Speed, PACE, [reach(9000.0), reach(4000.0)]).unwrap_err().to_string();
        assert!(refused.contains("-4000 to 4000"), "{refused}");
        let refused = generator.plan(Mode::Speed, PACE, [reach(9000.0), None]).unwrap_err().to_string();
        assert!(refused.starts_with("M2 has no range"), "{refused}");
        generator.motors = [false, false];
        assert!(
            generator.plan(Mode::Speed, PACE, [None, None]).unwrap_err().to_string().contains("No motor")
        );
    }
}

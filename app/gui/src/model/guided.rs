//! What the screens that drive ask of a connection beyond its sliders: a profile to be played, QPPS to be measured.

use brushwork_core::messages::ProfilePlanMessage;
use brushwork_link::device::{Channel, QueuedJob};
use brushwork_values::Motor;

use super::generator::mode_of;
use super::loop_settings::QPPS;
use super::position::{Seen, Travels};
use super::{Connection, Owner, Screen, Tab};
use brushwork_core::motion::profile::{Leg, Mode, Pace, Reach};

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuidedAction {
    /// Plays the profile of the screen that is open.
    Play,
    MeasureQpps,
    Cancel,
}

/// What a slider spans of a travel that has no ends to speak of: so long at full speed to either side of where the motor is, s, and so many
/// counts at the least. It moves on in steps of as much, so that a slider stays while a motor runs.
const NEAR_S: f64 = 5.0;
const NEAR_COUNTS: f64 = 10_000.0;

/// The part of a travel that is near the motor: all of it, unless it is far wider than what the motor does in some seconds.
fn near((low, high): (f64, f64), counts: f64, full_speed: f64) -> (f64, f64) {
    let near = (NEAR_S * full_speed).max(NEAR_COUNTS);
    if high - low <= 8.0 * near {
        return (low, high);
    }
    let middle = (counts / near).round() * near;
    ((middle - 2.0 * near).max(low), (middle + 2.0 * near).min(high))
}

impl Connection {
    /// Whether a job moves the motors, or may; the sliders rest meanwhile.
    pub fn is_guided(&self) -> bool {
        self.generator.job.is_running() || self.qpps.job.is_running() || self.may_owe()
    }

    /// Whether something runs that puts back what it changed when it ends: until then the unit must not be turned away from.
    pub fn may_owe(&self) -> bool {
        self.tune.is_running() || self.examination.is_running()
    }

    /// The legs of the profile that is set, or why there are none.
    pub fn plan(&self, mode: Mode) -> Result<Vec<Leg>, ProfilePlanMessage> {
        self.generator.plan(mode, self.pace(mode), self.reaches(mode))
    }

    /// A job to ask of the device thread, and whose it is; or why none can be.
    pub fn begin_guided(
        &mut self,
        action: GuidedAction,
        screen: Screen,
    ) -> Result<Option<(Owner, QueuedJob)>, ProfilePlanMessage> {
        let nothing = || ProfilePlanMessage::JobRuns;
        match action {
            GuidedAction::Cancel => {
                self.generator.job.cancel();
                self.qpps.job.cancel();
                self.general.clamp.job.cancel();
                Ok(None)
            }
            GuidedAction::MeasureQpps | GuidedAction::Play if self.is_guided() => Err(nothing()),
            GuidedAction::MeasureQpps => {
                let job = self.qpps.begin(self.pwm.accel_percent_per_s).ok_or_else(nothing)?;
                Ok(Some((Owner::Qpps, job)))
            }
            GuidedAction::Play => {
                let mode = screen.arm_scope().and_then(mode_of).ok_or_else(nothing)?;
                let (pace, reaches) = (self.pace(mode), self.reaches(mode));
                Ok(Some((Owner::Generator, self.generator.begin(mode, pace, reaches)?)))
            }
        }
    }

    /// The job was not taken.
    pub fn guided_not_begun(&mut self) {
        self.generator.job.forget();
        self.qpps.job.forget();
    }

    /// Puts what was measured into the settings of the PWM screen, where it is applied.
    pub fn take_over_qpps(&mut self, motor: Motor, counts_per_s: f64) {
        if let Some(unit) = self.settings.unit_mut() {
            unit.edit(motor, QPPS, counts_per_s);
            self.loops.note_edit();
        }
        if self.drawers.open(Screen::Pwm) != Some(Tab::Settings) {
            self.drawers.press(Screen::Pwm, Tab::Settings);
        }
    }

    /// Nobody can hold a jog button: what one asked for ends.
    pub fn release_jogs(&mut self) {
        let (qpps, travels) = (self.top_speeds(), self.travels());
        let seen = Motor::BOTH.map(|motor| self.seen(motor));
        for motor in Motor::BOTH {
            self.pwm.jog(motor, None);
            self.velocity.jog(motor, None, qpps);
            self.position.jog(motor, None, travels, seen);
        }
    }

    /// Speed at full duty of each motor, counts/s; 0 where it was not read.
    pub fn top_speeds(&self) -> [f64; 2] {
        let unit = self.settings.unit();
        Motor::BOTH
            .map(|motor| unit.and_then(|unit| unit.qpps(motor)).unwrap_or(0.0).min(f64::from(i32::MAX)))
    }

    pub fn travels(&self) -> Travels {
        match self.family().has_loops() {
            true => Motor::BOTH.map(|motor| self.settings.unit()?.travel(motor)),
            false => [self.virtual_travel(), None],
        }
    }

    /// The part of each travel that sliders and jogs span.
    pub fn near_travels(&self) -> Travels {
        let travels = self.travels();
        Motor::BOTH.map(|motor| {
            let full_speed = self.top_speeds()[motor.index()];
            travels[motor.index()].map(|travel| near(travel, self.seen(motor).counts, full_speed))
        })
    }

    /// Where a motor was seen last.
    pub fn seen(&self, motor: Motor) -> Seen {
        let (position, velocity) = match motor {
            Motor::M1 => (Channel::M1_POSITION, Channel::M1_VELOCITY),
            Motor::M2 => (Channel::M2_POSITION, Channel::M2_VELOCITY),
        };
        let read = |channel: Channel| self.link.readings.get(channel).unwrap_or(0.0);
        Seen { counts: read(position), counts_per_s: read(velocity) }
    }

    fn pace(&self, mode: Mode) -> Pace {
        let position = &self.position;
        let accel = match mode {
            Mode::Duty => self.pwm.accel_percent_per_s,
            Mode::Speed => self.velocity.accel_counts_per_s2,
            Mode::Position => position.accel_counts_per_s2,
        };
        Pace { accel, decel: position.decel_counts_per_s2, speed: position.speed_counts_per_s }
    }

    /// What each motor can be asked for; none where its settings say nothing.
    fn reaches(&self, mode: Mode) -> [Option<Reach>; 2] {
        Motor::BOTH.map(|motor| {
            let qpps = self.top_speeds()[motor.index()];
            match mode {
                Mode::Duty => Some(Reach { low: -100.0, high: 100.0, qpps }),
                Mode::Speed => (qpps >= 1.0).then_some(Reach { low: -qpps, high: qpps, qpps }),
                Mode::Position => {
                    self.settings.unit()?.travel(motor).map(|(low, high)| Reach { low, high, qpps })
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_travel_without_ends_to_speak_of_is_cut_to_what_is_near_the_motor() {
        let endless = (-2e9, 2e9);
        assert_eq!(near(endless, 0.0, 10_000.0), (-100_000.0, 100_000.0));
        assert_eq!(near(endless, 60_000.0, 10_000.0), (-50_000.0, 150_000.0));
        assert_eq!(
            near(endless, 60_100.0, 10_000.0),
            near(endless, 60_000.0, 10_000.0),
            "it stays for a while"
        );
        assert_eq!(near((-2_000.0, 2_000.0), 1_500.0, 10_000.0), (-2_000.0, 2_000.0));
        assert_eq!(near((0.0, 2e9), 0.0, 0.0), (0.0, 20_000.0));
    }
}

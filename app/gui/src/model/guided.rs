//! What the screens that drive ask of a desk beyond its sliders: a profile to be played, QPPS to be measured.

use brushwork_link::device::{Channel, Event, Request};
use brushwork_values::Motor;

use super::desk::Desk;
use super::drawer::Tab;
use super::generator::mode_of;
use super::link::Effect;
use super::message::Gravity;
use super::position::{Seen, Travels};
use super::screen::Screen;
use brushwork_core::motion::profile::{Leg, Mode, Pace, Reach};

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GuidedWish {
    /// Plays the profile of the screen that is open.
    Play,
    MeasureQpps,
    Cancel,
}

impl Desk {
    /// Whether a job moves the motors; the sliders rest meanwhile.
    pub fn is_guided(&self) -> bool {
        self.generator.is_running() || self.qpps.is_running() || self.tune.is_running()
    }

    /// The legs of the profile that is set, or why there are none.
    pub fn plan(&self, mode: Mode) -> Result<Vec<Leg>, String> {
        self.generator.plan(mode, self.pace(mode), self.reaches(mode))
    }

    /// What to ask of the device thread, or why nothing can be.
    pub fn guided_request(&mut self, wish: GuidedWish, screen: Screen) -> Result<Request, String> {
        let nothing = || "A job runs already. Wait for it or cancel it.".to_owned();
        match wish {
            GuidedWish::Cancel => Ok(Request::CancelJob),
            _ if self.is_guided() => Err(nothing()),
            GuidedWish::MeasureQpps => self.qpps.begin(self.pwm.accel_percent_per_s).ok_or_else(nothing),
            GuidedWish::Play => {
                let mode = screen.arm_scope().and_then(mode_of).ok_or_else(nothing)?;
                let (pace, reaches) = (self.pace(mode), self.reaches(mode));
                self.generator.begin(mode, pace, reaches)
            }
        }
    }

    /// The request was not taken.
    pub fn guided_not_begun(&mut self) {
        self.generator.not_begun();
        self.qpps.not_begun();
    }

    /// Puts what was measured into the settings of the PWM screen, where it is applied.
    pub fn take_over_qpps(&mut self, motor: Motor, counts_per_s: f64) {
        self.loops.edit_qpps(motor, counts_per_s);
        if self.drawers.open(Screen::Pwm) != Some(Tab::Settings) {
            self.drawers.press(Screen::Pwm, Tab::Settings);
        }
    }

    /// Whether the event is about such a job.
    pub(super) fn awaits_guided(&self, event: &Event) -> bool {
        self.generator.awaits(event) || self.qpps.awaits(event)
    }

    /// Takes in an event that it awaits.
    pub(super) fn take_guided(&mut self, event: Event) -> Vec<Effect> {
        let ended = matches!(event, Event::JobEnded(_));
        let (sentence, done) = if self.generator.awaits(&event) {
            (self.generator.take(event), "The profile was played to its end. The motors were stopped.")
        } else {
            (self.qpps.take(event), "QPPS was measured. The motors were stopped.")
        };
        match sentence {
            Some(text) if text.starts_with("Could not") => vec![Effect::Say(Gravity::Error, text)],
            Some(text) => vec![Effect::Say(Gravity::Warning, text)],
            None if ended => vec![Effect::Say(Gravity::Note, done.to_owned())],
            None => Vec::new(),
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
        Motor::BOTH.map(|motor| self.loops.qpps(motor).unwrap_or(0.0).min(f64::from(i32::MAX)))
    }

    pub fn travels(&self) -> Travels {
        match self.family().has_loops() {
            true => Motor::BOTH.map(|motor| self.loops.travel(motor)),
            false => [self.virtual_travel(), None],
        }
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
                Mode::Position => self.loops.travel(motor).map(|(low, high)| Reach { low, high, qpps }),
            }
        })
    }
}

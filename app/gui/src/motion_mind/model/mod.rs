//! What a Motion Mind 3 has of its own in the window: what its mode lets this program drive, and the state of its screens.

use brushwork_link::{Event, Identity, Request, Sample, SettingValue};
use brushwork_motion_mind_client::MotionMindFacts;
use brushwork_motion_mind_wire::register_named;
use std::time::Duration;

use crate::family::{Known, Own};
use crate::model::screen::Screen;

pub mod connection;
pub mod drive;
pub mod family;
pub mod radio;
pub mod registers;
pub mod steps;
pub mod terminal;
mod words;

use drive::Reach;
use radio::Radio;
use registers::{FUNCTION, Live, bit_key, key};
use steps::StepAssistant;
use terminal::Terminal;

/// The state of a Motion Mind's screens.
#[derive(Debug, Default)]
pub struct MotionMindConnection {
    /// All registers as read last, while a screen shows them.
    pub live: Live,
    /// The register that is explained, by its number.
    pub register: u8,
    /// What the sliders reach.
    pub reach: Reach,
    pub steps: StepAssistant,
    pub radio: Radio,
    pub terminal: Terminal,
}

/// What serial commands can move, by the mode and one bit (Motion Mind manual, chapter 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// Mode 3: a duty.
    Duty,
    /// Mode 4: a velocity, and positions.
    Loop,
    /// Mode 5 with ADSERIAL: positions.
    Position,
    /// Something else moves the motor, or nothing does.
    Nothing,
}

impl Driven {
    /// What the mode and ADSERIAL say.
    pub const fn of(mode: u8, takes_serial_setpoint: bool) -> Self {
        match mode {
            3 => Self::Duty,
            4 => Self::Loop,
            5 if takes_serial_setpoint => Self::Position,
            _ => Self::Nothing,
        }
    }

    /// The screens that drive, or the one that says why there is none.
    pub const fn screens(self) -> &'static [Screen] {
        match self {
            Self::Duty => &[Screen::Pwm],
            Self::Loop => &[Screen::Velocity, Screen::Position],
            Self::Position => &[Screen::Position],
            Self::Nothing => &[Screen::Motion],
        }
    }
}

impl Own for MotionMindConnection {
    fn take(&mut self, event: &Event) -> bool {
        self.terminal.note(event);
        if !self.live.take(event) {
            return false;
        }
        if let Some(count) = register_named(registers::RCCOUNT).and_then(|row| self.live.get(row)) {
            self.radio.note(count);
        }
        true
    }

    fn note_sample(&mut self, sample: &Sample) {
        self.steps.note_sample(sample);
    }

    fn rest(&mut self) {
        self.steps.give_up();
    }

    fn read(&mut self, unit: &Identity, now: Duration) -> Option<Request> {
        MotionMindFacts::of(unit)?;
        self.live.read(now)
    }

    /// The virtual limits, where they act.
    fn travel(&self, confirmed: Known<'_>, known: Known<'_>) -> Option<(f64, f64)> {
        let limit = |name: &str| {
            let register = register_named(name)?;
            match confirmed(&key(register)) {
                Some(SettingValue::Int(value)) => Some(value as f64),
                _ => self.live.get(register).map(|value| value as f64),
            }
        };
        let limits = limit("VNLIMIT").zip(limit("VPLIMIT"))?;
        let act = known(&bit_key(FUNCTION, "VIRTLIMIT")) == Some(SettingValue::Bool(true));
        (act && limits.0 < limits.1).then_some(limits)
    }

    fn not_read(&mut self) {
        self.live.not_begun();
    }

    fn not_sent(&mut self, id: u64) {
        self.terminal.not_sent(id);
    }

    fn forget_unit(&mut self) {
        self.live.forget();
        self.radio.give_up();
        self.steps = StepAssistant::default();
        self.terminal.link_ended();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_three_modes_are_driven_over_serial() {
        let driven: Vec<u8> = (0..8).filter(|mode| Driven::of(*mode, true) != Driven::Nothing).collect();
        assert_eq!(driven, [3, 4, 5]);
        assert_eq!(Driven::of(5, false), Driven::Nothing);
    }
}

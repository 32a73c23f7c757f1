//! The step-response assistant (Motion Mind manual 3.14): five stages, a step in each, and what the response says.

use std::time::Duration;

use brushwork_link::{Channel, Sample, SettingValue, SettingsImage};
use brushwork_motion_mind_wire::register_named;
use brushwork_tuning::{Point, StepFigures};

use super::registers::{bit_key, key};

/// How long a response is recorded.
const RECORD: Duration = Duration::from_secs(4);
/// Beyond this share of the step it is an overshoot worth a word.
const OVERSHOOT: f64 = 0.15;
/// Within this share of the step the motor has arrived.
const ARRIVED: f64 = 0.1;

/// One stage of the manual's recipe.
#[derive(Debug)]
pub struct Stage {
    pub title: &'static str,
    pub text: &'static str,
    /// What is offered to be changed.
    pub changes: &'static [Change],
}

/// One change of a register, by a button.
#[derive(Debug)]
pub struct Change {
    pub label: &'static str,
    pub hint: &'static str,
    register: &'static str,
    turn: Turn,
}

/// How a change makes a new value of the old one.
#[derive(Debug)]
enum Turn {
    Times(f64),
    Plus(i64),
    /// From 0 the first value; else times two.
    Raise(i64),
    Zero,
}

const P_UP: Change = Change { label: "P +25 %", hint: "PTERM", register: "PTERM", turn: Turn::Times(1.25) };
const P_DOWN: Change =
    Change { label: "P −20 %", hint: "PTERM", register: "PTERM", turn: Turn::Times(0.8) };
const STRONGER: Change = Change {
    label: "Output ×2",
    hint: "PIDSCALAR one less: the whole output of the PID doubles",
    register: "PIDSCALAR",
    turn: Turn::Plus(-1),
};
const WEAKER: Change = Change {
    label: "Output ÷2",
    hint: "PIDSCALAR one more: the whole output of the PID halves",
    register: "PIDSCALAR",
    turn: Turn::Plus(1),
};
const I_UP: Change =
    Change { label: "I up", hint: "ITERM doubles", register: "ITERM", turn: Turn::Raise(10) };
const I_DOWN: Change = Change { label: "I ÷2", hint: "ITERM", register: "ITERM", turn: Turn::Times(0.5) };
const I_OFF: Change = Change { label: "I = 0", hint: "ITERM", register: "ITERM", turn: Turn::Zero };
const D_UP: Change =
    Change { label: "D up", hint: "DTERM doubles", register: "DTERM", turn: Turn::Raise(500) };
const D_DOWN: Change = Change { label: "D ÷2", hint: "DTERM", register: "DTERM", turn: Turn::Times(0.5) };

/// The stages, in the manual's order.
pub const STAGES: [Stage; 5] = [
    Stage {
        title: "Prepare",
        text: "Set VELOCITYFF, ITERM and DTERM to 0 and clear VELLIMIT and SATPROT, in RAM. Give the motor room for a turn \
               of its encoder either way, then arm the screen.",
        changes: &[],
    },
    Stage {
        title: "P and scale",
        text: "Step by about one turn of the encoder. Change PTERM and PIDSCALAR until the motor goes about there. \
               One step of PIDSCALAR is a factor of two.",
        changes: &[STRONGER, WEAKER, P_UP, P_DOWN],
    },
    Stage {
        title: "I",
        text: "Go on stepping while ITERM goes up: the motor should be nudged into the last counts. Too much makes it \
               oscillate: lower ITERM, raise PTERM, or set SATPROT.",
        changes: &[I_UP, I_DOWN, P_UP, I_OFF],
    },
    Stage {
        title: "D",
        text: "Go on stepping while DTERM goes up: the overshoot gets less. Too much makes the motor noisy.",
        changes: &[D_UP, D_DOWN],
    },
    Stage {
        title: "Other steps",
        text: "Try larger and smaller steps with all settings. When they are good, keep them: Save to EEPROM on the \
               Registers screen.",
        changes: &[P_UP, P_DOWN, I_UP, I_DOWN, D_UP, D_DOWN, STRONGER, WEAKER],
    },
];

impl Change {
    /// The value after the change; none where the register has it already.
    fn made(&self, held: i64) -> Option<i64> {
        let row = register_named(self.register)?;
        let scaled = |factor: f64| (held as f64 * factor).round() as i64;
        let wanted = match self.turn {
            // A small whole number moves by one at least.
            Turn::Times(factor) if factor > 1.0 => scaled(factor).max(held + 1),
            Turn::Times(factor) => scaled(factor).min(held - 1),
            Turn::Plus(by) => held + by,
            Turn::Raise(first) if held == 0 => first,
            Turn::Raise(_) => held * 2,
            Turn::Zero => 0,
        };
        let wanted = wanted.clamp(*row.range.start(), *row.range.end());
        (wanted != held).then_some(wanted)
    }

    /// The change as settings of what the registers hold; none where the register is not known or at its end.
    pub fn image(&self, held: impl Fn(&str) -> Option<i64>) -> Option<SettingsImage> {
        let row = register_named(self.register)?;
        let wanted = self.made(held(self.register)?)?;
        Some(std::iter::once((key(row), SettingValue::Int(wanted))).collect())
    }
}

/// What the first stage writes.
pub fn prepared() -> SettingsImage {
    let zero = ["VELOCITYFF", "ITERM", "DTERM"].into_iter().filter_map(register_named);
    let zero = zero.map(|row| (key(row), SettingValue::Int(0)));
    let clear = ["VELLIMIT", "SATPROT"].map(|bit| (bit_key("FUNCTION", bit), SettingValue::Bool(false)));
    zero.chain(clear).collect()
}

/// The keys that the assistant may change, to be put back.
pub(super) fn touched() -> impl Iterator<Item = String> {
    let registers =
        ["VELOCITYFF", "PTERM", "ITERM", "DTERM", "PIDSCALAR"].into_iter().filter_map(register_named);
    registers.map(key).chain(["VELLIMIT", "SATPROT"].map(|bit| bit_key("FUNCTION", bit)))
}

/// The state of the assistant.
#[derive(Debug, Default)]
pub struct StepAssistant {
    pub stage: usize,
    recording: Option<Recording>,
    pub last: Option<Outcome>,
    /// What the registers were when the assistant began.
    pub before: Option<SettingsImage>,
}

#[derive(Debug)]
struct Recording {
    start: f64,
    target: f64,
    /// When the step was asked for: the first sample after it.
    began: Option<Duration>,
    points: Vec<Point>,
}

/// What a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    pub step_counts: f64,
    pub figures: StepFigures,
    /// Turns of direction about the target: a motor that oscillates.
    pub reversals: usize,
}

impl StepAssistant {
    /// A step is about to be asked for, from where the motor is.
    pub fn begin(&mut self, start: f64, target: f64) {
        if start != target {
            self.recording = Some(Recording { start, target, began: None, points: Vec::new() });
        }
    }

    pub fn is_recording(&self) -> bool {
        self.recording.is_some()
    }

    /// Takes in a sample of the unit.
    pub fn note_sample(&mut self, sample: &Sample) {
        let Some(recording) = &mut self.recording else { return };
        let (Some(value), Some(at)) =
            (sample.get(Channel::M1_POSITION), sample.read_at(Channel::M1_POSITION))
        else {
            return;
        };
        let began = *recording.began.get_or_insert(at);
        let time = at.saturating_sub(began);
        recording.points.push(Point { time_s: time.as_secs_f64(), value });
        if time >= RECORD {
            self.last = self.recording.take().and_then(|recording| recording.outcome());
        }
    }

    /// The motor was stopped, or the unit is another: what was recorded says nothing.
    pub fn give_up(&mut self) {
        self.recording = None;
    }

    /// Remembers what the registers are, once, so that they can be put back.
    pub fn remember(&mut self, connection_values: SettingsImage) {
        self.before.get_or_insert(connection_values);
    }

    /// The registers are as they were.
    pub fn is_back(&mut self) {
        self.before = None;
    }

    /// What the last step says about the next change.
    pub fn advice(&self) -> &'static str {
        let Some(last) = self.last else { return "Make a step: its figures stand here afterwards." };
        let share = (last.figures.final_error / last.step_counts).abs();
        match self.stage {
            _ if last.reversals > 4 && self.stage >= 2 => {
                "It oscillates. Lower ITERM, raise PTERM, or set SATPROT on the Registers screen."
            }
            _ if last.reversals > 4 => "It oscillates. Lower PTERM, or raise PIDSCALAR by one.",
            0 | 1 if share > 0.5 => {
                "It moves too little. Lower PIDSCALAR by one (output ×2), or raise PTERM."
            }
            0 | 1 if share > ARRIVED => {
                "It goes about there. A little more PTERM brings it nearer; the rest is for ITERM."
            }
            0 | 1 if last.figures.overshoot > OVERSHOOT => {
                "It gets there and overshoots. A little less PTERM, or leave it to DTERM."
            }
            0 | 1 => "It gets there. Go on to ITERM.",
            2 if share > 0.02 => "It stays short of the target. Raise ITERM.",
            2 => "It is nudged into place. Go on to DTERM.",
            3 if last.figures.overshoot > OVERSHOOT => "It overshoots. Raise DTERM.",
            3 => "Little overshoot. Go on with other step sizes.",
            _ if share > ARRIVED || last.figures.overshoot > OVERSHOOT => {
                "This step size is not good yet: go back to the stage that fits."
            }
            _ => "This step size is good too.",
        }
    }
}

impl Recording {
    fn outcome(&self) -> Option<Outcome> {
        let figures = StepFigures::of(&self.points, self.start, self.target)?;
        let step = self.target - self.start;
        // Which side of the target it is on, with a band in which it is on neither.
        let sides = self.points.iter().filter_map(|point| {
            let off = point.value - self.target;
            (off.abs() > 0.03 * step.abs()).then_some(off > 0.0)
        });
        let sides: Vec<bool> = sides.collect();
        let reversals = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
        Some(Outcome { step_counts: step, figures, reversals })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn response(value: impl Fn(f64) -> f64) -> StepAssistant {
        let mut assistant = StepAssistant { stage: 1, ..StepAssistant::default() };
        assistant.begin(0.0, 1000.0);
        for index in 0..=45 {
            let at = Duration::from_millis(index * 100);
            let mut sample = Sample::new(1);
            sample.set(Channel::M1_POSITION, value(at.as_secs_f64()), at, at);
            assistant.note_sample(&sample);
        }
        assert!(!assistant.is_recording());
        assistant
    }

    #[test]
    fn a_motor_that_falls_short_is_told_to_get_more_and_one_that_arrives_goes_on() {
        assert!(response(|_| 300.0).advice().contains("too little"));
        assert!(response(|t| 1000.0 * (1.0 - (-t / 0.2).exp())).advice().contains("Go on to ITERM"));
        let oscillating = |t: f64| 1000.0 + 800.0 * (t * 8.0).cos();
        let assistant = response(oscillating);
        assert!(assistant.last.unwrap().reversals > 4, "{:?}", assistant.last);
        assert!(assistant.advice().contains("oscillates"));
    }

    #[test]
    fn a_change_keeps_to_the_range_of_its_register_and_always_changes() {
        assert_eq!(STRONGER.made(0), None, "PIDSCALAR ends at 0");
        assert_eq!(WEAKER.made(14), Some(15));
        assert_eq!(P_UP.made(1), Some(2));
        assert_eq!(P_UP.made(65_000), Some(65_535));
        assert_eq!((I_UP.made(0), I_UP.made(10), I_OFF.made(0)), (Some(10), Some(20), None));
        assert_eq!(P_DOWN.made(0), None);
    }

    #[test]
    fn the_first_stage_clears_what_the_manual_says() {
        let image = prepared();
        assert_eq!(image.get("register.iterm"), Some(SettingValue::Int(0)));
        assert_eq!(image.get("function.satprot"), Some(SettingValue::Bool(false)));
        assert_eq!(image.iter().count(), 5);
    }
}

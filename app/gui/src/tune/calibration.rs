//! Calibration by hand, step by step: MCP manual 2.4.6 for the velocity loop, 2.4.7 for the position loop.
//!
//! Each step says what to do, offers the changes it is made of, and says what the motor's last moves speak for.

use brushwork_values::{Message, Motor};

use super::messages::AdviceMessage;
use super::observe::{Observation, Observer};
use super::registers::value_of;
use super::which::Loop;
use crate::messages::PathMessage;
use brushwork_core::tune::law::AnyRegisters;
use brushwork_tuning::registers::RegisterTable as _;

/// P of the position loop to begin with, 2000 on the wire (MCP manual 2.4.7), which is about 2 counts/s per count.
const FIRST_POSITION_P: f64 = 2000.0 / 1024.0;
/// Travel of an axis without end stops: so long at full speed to either side, s, and so many counts at the least. The MCP manual (2.4.7) has
/// 2 billion, within which no slider can be set and no limit ends a mistake.
const NO_STOPS_S: f64 = 60.0;
const NO_STOPS_COUNTS: f64 = 10_000.0;
/// Hardly moved: what is left of the way, as a share.
const HARDLY: f64 = 0.9;
/// Near enough to the setpoint to go on, as a share.
const NEAR: f64 = 0.05;
/// Exact, as a share.
const EXACT: f64 = 0.01;
/// Overshoot that is some, and that is too much.
const SOME_OVERSHOOT: f64 = 0.03;
const MUCH_OVERSHOOT: f64 = 0.25;

/// Where the assistant stands, for one loop.
#[derive(Clone, Debug)]
pub struct Calibration {
    pub motor: Motor,
    pub step: usize,
    observers: [Observer; 2],
}

impl Default for Calibration {
    fn default() -> Self {
        Self { motor: Motor::M1, step: 0, observers: <[Observer; 2]>::default() }
    }
}

/// One step.
#[derive(Debug)]
pub struct Step {
    pub title: &'static str,
    pub text: &'static str,
    pub changes: &'static [Change],
}

/// A change that a button makes.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    pub label: &'static str,
    pub hint: &'static str,
    make: fn(&mut AnyRegisters),
}

fn set(registers: &mut AnyRegisters, key: &str, change: impl Fn(f64) -> f64) {
    if let Some(field) = AnyRegisters::fields().into_iter().find(|field| field.key == key)
        && let Some(value) = registers.value(field)
    {
        registers.set_value(field, change(value));
    }
}

/// Limits for a motor without end stops.
fn set_no_stops(registers: &mut AnyRegisters) {
    let qpps = AnyRegisters::fields().into_iter().find(|field| field.key == "velocity.qpps");
    let qpps = qpps.and_then(|field| registers.value(field)).unwrap_or(0.0);
    let reach = (NO_STOPS_S * qpps).max(NO_STOPS_COUNTS);
    set(registers, "position.min", |_value| -reach);
    set(registers, "position.max", |_value| reach);
}

macro_rules! change {
    ($label:literal, $hint:literal, $($key:literal: |$value:ident| $new:expr),+) => {
        Change { label: $label, hint: $hint, make: |registers| { $(set(registers, $key, |$value| $new);)+ } }
    };
}

/// The steps of MCP manual 2.4.6.
pub const VELOCITY_STEPS: [Step; 5] = [
    Step {
        title: "Full speed",
        text: "QPPS is the speed at 100 % duty in counts/s. Measure it on the PWM screen, or enter an estimate under Velocity loop \
               if the motor cannot run freely. The slider here reaches as far as QPPS.",
        changes: &[],
    },
    Step {
        title: "First values",
        text: "Begin with P 1, I 0, D 0. Arm the screen and move the slider a little. If the motor stands still, raise P. If it \
               runs off at full speed at once, stop: the motor leads or the encoder wires are swapped.",
        changes: &[change!("Set P 1, I 0, D 0", "The values that the procedure begins with",
                "velocity.p": |_value| 1.0, "velocity.i": |_value| 0.0, "velocity.d": |_value| 0.0)],
    },
    Step {
        title: "P",
        text: "Ask for a moderate speed, a third of the range. Raise P until the speed comes near to it. When the motor vibrates, go \
               back to two thirds.",
        changes: &[
            change!("P up 25 %", "A stronger answer to the same error", "velocity.p": |p| (p * 1.25).max(p + 0.05)),
            change!("P to two thirds", "What the procedure does against a vibration", "velocity.p": |p| p * 2.0 / 3.0),
        ],
    },
    Step {
        title: "I",
        text: "Raise I in steps of 0.1 until the speed is exact. Too much of it makes the motor rough: it oscillates about the setpoint.",
        changes: &[
            change!("I up 0.1", "Makes good what P leaves, sooner", "velocity.i": |i| i + 0.1),
            change!("I up 0.02", "A small step, for quick motors", "velocity.i": |i| i + 0.02),
            change!("I down 0.1", "Less of it, against oscillation", "velocity.i": |i| i - 0.1),
            change!("I to two thirds", "Less of it, against oscillation", "velocity.i": |i| i * 2.0 / 3.0),
        ],
    },
    Step {
        title: "D",
        text: "D usually stays 0. Only if P and I cannot be made strong enough without overshoot, a little D damps them; it also makes \
               noise, which can oscillate by itself.",
        changes: &[
            change!("D up 0.1", "Damps overshoot, adds noise", "velocity.d": |d| d + 0.1),
            change!("D to 0", "As the procedure leaves it", "velocity.d": |_value| 0.0),
        ],
    },
];

/// The steps of MCP manual 2.4.7.
pub const POSITION_STEPS: [Step; 5] = [
    Step {
        title: "Speed and travel",
        text: "QPPS must be set as for the velocity loop. For simple position control P, I and D of the velocity loop are 0. Set Min \
               and Max under Position loop with some margin before each end stop; a motor without stops gets a minute at full speed each way. Travel \
               speed is best QPPS.",
        changes: &[
            change!("Velocity P, I, D to 0", "The position loop then acts on the duty itself",
                "velocity.p": |_value| 0.0, "velocity.i": |_value| 0.0, "velocity.d": |_value| 0.0),
            Change {
                label: "No end stops: a minute each way",
                hint: "Only for axes that turn without end: what QPPS makes in a minute, to either side of 0",
                make: set_no_stops,
            },
        ],
    },
    Step {
        title: "First values",
        text: "Begin with P 2000 on the wire, which is about 2 here, and I and D 0. Arm the screen and move the slider: the motor must \
               go the right way and stop, not necessarily near.",
        changes: &[
            change!("Set P 2, I 0, D 0", "The values that the procedure begins with", "position.p": |_value| FIRST_POSITION_P,
                "position.i": |_value| 0.0, "position.d": |_value| 0.0, "position.max_i": |_value| 0.0),
        ],
    },
    Step {
        title: "P, then D",
        text: "Raise P until each move overshoots a little. Then raise D, which damps the end of a move, until it does not. D is often 5 \
               to 20 times P. Go on with both until the motor is quick enough.",
        changes: &[
            change!("P up 25 %", "Quicker, with more overshoot", "position.p": |p| (p * 1.25).max(p + 0.05)),
            change!("P down 20 %", "Slower, with less overshoot", "position.p": |p| p * 0.8),
            Change {
                label: "D to 5 × P",
                hint: "Where the useful values of D usually begin",
                make: |registers| {
                    let p = value_of(registers, "position.p").unwrap_or_default();
                    set(registers, "position.d", |_value| 5.0 * p);
                },
            },
            change!("D up 25 %", "More damping", "position.d": |d| (d * 1.25).max(d + 0.5)),
            change!("D down 20 %", "Less damping, less noise", "position.d": |d| d * 0.8),
        ],
    },
    Step {
        title: "I and deadzone",
        text: "I brings the axis to the exact position. With backlash in the gears it makes it hunt about that position instead: widen the \
               deadzone, within which the position counts as reached, or lower I.",
        changes: &[
            change!("I up", "A quarter more, from 0.05 on", "position.i": |i| (i * 1.25).max(i + 0.05)),
            change!("I to two thirds", "Less of it, against hunting", "position.i": |i| i * 2.0 / 3.0),
            change!("Deadzone +1", "One count wider", "position.deadzone": |zone| zone + 1.0),
            change!("Deadzone -1", "One count narrower", "position.deadzone": |zone| zone - 1.0),
        ],
    },
    Step {
        title: "Max I",
        text: "I works only within Max I. Raise it until I carries what friction and load take; too much lets the axis oscillate.",
        changes: &[
            change!("Max I up", "Half as much again, from 10 on", "position.max_i": |most| (most * 1.5).max(most + 10.0)),
            change!("Max I down", "A third less", "position.max_i": |most| most / 1.5),
        ],
    },
];

impl Change {
    /// The registers with this change made.
    pub fn made(&self, held: AnyRegisters) -> AnyRegisters {
        let mut registers = held;
        (self.make)(&mut registers);
        registers
    }
}

/// What the motor's last moves speak for.
#[derive(Clone, Debug, PartialEq)]
pub enum Advice {
    /// Nothing to go by yet; what to do for it.
    Wait(Message),
    Good(AdviceMessage),
    Change(AdviceMessage),
    Danger(AdviceMessage),
}

impl Calibration {
    pub fn steps(which: Loop) -> &'static [Step] {
        if which == Loop::Velocity { &VELOCITY_STEPS } else { &POSITION_STEPS }
    }

    pub fn go_to(&mut self, which: Loop, step: usize) {
        self.step = step.min(Self::steps(which).len() - 1);
    }

    pub fn look_at(&mut self, motor: Motor) {
        self.motor = motor;
    }

    pub fn observer_mut(&mut self, motor: Motor) -> &mut Observer {
        &mut self.observers[motor.index()]
    }

    pub fn forget(&mut self) {
        self.observers.iter_mut().for_each(Observer::forget);
    }

    /// What to do now.
    pub fn advice(&self, which: Loop, held: Option<AnyRegisters>) -> Advice {
        let Some(held) = held else { return Advice::Wait(PathMessage::Unread.into()) };
        if let Some(missing) = missing(which, self.step, &held) {
            return Advice::Change(missing);
        }
        let observer = &self.observers[self.motor.index()];
        match (self.step, observer.observe(which)) {
            (0, _) => Advice::Good(ready(&held)),
            (_, Some(seen)) => advise(which, self.step, &seen),
            (_, None) if observer.is_asked(which) => Advice::Wait(AdviceMessage::Watching.into()),
            (_, None) => Advice::Wait(AdviceMessage::ArmAndMove.into()),
        }
    }
}

/// What must be there before the motor can be moved, or is in the way of the procedure.
fn missing(which: Loop, step: usize, held: &AnyRegisters) -> Option<AdviceMessage> {
    let raw = |key| held.raw(key).unwrap_or_default();
    if raw("velocity.qpps") < 1 {
        return Some(AdviceMessage::NoQpps);
    }
    if which != Loop::Position || held.raw("position.p").is_none() {
        return None;
    }
    let velocity = ["velocity.p", "velocity.i", "velocity.d"];
    if raw("position.max") <= raw("position.min") {
        Some(AdviceMessage::NoTravel)
    } else if step == 0 && velocity.iter().any(|key| raw(key) != 0) {
        Some(AdviceMessage::VelocityGains)
    } else {
        None
    }
}

fn ready(held: &AnyRegisters) -> AdviceMessage {
    let qpps = held.raw("velocity.qpps").unwrap_or_default();
    match (held.raw("position.min"), held.raw("position.max")) {
        (Some(min), Some(max)) => AdviceMessage::Ready { qpps, min, max },
        _ => AdviceMessage::QppsReady { qpps },
    }
}

fn advise(which: Loop, step: usize, seen: &Observation) -> Advice {
    if seen.runs_away {
        return Advice::Danger(AdviceMessage::RunsAway);
    }
    match which {
        Loop::Velocity => advise_velocity(step, seen),
        Loop::Position => advise_position(step, seen),
    }
}

fn advise_velocity(step: usize, seen: &Observation) -> Advice {
    let (below_percent, percent) =
        (100.0 * seen.error, 100.0 * seen.amplitude / seen.setpoint.abs().max(1.0));
    let vibrates =
        AdviceMessage::Vibrates { speed_percent: percent, duty_percent: seen.duty_amplitude_percent }.into();
    match (step, seen.vibrates) {
        (1 | 2, true) => Advice::Change(AdviceMessage::VibratesLessP { vibrates }),
        (3, true) => Advice::Change(AdviceMessage::VibratesLessI { vibrates }),
        (_, true) => Advice::Change(AdviceMessage::VibratesLess { vibrates }),
        (1, false) if seen.error > HARDLY => Advice::Change(AdviceMessage::HardlyTurns),
        (1, false) => Advice::Good(AdviceMessage::Turns),
        (2, false) if seen.error.abs() <= NEAR => Advice::Good(AdviceMessage::NearSpeed { below_percent }),
        (2, false) => Advice::Change(AdviceMessage::BelowWithP { below_percent }),
        (_, false) if seen.error.abs() > EXACT => Advice::Change(AdviceMessage::BelowWithI { below_percent }),
        (_, false) => match seen.overshoot.filter(|over| *over > MUCH_OVERSHOOT) {
            Some(over) => Advice::Change(AdviceMessage::OvershootsWithI { percent: 100.0 * over }),
            None => Advice::Good(AdviceMessage::SpeedDone),
        },
    }
}

fn advise_position(step: usize, seen: &Observation) -> Advice {
    let hunts = AdviceMessage::Hunts { counts: seen.amplitude }.into();
    let over = seen.overshoot.unwrap_or(0.0);
    let overshot = AdviceMessage::Overshot { percent: 100.0 * over }.into();
    match (step, seen.vibrates) {
        (1 | 2, true) => Advice::Change(AdviceMessage::HuntsLessD { hunts }),
        (_, true) => Advice::Change(AdviceMessage::HuntsInDeadzone { hunts }),
        (1, false) if seen.way.is_some_and(|way| seen.error.abs() > HARDLY * way.abs()) => {
            Advice::Change(AdviceMessage::HardlyGoes)
        }
        (1, false) => Advice::Good(AdviceMessage::Goes),
        (2, false) if over > MUCH_OVERSHOOT => Advice::Change(AdviceMessage::OvershotMoreD { overshot }),
        (2, false) if over > SOME_OVERSHOOT => Advice::Change(AdviceMessage::OvershotABit { overshot }),
        (2, false) if seen.error.abs() > 3.0 => {
            Advice::Change(AdviceMessage::ShortWithP { counts: seen.error.abs() })
        }
        (2, false) => Advice::Good(AdviceMessage::AtSetpoint),
        (_, false) if seen.error.abs() > 1.5 => {
            Advice::Change(AdviceMessage::ShortWithI { counts: seen.error.abs() })
        }
        (_, false) => Advice::Good(AdviceMessage::PositionDone),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(registers: AnyRegisters, changes: &[(&str, i64)]) -> AnyRegisters {
        let mut registers = registers;
        changes.iter().for_each(|(key, raw)| registers.set_raw(key, *raw));
        registers
    }

    fn held() -> AnyRegisters {
        let changes = [("velocity.p", 65_536), ("velocity.qpps", 10_000), ("position.p", 2000)];
        with(AnyRegisters::blank(true), &changes)
    }

    fn terms(registers: &AnyRegisters, of: &str) -> [Option<i64>; 3] {
        ["p", "i", "d"].map(|term| registers.raw(&format!("{of}.{term}")))
    }

    #[test]
    fn the_first_values_are_those_of_the_manual() {
        let velocity = VELOCITY_STEPS[1].changes[0].made(AnyRegisters::blank(false));
        assert_eq!(terms(&velocity, "velocity"), [Some(0x1_0000), Some(0), Some(0)]);
        let position = POSITION_STEPS[1].changes[0].made(held());
        assert_eq!(terms(&position, "position"), [Some(2000), Some(0), Some(0)]);
    }

    #[test]
    fn two_thirds_and_tenths_are_what_they_say() {
        let down = VELOCITY_STEPS[2].changes[1].made(held());
        assert_eq!(down.raw("velocity.p"), Some(43_691));
        let up = VELOCITY_STEPS[3].changes[0].made(held());
        assert_eq!(up.raw("velocity.i"), Some(6554));
        let d = POSITION_STEPS[2].changes[2].made(held());
        assert_eq!(d.raw("position.d"), Some(10_000));
    }

    #[test]
    fn what_is_missing_is_told_in_whatever_step() {
        let mut calibration = Calibration::default();
        let travel = |min, max| with(held(), &[("position.min", min), ("position.max", max)]);
        let (slow, stuck) = (with(held(), &[("velocity.qpps", 0)]), travel(0, 0));
        for step in 0..5 {
            calibration.go_to(Loop::Position, step);
            let advice = |held| calibration.advice(Loop::Position, Some(held));
            assert!(matches!(advice(slow), Advice::Change(text) if text.to_string().contains("QPPS is 0")));
            assert!(matches!(advice(stuck), Advice::Change(text) if text.to_string().contains("no travel")));
        }
        calibration.go_to(Loop::Position, 0);
        let cascaded = travel(-100, 100);
        let advice = calibration.advice(Loop::Position, Some(cascaded));
        assert!(
            matches!(advice, Advice::Change(text) if text.to_string().contains("velocity loop are not 0"))
        );
        let simple = with(cascaded, &[("velocity.p", 0)]);
        let advice = calibration.advice(Loop::Position, Some(simple));
        assert!(matches!(advice, Advice::Good(text) if text.to_string().contains("from -100 to 100 counts")));
    }

    #[test]
    fn advice_follows_the_procedure() {
        let seen = Observation { setpoint: 1000.0, error: 0.3, ..Observation::default() };
        assert!(
            matches!(advise(Loop::Velocity, 2, &seen), Advice::Change(text) if text.to_string().contains("Raise P"))
        );
        let shakes = Observation { vibrates: true, amplitude: 100.0, ..seen };
        assert!(
            matches!(advise(Loop::Velocity, 2, &shakes), Advice::Change(text) if text.to_string().contains("two thirds"))
        );
        let near = Observation { error: 0.02, ..seen };
        assert!(matches!(advise(Loop::Velocity, 2, &near), Advice::Good(_)));
        assert!(
            matches!(advise(Loop::Velocity, 3, &near), Advice::Change(text) if text.to_string().contains("Raise I"))
        );
        let over =
            Observation { error: 0.0, overshoot: Some(0.2), setpoint: 500.0, ..Observation::default() };
        assert!(
            matches!(advise(Loop::Position, 2, &over), Advice::Change(text) if text.to_string().contains("Raise D"))
        );
        let away = Observation { runs_away: true, ..over };
        assert!(matches!(advise(Loop::Position, 1, &away), Advice::Danger(_)));
    }
}

//! Watches a motor that a person drives: how near it comes to its setpoint, whether it vibrates, overshoots, hunts or runs away.
//!
//! It sees what the graph sees, at the rate of the window's own samples. Ten of them a second cannot show every vibration, but an
//! aliased vibration is one still.

use std::collections::VecDeque;

use brushwork_link::device::{Channel, Sample};
use brushwork_values::Motor;

use super::which::Loop;

/// How far back it looks, s.
const MEMORY_S: f64 = 12.0;
/// The part at the end of a constant setpoint that counts as steady, s: of a speed, and of a position, about which it hunts slowly. The
/// fewest samples in it.
const STEADY_S: [f64; 2] = [1.5, 3.0];
const FEWEST: usize = 8;
/// How long a motor is given to come to its setpoint, s.
const SETTLING_S: f64 = 1.0;
/// Oscillations beyond these, with enough turning points, are a vibration: of the speed over the setpoint, of the duty, %.
const SPEED_OSCILLATION: f64 = 0.04;
const DUTY_OSCILLATION_PERCENT: f64 = 6.0;
/// An oscillation of a speed or of a position that turns less often in a second than this is a drift.
const FEWEST_TURNS_PER_S: [f64; 2] = [1.6, 0.9];
/// Duty that is full, %.
const FULL_PERCENT: f64 = 97.0;
/// Counts that are rounding.
const ROUNDING_COUNTS: f64 = 2.0;

#[derive(Clone, Copy, Debug)]
struct Reading {
    t: f64,
    setpoint: f64,
    value: f64,
    duty_percent: f64,
}

/// What was seen of one motor under one loop.
#[derive(Clone, Debug, Default)]
pub struct Observer {
    readings: VecDeque<Reading>,
}

/// What it amounts to, at a constant setpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    pub setpoint: f64,
    /// Mean distance below the setpoint, over it; for positions in counts.
    pub error: f64,
    /// Half the peak-to-peak oscillation of speed or position, in its unit.
    pub amplitude: f64,
    /// The same of the duty, %.
    pub duty_amplitude_percent: f64,
    /// How often the value turned, 1/s.
    pub turns_per_s: f64,
    pub vibrates: bool,
    /// At full duty, and going the other way or far beyond.
    pub runs_away: bool,
    /// Beyond the setpoint after its last change, over that change.
    pub overshoot: Option<f64>,
    /// From where it stood at the last change to the setpoint, in its unit.
    pub way: Option<f64>,
}

impl Observer {
    /// Takes in a sample of the window. Another unit of setpoint (another screen) begins anew.
    pub fn note(&mut self, sample: &Sample, which: Loop, motor: Motor) {
        let [setpoint, speed, position, duty] = match motor {
            Motor::M1 => [Channel::M1_SETPOINT, Channel::M1_VELOCITY, Channel::M1_POSITION, Channel::M1_PWM],
            Motor::M2 => [Channel::M2_SETPOINT, Channel::M2_VELOCITY, Channel::M2_POSITION, Channel::M2_PWM],
        };
        let value = if which == Loop::Velocity { speed } else { position };
        let (Some(setpoint), Some(read), Some(duty_percent)) =
            (sample.get(setpoint), sample.get(value), sample.get(duty))
        else {
            return;
        };
        let t = sample.replied_at.as_secs_f64();
        self.push(Reading { t, setpoint, value: read, duty_percent });
    }

    fn push(&mut self, reading: Reading) {
        if self.readings.back().is_some_and(|last| reading.t <= last.t || reading.t - last.t > 1.0) {
            self.readings.clear();
        }
        self.readings.push_back(reading);
        while self.readings.front().is_some_and(|first| reading.t - first.t > MEMORY_S) {
            self.readings.pop_front();
        }
    }

    pub fn forget(&mut self) {
        self.readings.clear();
    }

    /// When the setpoint changed last, what it was before, and what it is.
    fn last_change(&self) -> Option<(f64, f64, f64)> {
        let now = self.readings.back()?.setpoint;
        let before = self.readings.iter().rev().find(|reading| reading.setpoint != now)?;
        let first = self.readings.iter().find(|reading| reading.t > before.t)?;
        Some((first.t, before.setpoint, now))
    }

    /// What was seen since the setpoint was last changed; none before there is enough, or at rest.
    pub fn observe(&self, which: Loop) -> Option<Observation> {
        let last = *self.readings.back()?;
        let changed_s = self.last_change().map_or(f64::NEG_INFINITY, |(at, ..)| at);
        let from_s = (last.t - STEADY_S[which as usize]).max(changed_s + SETTLING_S);
        let steady: Vec<Reading> = self.readings.iter().filter(|r| r.t >= from_s).copied().collect();
        let is_asked = which == Loop::Position || last.setpoint != 0.0;
        if steady.len() < FEWEST || !is_asked {
            return None;
        }
        let (mean, amplitude, turns) = oscillation(steady.iter().map(|r| r.value));
        let (duty, duty_amplitude_percent, duty_turns) = oscillation(steady.iter().map(|r| r.duty_percent));
        let seconds = last.t - steady[0].t;
        let turns_per_s = turns.max(duty_turns) as f64 / seconds.max(0.1);
        let mut seen = Observation {
            setpoint: last.setpoint,
            error: last.setpoint - mean,
            amplitude,
            duty_amplitude_percent,
            turns_per_s,
            overshoot: self.overshoot(which),
            way: self.last_way(which).map(|(_, _, way)| way),
            ..Observation::default()
        };
        let turns_enough = turns_per_s >= FEWEST_TURNS_PER_S[which as usize];
        match which {
            Loop::Velocity => {
                seen.error /= last.setpoint;
                let shakes = amplitude > SPEED_OSCILLATION * last.setpoint.abs()
                    || duty_amplitude_percent > DUTY_OSCILLATION_PERCENT;
                seen.vibrates = shakes && turns_enough;
                let wrong_way = mean * last.setpoint < 0.0 || mean.abs() > 1.6 * last.setpoint.abs();
                seen.runs_away = duty.abs() > FULL_PERCENT && wrong_way;
            }
            Loop::Position => {
                let shakes = amplitude > ROUNDING_COUNTS || duty_amplitude_percent > DUTY_OSCILLATION_PERCENT;
                seen.vibrates = shakes && turns_enough;
                let first = steady[0].value;
                let away =
                    (last.value - last.setpoint).abs() > (first - last.setpoint).abs() + ROUNDING_COUNTS;
                seen.runs_away = duty.abs() > FULL_PERCENT && away;
            }
        }
        Some(seen)
    }

    /// Whether something was asked of the motor that it can be watched at.
    pub fn is_asked(&self, which: Loop) -> bool {
        self.readings.back().is_some_and(|last| which == Loop::Position || last.setpoint != 0.0)
    }

    /// When the setpoint changed last, what it is, and how far it was to go.
    fn last_way(&self, which: Loop) -> Option<(f64, f64, f64)> {
        let (at, _, goal) = self.last_change()?;
        let start = self.readings.iter().rev().find(|reading| reading.t < at)?.value;
        let way = goal - start;
        let least = if which == Loop::Velocity { 1.0 } else { 10.0 };
        (way.abs() >= least).then_some((at, goal, way))
    }

    fn overshoot(&self, which: Loop) -> Option<f64> {
        let (at, goal, way) = self.last_way(which)?;
        let after = self.readings.iter().filter(|reading| reading.t >= at);
        let most = after.map(|reading| (reading.value - goal) * way.signum()).fold(0.0, f64::max);
        Some(most / way.abs())
    }
}

/// Mean, half of the span, and turning points.
fn oscillation(values: impl Iterator<Item = f64>) -> (f64, f64, usize) {
    let values: Vec<f64> = values.collect();
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let span = (high - low).max(0.0);
    // A turn counts when it is a fair part of the span, so that noise on a drift is none.
    let mut turns = 0;
    let mut extreme = values.first().copied().unwrap_or(0.0);
    let mut rising = None;
    for value in values.iter().skip(1) {
        let far = (value - extreme).abs() > 0.4 * span;
        match rising {
            Some(up) if (*value > extreme) == up => extreme = *value,
            _ if far => {
                turns += usize::from(rising.is_some());
                rising = Some(*value > extreme);
                extreme = *value;
            }
            _ => {}
        }
    }
    (mean, 0.5 * span, turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(which: Loop, setpoint: impl Fn(f64) -> f64, value: impl Fn(f64) -> (f64, f64)) -> Observation {
        let mut observer = Observer::default();
        for n in 0..60 {
            let t = f64::from(n) * 0.1;
            let (value, duty_percent) = value(t);
            observer.push(Reading { t, setpoint: setpoint(t), value, duty_percent });
        }
        observer.observe(which).expect("enough")
    }

    #[test]
    fn a_steady_motor_below_its_setpoint_is_told_by_how_much() {
        let seen = seen(Loop::Velocity, |_| 1000.0, |t| (900.0 + 4.0 * (9.0 * t).sin(), 30.0));
        assert!((seen.error - 0.1).abs() < 0.01 && !seen.vibrates && !seen.runs_away, "{seen:?}");
    }

    #[test]
    fn a_vibration_is_told_from_noise_and_from_a_drift() {
        let shakes = seen(
            Loop::Velocity,
            |_| 1000.0,
            |t| (1000.0 + 150.0 * (17.0 * t).sin(), 30.0 + 10.0 * (17.0 * t).cos()),
        );
        assert!(shakes.vibrates, "{shakes:?}");
        let drifts = seen(Loop::Velocity, |_| 1000.0, |t| (900.0 + 30.0 * t, 30.0));
        assert!(!drifts.vibrates, "{drifts:?}");
    }

    #[test]
    fn the_overshoot_is_that_of_the_last_change() {
        let seen = seen(
            Loop::Position,
            |t| if t < 3.0 { 0.0 } else { 1000.0 },
            |t| {
                if t < 3.0 {
                    (0.0, 0.0)
                } else {
                    (1000.0 + 250.0 * (-4.0 * (t - 3.2)).exp().min(1.0) * f64::from(u8::from(t > 3.2)), 0.0)
                }
            },
        );
        assert!((seen.overshoot.unwrap() - 0.2).abs() < 0.06, "{seen:?}");
        assert!(seen.error.abs() < 2.0);
    }

    #[test]
    fn full_duty_the_wrong_way_is_a_runaway() {
        let seen = seen(Loop::Velocity, |_| 1000.0, |_| (-9000.0, 100.0));
        assert!(seen.runs_away);
    }

    #[test]
    fn hunting_about_a_place_is_a_vibration() {
        let seen = seen(Loop::Position, |_| 500.0, |t| (500.0 + 8.0 * (6.0 * t).sin(), 3.0));
        assert!(seen.vibrates, "{seen:?}");
    }
}

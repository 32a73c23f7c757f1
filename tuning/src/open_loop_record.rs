//! The record of an open-loop run as a fit needs it, and the counts that a model predicts for it.

use crate::duty_limiter::{DutyLimit, Limiter, LimiterState};
use crate::model::{Decay, Motion, PlantModel};
use crate::poll::{Drive, Input, Point};
use crate::thresholds::thresholds;

thresholds! {
    /// How duty goes from one value to another between two polls, and how exactly a poll is dated.
    pub OPEN_LOOP: Thresholds {
        /// Ramp of the explicit highest acceleration, in full duties per second: 100 % to -100 % in 100 ms.
        duty_slew_per_s: f64 = 20.0,
        /// Step of the computation along a duty ramp, in seconds.
        ramp_step_s: f64 = 0.001,
        /// Step of the computation under a current limit, in seconds.
        limited_step_s: f64 = 0.002,
        /// Standard deviation of the time stamp of a reading that came promptly or with its time, in seconds.
        stamp_s: f64 = 0.0010,
        /// How near to the same time within a tick polls may come for it to be open how old counts are: the length of the mean of their phases, 0 where they are even and 1 where all are one.
        /// Of 28 runs in real time none is above 0.2; polls of a simulated clock that come each third tick are at 1.
        in_step: f64 = 0.5,
    }
}

/// Whether polls come at nearly the same time within a tick, so that counts show nothing of how old they are.
pub(crate) fn are_in_step(times_s: impl Iterator<Item = f64>, tick_s: f64) -> bool {
    let (mut sum, mut polls) = ((0.0, 0.0), 0.0);
    for t in times_s {
        let (sine, cosine) = (std::f64::consts::TAU * t / tick_s).sin_cos();
        sum = (sum.0 + cosine, sum.1 + sine);
        polls += 1.0;
    }
    f64::hypot(sum.0, sum.1) > OPEN_LOOP.in_step * polls
}

/// Duties, counts and battery voltage over time.
#[derive(Clone, Debug, Default)]
pub struct OpenLoopRecord {
    /// (time, duty) of each command.
    pub duties: Vec<(f64, f64)>,
    /// (time, counts) of each poll.
    pub counts: Vec<(f64, f64)>,
    /// Which polls the current limit was at work in.
    pub limited: Vec<bool>,
    /// (time, battery voltage over the reference) of the polls that read it.
    pub volts: Vec<(f64, f64)>,
    /// Speed at the first poll, counts/s.
    pub start_speed: f64,
    /// How the controller takes a duty.
    pub actuation: Actuation,
}

/// How a controller takes a duty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuation {
    /// Duty per second of its ramp; infinite where there is none.
    pub slew_per_s: f64,
    /// From the stamp of a command to its effect, with the age of a reading, s: the usual.
    pub offset_s: f64,
    /// How much of that is the age of counts that are up to a tick old, s; 0 where they come with their time.
    pub age_s: f64,
    /// The limit of the duty by which the current is held, where it is not the current itself that is limited.
    pub duty_limit: Option<DutyLimit>,
    /// Standard deviation of the time stamps of readings, s.
    pub stamp_s: f64,
}

impl Default for Actuation {
    /// A ramp of 100 % to -100 % in 100 ms; half a tick of waiting and half a tick of age at 300 Hz.
    fn default() -> Self {
        Self {
            slew_per_s: OPEN_LOOP.duty_slew_per_s,
            offset_s: 0.0035,
            age_s: 0.5 / 300.0,
            duty_limit: None,
            stamp_s: OPEN_LOOP.stamp_s,
        }
    }
}

impl OpenLoopRecord {
    /// The part of a run between two times, from the last poll before the first of them on, with the duty in force there, which must
    /// have been reached. Voltages are taken relative to `reference`.
    #[must_use]
    pub fn new(points: &[Point], drives: &[Drive], from_s: f64, to_s: f64, reference: Option<f64>) -> Self {
        let first = points.partition_point(|p| p.t < from_s).saturating_sub(1);
        let start_s = points.get(first).map_or(from_s, |p| p.t);
        let mut duties: Vec<(f64, f64)> = Vec::new();
        for drive in drives {
            if let Input::Duty(duty) = drive.input {
                if drive.t < start_s {
                    duties.clear();
                }
                if drive.t <= to_s {
                    duties.push((drive.t, duty));
                }
            }
        }
        let inside = || points[first.min(points.len())..].iter().filter(|p| p.t <= to_s);
        let start_speed = match (points.get(first), points.get(first.wrapping_sub(3))) {
            (Some(last), Some(earlier)) if last.t > earlier.t => {
                (last.counts - earlier.counts) / (last.t - earlier.t)
            }
            _ => 0.0,
        };
        let volts = match reference {
            Some(reference) if reference > 0.0 => {
                inside().filter_map(|p| p.volts.map(|v| (p.t, v / reference))).collect()
            }
            _ => Vec::new(),
        };
        Self {
            duties,
            counts: inside().map(|p| (p.t, p.counts)).collect(),
            limited: inside().map(|p| p.limited).collect(),
            volts,
            start_speed,
            actuation: Actuation::default(),
        }
    }

    /// Share of the polls that the current limit was at work in.
    #[must_use]
    pub fn limited_share(&self) -> f64 {
        self.limited.iter().filter(|&&l| l).count() as f64 / self.limited.len().max(1) as f64
    }

    /// Predicted counts at each poll, from the first one on, and battery voltages at each reading; each duty takes effect
    /// `offset_s` after its time stamp.
    pub fn predict(&self, model: &PlantModel, offset_s: f64, counts: &mut Vec<f64>, volts: &mut Vec<f64>) {
        self.predict_with(&self.actuation, (model, offset_s), counts, volts);
    }

    /// The same of a controller that takes a duty otherwise.
    pub(crate) fn predict_with(
        &self,
        actuation: &Actuation,
        (model, offset_s): (&PlantModel, f64),
        counts: &mut Vec<f64>,
        volts: &mut Vec<f64>,
    ) {
        counts.clear();
        volts.clear();
        let Some(&(start, _)) = self.counts.first() else { return };
        let motion = Motion { speed: self.start_speed, position: 0.0 };
        let limiter = actuation.duty_limit.and_then(|limit| Limiter::new(limit, model.drive_limit));
        // A limit of the duty leaves none of the current.
        let model = &match actuation.duty_limit {
            Some(_) => PlantModel { drive_limit: None, ..*model },
            None => *model,
        };
        let mut state = Cursor {
            t: start,
            duty: 0.0,
            goal: 0.0,
            motion,
            limiter,
            limit: LimiterState::default(),
            decay: Decay::default(),
        };
        let mut next = 0;
        while let Some(&(t, duty)) = self.duties.get(next)
            && t <= start
        {
            (state.duty, state.goal) = (duty, duty);
            next += 1;
        }
        for &(t, _) in &self.counts {
            while let Some(&(at, duty)) = self.duties.get(next)
                && at + offset_s <= t
            {
                advance(actuation, model, &mut state, at + offset_s);
                state.goal = duty;
                next += 1;
            }
            advance(actuation, model, &mut state, t);
            counts.push(state.motion.position);
            if self.volts.get(volts.len()).is_some_and(|reading| reading.0 <= t) {
                let limit = model.push_limit(state.duty, state.motion.speed).unwrap_or(f64::INFINITY);
                let emf = state.motion.speed / model.gain_counts_per_s;
                let drawn = (state.duty - emf).clamp(-limit, limit);
                volts.push(1.0 - model.sag * (emf + drawn) * drawn);
            }
        }
    }
}

/// Moves on along the ramp of the duty.
fn advance(actuation: &Actuation, model: &PlantModel, state: &mut Cursor, to: f64) {
    if actuation.slew_per_s.is_infinite() {
        state.duty = state.goal;
    }
    if let Some(limiter) = state.limiter {
        return advance_limited(model, &limiter, state, to);
    }
    while state.t < to - 1e-12 {
        let left = to - state.t;
        let gap = state.goal - state.duty;
        let (step, duty) = if gap == 0.0 {
            let longest = if model.drive_limit.is_some() { OPEN_LOOP.limited_step_s } else { left };
            (left.min(longest), state.duty)
        } else {
            let slew = actuation.slew_per_s;
            let step = left.min(OPEN_LOOP.ramp_step_s).min(gap.abs() / slew);
            let change = (slew * step).min(gap.abs()) * gap.signum();
            let middle = state.duty + 0.5 * change;
            state.duty = if gap.abs() <= slew * step * 1.000_001 { state.goal } else { state.duty + change };
            (step.max(1e-9), middle)
        };
        model.step_on(&mut state.motion, duty, step, &mut state.decay);
        state.t += step;
    }
}

/// The same where a limiter moves the bound of the duty.
fn advance_limited(model: &PlantModel, limiter: &Limiter, state: &mut Cursor, to: f64) {
    while state.t < to - 1e-12 {
        let step = (to - state.t).min(limiter.step_s());
        let duty = Limiter::left(&state.limit, state.duty);
        let before = state.motion.speed;
        model.step_on(&mut state.motion, duty, step, &mut state.decay);
        let emf = 0.5 * (before + state.motion.speed) / model.gain_counts_per_s;
        limiter.see(&mut state.limit, duty - emf, step);
        state.t += step;
    }
}

struct Cursor {
    t: f64,
    duty: f64,
    goal: f64,
    motion: Motion,
    limiter: Option<Limiter>,
    limit: LimiterState,
    decay: Decay,
}

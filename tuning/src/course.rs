//! The record of an open-loop run as a fit needs it, and the counts that a model predicts for it.

use crate::model::{Motion, PlantModel};
use crate::rig::{Drive, Input, Point};

/// Duty per second of the explicit highest acceleration: 100 % to -100 % in 100 ms (MCP manual, command 52).
pub(crate) const DUTY_SLEW_PER_S: f64 = 20.0;
/// Step along a duty ramp, and under a current limit, s.
const RAMP_STEP_S: f64 = 0.001;
const LIMITED_STEP_S: f64 = 0.002;

/// Duties, counts and battery voltage over time.
#[derive(Clone, Debug, Default)]
pub struct Course {
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
}

impl Course {
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
        counts.clear();
        volts.clear();
        let Some(&(start, _)) = self.counts.first() else { return };
        let motion = Motion { speed: self.start_speed, place: 0.0 };
        let mut state = Cursor { t: start, duty: 0.0, goal: 0.0, motion };
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
                self.advance(model, &mut state, at + offset_s);
                state.goal = duty;
                next += 1;
            }
            self.advance(model, &mut state, t);
            counts.push(state.motion.place);
            if self.volts.get(volts.len()).is_some_and(|reading| reading.0 <= t) {
                let limit = model.push_limit(state.duty, state.motion.speed).unwrap_or(f64::INFINITY);
                let emf = state.motion.speed / model.gain_counts_per_s;
                let drawn = (state.duty - emf).clamp(-limit, limit);
                volts.push(1.0 - model.sag * (emf + drawn) * drawn);
            }
        }
    }

    fn advance(&self, model: &PlantModel, state: &mut Cursor, to: f64) {
        while state.t < to - 1e-12 {
            let left = to - state.t;
            let gap = state.goal - state.duty;
            let (step, duty) = if gap == 0.0 {
                let longest = if model.drive_limit.is_some() { LIMITED_STEP_S } else { left };
                (left.min(longest), state.duty)
            } else {
                let step = left.min(RAMP_STEP_S).min(gap.abs() / DUTY_SLEW_PER_S);
                let change = (DUTY_SLEW_PER_S * step).min(gap.abs()) * gap.signum();
                let middle = state.duty + 0.5 * change;
                state.duty = if gap.abs() <= DUTY_SLEW_PER_S * step * 1.000_001 {
                    state.goal
                } else {
                    state.duty + change
                };
                (step.max(1e-9), middle)
            };
            model.step(&mut state.motion, duty, step);
            state.t += step;
        }
    }
}

struct Cursor {
    t: f64,
    duty: f64,
    goal: f64,
    motion: Motion,
}

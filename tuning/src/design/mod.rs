//! Gains from a model: a search over the identified, non-linear loop under a bound on the maximum sensitivity.
//!
//! An unstable loop can have a small sensitivity, so each search starts at a gain near zero, where the loop is stable, goes up
//! and stops at the first bound it meets.

mod binding;
mod position;
mod velocity;

pub use binding::{Bound, Limit, limit};
pub(crate) use position::deadzone;
pub use position::{design_pd, design_pid, design_piv};
pub use velocity::design_velocity;

use crate::linear::{DiscretePlant, LoopPlant, Margins};
use crate::model::{Gains, Lag, LoopLaw, PlantModel};
use crate::score::Score;
use serde::{Deserialize, Serialize};

/// Duty noise that a design of the default level may have.
const USUAL_NOISE: f64 = 0.08;

/// How far a design may go.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Highest maximum sensitivity.
    pub ms: f64,
    /// Highest duty noise from the rounding of counts, root mean square.
    pub noise_duty: f64,
}

impl Goal {
    /// The goal of a level from 0 (soft) to 100 (stiff); 50 is the default (MCP manual 2.4.5 calls it aggressiveness).
    #[must_use]
    pub fn of_level(level: f64) -> Self {
        let level = level.clamp(0.0, 100.0);
        Self { ms: 1.2 + 0.008 * level, noise_duty: USUAL_NOISE * 4.0_f64.powf((level - 50.0) / 100.0) }
    }

    /// How much stiffer than the default a level is in all that has no bound of its own: 0.7 to 1.4.
    pub(crate) fn pace(&self) -> f64 {
        (self.noise_duty / USUAL_NOISE).sqrt()
    }
}

/// What a design is made for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The motor.
    pub plant: PlantModel,
    /// The controller.
    pub law: LoopLaw,
    /// The lag beyond hold and count difference: the most likely one.
    pub lag: Lag,
    /// The largest lag that is still likely; the sensitivity is bounded with this one too.
    pub worst_lag: Lag,
    /// Speed at full duty, counts/s.
    pub qpps: f64,
    /// How far to go.
    pub goal: Goal,
    /// What the measured duty noise is to the predicted one.
    pub noise_factor: f64,
    /// Backlash of the mechanics, counts.
    #[serde(rename = "slack_counts")]
    pub backlash_counts: f64,
    /// Shortest integral time of the velocity loop, s: backlash turns a quick integral into a limit cycle.
    pub least_integral_s: f64,
    /// Overshoot of a speed step beyond which the cost jumps, over the step.
    pub most_overshoot: f64,
}

/// Lag that the model leaves out, ticks: the winding, a springy shaft. Ticks of 5 ms are longer than those it was found with.
pub(crate) fn unmodelled_ticks(law: &LoopLaw) -> f64 {
    if law.motion_mind.is_some() { 0.33 } else { 0.5 }
}

/// The overshoot of a speed step that a well-known motor may be designed for.
pub const USUAL_OVERSHOOT: f64 = 0.20;

/// Gains and what they promise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The gains.
    pub gains: Gains,
    /// Predicted response.
    pub score: Score,
    /// Predicted maximum sensitivity.
    pub ms: f64,
    /// Predicted duty noise.
    pub noise_duty: f64,
}

/// The loops a design is checked with: as likely, with the worst lag, with half the inertia.
struct Loops {
    nominal: LoopPlant,
    worst: LoopPlant,
    light: LoopPlant,
}

impl Loops {
    fn new(task: &Task) -> Self {
        let tick_s = task.law.tick_s();
        let light = PlantModel { tau_s: 0.5 * task.plant.tau_s, ..task.plant };
        let of = |plant: &PlantModel, lag| LoopPlant::new(DiscretePlant::of(plant, tick_s), &task.law, lag);
        Self {
            nominal: of(&task.plant, task.lag),
            worst: of(&task.plant, task.worst_lag),
            light: of(&light, task.lag),
        }
    }

    /// Margins as likely, if every bound is kept.
    fn within(&self, task: &Task, gains: &Gains) -> Option<Margins> {
        if gains.velocity.i * task.least_integral_s > 1.000_001 * gains.velocity.p {
            return None;
        }
        let margins = self.nominal.margins(gains, task.qpps);
        let kept = margins.ms <= task.goal.ms
            && margins.noise_duty * task.noise_factor <= task.goal.noise_duty
            && self.worst.margins(gains, task.qpps).ms <= 1.12 * task.goal.ms
            && self.light.margins(gains, task.qpps).ms <= 1.4 * task.goal.ms;
        kept.then_some(margins)
    }

    fn stable(&self, task: &Task, gains: &Gains) -> bool {
        [&self.nominal, &self.worst, &self.light]
            .iter()
            .all(|plant| plant.spectral_radius(gains, task.qpps) < 1.0)
    }
}

/// The largest factor up to which `gains(factor)` keeps every bound, going up from near zero.
fn ascend(loops: &Loops, task: &Task, top: f64, gains: impl Fn(f64) -> Gains) -> Option<f64> {
    const RATIO: f64 = 1.25;
    let mut factor = top * 1e-4;
    loops.within(task, &gains(factor))?;
    while factor < top && loops.within(task, &gains(factor * RATIO)).is_some() {
        factor *= RATIO;
    }
    let (mut low, mut high) = (factor, factor * RATIO);
    for _ in 0..4 {
        let middle = (low * high).sqrt();
        if loops.within(task, &gains(middle)).is_some() { low = middle } else { high = middle }
    }
    Some(low)
}

/// A candidate with its cost.
struct Candidate {
    gains: Gains,
    score: Score,
    cost: f64,
}

fn better(best: Option<Candidate>, other: Candidate) -> Option<Candidate> {
    match best {
        Some(best) if best.cost <= other.cost => Some(best),
        _ => Some(other),
    }
}

fn finish(loops: &Loops, task: &Task, best: Option<Candidate>) -> Option<Design> {
    let best = best?;
    let margins = loops.nominal.margins(&best.gains, task.qpps);
    Some(Design {
        gains: best.gains,
        score: best.score,
        ms: margins.ms,
        noise_duty: margins.noise_duty * task.noise_factor,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn task(level: f64) -> Task {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };
        Task {
            plant: PlantModel {
                gain_counts_per_s: 30_000.0,
                tau_s: 0.1,
                coulomb_duty: 0.05,
                load_duty: 0.0,
                drive_limit: None,
                brake_limit: None,
                sag: 0.03,
            },
            law: LoopLaw::default(),
            lag,
            worst_lag: lag,
            qpps: 28_000.0,
            goal: Goal::of_level(level),
            noise_factor: 1.0,
            backlash_counts: 0.0,
            least_integral_s: 0.0,
            most_overshoot: USUAL_OVERSHOOT,
        }
    }

    #[test]
    fn every_method_keeps_its_goal_at_every_level_and_stiffer_is_never_slower() {
        type Method = fn(&Task) -> Option<Design>;
        let methods: [(&str, Method); 4] =
            [("velocity", design_velocity), ("pd", design_pd), ("pid", design_pid), ("piv", design_piv)];
        for (name, method) in methods {
            let mut before = f64::INFINITY;
            for level in [0.0, 25.0, 50.0, 75.0] {
                let task = task(level);
                let design = method(&task).unwrap_or_else(|| panic!("{name} at level {level}: no gains"));
                assert!(design.ms <= task.goal.ms + 1e-9, "{name} at level {level}: Ms {}", design.ms);
                assert!(design.noise_duty <= task.goal.noise_duty + 1e-9, "{name} at level {level}");
                let cost = design.score.setpoint + design.score.load;
                assert!(cost <= 1.1 * before, "{name} at level {level}: {cost} after {before}");
                before = cost;
            }
        }
    }

    #[test]
    fn the_same_task_gives_the_same_gains_to_the_last_bit() {
        assert_eq!(design_piv(&task(50.0)), design_piv(&task(50.0)));
    }
}

//! A search over gains: the bounds that they keep, and which candidate is cheaper.

use super::task::{Design, Task};
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant, Margins};
use crate::model::{Gains, PlantModel};
use crate::score::Score;
use crate::thresholds::thresholds;

thresholds! {
    /// How gains go up from near zero, and what they may not pass.
    pub(super) SEARCH: Thresholds {
        /// By what share of them gains go up from one try to the next, before the last step is halved.
        rise: f64 = 0.25,
        /// Sensitivity that a design may have with the worst lag, as a multiple of that of its goal.
        worst_ms: f64 = 1.12,
        /// Sensitivity that it may have with half the inertia, as a multiple of that of its goal.
        light_ms: f64 = 1.4,
    }
}

/// The loops a design is checked with: as likely, with the worst lag, with half the inertia.
pub(super) struct Loops {
    pub nominal: LoopPlant,
    pub worst: LoopPlant,
    pub light: LoopPlant,
}

impl Loops {
    /// The loops of a task.
    pub(super) fn new<L: Law>(task: &Task<L>) -> Self {
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
    pub(super) fn within<L: Law>(&self, task: &Task<L>, gains: &Gains) -> Option<Margins> {
        if gains.velocity.i * task.least_integral_s > 1.000_001 * gains.velocity.p {
            return None;
        }
        if task.most_speed_gain.is_some_and(|most| gains.speed_gain() > 1.000_001 * most) {
            return None;
        }
        let margins = self.nominal.margins(gains, task.qpps);
        let kept = margins.ms <= task.goal.ms
            && margins.noise_duty * task.noise_factor <= task.goal.noise_duty
            && self.worst.keeps(gains, task.qpps, SEARCH.worst_ms * task.goal.ms)
            && self.light.keeps(gains, task.qpps, SEARCH.light_ms * task.goal.ms);
        kept.then_some(margins)
    }

    /// Whether all three come to rest.
    pub(super) fn stable<L: Law>(&self, task: &Task<L>, gains: &Gains) -> bool {
        [&self.nominal, &self.worst, &self.light]
            .iter()
            .all(|plant| plant.spectral_radius(gains, task.qpps) < 1.0)
    }
}

/// The largest factor up to which `gains(factor)` keeps every bound, going up from near zero.
pub(super) fn ascend<L: Law>(
    loops: &Loops,
    task: &Task<L>,
    top: f64,
    gains: impl Fn(f64) -> Gains,
) -> Option<f64> {
    let (lowest, ratio) = (top * 1e-4, 1.0 + SEARCH.rise);
    let mut factor = lowest;
    loops.within(task, &gains(factor))?;
    while factor < top && loops.within(task, &gains(factor * ratio)).is_some() {
        factor *= ratio;
    }
    let (mut low, mut high) = (factor, factor * ratio);
    for _ in 0..4 {
        let middle = (low * high).sqrt();
        if loops.within(task, &gains(middle)).is_some() { low = middle } else { high = middle }
    }
    // The margins of a loop that does not come to rest may look like those of a calm one, where a step goes past the gain between them.
    while low > lowest && !loops.stable(task, &gains(low)) {
        low /= ratio;
    }
    Some(low)
}

/// A candidate with its cost.
pub(super) struct Candidate {
    pub gains: Gains,
    pub score: Score,
    pub cost: f64,
}

/// What there is, or what costs less than it.
pub(super) fn better(
    best: Option<Candidate>,
    other: impl FnOnce(f64) -> Option<Candidate>,
) -> Option<Candidate> {
    other(best.as_ref().map_or(f64::INFINITY, |best| best.cost)).or(best)
}

/// What the best candidate promises.
pub(super) fn finish<L: Law>(loops: &Loops, task: &Task<L>, best: Option<Candidate>) -> Option<Design> {
    let best = best?;
    let margins = loops.nominal.margins(&best.gains, task.qpps);
    Some(Design {
        gains: best.gains,
        score: best.score,
        ms: margins.ms,
        noise_duty: margins.noise_duty * task.noise_factor,
    })
}

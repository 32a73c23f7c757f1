//! Which bound keeps gains from being made stiffer: what a person who turns the level wants to know when it does little.

use super::search::{Loops, SEARCH};
use super::task::Task;
use crate::law::Law;
use crate::linear::LoopPlant;
use crate::model::Gains;
use crate::thresholds::thresholds;

/// The bound that is met first when gains go up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// Maximum sensitivity on the model as it most likely is.
    Sensitivity,
    /// The same with the largest lag that is still likely.
    Lag,
    /// The same with half the inertia.
    LightLoad,
    /// What the rounding of counts does to the duty.
    DutyNoise,
    /// The shortest integral time that the backlash of the mechanics allows.
    Backlash,
}

/// A bound and how much of it is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Which.
    pub by: Bound,
    /// What the gains come to, over what the goal allows: above 1 they are beyond it.
    pub used: f64,
}

thresholds! {
    /// When a bound of the design counts as the one that holds the gains back.
    BINDING: Thresholds {
        /// Factor by which all gains are raised: a bound that they then break was near.
        near: f64 = 1.25,
    }
}

/// Which bound of `task` is met first when all of `gains` are raised by a quarter: the one that is broken by the most. `None` where none
/// is: stiffer gains would only overshoot more.
#[must_use]
pub fn limit<L: Law>(task: &Task<L>, gains: &Gains) -> Option<Limit> {
    let loops = Loops::new(task);
    let (now, raised) = (shares(task, &loops, gains), shares(task, &loops, &raised(gains)));
    let most = (0..raised.len()).max_by(|a, b| raised[*a].1.total_cmp(&raised[*b].1))?;
    let (by, share) = raised[most];
    (share > 1.0).then_some(Limit { by, used: now[most].1 })
}

/// How much of each bound is used.
fn shares<L: Law>(task: &Task<L>, loops: &Loops, gains: &Gains) -> [(Bound, f64); 5] {
    let ms = |plant: &LoopPlant| plant.margins(gains, task.qpps).ms;
    let nominal = loops.nominal.margins(gains, task.qpps);
    // Raising all gains leaves the integral time as it is, so that a bound that is reached counts as broken.
    let integral = 1.01 * gains.velocity.i * task.least_integral_s / gains.velocity.p.max(f64::MIN_POSITIVE);
    [
        (Bound::Sensitivity, nominal.ms / task.goal.ms),
        (Bound::Lag, ms(&loops.worst) / (SEARCH.worst_ms * task.goal.ms)),
        (Bound::LightLoad, ms(&loops.light) / (SEARCH.light_ms * task.goal.ms)),
        (Bound::DutyNoise, nominal.noise_duty * task.noise_factor / task.goal.noise_duty),
        (Bound::Backlash, integral),
    ]
}

fn raised(gains: &Gains) -> Gains {
    let mut raised = *gains;
    for pid in [Some(&mut raised.velocity), raised.position.as_mut()].into_iter().flatten() {
        (pid.p, pid.i, pid.d) = (BINDING.near * pid.p, BINDING.near * pid.i, BINDING.near * pid.d);
    }
    raised
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Goal, design_velocity};
    use crate::model::{Lag, Pid, PlantModel};
    use crate::plain_law::PlainLaw;

    fn task(tau_s: f64, gain_counts_per_s: f64, level: f64) -> Task<PlainLaw> {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };
        let plant = PlantModel {
            gain_counts_per_s,
            tau_s,
            coulomb_duty: 0.05,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        };
        Task { goal: Goal::of_level(level), ..Task::new(plant, PlainLaw::default(), lag, gain_counts_per_s) }
    }

    #[test]
    fn a_limit_is_reported_exactly_where_the_search_would_not_go_on() {
        for (tau_s, gain) in
            [(0.01, 3_000.0), (0.03, 10_000.0), (0.1, 30_000.0), (1.0, 30_000.0), (0.3, 600.0)]
        {
            for level in [0.0, 50.0, 100.0] {
                let task = task(tau_s, gain, level);
                let Some(design) = design_velocity(&task) else { continue };
                let goes_on = Loops::new(&task).within(&task, &raised(&design.gains)).is_some();
                let limit = limit(&task, &design.gains);
                assert_eq!(limit.is_none(), goes_on, "tau {tau_s}, level {level}: {limit:?}");
                assert!(
                    limit.is_none_or(|limit| limit.used <= 1.0 + 1e-9),
                    "{limit:?}: a design keeps its bounds"
                );
            }
        }
    }

    #[test]
    fn a_coarse_encoder_is_limited_by_duty_noise_and_much_gain_by_a_sensitivity() {
        let coarse = Gains { velocity: Pid { p: 3.0, i: 3.0, d: 0.0 }, ..Gains::default() };
        let noisy = limit(&task(0.3, 600.0, 50.0), &coarse).unwrap();
        assert!(noisy.by == Bound::DutyNoise && noisy.used > 1.0, "{noisy:?}");
        let stiff = Gains { velocity: Pid { p: 12.0, i: 60.0, d: 0.0 }, ..Gains::default() };
        let tense = limit(&task(0.1, 3_000_000.0, 0.0), &stiff).unwrap();
        assert!(!matches!(tense.by, Bound::DutyNoise | Bound::Backlash) && tense.used > 1.0, "{tense:?}");
        let soft = Gains { velocity: Pid { p: 0.05, i: 0.05, d: 0.0 }, ..Gains::default() };
        assert_eq!(limit(&task(0.1, 30_000.0, 50.0), &soft), None);
    }

    #[test]
    fn an_integral_as_quick_as_the_backlash_allows_is_reported() {
        let task = Task { least_integral_s: 0.5, ..task(0.1, 30_000.0, 50.0) };
        let gains = Gains { velocity: Pid { p: 0.1, i: 0.2, d: 0.0 }, ..Gains::default() };
        assert_eq!(limit(&task, &gains).unwrap().by, Bound::Backlash);
    }
}

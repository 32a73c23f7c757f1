//! The gains of another level on the model that a run identified.
//!
//! Pure and quick; nothing is sent and no motor moves.

use crate::design::{Design, Goal, Limit, Task, limit};
pub use crate::forecast::{Forecast, LoopPoint, Reply, forecast, frequency_response};
use crate::law::Law;
use crate::model::Gains;
use crate::proposal::design_for;
use crate::report::Report;
use crate::request::Method;

/// The task of another level: what the run learned to be careful about stays.
#[must_use]
pub fn at_level<L: Law>(task: &Task<L>, was: f64, level: f64) -> Task<L> {
    let (before, now) = (Goal::of_level(was), Goal::of_level(level));
    let share = (task.goal.ms - 1.0) / (before.ms - 1.0);
    let noise = task.goal.noise_duty / before.noise_duty;
    let goal = Goal { ms: 1.0 + share * (now.ms - 1.0), noise_duty: noise * now.noise_duty };
    Task { goal, ..*task }
}

/// The gains of another level from the model of a run, with no new experiment. What the run took back on the machine is taken back
/// here in the same proportion.
#[must_use]
pub fn redesign<L: Law>(
    method: Method,
    task: &Task<L>,
    was: f64,
    run: &Design,
    level: f64,
) -> Option<Design> {
    let design = design_for(method, &at_level(task, was, level))?;
    let as_held = |first: Design| share_of(&run.gains, &task.law.rounded(&first.gains, task.qpps));
    let ratio = design_for(method, task).map_or(1.0, as_held);
    if ratio >= 0.999 {
        return Some(design);
    }
    let mut gains = design.gains;
    for pid in [Some(&mut gains.velocity), gains.position.as_mut()].into_iter().flatten() {
        pid.p *= ratio;
        pid.i *= ratio * ratio;
        pid.d *= ratio;
    }
    let forecast = forecast(task, &gains);
    Some(Design { gains, score: forecast.score, ms: forecast.ms, noise_duty: forecast.noise_duty })
}

/// The registers of another level, from the report of a run.
#[must_use]
pub fn redesign_registers<L: Law>(report: &Report<L>, level: f64) -> Option<L::Registers> {
    let (request, task, design) = (&report.request, report.task?, report.design?);
    if level == request.level {
        return Some(report.proposed);
    }
    let design = redesign(request.method, &task, request.level, &design, level)?;
    let travel = request.guard.travel.or(report.free_limits);
    Some(request.law.registers(&report.before?.held, &design.gains, task.qpps, travel))
}

/// What keeps the gains of a level from being stiffer; see [`limit`].
#[must_use]
pub fn limit_at<L: Law>(task: &Task<L>, was: f64, level: f64, gains: &Gains) -> Option<Limit> {
    limit(&at_level(task, was, level), gains)
}

/// The share of the first gains that was left on the machine.
fn share_of(left: &Gains, first: &Gains) -> f64 {
    let lead = |gains: &Gains| gains.position.map_or(gains.velocity.p, |position| position.p);
    if lead(first) > 0.0 { (lead(left) / lead(first)).clamp(0.0, 1.0) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Lag, Pid, PlantModel};
    use crate::plain_law::PlainLaw;

    fn task() -> Task<PlainLaw> {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };
        Task {
            plant: PlantModel {
                gain_counts_per_s: 30_000.0,
                tau_s: 0.1,
                coulomb_duty: 0.0,
                load_duty: 0.0,
                drive_limit: None,
                brake_limit: None,
                sag: 0.0,
            },
            law: PlainLaw::default(),
            lag,
            worst_lag: lag,
            qpps: 30_000.0,
            goal: Goal::of_level(50.0),
            noise_factor: 1.0,
            backlash_counts: 0.0,
            least_integral_s: 0.0,
            most_overshoot: crate::design::USUAL_OVERSHOOT,
            most_speed_gain: None,
            sd_coulomb_duty: 0.0,
        }
    }

    #[test]
    fn a_design_keeps_what_its_forecast_shows() {
        for method in [Method::Velocity, Method::Pd, Method::Pid, Method::Piv] {
            let design = design_for(method, &task()).unwrap();
            let shown = forecast(&task(), &design.gains);
            assert!(shown.is_stable, "{method:?}");
            assert!(
                (shown.ms - design.ms).abs() < 1e-9 && (shown.score.load - design.score.load).abs() < 1e-9
            );
            let most = frequency_response(&task(), &design.gains)
                .iter()
                .map(LoopPoint::sensitivity)
                .fold(0.0, f64::max);
            assert!((most - shown.ms).abs() < 1e-9, "{method:?}: {most} {}", shown.ms);
        }
    }

    #[test]
    fn a_p_loop_with_feed_forward_gives_way_to_a_load_as_its_gain_says() {
        // At rest again, the load's share of the gain is held off by 1 + P: 0.15 x 30000 / (1 + 2) counts/s.
        let gains = Gains { velocity: Pid { p: 2.0, i: 0.0, d: 0.0 }, ..Gains::default() };
        let shown = forecast(&task(), &gains);
        let end = shown.after_load.last().unwrap().value;
        assert!((end - (13_500.0 - 1_500.0)).abs() < 60.0, "{end}");
        assert!((shown.load_dip - 1_500.0 / 9_000.0).abs() < 0.02, "{}", shown.load_dip);
    }

    #[test]
    fn too_much_gain_is_reported_as_unstable() {
        let gains = Gains { velocity: Pid { p: 400.0, i: 0.0, d: 0.0 }, ..Gains::default() };
        assert!(!forecast(&task(), &gains).is_stable);
    }

    #[test]
    fn another_level_is_designed_from_the_same_model_and_stiffer_gives_less_to_a_load() {
        let first = design_for(Method::Velocity, &task()).unwrap();
        let at = |level| redesign(Method::Velocity, &task(), 50.0, &first, level).unwrap();
        assert_eq!(at(50.0), first);
        let dips = [10.0, 50.0, 90.0].map(|level| forecast(&task(), &at(level).gains).load_dip);
        assert!(dips[0] > dips[1] && dips[1] > dips[2], "{dips:?}");
        let lowered = Design {
            gains: Gains {
                velocity: Pid { p: 0.7 * first.gains.velocity.p, ..first.gains.velocity },
                ..first.gains
            },
            ..first
        };
        let again = redesign(Method::Velocity, &task(), 50.0, &lowered, 50.0).unwrap();
        assert!((again.gains.velocity.p - lowered.gains.velocity.p).abs() < 1e-9);
    }
}

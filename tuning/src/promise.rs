//! How far what gains promise may be off: the figures over all that is not known of the motor and of the lag.
//!
//! Each quantity is moved to the ends of its own interval, the others left as they are likely. The sensitivity is smooth in all of them, so that its
//! deviations add as squares (the law of error propagation). The settling time is not: it jumps where an overshoot comes to touch the band, so that it
//! gets the whole range, over narrower and wider bands too.

use crate::design::Task;
use crate::fit::Fit;
use crate::forecast::{Forecast, forecast};
use crate::lag::LagFit;
use crate::law::Law;
use crate::model::{Gains, Lag, PlantModel};

use crate::thresholds::thresholds;
use serde::Serialize;

thresholds! {
    /// How wide the ranges are. Chosen on 288 velocity loops of the bench (96 each of seeds 7, 11 and 101) and 96 of a Motion Mind (seed 7), of which they hold 92 to 97 %
    /// (MEASURED.md, "Intervals").
    PROMISE_WIDTHS: Widths {
        /// How many of its standard deviations to either side each quantity is tried at.
        deviations: f64 = 2.0,
        /// What no model of one mass tells of the sensitivity's excess over 1, as two deviations: downwards and upwards as shares of that excess, and a part that does
        /// not depend on it.
        ms: (f64, f64, f64) = (0.2, 0.4, 0.02),
        /// Narrowest and widest band that a step may be said to have settled in, as multiples of the usual one: what rounding, ripple and an unknown load do.
        bands: (f64, f64) = (0.6, 1.6),
        /// What the settling time is off by at the least, as a share of it; a tick is added.
        settling: f64 = 0.05,
    }
}

thresholds! {
    /// What the model leaves unexplained of the margins.
    PROMISE: Thresholds {
        /// Highest excess of the sensitivity over 1 where the model does not explain the closed loop, as a multiple of the one that the model has. Springy joints of the
        /// bench with such a lag had up to 4.95 times as much.
        unexplained_excess: f64 = 4.5,
    }
}

/// What gains promise, each as the range that holds the truth with a probability of about 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Promise {
    /// Maximum sensitivity.
    pub ms: (f64, f64),
    /// Settling time of a step, s, within 5 % (velocity) or 2 % (position).
    pub settling_s: (f64, f64),
}

impl Promise {
    /// What gains promise on a model that was fitted that well.
    #[must_use]
    pub fn of<L: Law>(task: &Task<L>, gains: &Gains, fit: &Fit, lag: Option<&LagFit>) -> Self {
        let likely = forecast(task, gains);
        let others = others(task, fit, lag);
        let others: Vec<[Forecast; 2]> =
            others.iter().map(|ends| ends.each_ref().map(|end| forecast(end, gains))).collect();
        let is_unexplained = lag.is_some_and(LagFit::is_unexplained);
        Self {
            ms: sensitivity(&likely, &others, is_unexplained),
            settling_s: settling(&likely, &others, task.law.tick_s()),
        }
    }
}

/// The sensitivity that a loop may have which its model does not explain.
pub(crate) fn unexplained_ms(ms: f64) -> f64 {
    1.0 + PROMISE.unexplained_excess * (ms - 1.0)
}

/// The task with each quantity at either end of its interval.
fn others<L: Law>(task: &Task<L>, fit: &Fit, lag: Option<&LagFit>) -> [[Task<L>; 2]; 4] {
    let ends = [-PROMISE_WIDTHS.deviations, PROMISE_WIDTHS.deviations];
    let with = |plant: PlantModel| Task { plant, ..*task };
    let plant = task.plant;
    let factor = |sd: f64, n: f64| (n * sd).exp();
    let tick_s = task.law.tick_s();
    let total_s = task.lag.total_s(tick_s);
    let shortest_s = lag.map_or(0.0, |lag| lag.interval_s.0).min(total_s);
    let share = if total_s > 0.0 { shortest_s / total_s } else { 1.0 };
    let shortest = Lag { filter_s: share * task.lag.filter_s, delay_ticks: share * task.lag.delay_ticks };
    [
        ends.map(|n| with(PlantModel { tau_s: plant.tau_s * factor(fit.sd_ln_tau, n), ..plant })),
        ends.map(|n| {
            with(PlantModel {
                gain_counts_per_s: plant.gain_counts_per_s * factor(fit.sd_ln_gain, n),
                ..plant
            })
        }),
        ends.map(|n| {
            with(PlantModel { coulomb_duty: (plant.coulomb_duty + n * fit.sd_coulomb).max(0.0), ..plant })
        }),
        [shortest, task.worst_lag].map(|lag| Task { lag, ..*task }),
    ]
}

fn sensitivity(likely: &Forecast, others: &[[Forecast; 2]], is_unexplained: bool) -> (f64, f64) {
    let excess = likely.ms - 1.0;
    let (below, above, constant) = PROMISE_WIDTHS.ms;
    let (mut low, mut high) = (below * excess + constant, above * excess + constant);
    for ends in others {
        let off = ends.each_ref().map(|end| end.ms - likely.ms);
        low = low.hypot(-off[0].min(off[1]).min(0.0));
        high = high.hypot(off[0].max(off[1]).max(0.0));
    }
    let high = likely.ms + high;
    let high = if is_unexplained { high.max(unexplained_ms(likely.ms)) } else { high };
    ((likely.ms - low).max(1.0), high)
}

fn settling(likely: &Forecast, others: &[[Forecast; 2]], tick_s: f64) -> (f64, f64) {
    let usual = likely.score.settling_s;
    let mut low = usual * (1.0 - PROMISE_WIDTHS.settling) - tick_s;
    let mut high = usual * (1.0 + PROMISE_WIDTHS.settling) + tick_s;
    let bands = [PROMISE_WIDTHS.bands.0, 1.0, PROMISE_WIDTHS.bands.1];
    for forecast in std::iter::once(likely).chain(others.iter().flatten()) {
        for settled in bands.map(|share| forecast.settled_within(share)) {
            low = low.min(settled);
            high = high.max(settled);
        }
    }
    (low.max(0.0), high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{design_pd, design_velocity};
    use crate::law::Windup;
    use crate::plain_law::PlainLaw;

    fn known(sd: f64, chi_square: f64) -> (Task<PlainLaw>, Fit, LagFit) {
        let lag = Lag { filter_s: 0.002, delay_ticks: 1.0 };
        let worst = Lag { delay_ticks: 1.0 + 30.0 * sd, ..lag };
        let plant = PlantModel {
            gain_counts_per_s: 30_000.0,
            tau_s: 0.08,
            coulomb_duty: 0.04,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.02,
        };
        let law = PlainLaw::default();
        let total_s = lag.total_s(law.tick_s());
        let interval_s = (total_s * (1.0 - 10.0 * sd), worst.total_s(law.tick_s()));
        let task = Task { worst_lag: worst, ..Task::new(plant, law, lag, 28_000.0) };
        let fit = Fit {
            model: plant,
            offset_s: 0.0,
            chi_square: 1.0,
            sd_ln_gain: 0.2 * sd,
            sd_ln_tau: sd,
            sd_coulomb: 0.1 * sd,
            ramp: 1.0,
        };
        (
            task,
            fit,
            LagFit {
                lag,
                worst,
                interval_s,
                tau_scale: 1.0,
                chi_square,
                least_filter_s: None,
                windup: Windup::Open,
                has_other_sum: false,
                loudness: 1.0,
            },
        )
    }

    #[test]
    fn a_range_holds_what_is_likely_and_grows_with_what_is_not_known() {
        for design in [design_velocity::<PlainLaw>, design_pd::<PlainLaw>] {
            let mut before: Option<(f64, f64)> = None;
            for sd in [0.002, 0.02, 0.05] {
                let (task, fit, lag) = known(sd, 1.0);
                let design = design(&known(0.02, 1.0).0).expect("there are gains");
                let promise = Promise::of(&task, &design.gains, &fit, Some(&lag));
                let likely = forecast(&task, &design.gains);
                assert!(promise.ms.0 < likely.ms && likely.ms < promise.ms.1, "{promise:?}");
                let (low, high) = promise.settling_s;
                assert!(low < likely.score.settling_s && likely.score.settling_s < high, "{promise:?}");
                let widths = (promise.ms.1 - promise.ms.0, high - low);
                if let Some(before) = before {
                    assert!(widths.0 > before.0 && widths.1 >= before.1, "{widths:?} after {before:?}");
                }
                before = Some(widths);
            }
        }
    }

    /// The ends are those that the loop has with motors at the ends of their intervals, not farther off than all of them at once.
    #[test]
    fn the_range_of_the_sensitivity_is_that_of_the_motors_that_are_likely() {
        let (task, fit, lag) = known(0.05, 1.0);
        let design = design_velocity(&task).expect("there are gains");
        let promise = Promise::of(&task, &design.gains, &fit, Some(&lag));
        let quick = PlantModel { tau_s: task.plant.tau_s * (-0.1_f64).exp(), ..task.plant };
        let alone = forecast(&Task { plant: quick, ..task }, &design.gains).ms;
        let all = forecast(&Task { plant: quick, lag: lag.worst, ..task }, &design.gains).ms;
        assert!(promise.ms.1 > alone && promise.ms.1 < all + 0.1, "{promise:?}, {alone}, {all}");
    }

    #[test]
    fn a_loop_that_no_lag_explains_may_be_far_more_sensitive() {
        let (task, fit, lag) = known(0.02, 1.0);
        let design = design_velocity(&task).expect("there are gains");
        let explained = Promise::of(&task, &design.gains, &fit, Some(&lag));
        let other = LagFit { chi_square: 3.0, ..lag };
        let unexplained = Promise::of(&task, &design.gains, &fit, Some(&other));
        assert_eq!(explained.ms.0, unexplained.ms.0);
        assert!(unexplained.ms.1 > explained.ms.1 + 0.5, "{explained:?} {unexplained:?}");
        // Without a record of the closed loop the lag may be none at all.
        let unmeasured = Promise::of(&task, &design.gains, &fit, None);
        assert!(unmeasured.ms.0 < explained.ms.0, "{unmeasured:?}");
    }
}

//! Gains from a model: a search over the identified, non-linear loop under a bound on the maximum sensitivity.
//!
//! An unstable loop can have a small sensitivity, so each search starts at a gain near zero, where the loop is stable, goes up
//! and stops at the first bound it meets.

pub(crate) mod binding;
pub(crate) mod position;
pub(crate) mod search;
pub(crate) mod task;
pub(crate) mod velocity;

pub use binding::{Bound, Limit, limit};
pub(crate) use position::{deadzone, direct_gains};
pub use position::{design_pd, design_pid, design_piv};
pub use task::{Design, Goal, Task, USUAL_OVERSHOOT};
pub use velocity::design_velocity;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Gains, Lag, Pid, PlantModel};
    use crate::plain_law::PlainLaw;
    use crate::score::{POSITION_OVERSHOOT, VELOCITY_OVERSHOOT};
    use crate::ticks::{position_test_and_end, velocity_test};

    fn task(level: f64) -> Task<PlainLaw> {
        let lag = Lag { filter_s: 0.004, delay_ticks: 1.0 };
        let plant = PlantModel {
            gain_counts_per_s: 30_000.0,
            tau_s: 0.1,
            coulomb_duty: 0.05,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.03,
        };
        Task { goal: Goal::of_level(level), ..Task::new(plant, PlainLaw::default(), lag, 28_000.0) }
    }

    /// Over 12 motors whose friction is known to a twelfth: what gains cost in the mean of as much less, the same and more of it, beside gains for the likely friction alone.
    #[test]
    fn gains_that_come_out_well_by_where_friction_stops_them_are_not_taken() {
        type Method = fn(&Task<PlainLaw>) -> Option<Design>;
        let methods: [(&str, Method); 2] = [("pd", design_pd), ("pid", design_pid)];
        for (name, method) in methods {
            let mut worth = 0.0;
            for n in 0..12 {
                let n = f64::from(n);
                let (gain, tau_s, coulomb) = (4_000.0 + 350.0 * n, 0.05 + 0.008 * n, 0.06 + 0.004 * n);
                let of = |coulomb_duty: f64| PlantModel {
                    gain_counts_per_s: gain,
                    tau_s,
                    coulomb_duty,
                    ..task(50.0).plant
                };
                let qpps = gain * (1.0 - coulomb);
                let known = Task { plant: of(coulomb), qpps, ..task(50.0) };
                let doubted = Task { sd_coulomb_duty: coulomb / 12.0, ..known };
                let mean = |task: &Task<PlainLaw>| {
                    let gains = method(task).expect("gains").gains;
                    let cost = |share: f64| {
                        let plant = of(share * coulomb);
                        let test = position_test_and_end(&plant, &task.law, task.lag, &gains, qpps);
                        test.0.cost(POSITION_OVERSHOOT)
                    };
                    [-2.0, 0.0, 2.0].map(|by| cost(1.0 + by / 12.0)).iter().sum::<f64>()
                };
                worth += (mean(&known) / mean(&doubted)).ln() / 12.0;
            }
            assert!(worth.exp() > 1.02, "{name}: {:.3} times as much", worth.exp());
        }
    }

    #[test]
    fn every_method_keeps_its_goal_at_every_level_and_stiffer_is_never_slower() {
        type Method = fn(&Task<PlainLaw>) -> Option<Design>;
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
    fn a_pid_is_never_worse_than_the_pd_that_it_may_be() {
        for (tau_s, gain_counts_per_s) in
            [(0.012, 150_000.0), (0.05, 3_000.0), (0.1, 30_000.0), (1.0, 30_000.0)]
        {
            let task = task(50.0);
            let plant = PlantModel { tau_s, gain_counts_per_s, ..task.plant };
            let task = Task { plant, qpps: 0.95 * gain_counts_per_s, ..task };
            let cost = |design: Option<Design>| {
                design.map(|design| design.score.cost(POSITION_OVERSHOOT)).expect("gains")
            };
            // A PD has no dead zone of a count, and each search ends somewhere near its best.
            let (pd, pid) = (cost(design_pd(&task)), cost(design_pid(&task)));
            assert!(pid <= 1.15 * pd, "tau {tau_s} s: {pid} with an integral, {pd} without");
        }
    }

    #[test]
    fn gains_beside_a_bounded_speed_gain_cost_less_than_all_of_them_scaled_where_that_is_smooth() {
        type Method = fn(&Task<PlainLaw>) -> Option<Design>;
        let methods: [(&str, Method); 3] =
            [("velocity", design_velocity), ("pd", design_pd), ("piv", design_piv)];
        for (name, method) in methods {
            let (free, share) = (method(&task(50.0)).expect("gains"), 0.6);
            let bound = share * free.gains.speed_gain();
            let task = Task { most_speed_gain: Some(bound), ..task(50.0) };
            let bounded = method(&task).expect("gains");
            assert!(bounded.gains.speed_gain() <= 1.000_01 * bound, "{name}: {bounded:?}");
            let less = |pid: Pid| Pid { p: share * pid.p, i: share * pid.i, d: share * pid.d };
            let gains = Gains {
                velocity: less(free.gains.velocity),
                position: free.gains.position.map(less),
                ..free.gains
            };
            let (scaled, overshoot) = match gains.position {
                None => {
                    (velocity_test(&task.plant, &task.law, task.lag, &gains, task.qpps), VELOCITY_OVERSHOOT)
                }
                Some(_) => {
                    let test = position_test_and_end(&task.plant, &task.law, task.lag, &gains, task.qpps);
                    (test.0, POSITION_OVERSHOOT)
                }
            };
            let is_smooth = scaled.overshoot <= task.most_overshoot;
            let [free, bounded, scaled] =
                [free.score, bounded.score, scaled].map(|score| score.cost(overshoot));
            assert!(
                free < 1.1 * bounded && (!is_smooth || bounded < scaled),
                "{name}: {free} free, {bounded} bounded, {scaled} scaled"
            );
        }
    }

    #[test]
    fn a_quick_motor_does_not_overshoot_where_its_current_limit_comes_late() {
        for (tau_s, delay_ticks) in [(0.006, 0.2), (0.008, 0.5), (0.010, 1.2), (0.014, 1.0)] {
            let task = task(50.0);
            let plant =
                PlantModel { tau_s, gain_counts_per_s: 160_000.0, drive_limit: Some(0.39), ..task.plant };
            let lag = Lag { filter_s: 0.0, delay_ticks };
            let task = Task { plant, lag, worst_lag: lag, qpps: 150_000.0, ..task };
            let gains = design_velocity(&task).expect("gains").gains;
            let unlimited = PlantModel { drive_limit: None, ..plant };
            let overshoot = velocity_test(&unlimited, &task.law, lag, &gains, task.qpps).overshoot;
            assert!(overshoot < 0.25, "tau {tau_s} s: {overshoot} without the limit");
        }
    }

    #[test]
    fn the_same_task_gives_the_same_gains_to_the_last_bit() {
        assert_eq!(design_piv(&task(50.0)), design_piv(&task(50.0)));
    }
}

//! The lag that hides in the firmware's loop, measured on the closed loop.
//!
//! Polls at 50 to 100 Hz cannot see a few milliseconds in the counts of an open loop. In a closed one the duty is the
//! controller's own answer to the speed as it sees it: the candidate loop is simulated with each lag of a grid, and the
//! lags under which simulated counts and duties agree with the polled ones are the likely ones.

use crate::experiment_guard::{ExperimentGuard, Input};
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, Lag, PlantModel};
use crate::ticks::{Setpoint, TickLoop};
use serde::{Deserialize, Serialize};

/// Time constants tried, in prior standard deviations of their logarithm, and the bounds of that deviation.
const TAU_STEPS: [f64; 9] = [-2.4, -1.8, -1.2, -0.6, 0.0, 0.6, 1.2, 1.8, 2.4];
const TAU_PRIOR: (f64, f64) = (0.02, 0.6);
/// Offsets of commands against stamps tried, s, and their prior.
const OFFSETS_S: [f64; 4] = [-0.0015, 0.0, 0.0015, 0.003];
const OFFSET_PRIOR_S: (f64, f64) = (0.0, 0.0015);
/// How much of the delay may lie in the winding, ticks: the duty is read before it, the counts behind it.
const WINDINGS_TICKS: [f64; 3] = [0.0, 0.5, 1.0];
/// What the model is trusted to, as duty and as a share of the step's counts per poll.
const MODEL_DUTY: f64 = 0.006;
/// Standard deviation of a time stamp, s.
const STAMP_S: f64 = 0.0012;
/// An exchange that took this much longer than the shortest says too little about when its counts were read, s.
const LATE_S: f64 = 0.004;
/// Residuals beyond this many standard deviations say no more.
const SOFT_SQUARE: f64 = 25.0;

/// The closed-loop record.
#[derive(Clone, Debug, Default)]
pub struct ClosedLoopRecord {
    /// (time, setpoint speed).
    pub setpoints: Vec<(f64, f64)>,
    /// (time, counts).
    pub counts: Vec<(f64, f64)>,
    /// (time, duty).
    pub duties: Vec<(f64, f64)>,
    /// Standard deviation of the times of counts, as far as a busy host or line makes it, s.
    pub stamp_s: f64,
    /// Whether each count came with its own time, so that it is known to much less than a tick.
    pub is_dated: bool,
}

impl ClosedLoopRecord {
    /// What the experiment guard recorded between two times under speed commands.
    #[must_use]
    pub fn of<L: Law>(guard: &ExperimentGuard<'_, L>, from_s: f64, to_s: f64) -> Self {
        let inside = |t: f64| t >= from_s && t <= to_s;
        let setpoints = guard.drives.iter().filter(|d| inside(d.t)).filter_map(|d| match d.input {
            Input::Speed(speed) => Some((d.t, speed)),
            Input::Duty(_) | Input::Position(..) => None,
        });
        let points = || guard.points.iter().zip(&guard.exchanges).filter(|(p, _)| inside(p.t));
        // The quickest exchanges show what the line takes by itself; when in a longer one the counts were read is open.
        let shortest = points().map(|(_, took)| took.1).fold(f64::INFINITY, f64::min);
        let prompt = || points().filter(|(_, took)| took.1 - shortest <= LATE_S);
        let n = prompt().count().max(1) as f64;
        let stamps = L::stamps(&guard.setup.held);
        let open = prompt().map(|(_, took)| (took.1 - shortest).powi(2)).sum::<f64>() / n;
        Self {
            setpoints: setpoints.collect(),
            counts: prompt().map(|(p, _)| (p.t, p.counts)).collect(),
            duties: points().filter_map(|(p, _)| p.duty).collect(),
            stamp_s: (open / 12.0).sqrt().hypot(stamps.open_s),
            is_dated: stamps.are_dated,
        }
    }
}

/// The lag and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LagFit {
    /// The most likely lag.
    pub lag: Lag,
    /// The lag of the longest total that is still likely.
    pub worst: Lag,
    /// Shortest and longest likely total, s.
    pub interval_s: (f64, f64),
    /// Time constant that goes with the most likely lag, relative to the model's.
    pub tau_scale: f64,
    /// Reduced chi-square of the best.
    pub chi_square: f64,
}

struct Case {
    lag: Lag,
    tau_scale: f64,
    /// What is compared: misfit, and how much of it was to be expected.
    cost: f64,
    misfit: f64,
}

/// Fits the lag. `sd_ln_tau` is how loosely the time constant is known.
#[must_use]
pub fn fit_lag<L: Law>(
    record: &ClosedLoopRecord,
    plant: &PlantModel,
    law: &L,
    gains: &Gains,
    qpps: f64,
    sd_ln_tau: f64,
) -> Option<LagFit> {
    if record.setpoints.len() < 3 || record.duties.len() < 20 {
        return None;
    }
    let spread = (1.5 * sd_ln_tau).clamp(TAU_PRIOR.0, TAU_PRIOR.1);
    let mut cases: Vec<Case> = Vec::new();
    for &filter_s in law.facts().filters_s {
        for &delay_ticks in law.facts().delays_ticks {
            let lag = Lag { filter_s, delay_ticks };
            // A lag that lets more of the rounding through explains a rougher duty.
            let linear = LoopPlant::new(DiscretePlant::of(plant, law.tick_s()), law, lag);
            let sigma_duty = linear.margins(gains, qpps).noise_duty.hypot(MODEL_DUTY);
            let spread_cost = 2.0 * record.duties.len() as f64 * (sigma_duty / MODEL_DUTY).ln();
            for step in TAU_STEPS {
                let tau_scale = (step * spread).exp();
                let model = PlantModel { tau_s: plant.tau_s * tau_scale, ..*plant };
                for offset_s in OFFSETS_S {
                    let twin = TickLoop::new(model, *law, lag, *gains, qpps).smooth();
                    let mut cost = step.powi(2) + ((offset_s - OFFSET_PRIOR_S.0) / OFFSET_PRIOR_S.1).powi(2);
                    cost += mismatch(record, twin, law, offset_s, sigma_duty);
                    cases.push(Case { lag, tau_scale, cost: cost + spread_cost, misfit: cost });
                }
            }
        }
    }
    let best = cases.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let readings = (record.counts.len() + record.duties.len()) as f64;
    let chi_square = best.misfit / readings;
    // What the model explains badly it also locates badly.
    let likely = best.cost + 4.0 * chi_square.max(1.0).powi(2);
    let total = |case: &&Case| case.lag.total_s(law.tick_s());
    let within = || cases.iter().filter(|case| case.cost < likely);
    let shortest = within().map(|c| total(&c)).fold(f64::INFINITY, f64::min);
    let worst = within().max_by(|a, b| total(a).total_cmp(&total(b)))?;
    Some(LagFit {
        lag: best.lag,
        worst: worst.lag,
        interval_s: (shortest, worst.lag.total_s(law.tick_s())),
        tau_scale: best.tau_scale,
        chi_square,
    })
}

/// What a loop does under the setpoints of a record, tick by tick from its first poll on.
struct Followed {
    start: f64,
    tick_s: f64,
    positions: Vec<f64>,
    duties: Vec<f64>,
}

impl Followed {
    /// `started` says whether the loop is at work before the first setpoint of the record. `offset_s` is how long after its stamp a
    /// setpoint takes effect.
    fn new<L: Law>(
        record: &ClosedLoopRecord,
        mut twin: TickLoop<L>,
        law: &L,
        offset_s: f64,
        before: Option<f64>,
    ) -> Option<Self> {
        let tick_s = law.tick_s();
        let (start, end) = (record.counts.first()?.0, record.counts.last()?.0);
        let ticks = ((end - start) / tick_s) as usize + 2;
        let (mut positions, mut duties) = (Vec::with_capacity(ticks), Vec::with_capacity(ticks));
        let (mut next, mut goal) = (0, before);
        for n in 0..ticks {
            let t = start + n as f64 * tick_s;
            while let Some(&(at, speed)) = record.setpoints.get(next)
                && at + offset_s <= t
            {
                goal = Some(speed);
                next += 1;
            }
            positions.push(twin.motion.position);
            if let Some(speed) = goal {
                twin.tick(Setpoint::Speed(speed), 0.0);
            }
            duties.push(twin.duty);
        }
        Some(Self { start, tick_s, positions, duties })
    }

    fn position_at(&self, t: f64) -> f64 {
        // Assumed: the register is refreshed once a tick, so a reading is half a tick old on average.
        let x = ((t - self.start) / self.tick_s - 0.5).max(0.0);
        let n = (x as usize).min(self.positions.len() - 2);
        self.positions[n] + (self.positions[n + 1] - self.positions[n]) * (x - n as f64).min(1.0)
    }
}

/// The record that a loop, at work at the speed `before`, would have given under the same setpoints and polls.
pub(crate) fn predicted_record<L: Law>(
    record: &ClosedLoopRecord,
    twin: TickLoop<L>,
    law: &L,
    before: f64,
) -> Option<ClosedLoopRecord> {
    let followed = Followed::new(record, twin, law, 0.5 * law.tick_s(), Some(before))?;
    let counts = record.counts.iter().map(|&(t, _)| (t, followed.position_at(t).floor())).collect();
    Some(ClosedLoopRecord { setpoints: record.setpoints.clone(), counts, ..ClosedLoopRecord::default() })
}

/// Sum of the squared misfits of counts (differences between polls) and duties.
fn mismatch<L: Law>(
    record: &ClosedLoopRecord,
    twin: TickLoop<L>,
    law: &L,
    offset_s: f64,
    sigma_duty: f64,
) -> f64 {
    let Some(followed) = Followed::new(record, twin, law, offset_s, None) else { return f64::INFINITY };
    let (start, tick_s, duties) = (followed.start, followed.tick_s, &followed.duties);
    let ticks = duties.len();
    let stamp_s = STAMP_S.hypot(record.stamp_s);
    let mut sum = 0.0;
    // The start from rest is the business of friction and of the current limit, not of the lag.
    let from_s = record.setpoints.get(1).map_or(start, |second| second.0 - 0.01);
    for pair in record.counts.windows(2) {
        let ((t0, y0), (t1, y1)) = (pair[0], pair[1]);
        if t0 < from_s {
            continue;
        }
        let moved = followed.position_at(t1) - followed.position_at(t0);
        let speed = (y1 - y0) / (t1 - t0).max(1e-4);
        let variance = 0.66 + (stamp_s * speed).powi(2) + (0.01 * (y1 - y0)).powi(2);
        sum += ((y1 - y0 - moved).powi(2) / variance).min(SOFT_SQUARE);
    }
    let duties_with = |winding_ticks: f64| -> f64 {
        let misfit = |&(t, duty): &(f64, f64)| {
            let n = (((t - start) / tick_s + winding_ticks).max(0.0) as usize).min(ticks - 1);
            // A stamp may be off by a tick either way: a steep flank counts with its own height.
            let (before, after) = (duties[n.saturating_sub(1)], duties[(n + 1).min(ticks - 1)]);
            let variance = sigma_duty.powi(2) + (0.25 * (after - before)).powi(2);
            ((duty - duties[n]).powi(2) / variance).min(SOFT_SQUARE)
        };
        record.duties.iter().filter(|duty| duty.0 > from_s).map(misfit).sum()
    };
    sum + WINDINGS_TICKS.iter().map(|&ticks| duties_with(ticks)).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Pid;
    use crate::plain_law::PlainLaw;

    const PLANT: PlantModel = PlantModel {
        gain_counts_per_s: 40_000.0,
        tau_s: 0.12,
        coulomb_duty: 0.05,
        load_duty: 0.0,
        drive_limit: None,
        brake_limit: None,
        sag: 0.0,
    };
    const GAINS: Gains = Gains {
        velocity: Pid { p: 3.0, i: 20.0, d: 0.0 },
        velocity_sum: 0.0,
        position: None,
        max_integral: 0.0,
        deadzone_counts: 0.0,
    };

    /// Steps of a loop with a known lag, polled every 12.3 ms.
    fn known_record(lag: Lag) -> ClosedLoopRecord {
        let law = PlainLaw::default();
        let mut twin = TickLoop::new(PLANT, law, lag, GAINS, 40_000.0);
        let mut record = ClosedLoopRecord::default();
        for n in 0..5 {
            let speed = if n % 2 == 0 { 15_000.0 } else { 20_000.0 };
            record.setpoints.push((0.02 + 0.35 * f64::from(n), speed));
        }
        let mut poll = 0.0;
        for tick in 0..540 {
            let t = f64::from(tick) * law.tick_s();
            let goal = record.setpoints.iter().rev().find(|s| s.0 <= t).map(|s| s.1);
            let position = twin.motion.position;
            if let Some(goal) = goal {
                twin.tick(Setpoint::Speed(goal), 0.0);
            }
            if t >= poll {
                // A reading is half a tick old.
                record.counts.push((t + 0.5 * law.tick_s(), position.floor()));
                record.duties.push((t + 0.5 * law.tick_s(), twin.duty));
                poll += 0.0123;
            }
        }
        record
    }

    #[test]
    fn a_known_lag_is_found_again_and_lies_in_its_interval() {
        let law = PlainLaw::default();
        for lag in [
            Lag::default(),
            Lag { filter_s: 0.004, delay_ticks: 1.0 },
            Lag { filter_s: 0.010, delay_ticks: 0.0 },
            Lag { filter_s: 0.010, delay_ticks: 1.0 },
        ] {
            let found =
                fit_lag(&known_record(lag), &PLANT, &law, &GAINS, 40_000.0, 0.03).expect("enough readings");
            let (got, wanted) = (found.lag.total_s(law.tick_s()), lag.total_s(law.tick_s()));
            assert!((got - wanted).abs() < 0.0025, "{got} s instead of {wanted} s: {found:?}");
            assert!(found.chi_square < 1.5, "{found:?}");
        }
    }

    #[test]
    fn a_record_without_steps_says_nothing() {
        assert!(
            fit_lag(&ClosedLoopRecord::default(), &PLANT, &PlainLaw::default(), &GAINS, 40_000.0, 0.1)
                .is_none()
        );
    }
}

//! Backlash of the mechanics, read off reversals: a push the other way loses the backlash that a second push the same way does not.
//!
//! Only an encoder behind the backlash sees any of it; one on the motor's own shaft counts the travel through it as any other. A load that
//! coasts through the backlash while the motor brakes hides a part of it, so what is found is a lower bound.

use super::Probe;
use crate::cause::Cause;
use crate::diagnosis::why_unmoved;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::model::PlantModel;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// How play is measured: small pushes this way and that from rest.
    BACKLASH: Thresholds {
        /// Directions of the pushes, 1 or -1: after each pair comes a reversal.
        pushes: [f64; 7] = [1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0],
        /// Duty of a push above the starting one: as a share of it, and at the least as a share of full.
        above: (f64, f64) = (0.3, 0.03),
        /// How far a push should go: the way of so many seconds at full speed.
        push_s: f64 = 0.006,
        /// How far a push should go at the least, in counts.
        push_counts: f64 = 18.0,
        /// How far a push may go at the most, as a share of the room.
        room_share: f64 = 0.12,
        /// Longest push, in seconds.
        longest_push_s: f64 = 0.35,
        /// How long the motor may take to rest after a push: time constants, and seconds on top.
        rest: (f64, f64) = (4.0, 0.08),
        /// The longest that this may be, in seconds.
        longest_rest_s: f64 = 1.0,
        /// Time constant, in seconds, above which motors are still moving when they are looked at.
        slowest_s: f64 = 0.3,
        /// Least distance by which a push moves the axis, in counts.
        least_distance_counts: f64 = 2.0,
        /// Backlash that is reported is more than this, in counts.
        least_counts: f64 = 1.5,
        /// Backlash that is reported is more than so many of its standard errors.
        sure: f64 = 3.0,
        /// Backlash that is reported is more than this share of the push.
        least_share: f64 = 0.04,
        /// Student's t of 95 % for one degree of freedom to six: the seven pushes have four.
        students_t: [f64; 6] = [12.71, 4.30, 3.18, 2.78, 2.57, 2.45],
        /// Standard error that rounding leaves, in counts.
        least_error_counts: f64 = 0.4,
    }
}

/// What the reversals showed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Backlash {
    /// Counts lost at a reversal, a lower bound of the backlash; 0 where nothing is sure.
    pub counts: f64,
    /// Half of the 95 % interval, counts.
    pub interval_counts: f64,
    /// Reversals seen.
    pub reversals: usize,
}

/// Pushes the axis to and fro with little duty. `None` where there is no room for it, or it did not move.
pub fn measure_backlash<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    model: &PlantModel,
) -> Result<Option<Backlash>, Cause> {
    let room = guard.room_counts().map_or(f64::INFINITY, |room| BACKLASH.room_share * room);
    let distance = (BACKLASH.push_s * model.gain_counts_per_s).max(BACKLASH.push_counts).min(room);
    if distance < 6.0 || model.tau_s > BACKLASH.slowest_s {
        return Ok(None);
    }
    // The motor was started upwards, against the load or with it.
    let start = (probe.start_duty - model.load_duty).max(model.coulomb_duty);
    let most = guard.options.max_duty - model.load_duty.abs();
    let duty = (start + (BACKLASH.above.0 * start).max(BACKLASH.above.1)).min(most);
    let push_s = push_time_s(model, duty, distance);
    let rest_s = (BACKLASH.rest.0 * model.tau_s + BACKLASH.rest.1).min(BACKLASH.longest_rest_s);
    // Backlash looks like a stall for a while. The duty is low, and a motor that does not move ends the run here.
    let kept_start_duty = std::mem::take(&mut guard.monitor.start_duty);
    let distances = push(guard, duty, model.load_duty, push_s, rest_s);
    guard.monitor.start_duty = kept_start_duty;
    let distances = distances?;
    if did_not_move(&distances) {
        let backwards =
            distances.iter().rev().take(2).all(|(_, distance)| *distance <= -BACKLASH.least_distance_counts);
        return Err(why_unmoved(&guard.monitor, backwards));
    }
    Ok(Some(backlash_of(&distances)))
}

/// Whether two pushes in a row moved nothing: one may end in the backlash.
fn did_not_move(distances: &[(f64, f64)]) -> bool {
    distances
        .windows(2)
        .any(|pair| pair.iter().all(|(_, distance)| *distance < BACKLASH.least_distance_counts))
}

/// Pushes with a duty to either side of the one that balances the load. For each push: 1 for another one in the same
/// direction, -1 for one after a reversal, 0 for the first; and its distance, counts.
fn push<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    duty: f64,
    load_duty: f64,
    push_s: f64,
    rest_s: f64,
) -> Result<Vec<(f64, f64)>, Cause> {
    let mut distances = Vec::new();
    let mut before = 0.0;
    for direction in BACKLASH.pushes {
        guard.poll(false)?;
        let from = position(guard);
        guard.duty(load_duty + direction * duty)?;
        let pushed_s = guard.now_s();
        guard.poll_for(push_s, false)?;
        let held_s = guard.now_s() - pushed_s;
        if guard.monitor.drew_nothing(pushed_s) {
            return Err(Cause::MotorOpened);
        }
        guard.duty(0.0)?;
        guard.poll_for(rest_s, false)?;
        // A computer that was late pushed for longer.
        distances.push((
            before * direction,
            (position(guard) - from) * direction * (push_s / held_s.max(1e-3)).min(1.0),
        ));
        before = direction;
        if did_not_move(&distances) {
            break;
        }
    }
    Ok(distances)
}

fn position<L: Law>(guard: &ExperimentGuard<'_, L>) -> f64 {
    let last = guard.points.iter().rev().take(3).map(|p| p.counts);
    last.sum::<f64>() / guard.points.len().clamp(1, 3) as f64
}

/// Time for a distance from rest at a duty.
fn push_time_s(model: &PlantModel, duty: f64, distance: f64) -> f64 {
    let speed = model.gain_counts_per_s * (duty - model.coulomb_duty).max(0.02);
    let tau = model.tau_s;
    let mut t = 0.02;
    while t < BACKLASH.longest_push_s && speed * (t - tau * (1.0 - (-t / tau).exp())) < distance {
        t += 0.005;
    }
    t
}

/// What the pushes after a reversal are short of the others.
fn backlash_of(distances: &[(f64, f64)]) -> Backlash {
    let of = |turned: bool| -> Vec<f64> {
        distances
            .iter()
            .filter(|(turn, _)| if turned { *turn < 0.0 } else { *turn > 0.0 })
            .map(|(_, distance)| *distance)
            .collect()
    };
    let (same, turned) = (of(false), of(true));
    let (a, b) = (mean_and_error(&same), mean_and_error(&turned));
    let (short, error) = (a.0 - b.0, a.1.hypot(b.1).max(BACKLASH.least_error_counts));
    let is_sure =
        short > BACKLASH.least_counts && short > BACKLASH.sure * error && short > BACKLASH.least_share * a.0;
    let freedom = (same.len() + turned.len()).saturating_sub(2).clamp(1, BACKLASH.students_t.len());
    Backlash {
        counts: if is_sure { short } else { 0.0 },
        interval_counts: BACKLASH.students_t[freedom - 1] * error,
        reversals: turned.len(),
    }
}

fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    (mean, (square / n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lost_at_reversals_is_the_backlash_and_scatter_is_none() {
        let pushes =
            [(0.0, 30.0), (1.0, 30.0), (-1.0, 22.0), (1.0, 31.0), (-1.0, 21.0), (1.0, 30.0), (-1.0, 23.0)];
        let found = backlash_of(&pushes);
        assert!((found.counts - 8.33).abs() < 0.1, "{found:?}");
        assert_eq!(found.reversals, 3);
        // Variances of 1/3 and 1 over three pushes each; Student's t of four degrees of freedom.
        assert!((found.interval_counts - 2.78 * (4.0_f64 / 9.0).sqrt()).abs() < 1e-9, "{found:?}");
        let noisy =
            pushes.map(|(turn, distance)| (turn, if turn > 0.0 { distance - 6.0 * turn } else { distance }));
        assert!(backlash_of(&noisy).counts < 4.0);
        let rigid = pushes.map(|(turn, distance)| (turn, if turn < 0.0 { 31.0 } else { distance }));
        assert_eq!(backlash_of(&rigid).counts, 0.0);
    }
}

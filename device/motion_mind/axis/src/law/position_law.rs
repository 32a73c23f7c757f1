//! The law of a Motion Mind in figures: one loop on the position, with feed-forward and a bounded sum.

use brushwork_tuning::model::{Gains, Pid};
use serde::{Deserialize, Serialize};

/// Loops in a second (Motion Mind manual 3.15).
pub const LOOPS_PER_S: u32 = 200;
/// The step of a speed command, counts/s: one count in each loop.
pub const SPEED_STEP_COUNTS_PER_S: f64 = LOOPS_PER_S as f64;
/// Full duty.
pub const FULL_PWM: f64 = 1023.0;
/// VELOCITYFF that adds one step of duty for each count and loop.
pub const FULL_FEED_FORWARD: u8 = 255;
/// Bounds of the sum of errors, counts x loops: with SATPROT and without (Motion Mind manual, figure 20).
const SUM_BOUNDS: [f64; 2] = [4_096.0, 120_000.0];
/// The same, counts x s.
pub(crate) const SUM_BOUNDS_S: [f64; 2] =
    [SUM_BOUNDS[0] / SPEED_STEP_COUNTS_PER_S, SUM_BOUNDS[1] / SPEED_STEP_COUNTS_PER_S];

/// What the law has beyond the gains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MotionMindLaw {
    /// VELOCITYFF.
    pub velocity_ff: u8,
    /// AMPSLIMIT, 20 mA; 0 = the current is not limited.
    pub amps_limit: u16,
}

impl MotionMindLaw {
    /// The feed-forward that a motor wants, as far as the register can carry it. It is full below 204,600 counts/s at full duty.
    #[must_use]
    pub fn of_qpps(qpps: f64) -> Self {
        let wanted = f64::from(FULL_FEED_FORWARD) * FULL_PWM * SPEED_STEP_COUNTS_PER_S / qpps.max(1.0);
        Self { velocity_ff: wanted.round().min(f64::from(FULL_FEED_FORWARD)) as u8, ..Self::default() }
    }

    /// Share of the duty of a steady speed, friction aside, that the feed-forward gives.
    #[must_use]
    pub fn covered(&self, qpps: f64) -> f64 {
        let share = f64::from(self.velocity_ff) / f64::from(FULL_FEED_FORWARD);
        share * qpps / SPEED_STEP_COUNTS_PER_S / FULL_PWM
    }
}

/// The gains on the error of the position: counts in, counts/s out, over QPPS a duty.
#[must_use]
pub(crate) fn on_position(gains: &Gains) -> Pid {
    gains.position.unwrap_or(Pid { p: gains.velocity.i, i: gains.velocity_sum, d: gains.velocity.p })
}

/// The smaller bound of the sum that suffices, as counts x s: SATPROT where it does, since it keeps the sum from winding up.
#[must_use]
pub(crate) fn sum_bound_s(wanted: f64) -> f64 {
    let [protected, plain] = SUM_BOUNDS_S;
    if wanted <= protected * 1.000_001 { protected } else { plain }
}

/// Whether a bound of the sum is that of SATPROT.
#[must_use]
pub(crate) fn is_protected(max_integral: f64) -> bool {
    sum_bound_s(max_integral) == SUM_BOUNDS_S[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_feed_forward_is_full_below_204600_counts_per_second() {
        assert_eq!(MotionMindLaw::of_qpps(20_460.0).velocity_ff, 255);
        assert!((MotionMindLaw::of_qpps(20_460.0).covered(20_460.0) - 0.1).abs() < 1e-9);
        assert_eq!(MotionMindLaw::of_qpps(204_601.0).velocity_ff, 255);
        assert_eq!(MotionMindLaw::of_qpps(409_200.0).velocity_ff, 128);
        assert!((MotionMindLaw::of_qpps(409_200.0).covered(409_200.0) - 1.0).abs() < 0.005);
    }

    #[test]
    fn the_smaller_bound_of_the_sum_is_taken_where_it_suffices() {
        assert!(is_protected(20.0) && is_protected(20.48) && !is_protected(20.5));
        assert_eq!(sum_bound_s(100.0), 600.0);
    }
}

//! Overshoot and oscillation of a velocity loop, read off polls that see neither well.
//!
//! A difference of two polls is a poor speed: a count is rounded, and the register it comes from is up to a tick old. Flanks are
//! therefore laid over each other by their commands, and a plateau is searched for sines, whose counts grow as they get slower.

use crate::closed_loop_record::{ClosedLoopRecord, CountAge};
use crate::thresholds::thresholds;
use nalgebra::{Matrix4, Vector4};
use std::f64::consts::TAU;

thresholds! {
    /// Which noise of a record counts as an oscillation.
    pub(crate) OSCILLATION: Thresholds {
        /// Variance of a count's rounding, in counts squared.
        rounding: f64 = 1.0 / 12.0,
        /// Standard deviation of the time of a count at 300 Hz, in seconds.
        stamp_s: f64 = 0.001,
        /// Lowest and highest frequency of the oscillations looked for, in hertz.
        oscillations_hz: (f64, f64) = (2.5, 16.0),
        /// Highest frequency that counts show which came with their time, in hertz.
        dated_oscillations_hz: f64 = 33.0,
        /// How uncertain an average of flanks may be, as a share of the step.
        uncertain: f64 = 0.03,
        /// Least and greatest half width of such an average, in seconds.
        width_s: (f64, f64) = (0.004, 0.25),
        /// How many times louder a speed may be than the duty that answers it says: a loop answers every oscillation that it sees. What the polls make up
        /// of the age of a register, which beats with the tick, is not in the duty.
        louder: f64 = 2.0,
    }
}

/// Standard deviation of dated values about a slow trend, the cubic that fits them best; 0 of fewer than eight.
#[must_use]
pub fn deviation(values: &[(f64, f64)]) -> f64 {
    if values.len() < 8 {
        return 0.0;
    }
    let rest = detrended(values);
    (rest.iter().map(|r| r.1 * r.1).sum::<f64>() / (rest.len() as f64 - 4.0)).sqrt()
}

/// What a loop answers to a speed: its duties over the same plateau, and the duty that a speed of 1 count/s at an angular frequency makes.
pub(crate) struct Answer<'a> {
    pub(crate) duties: &'a [(f64, f64)],
    pub(crate) duty_per_speed: &'a dyn Fn(f64) -> f64,
}

/// Root mean square of the speed about a plateau in counts/s, as far as it is more than rounding and stamps make up, and as far as the loop answers
/// it. `plateau` is a part of the record.
pub(crate) fn speed_ripple(
    plateau: &[(f64, f64)],
    record: &ClosedLoopRecord,
    answer: Option<&Answer<'_>>,
) -> f64 {
    let highest_hz = if record.age == CountAge::Dated {
        OSCILLATION.dated_oscillations_hz
    } else {
        OSCILLATION.oscillations_hz.1
    };
    let (Some(first), Some(last)) = (plateau.first(), plateau.last()) else { return 0.0 };
    let seconds = last.0 - first.0;
    if plateau.len() < 20 || seconds <= 0.0 {
        return 0.0;
    }
    let speed = (last.1 - first.1) / seconds;
    let rest = detrended(plateau);
    let n = rest.len() as f64;
    let nyquist = 0.45 * n / seconds;
    let answered = answer.filter(|answer| answer.duties.len() >= 20);
    let duties = answered.map(|answer| detrended(answer.duties)).unwrap_or_default();
    let most = |w: f64| {
        let bound = |answer: &Answer<'_>| {
            (OSCILLATION.louder / (answer.duty_per_speed)(w)).powi(2) * mean_square(&duties, w)
        };
        answered.map_or(f64::INFINITY, bound)
    };
    let first = (OSCILLATION.oscillations_hz.0 * seconds).ceil().max(3.0) as usize;
    let sines: Vec<(f64, f64)> = (first..)
        .map(|k| TAU * k as f64 / seconds)
        .take_while(|w| *w <= TAU * nyquist)
        .map(|w| (w, mean_square(&rest, w)))
        .collect();
    // What noise alone gives each sine: what is known of it, or what most sines show (exponentially distributed) where that is less.
    let known =
        2.0 * (OSCILLATION.rounding + (OSCILLATION.stamp_s.hypot(record.stamp_s) * speed).powi(2)) / n;
    let mut sorted: Vec<f64> = sines.iter().map(|sine| sine.1).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let floor = known.min(middle / std::f64::consts::LN_2);
    let looked_at = sines.iter().take_while(|(w, _)| *w <= TAU * highest_hz);
    looked_at.map(|(w, square)| (w * w * (square - floor)).min(most(*w))).sum::<f64>().max(0.0).sqrt()
}

/// Mean square of a sine in values about their trend.
fn mean_square(rest: &[(f64, f64)], w: f64) -> f64 {
    let n = rest.len() as f64;
    let project = |(c, s): (f64, f64), (t, y): &(f64, f64)| (c + y * (w * t).cos(), s + y * (w * t).sin());
    let (c, s) = rest.iter().fold((0.0, 0.0), project);
    2.0 * (c * c + s * s) / (n * n)
}

/// How far the speed goes past its setpoint after a flank, over the step: the flanks of the record laid over each other.
pub(crate) fn flank_overshoot(record: &ClosedLoopRecord, step: f64, poll_s: f64) -> f64 {
    let mut shares: Vec<(f64, f64)> = Vec::new();
    for (n, &(at, goal)) in record.setpoints.iter().enumerate() {
        let until = record.setpoints.get(n + 1).map_or(f64::INFINITY, |next| next.0);
        let up = if n % 2 == 0 { 1.0 } else { -1.0 };
        for pair in record.counts.windows(2) {
            let ((t0, y0), (t1, y1)) = (pair[0], pair[1]);
            if t0 > at && t1 < until && t1 - t0 < 2.5 * poll_s {
                shares.push((0.5 * (t0 + t1) - at, up * ((y1 - y0) / (t1 - t0) - goal) / step));
            }
        }
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let goal = record.setpoints.iter().map(|s| s.1.abs()).fold(0.0, f64::max);
    let stamp_s = OSCILLATION.stamp_s.hypot(record.stamp_s);
    let noise = (2.0 * (OSCILLATION.rounding + (stamp_s * goal).powi(2))).sqrt() / poll_s / step.abs();
    let wanted = (noise / OSCILLATION.uncertain).powi(2).max(1.0);
    let longest = shares.last().map_or(0.0, |last| last.0);
    let flanks = record.setpoints.len().max(1) as f64;
    let half_s = (0.5 * wanted * poll_s / flanks)
        .clamp(OSCILLATION.width_s.0, OSCILLATION.width_s.1.min(0.25 * longest).max(OSCILLATION.width_s.0));
    let mut most: f64 = 0.0;
    for (middle, _) in &shares {
        let from = shares.partition_point(|s| s.0 < middle - half_s);
        let to = shares.partition_point(|s| s.0 <= middle + half_s);
        let inside = &shares[from..to];
        if (inside.len() as f64) < wanted.min(3.0) {
            continue;
        }
        most = most.max(inside.iter().map(|s| s.1).sum::<f64>() / inside.len() as f64);
    }
    most
}

/// The values less the cubic that fits them best, over the time from their middle: what settles slowly is no oscillation.
fn detrended(values: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (values.first(), values.last()) else { return Vec::new() };
    let (middle, half) = (0.5 * (first.0 + last.0), (0.5 * (last.0 - first.0)).max(1e-6));
    let row = |t: f64| {
        let x = (t - middle) / half;
        Vector4::new(1.0, x, x * x, x * x * x)
    };
    let (mut square, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for (t, y) in values {
        square += row(*t) * row(*t).transpose();
        right += row(*t) * (y - first.1);
    }
    let fitted = square.try_inverse().map_or(Vector4::zeros(), |inverse| inverse * right);
    values.iter().map(|(t, y)| (t - middle, y - first.1 - row(*t).dot(&fitted))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts of a speed, polled every 13 ms for a second, rounded.
    fn plateau(position: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        (0..80).map(|n| f64::from(n) * 0.013).map(|t| (t, position(t).floor())).collect()
    }

    #[test]
    fn a_sine_on_a_plateau_has_its_root_mean_square_and_a_plain_one_next_to_none() {
        // 60 counts/s about 1500 at 8 Hz.
        let w = TAU * 8.0;
        let oscillating = speed_ripple(
            &plateau(|t| 1_500.0 * t - 60.0 / w * (w * t).cos()),
            &ClosedLoopRecord::default(),
            None,
        );
        assert!((oscillating / (60.0 / 2.0_f64.sqrt()) - 1.0).abs() < 0.2, "{oscillating}");
        assert!(speed_ripple(&plateau(|t| 1_500.0 * t), &ClosedLoopRecord::default(), None) < 10.0);
    }

    #[test]
    fn a_quick_oscillation_is_looked_for_where_each_count_came_with_its_time() {
        let w = TAU * 24.0;
        let counts = plateau(|t| 1_500.0 * t - 300.0 / w * (w * t).cos());
        let dated = ClosedLoopRecord { age: CountAge::Dated, ..ClosedLoopRecord::default() };
        let oscillating = speed_ripple(&counts, &dated, None);
        assert!((oscillating / (300.0 / 2.0_f64.sqrt()) - 1.0).abs() < 0.2, "{oscillating}");
        assert!(speed_ripple(&plateau(|t| 1_500.0 * t), &dated, None) < 40.0);
        assert!(speed_ripple(&counts, &ClosedLoopRecord::default(), None) < 0.1 * oscillating);
    }

    #[test]
    fn a_speed_that_settles_slowly_is_no_oscillation() {
        let settling = speed_ripple(
            &plateau(|t| 1_500.0 * t + 200.0 * (-t / 0.8).exp()),
            &ClosedLoopRecord::default(),
            None,
        );
        assert!(settling < 15.0, "{settling}");
    }

    #[test]
    fn flanks_laid_over_each_other_show_the_overshoot_that_each_poll_misses() {
        // A second-order step up and down again, damping 0.5: it goes past by 16.3 % of the step.
        let (zeta, omega, high) = (0.5_f64, 40.0, 9_000.0);
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        // Position of a unit step of speed.
        let position = |t: f64| {
            let decay = (-zeta * omega * t).exp();
            let (c, s) = ((damped * t).cos(), (damped * t).sin());
            t - 2.0 * zeta / omega
                + decay / omega * (2.0 * zeta * c + (2.0 * zeta * zeta - 1.0) * omega / damped * s)
        };
        let setpoints: Vec<(f64, f64)> =
            (0..6).map(|n| (0.4 * f64::from(n), if n % 2 == 0 { high } else { 0.0 })).collect();
        let counts = (0..185).map(|n| f64::from(n) * 0.013).map(|t| {
            let flanks = setpoints.iter().filter(|s| s.0 <= t);
            let sum: f64 =
                flanks.map(|&(at, goal)| (if goal > 0.0 { high } else { -high }) * position(t - at)).sum();
            (t, sum.floor())
        });
        let record = ClosedLoopRecord {
            counts: counts.collect(),
            setpoints: setpoints.clone(),
            ..ClosedLoopRecord::default()
        };
        let seen = flank_overshoot(&record, high, 0.013);
        assert!((seen - 0.163).abs() < 0.04, "{seen}");
    }

    #[test]
    fn a_deviation_leaves_a_slow_trend_out() {
        let values: Vec<(f64, f64)> = (0..200)
            .map(|n| f64::from(n) * 0.01)
            .map(|t| (t, 0.3 + 0.1 * t + 0.02 * (TAU * 7.0 * t).sin()))
            .collect();
        assert!((deviation(&values) - 0.02 / 2.0_f64.sqrt()).abs() < 0.001);
        assert_eq!(deviation(&values[..3]), 0.0);
    }
}

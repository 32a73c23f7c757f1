//! Reads a settled speed and a time constant off the counts of one constant drive.
//!
//! For each time constant of a grid, `y = y0 + v t + a (1 - exp(-t/tau))` is linear in the rest, so the best of all is found
//! without a start value.

use crate::poll::Point;
use crate::thresholds::thresholds;
use nalgebra::{Matrix3, Vector3};

/// A speed that a drive settles at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Final speed, counts/s.
    pub speed: f64,
    /// Half of the 95 % interval of the speed over the speed.
    pub interval: f64,
    /// Time constant of the best fit, s.
    pub tau_s: f64,
    /// Speed over the last quarter, counts/s.
    pub tail_speed: f64,
    /// By how much the speed at the last point still differs from the one it settles at, as the fit has it, over that one.
    pub remaining: f64,
}

thresholds! {
    /// The fit of an exponential to a speed that settles.
    SETTLE: Thresholds {
        /// Time constants that are tried: lowest and highest, in seconds, and how many.
        grid: (f64, f64, u32) = (0.004, 4.0, 26),
        /// Standard deviation of a time stamp, in seconds.
        stamp_s: f64 = 0.0006,
    }
}

/// Fits the points, which all belong to one drive. `None` with fewer than eight.
#[must_use]
pub fn settled(points: &[Point]) -> Option<Settled> {
    let (first, last) = (points.first()?, points.last()?);
    if points.len() < 8 {
        return None;
    }
    let quarter = &points[points.len() * 3 / 4..];
    let tail_speed = slope(quarter)?;
    let sigma2 = 0.17 + (SETTLE.stamp_s * tail_speed).powi(2);
    let mut best: Option<(f64, f64, f64, f64, f64)> = None;
    let mut all = Vec::new();
    let mut tried = |tau: f64, best: &mut Option<(f64, f64, f64, f64, f64)>| {
        let Some((speed, variance, error, remaining)) = fit(points, first.t, tau, last.t - first.t) else {
            return;
        };
        let cost = error / sigma2;
        all.push((speed, variance * sigma2, cost));
        if best.is_none_or(|b| cost < b.3) {
            *best = Some((speed, variance * sigma2, tau, cost, remaining));
        }
    };
    let ratio = SETTLE.grid.1 / SETTLE.grid.0;
    for n in 0..SETTLE.grid.2 {
        tried(SETTLE.grid.0 * ratio.powf(f64::from(n) / f64::from(SETTLE.grid.2 - 1)), &mut best);
    }
    // Between the points of the grid, three times finer each round.
    let mut spacing = ratio.powf(1.0 / f64::from(SETTLE.grid.2 - 1));
    for _ in 0..3 {
        spacing = spacing.powf(1.0 / 3.0);
        let centre = best?.2;
        for n in [-2, -1, 1, 2] {
            tried(centre * spacing.powi(n), &mut best);
        }
    }
    let (speed, variance, tau_s, cost, remaining) = best?;
    let scale = (cost / (points.len() as f64 - 3.0)).max(1.0);
    let spread = all
        .iter()
        .filter(|other| other.2 < cost + 4.0 * scale)
        .map(|other| (other.0 - speed).abs() + 2.0 * (other.1 * scale).sqrt())
        .fold(2.0 * (variance * scale).sqrt(), f64::max);
    let share = |of: f64| of / speed.abs().max(1e-9);
    Some(Settled { speed, interval: share(spread), tau_s, tail_speed, remaining: share(remaining) })
}

/// Least-squares slope of counts over time.
#[must_use]
pub fn slope(points: &[Point]) -> Option<f64> {
    let n = points.len() as f64;
    if points.len() < 2 {
        return None;
    }
    let (mt, my) =
        (points.iter().map(|p| p.t).sum::<f64>() / n, points.iter().map(|p| p.counts).sum::<f64>() / n);
    let sxx: f64 = points.iter().map(|p| (p.t - mt).powi(2)).sum();
    let sxy: f64 = points.iter().map(|p| (p.t - mt) * (p.counts - my)).sum();
    (sxx > 0.0).then(|| sxy / sxx)
}

/// (final speed, its variance per unit of error variance, sum of squared errors, speed still missing at the end) for one time constant.
fn fit(points: &[Point], t0: f64, tau: f64, span: f64) -> Option<(f64, f64, f64, f64)> {
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    let row = |p: &Point| Vector3::new(1.0, (p.t - t0) / span, 1.0 - (-(p.t - t0) / tau).exp());
    for p in points {
        let x = row(p);
        normal += x * x.transpose();
        right += x * p.counts;
    }
    let inverse = normal.try_inverse()?;
    let q = inverse * right;
    let error = points.iter().map(|p| (p.counts - row(p).dot(&q)).powi(2)).sum();
    let remaining = (q[2] / tau * (-span / tau).exp()).abs();
    Some((q[1] / span, inverse[(1, 1)].abs() / (span * span), error, remaining))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first_order_rise(speed: f64, tau: f64, seconds: f64) -> Vec<Point> {
        let polls = (seconds / 0.012) as usize;
        (0..polls)
            .map(|n| {
                let t = n as f64 * 0.012;
                let counts = (speed * (t - tau * (1.0 - (-t / tau).exp()))).round();
                Point { t, counts, duty: None, amps: None, volts: None, limited: false }
            })
            .collect()
    }

    #[test]
    fn a_known_rise_gives_its_speed_long_before_it_has_settled() {
        for (speed, tau) in [(9_000.0, 0.02), (4_000.0, 0.15), (-30_000.0, 1.2)] {
            let found = settled(&first_order_rise(speed, tau, 2.2 * tau + 0.2)).unwrap();
            assert!((found.speed / speed - 1.0).abs() < 0.02, "{found:?}");
            assert!(found.interval < 0.1, "{found:?}");
        }
    }

    #[test]
    fn the_interval_covers_the_truth() {
        let found = settled(&first_order_rise(800.0, 0.3, 0.5)).unwrap();
        assert!((found.speed - 800.0).abs() <= 800.0 * found.interval * 1.5, "{found:?}");
    }
}

//! What a limit cycle shows: its period, and the first harmonics of what drives it and of what answers.

use crate::cause::Cause;
use crate::experiment_guard::{ExperimentGuard, Input, Point};
use crate::law::Law;
use crate::thresholds::thresholds;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::TAU;

thresholds! {
    /// Which swings of a relay count, and how much they may differ.
    pub(crate) LIMIT_CYCLE: Thresholds {
        /// Cycles that are left out at first.
        first_cycles: usize = 2,
        /// Cycles that are looked at together, as a group.
        group: usize = 3,
        /// How many such groups there are: a spread wants three at least.
        groups: usize = 4,
        /// Cycles that are looked at in all.
        cycles: usize = group * groups,
        /// Half of the 95 % interval of the period, from its spread between groups, beyond which there is no limit cycle, as a share of the period.
        most_spread: f64 = 0.3,
        /// The 97.5 % point of Student's t with three degrees of freedom: the intervals are of four groups.
        student: f64 = 3.182,
    }
}

/// A figure and half of its 95 % interval.
pub type Figure = (f64, f64);

/// A few cycles together.
pub(super) struct Group {
    pub period_s: f64,
    pub mean_speed: f64,
    pub mean_duty: f64,
    /// The first harmonics.
    pub speed: Complex<f64>,
    pub duty: Complex<f64>,
}

impl Group {
    /// From the counts and duties of whole cycles, each from one time to the next.
    pub fn of<L: Law>(guard: &ExperimentGuard<'_, L>, ups: &[f64]) -> Option<Self> {
        let (&from_s, &to_s) = ups.first().zip(ups.last())?;
        let cycles = (ups.len() - 1) as f64;
        let (span_s, omega) = (to_s - from_s, TAU * cycles / (to_s - from_s));
        let points: Vec<&Point> = guard.points.iter().filter(|p| p.t >= from_s && p.t <= to_s).collect();
        let (slope, place) = harmonic_of(&points, from_s, omega)?;
        let duties: Vec<(f64, f64)> = guard
            .drives
            .iter()
            .filter(|drive| drive.t >= from_s - 1e-9)
            .filter_map(|drive| match drive.input {
                Input::Duty(duty) => Some((drive.t, duty)),
                Input::Speed(_) | Input::Position(..) => None,
            })
            .collect();
        let (mut mean_duty, mut harmonic) = (0.0, Complex::new(0.0, 0.0));
        for (n, (at_s, duty)) in duties.iter().enumerate() {
            let until_s = duties.get(n + 1).map_or(to_s, |next| next.0).min(to_s);
            let (a, b) = (at_s - from_s, until_s - from_s);
            if b <= a {
                continue;
            }
            mean_duty += duty * (b - a) / span_s;
            // 2/T times the integral of u exp(-jwt).
            let wave = |t: f64| Complex::new(0.0, -omega * t).exp();
            harmonic += (wave(b) - wave(a)) / Complex::new(0.0, -omega) * (2.0 * duty / span_s);
        }
        Some(Self {
            period_s: span_s / cycles,
            mean_speed: slope,
            mean_duty,
            speed: place * Complex::new(0.0, omega),
            duty: harmonic,
        })
    }
}

/// The groups of a limit cycle that was switched up at these times.
pub(super) fn groups<L: Law>(guard: &ExperimentGuard<'_, L>, ups: &[f64]) -> Result<Vec<Group>, Cause> {
    let cycles = ups.windows(LIMIT_CYCLE.group + 1).step_by(LIMIT_CYCLE.group);
    let groups: Vec<Group> = cycles.filter_map(|ups| Group::of(guard, ups)).collect();
    if groups.len() < LIMIT_CYCLE.groups { Err(Cause::NoLimitCycle) } else { Ok(groups) }
}

/// A figure of groups.
pub(super) fn figure(groups: &[Group], of: impl Fn(&Group) -> f64) -> Figure {
    mean_and_doubt(&groups.iter().map(of).collect::<Vec<f64>>())
}

/// Whether cycles of this period are all alike.
pub(super) fn is_steady(period_s: Figure) -> bool {
    period_s.1 < LIMIT_CYCLE.most_spread * period_s.0
}

/// The slope of counts, and the first harmonic of what is beside it, by least squares with the next two harmonics beside. `None` with too few.
fn harmonic_of(points: &[&Point], from_s: f64, omega: f64) -> Option<(f64, Complex<f64>)> {
    const TERMS: usize = 8;
    if points.len() < TERMS + 4 {
        return None;
    }
    let first = points.first()?.counts;
    let row = |t: f64| {
        let mut row = vec![1.0, t];
        for n in 1..=3 {
            let at = f64::from(n) * omega * t;
            row.extend([at.cos(), at.sin()]);
        }
        row
    };
    let rows: Vec<f64> = points.iter().flat_map(|point| row(point.t - from_s)).collect();
    let matrix = DMatrix::from_row_slice(points.len(), TERMS, &rows);
    let right = DVector::from_iterator(points.len(), points.iter().map(|point| point.counts - first));
    let square = matrix.transpose() * &matrix;
    let found = square.lu().solve(&(matrix.transpose() * right))?;
    // c cos + s sin is the real part of (c - js) exp(jwt).
    Some((found[1], Complex::new(found[2], -found[3])))
}

/// A mean, and half of the 95 % interval of it.
pub(super) fn mean_and_doubt(values: &[f64]) -> Figure {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    (mean, LIMIT_CYCLE.student * (square / count).sqrt())
}

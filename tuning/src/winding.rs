//! Resistance of the winding, from volts, duty, current and speed of the samples of a run: `duty volts = R amps + k speed`.
//!
//! The inductance cannot be seen in polls: it is over within a millisecond.

use crate::experiment_guard::{Drive, Input, Point};
use crate::thresholds::thresholds;
use nalgebra::{Matrix2, Vector2};
use serde::{Deserialize, Serialize};

thresholds! {
    /// The fit of resistance and back-EMF: which samples count, and what is believed of them.
    WINDING: Thresholds {
        /// How long after the end of its ramp a duty has settled in the winding, in seconds.
        settled_s: f64 = 0.012,
        /// How long the ramp of a duty takes per full duty, in seconds: up to 0.1 s from one end to the other.
        ramp_s: f64 = 0.05,
        /// Readings below this are no current, in amperes.
        least_amps: f64 = 0.05,
        /// Share of the highest speed by which the speed may change between the polls around a reading: a current is read later than the counts.
        steady: f64 = 0.06,
        /// Standard deviation of what the rest of the model leaves open, as a share of the volts.
        model: f64 = 0.01,
        /// Counts over which a speed is taken.
        clear_counts: f64 = 25.0,
        /// Most polls on either side over which it is taken.
        widest_polls: usize = 8,
        /// How far currents must lie apart: as a multiple of their median, and at the least in amperes.
        spread: (f64, f64) = (0.7, 0.2),
        /// Fewest samples from which a resistance is told.
        least_samples: usize = 12,
        /// Half of the widest interval that says anything, as a share of the resistance.
        widest: f64 = 0.5,
        /// What the model leaves open and does not average out, as a share of the resistance.
        model_share: f64 = 0.08,
        /// Offset of a current reading, which does not average out either, in amperes.
        offset_amps: f64 = 0.01,
        /// Standard deviation of a battery reading from its rounding, in volts.
        rounding_volts: f64 = 0.03,
        /// Standard deviation of the volts from the rounding of the current, in volts per ampere.
        rounding_volts_per_amp: f64 = 0.003,
    }
}

/// The winding as a run showed it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Winding {
    /// Resistance of winding, leads and bridge, ohm.
    pub ohms: f64,
    /// Half of its 95 % interval, ohm.
    pub interval_ohms: f64,
    /// Volts per count/s of the turning motor.
    pub volts_per_count_per_s: f64,
    /// Samples used.
    pub samples: usize,
}

/// Why a run does not show the resistance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WindingUnknown {
    /// The controller measures no current, or none above its noise.
    NoCurrents,
    /// Too few polls lay under a steady duty with a current.
    TooFew,
    /// All currents were about the same, so that nothing distinguishes the resistance from the speed's share: a motor that turns freely.
    Alike,
    /// It came out with too wide an interval.
    Vague,
}

impl WindingUnknown {
    /// Why, and what to do to have it, as the end of a sentence.
    #[must_use]
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::NoCurrents => {
                "the controller measured no motor current to speak of. Tune with a load on the shaft, or measure R with a meter."
            }
            Self::TooFew => {
                "too few readings lay under a steady duty. A run that turns freely at more duty has more of them."
            }
            Self::Alike => {
                "a motor that turns freely draws about the same current all the time. Tune with a load or a flywheel on the shaft, \
                 or measure R with a meter."
            }
            Self::Vague => {
                "the readings scatter too much. Try again with more load or more duty, or measure R with a meter."
            }
        }
    }
}

/// What one sample says.
struct Row {
    volts: f64,
    amps: f64,
    speed: f64,
}

/// Regresses over the polls of an open-loop run.
///
/// # Errors
/// Why it is not known: no currents, or ones that do not distinguish R.
pub fn winding_of(points: &[Point], drives: &[Drive]) -> Result<Winding, WindingUnknown> {
    let has_current = |point: &Point| point.amps.is_some_and(|amps| amps.abs() >= WINDING.least_amps);
    if !points.iter().any(has_current) {
        return Err(WindingUnknown::NoCurrents);
    }
    let battery = Battery::of(points, drives).ok_or(WindingUnknown::TooFew)?;
    let highest = points.windows(2).map(|pair| speed_of(&pair[0], &pair[1]).abs()).fold(0.0, f64::max);
    let inside = 1..points.len().saturating_sub(2);
    let rows: Vec<Row> =
        inside.filter_map(|n| row_at(points, drives, n, &battery, WINDING.steady * highest)).collect();
    if rows.len() < WINDING.least_samples {
        return Err(WindingUnknown::TooFew);
    }
    if !differ(&rows) {
        return Err(WindingUnknown::Alike);
    }
    let scale = rows.iter().map(|row| row.speed.abs()).fold(0.0, f64::max).max(1.0);
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for row in &rows {
        let weight = row.weight();
        let x = Vector2::new(row.amps, row.speed / scale) * weight;
        normal += x * x.transpose();
        right += x * (row.volts * weight);
    }
    let inverse = normal.try_inverse().ok_or(WindingUnknown::Alike)?;
    let found = inverse * right;
    let (ohms, back_emf) = (found[0], found[1] / scale);
    let misfit = |row: &Row| ((row.volts - ohms * row.amps - back_emf * row.speed) * row.weight()).powi(2);
    let freedom = (rows.len() - 2) as f64;
    let variance = (rows.iter().map(misfit).sum::<f64>() / freedom).max(1.0);
    let mean_amps = rows.iter().map(|row| row.amps).sum::<f64>() / rows.len() as f64;
    let systematic = ohms * (WINDING.model_share + WINDING.offset_amps / mean_amps);
    let interval_ohms = (1.96 * (variance * inverse[(0, 0)]).sqrt()).hypot(systematic);
    let is_known = ohms > 0.0 && back_emf > 0.0 && interval_ohms < WINDING.widest * ohms;
    let winding = Winding { ohms, interval_ohms, volts_per_count_per_s: back_emf, samples: rows.len() };
    is_known.then_some(winding).ok_or(WindingUnknown::Vague)
}

/// Whether the currents differ by more than a sensor's noise: with one current alone nothing distinguishes R from the speed's share.
fn differ(rows: &[Row]) -> bool {
    let mut amps: Vec<f64> = rows.iter().map(|row| row.amps).collect();
    amps.sort_by(f64::total_cmp);
    let at = |share: f64| amps[(share * (amps.len() - 1) as f64) as usize];
    at(0.95) - at(0.05) > (WINDING.spread.0 * at(0.5)).max(WINDING.spread.1)
}

impl Row {
    /// One over the standard deviation of its volts.
    fn weight(&self) -> f64 {
        1.0 / (WINDING.rounding_volts.powi(2)
            + (WINDING.model * self.volts).powi(2)
            + (WINDING.rounding_volts_per_amp * self.amps).powi(2))
        .sqrt()
    }
}

/// The battery: its voltage without load, and how much it sags per ampere that it gives.
struct Battery {
    volts: f64,
    ohms: f64,
}

impl Battery {
    /// From the polls that read it; the current that it gives is that of the motor times the duty.
    fn of(points: &[Point], drives: &[Drive]) -> Option<Self> {
        let readings: Vec<(f64, f64)> = (0..points.len())
            .filter(|n| !points[*n].limited)
            .filter_map(|n| Some((points[n].volts?, given_amps(points, drives, n).unwrap_or(0.0))))
            .collect();
        let n = readings.len() as f64;
        if readings.is_empty() {
            return None;
        }
        let mean = readings.iter().fold((0.0, 0.0), |sum, r| (sum.0 + r.0 / n, sum.1 + r.1 / n));
        let spread: f64 = readings.iter().map(|r| (r.1 - mean.1).powi(2)).sum();
        let both: f64 = readings.iter().map(|r| (r.1 - mean.1) * (mean.0 - r.0)).sum();
        let ohms = if spread > 0.01 { (both / spread).max(0.0) } else { 0.0 };
        Some(Self { volts: mean.0 + ohms * mean.1, ohms })
    }
}

/// What the battery gives at a poll, by the currents beside it.
fn given_amps(points: &[Point], drives: &[Drive], n: usize) -> Option<f64> {
    let at = drives.partition_point(|drive| drive.t <= points[n].t).checked_sub(1)?;
    let Input::Duty(duty) = drives[at].input else { return None };
    let beside = points[n.saturating_sub(1)..(n + 2).min(points.len())].iter().filter_map(|p| p.amps);
    let (sum, count) = beside.fold((0.0, 0.0), |(sum, count), amps| (sum + amps.abs(), count + 1.0));
    (count > 0.0).then(|| duty.abs() * sum / count)
}

fn speed_of(a: &Point, b: &Point) -> f64 {
    (b.counts - a.counts) / (b.t - a.t).max(1e-3)
}

/// A poll under a settled duty that drives the way the motor turns, and a speed that hardly changes, with its current.
fn row_at(points: &[Point], drives: &[Drive], n: usize, battery: &Battery, steady: f64) -> Option<Row> {
    let point = &points[n];
    let amps = point.amps.filter(|amps| amps.abs() >= WINDING.least_amps && !point.limited)?.abs();
    let at = drives.partition_point(|drive| drive.t <= point.t).checked_sub(1)?;
    let Input::Duty(duty) = drives[at].input else { return None };
    let last = at.checked_sub(1).map_or(0.0, |at| match drives[at].input {
        Input::Duty(duty) => duty,
        Input::Speed(_) | Input::Position(..) => 0.0,
    });
    let steady_since = drives[at].t + WINDING.settled_s + WINDING.ramp_s * (duty - last).abs();
    let next = drives.get(at + 1).map_or(f64::INFINITY, |drive| drive.t);
    // Over as many polls as it takes for the rounding of the counts to be small; speed must not matter beside it.
    let widths = 1..=WINDING.widest_polls.min(n).min(points.len() - 1 - n);
    let ends = widths.map(|width| (&points[n - width], &points[n + width]));
    let inside =
        ends.take_while(|(before, after)| before.t >= steady_since - WINDING.settled_s && after.t <= next);
    let mut last_ends = None;
    for (before, after) in inside {
        last_ends = Some((before, after));
        if (after.counts - before.counts).abs() >= WINDING.clear_counts {
            break;
        }
    }
    let (before, after) = last_ends?;
    let moved = (after.counts - before.counts).abs();
    // No count for a moment is no standstill.
    let around =
        &points[n.saturating_sub(WINDING.widest_polls)..(n + WINDING.widest_polls + 1).min(points.len())];
    let stands = around.iter().all(|p| (p.counts - point.counts).abs() < 1.0);
    if !stands && moved < WINDING.clear_counts {
        return None;
    }
    let speed = speed_of(before, after);
    let changes = (speed_of(point, after) - speed_of(before, point)).abs()
        > steady.max(2.0 / (after.t - point.t).max(1e-3));
    // A duty that came down brakes, and not every controller reports the sign of a current.
    let brakes = duty.abs() < last.abs() && duty * last > 0.0;
    if duty == 0.0 || brakes || point.t < steady_since || speed * duty < 0.0 || changes {
        return None;
    }
    let volts = battery.volts - battery.ohms * duty.abs() * amps;
    Some(Row { volts: volts * duty.abs(), amps, speed: speed.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polls every 10 ms of a motor of 0.8 ohm and 0.002 V per count/s, driven at two duties from rest.
    fn run(amps_at: impl Fn(f64) -> Option<f64>) -> (Vec<Point>, Vec<Drive>) {
        let drives =
            vec![Drive { t: 0.0, input: Input::Duty(0.5) }, Drive { t: 1.0, input: Input::Duty(0.9) }];
        let (mut speed, mut counts) = (0.0, 0.0);
        let points = (0..200).map(|n| {
            let t = 0.01 * f64::from(n);
            let duty = if t < 1.0 { 0.5 } else { 0.9 };
            let amps = (duty * 12.0 - 0.002 * speed) / 0.8;
            let point = Point {
                t,
                counts,
                duty: None,
                amps: amps_at(amps),
                volts: (n % 4 == 0).then_some(12.0),
                limited: false,
            };
            counts += speed * 0.01;
            speed += (amps - 0.4) * 30.0;
            point
        });
        (points.collect(), drives)
    }

    #[test]
    fn a_known_resistance_is_found_again() {
        let (points, drives) = run(|amps| Some((100.0 * amps).round() / 100.0));
        let found = winding_of(&points, &drives).expect("there are currents");
        // The steps of this motor are coarse.
        assert!((found.ohms / 0.8 - 1.0).abs() < 0.05, "{found:?}");
        assert!(found.interval_ohms < 0.1, "{found:?}");
        assert!((found.volts_per_count_per_s / 0.002 - 1.0).abs() < 0.03, "{found:?}");
    }

    #[test]
    fn without_currents_nothing_is_claimed() {
        for amps in [None, Some(0.0)] {
            let (points, drives) = run(|_| amps);
            assert_eq!(winding_of(&points, &drives), Err(WindingUnknown::NoCurrents));
        }
    }

    #[test]
    fn one_current_alone_tells_nothing_and_says_so() {
        let (points, drives) = run(|_| Some(0.8));
        assert_eq!(winding_of(&points, &drives), Err(WindingUnknown::Alike));
        let (points, drives) = run(Some);
        assert_eq!(winding_of(&points[..20], &drives), Err(WindingUnknown::TooFew));
    }
}

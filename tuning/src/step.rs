//! Figures of merit of a step response.
//!
//! Definitions as in control texts (Astrom and Murray, "Feedback Systems", 2nd edition, section 6.3): rise time from 10 % to 90 %
//! of the step, overshoot beyond the setpoint as a share of the step, settling time after which the response stays within 5 %.

use crate::thresholds::thresholds;
use serde::Serialize;

thresholds! {
    /// When a step counts as settled.
    SETTLED: Thresholds {
        /// The band around the setpoint inside which a response counts as settled, as a share of the step.
        settled_share: f64 = 0.05,
    }
}

/// One measured point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time since the step was commanded, in seconds.
    pub time_s: f64,
    /// The measured signal.
    pub value: f64,
}

/// What a step response amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StepFigures {
    /// From 10 % to 90 % of the step, in seconds; `None` if 90 % was not reached.
    pub rise_time_s: Option<f64>,
    /// Beyond the setpoint, as a share of the step; 0 if it never was.
    pub overshoot: f64,
    /// After which the response stays within 5 % of the step, in seconds; `None` if it was outside at the end.
    pub settling_time_s: Option<f64>,
    /// The mean of the last fifth of the record, less the setpoint, in the signal's unit.
    pub final_error: f64,
    /// Integral of time times absolute error over the record, in signal unit times seconds squared.
    pub itae: f64,
}

impl StepFigures {
    /// Judges a step from `start` to `setpoint`. The points are in the order of their times; those that are not numbers are
    /// left out. `None` if the step has no height or fewer than three points are left.
    #[must_use]
    pub fn of(points: &[Point], start: f64, setpoint: f64) -> Option<Self> {
        let step = setpoint - start;
        let finite = |point: &&Point| point.time_s.is_finite() && point.value.is_finite();
        let shares: Vec<Point> = points
            .iter()
            .filter(finite)
            .map(|point| Point { value: (point.value - start) / step, ..*point })
            .collect();
        if step == 0.0 || !step.is_finite() || shares.len() < 3 {
            return None;
        }
        let rise_time_s = crossing(&shares, 0.9).map(|end| end - crossing(&shares, 0.1).unwrap_or(end));
        Some(Self {
            rise_time_s,
            overshoot: shares.iter().map(|point| point.value - 1.0).fold(0.0, f64::max),
            settling_time_s: settling_time(&shares),
            final_error: (mean_of_last_fifth(&shares) - 1.0) * step,
            itae: itae(&shares) * step.abs(),
        })
    }
}

/// When the response first reaches a share of the step, between two points by a straight line.
fn crossing(shares: &[Point], level: f64) -> Option<f64> {
    let index = shares.iter().position(|point| point.value >= level)?;
    let after = shares[index];
    let Some(before) = index.checked_sub(1).map(|before| shares[before]) else { return Some(after.time_s) };
    let part = (level - before.value) / (after.value - before.value);
    Some(before.time_s + part * (after.time_s - before.time_s))
}

fn settling_time(shares: &[Point]) -> Option<f64> {
    let is_outside = |point: &Point| (point.value - 1.0).abs() > SETTLED.settled_share;
    match shares.iter().rposition(is_outside) {
        None => shares.first().map(|point| point.time_s),
        Some(last) => shares.get(last + 1).map(|point| point.time_s),
    }
}

fn mean_of_last_fifth(shares: &[Point]) -> f64 {
    let count = (shares.len() / 5).max(1);
    let last = &shares[shares.len() - count..];
    last.iter().map(|point| point.value).sum::<f64>() / last.len() as f64
}

/// By the trapezoidal rule.
fn itae(shares: &[Point]) -> f64 {
    let weight = |point: &Point| point.time_s * (point.value - 1.0).abs();
    shares
        .windows(2)
        .map(|pair| (weight(&pair[0]) + weight(&pair[1])) / 2.0 * (pair[1].time_s - pair[0].time_s))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A response sampled each millisecond.
    fn record(seconds: f64, value: impl Fn(f64) -> f64) -> Vec<Point> {
        let count = (seconds * 1000.0) as usize;
        (0..=count)
            .map(|index| index as f64 / 1000.0)
            .map(|time_s| Point { time_s, value: value(time_s) })
            .collect()
    }

    #[test]
    fn a_first_order_lag_has_its_textbook_figures() {
        let tau_s = 0.1;
        let figures =
            StepFigures::of(&record(2.0, |t| 500.0 * (1.0 - (-t / tau_s).exp())), 0.0, 500.0).unwrap();
        // tau ln 9, tau ln 20, step times tau squared.
        assert!((figures.rise_time_s.unwrap() - tau_s * 9f64.ln()).abs() < 1e-4);
        assert!((figures.settling_time_s.unwrap() - tau_s * 20f64.ln()).abs() < 2e-3);
        assert!((figures.itae - 500.0 * tau_s * tau_s).abs() < 0.01);
        assert!(figures.overshoot == 0.0 && figures.final_error.abs() < 1e-3);
    }

    #[test]
    fn a_second_order_response_overshoots_by_what_its_damping_says() {
        let (zeta, omega) = (0.5_f64, 20.0);
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let response = |t: f64| {
            let decay = (-zeta * omega * t).exp();
            1.0 - decay * ((damped * t).cos() + zeta * omega / damped * (damped * t).sin())
        };
        let figures = StepFigures::of(&record(3.0, response), 0.0, 1.0).unwrap();
        let expected = (-zeta * std::f64::consts::PI / (1.0 - zeta * zeta).sqrt()).exp();
        assert!((figures.overshoot - expected).abs() < 1e-4, "{figures:?}");
    }

    #[test]
    fn a_step_downwards_is_judged_like_one_upwards() {
        let up = StepFigures::of(&record(1.0, |t| 1.0 - (-t / 0.05).exp()), 0.0, 1.0).unwrap();
        let down = StepFigures::of(&record(1.0, |t| (-t / 0.05).exp() - 1.0), 0.0, -1.0).unwrap();
        assert_eq!(
            (up.rise_time_s, up.settling_time_s, up.itae),
            (down.rise_time_s, down.settling_time_s, down.itae)
        );
    }

    #[test]
    fn what_was_not_reached_is_not_made_up() {
        let figures = StepFigures::of(&record(1.0, |t| 0.4 * t), 0.0, 1.0).unwrap();
        assert_eq!((figures.rise_time_s, figures.settling_time_s, figures.overshoot), (None, None, 0.0));
        assert!(figures.final_error < -0.6);
    }

    #[test]
    fn records_that_say_nothing_give_nothing() {
        let gap = Point { time_s: 0.0, value: f64::NAN };
        assert_eq!(StepFigures::of(&[gap; 9], 0.0, 1.0), None);
        assert_eq!(StepFigures::of(&record(1.0, |_| 3.0), 3.0, 3.0), None);
        assert_eq!(StepFigures::of(&[], 0.0, 1.0), None);
    }
}

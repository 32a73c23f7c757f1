//! What a step response amounts to by a model that is fitted to its time-stamped counts, with how sure that is.
//!
//! Speeds that are taken from counts between two readings jump with the moments of the readings: the greatest of hundreds of them is noise, and was told as
//! overshoot. A response of second order with a delay is fitted to the counts themselves instead, as [`crate::fit`] does with a motor: readings
//! that took long count less, and what was not read makes the figures less sure.

use crate::fit::innovations;
use crate::step::{Point, StepFigures};
use crate::thresholds::thresholds;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{Complex, DMatrix, DVector, Dyn};

thresholds! {
    /// The fit of a second-order response to the steps of a closed loop.
    RESPONSE: Thresholds {
        /// Variance of a count's rounding, in counts squared.
        rounding: f64 = 0.1,
        /// How far the counts drift off the model in a second, as a standard deviation over the counts that the motor makes in that second; it grows with the root of the
        /// time.
        drift: f64 = 0.003,
        /// Standard deviation of a reading's age, in seconds: the controller takes its counts once in a tick.
        age_s: f64 = crate::open_loop_record::OPEN_LOOP.stamp_s,
        /// Lowest and highest delay, in seconds.
        delay_s: (f64, f64) = (-0.01, 0.5),
        /// Prior mean and standard deviation of the delay, in seconds.
        delay_prior_s: (f64, f64) = (0.005, 0.03),
        /// Prior of the natural frequency: its median, in radians per second, and the standard deviation of its logarithm. It is weak, for what the readings cannot tell.
        frequency_prior: (f64, f64) = (40.0, 3.0),
        /// Prior of the damping: the median of its ratio, and the standard deviation of its logarithm. It is as weak.
        damping_prior: (f64, f64) = (1.0, 1.5),
        /// Time between two points of the fitted response, in seconds.
        step_s: f64 = 0.001,
        /// Reduced chi-square above which a model is not what was seen.
        most_chi_square: f64 = 25.0,
        /// Error above which a model is not what was seen, as a root mean square over the step, or over the way that the step makes.
        most_error: f64 = 0.1,
    }
}

/// Start values of the frequency, rad/s, and of the damping.
const STARTS: [(f64, f64); 6] =
    [(8.0, 1.2), (30.0, 1.2), (120.0, 1.2), (400.0, 1.5), (15.0, 0.4), (80.0, 0.4)];

/// One reading of an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamped {
    /// Time since the step was commanded, s; before it negative.
    pub time_s: f64,
    /// Counts.
    pub counts: f64,
    /// Standard deviation of its time, s.
    pub spread_s: f64,
}

/// What steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The counts.
    Position,
    /// The counts per second.
    Speed,
}

/// Standard deviations of the figures; none where one has no value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Of the rise time, s.
    pub rise_s: Option<f64>,
    /// Of the overshoot, as a share of the step.
    pub overshoot: f64,
    /// Of the settling time, s.
    pub settling_s: Option<f64>,
}

/// A fitted response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Where it begins, in the unit of what steps.
    pub start: f64,
    /// Where it was to go: the setpoint, or else where it ends.
    pub end: f64,
    /// Its figures.
    pub figures: StepFigures,
    /// How sure they are.
    pub spread: Spread,
    /// Reduced chi-square; 1 where model and noise explain the readings.
    pub chi_square: f64,
}

/// Fits the response to a step at time 0; without a setpoint it is judged against where it ends. `None` where there is too little, or where no response of
/// second order is like it.
#[must_use]
pub fn response(readings: &[Stamped], quantity: Quantity, setpoint: Option<f64>) -> Option<Response> {
    let after = readings.iter().filter(|reading| reading.time_s >= 0.0).count();
    let last_s = readings.last()?.time_s;
    if after < 12 || last_s <= 0.0 {
        return None;
    }
    let mut best: Option<(f64, Problem<'_>)> = None;
    for start in STARTS {
        let problem = Problem::new(readings, quantity, start)?;
        let (problem, report) = LevenbergMarquardt::new().with_patience(20).minimize(problem);
        let cost = report.objective_function;
        if cost.is_finite() && best.as_ref().is_none_or(|(known, _)| cost < *known) {
            best = Some((cost, problem));
        }
    }
    best?.1.report(setpoint, last_s)
}

/// Parameters: ln frequency, ln damping, delay (through a bounded map), height over the scale, start over the scale, speed before the step over the scale.
struct Problem<'a> {
    readings: &'a [Stamped],
    quantity: Quantity,
    noise: Vec<(f64, f64)>,
    scale: f64,
    q: DVector<f64>,
}

impl<'a> Problem<'a> {
    fn new(readings: &'a [Stamped], quantity: Quantity, (frequency, damping): (f64, f64)) -> Option<Self> {
        let (first, last) = (readings.first()?, readings.last()?);
        let at_step = readings.iter().find(|reading| reading.time_s >= 0.0)?;
        let tail = readings.get(readings.len() - (readings.len() / 5).max(2))?;
        let rate =
            |from: &Stamped, to: &Stamped| (to.counts - from.counts) / (to.time_s - from.time_s).max(1e-4);
        let before = if at_step.time_s - first.time_s > 0.02 { rate(first, at_step) } else { 0.0 };
        let (height, start, speed) = match quantity {
            Quantity::Position => (last.counts - at_step.counts, at_step.counts, 0.0),
            Quantity::Speed => (rate(tail, last) - before, at_step.counts, before),
        };
        let scale = height.abs().max(1.0);
        let q = DVector::from_vec(vec![
            frequency.ln(),
            damping.ln(),
            unbounded(0.005, RESPONSE.delay_s),
            height / scale,
            start / scale,
            speed / scale,
        ]);
        let mut noise: Vec<(f64, f64)> = readings
            .windows(2)
            .map(|pair| {
                let dt = (pair[1].time_s - pair[0].time_s).max(1e-4);
                let speed = (pair[1].counts - pair[0].counts) / dt;
                let stamp = pair[0].spread_s.max(pair[1].spread_s).hypot(RESPONSE.age_s);
                (RESPONSE.rounding + (stamp * speed).powi(2), (RESPONSE.drift * speed).powi(2) * dt + 1e-3)
            })
            .collect();
        noise.insert(0, noise.first().copied().unwrap_or((1.0, 1.0)));
        Some(Self { readings, quantity, noise, scale, q })
    }

    fn shape(q: &DVector<f64>) -> Shape {
        Shape::new(q[0].clamp(-3.0, 9.0).exp(), q[1].clamp(-4.0, 4.0).exp(), bounded(q[2], RESPONSE.delay_s))
    }

    /// What each reading has beyond the model, counts.
    fn errors(&self, q: &DVector<f64>) -> Vec<f64> {
        let shape = Self::shape(q);
        let error = |reading: &Stamped| {
            let part = match self.quantity {
                Quantity::Position => shape.value(reading.time_s),
                Quantity::Speed => shape.integral(reading.time_s),
            };
            reading.counts - self.scale * (q[4] + q[5] * reading.time_s + q[3] * part)
        };
        self.readings.iter().map(error).collect()
    }

    fn evaluate(&self, q: &DVector<f64>) -> DVector<f64> {
        let errors = self.errors(q);
        let mut residuals = innovations(&errors, &self.noise);
        residuals.extend([
            (q[0] - RESPONSE.frequency_prior.0.ln()) / RESPONSE.frequency_prior.1,
            (q[1] - RESPONSE.damping_prior.0.ln()) / RESPONSE.damping_prior.1,
            (bounded(q[2], RESPONSE.delay_s) - RESPONSE.delay_prior_s.0) / RESPONSE.delay_prior_s.1,
        ]);
        // The drift that is followed begins at no error.
        residuals.extend(errors.first().zip(self.noise.first()).map(|(error, noise)| error / noise.0.sqrt()));
        if self.quantity == Quantity::Position {
            // A position that steps was at rest.
            residuals.push(q[5] / 1e-3);
        }
        DVector::from_vec(residuals)
    }

    /// Where the response begins and the points of it up to `last_s`.
    fn points(&self, q: &DVector<f64>, last_s: f64) -> (f64, Vec<Point>) {
        let shape = Self::shape(q);
        let start = match self.quantity {
            Quantity::Position => self.scale * q[4],
            Quantity::Speed => self.scale * q[5],
        };
        let count = (last_s / RESPONSE.step_s).ceil() as usize;
        let point = |index: usize| {
            let time_s = index as f64 * RESPONSE.step_s;
            Point { time_s, value: start + self.scale * q[3] * shape.value(time_s) }
        };
        (start, (0..=count).map(point).collect())
    }

    fn report(&self, setpoint: Option<f64>, last_s: f64) -> Option<Response> {
        let judged = |q: &DVector<f64>| {
            let (start, points) = self.points(q, last_s);
            let end = setpoint.unwrap_or(start + self.scale * q[3]);
            Some((start, end, StepFigures::of(&points, start, end)?))
        };
        let (start, end, figures) = judged(&self.q)?;
        let residuals = self.evaluate(&self.q);
        let freedom = (residuals.len() as f64 - self.q.len() as f64).max(1.0);
        let chi_square = residuals.norm_squared() / freedom;
        let errors = self.errors(&self.q);
        let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
        let whole = match self.quantity {
            Quantity::Position => self.scale,
            Quantity::Speed => self.scale * last_s,
        };
        if chi_square > RESPONSE.most_chi_square || rms > RESPONSE.most_error * whole {
            return None;
        }
        let jacobian = self.jacobian_at(&self.q);
        let count = self.q.len();
        let information = jacobian.tr_mul(&jacobian) + DMatrix::<f64>::identity(count, count) * 1e-6;
        let covariance = information.try_inverse()? * chi_square.max(1.0);
        let root = covariance.cholesky()?.l();
        let mut spread = Spread {
            rise_s: figures.rise_time_s.map(|_| 0.0),
            overshoot: 0.0,
            settling_s: figures.settling_time_s.map(|_| 0.0),
        };
        for column in 0..count {
            // At most a great step: beyond it the bounds tell nothing.
            let by = root.column(column).map(|part: f64| part.clamp(-3.0, 3.0));
            let sides = [judged(&(&self.q + &by)), judged(&(&self.q - &by))]
                .map(|side| side.map(|(_, _, figures)| figures));
            let [Some(up), Some(down)] = sides else { continue };
            let half = |of: fn(&StepFigures) -> Option<f64>, known: Option<f64>, add: Option<f64>| {
                let apart = (of(&up)? - of(&down)?) / 2.0;
                known?;
                Some(add?.hypot(apart))
            };
            spread.rise_s = half(|figures| figures.rise_time_s, figures.rise_time_s, spread.rise_s);
            spread.settling_s =
                half(|figures| figures.settling_time_s, figures.settling_time_s, spread.settling_s);
            // Overshoot has no lower side at 0.
            let most =
                (up.overshoot - figures.overshoot).abs().max((down.overshoot - figures.overshoot).abs());
            spread.overshoot = spread.overshoot.hypot(most);
        }
        Some(Response { start, end, figures, spread, chi_square })
    }

    fn jacobian_at(&self, q: &DVector<f64>) -> DMatrix<f64> {
        const BY: f64 = 1e-5;
        let columns: Vec<DVector<f64>> = (0..q.len())
            .map(|n| {
                let (mut up, mut down) = (q.clone(), q.clone());
                up[n] += BY;
                down[n] -= BY;
                (self.evaluate(&up) - self.evaluate(&down)) / (2.0 * BY)
            })
            .collect();
        DMatrix::from_columns(&columns)
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, q: &DVector<f64>) {
        self.q.copy_from(q);
    }

    fn params(&self) -> DVector<f64> {
        self.q.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.evaluate(&self.q))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(self.jacobian_at(&self.q))
    }
}

/// A unit step response of second order, by its poles.
struct Shape {
    poles: [Complex<f64>; 2],
    delay_s: f64,
}

impl Shape {
    fn new(frequency: f64, damping: f64, delay_s: f64) -> Self {
        // Two equal poles have no form of this kind; nobody sees the difference.
        let damping = if (damping - 1.0).abs() < 1e-4 { 1.0001 } else { damping };
        let root = Complex::new(damping * damping - 1.0, 0.0).sqrt();
        Self { poles: [(root + damping) * frequency, (-root + damping) * frequency], delay_s }
    }

    fn value(&self, time_s: f64) -> f64 {
        let t = time_s - self.delay_s;
        if t <= 0.0 {
            return 0.0;
        }
        let [a, b] = self.poles;
        (Complex::new(1.0, 0.0) - (b * (-a * t).exp() - a * (-b * t).exp()) / (b - a)).re
    }

    fn integral(&self, time_s: f64) -> f64 {
        let t = time_s - self.delay_s;
        if t <= 0.0 {
            return 0.0;
        }
        let [a, b] = self.poles;
        let one = Complex::new(1.0, 0.0);
        t - ((b / a * (one - (-a * t).exp()) - a / b * (one - (-b * t).exp())) / (b - a)).re
    }
}

fn bounded(x: f64, (low, high): (f64, f64)) -> f64 {
    low + (high - low) / (1.0 + (-x).exp())
}

fn unbounded(value: f64, (low, high): (f64, f64)) -> f64 {
    let share = ((value - low) / (high - low)).clamp(1e-6, 1.0 - 1e-6);
    (share / (1.0 - share)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small numbers that look random, the same in each run.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }

    /// Whole counts of a speed that goes to 5000 counts/s with a time constant of 60 ms, their times off by up to `late_s`.
    fn first_order(late_s: f64, skip: std::ops::Range<f64>) -> Vec<Stamped> {
        let mut seed = 7;
        let true_counts =
            |t: f64| if t < 0.0 { 0.0 } else { 5000.0 * (t - 0.06 * (1.0 - (-t / 0.06).exp())) };
        (-20..400)
            .map(|index| f64::from(index) * 0.005)
            .filter(|time| !skip.contains(time))
            .map(|time_s| {
                let at_s = time_s + late_s * noise(&mut seed);
                Stamped {
                    time_s,
                    counts: true_counts(at_s).floor(),
                    spread_s: late_s / 12f64.sqrt() + 0.0002,
                }
            })
            .collect()
    }

    #[test]
    fn a_motor_that_has_no_overshoot_gets_none_however_late_its_readings_are() {
        for late_s in [0.0, 0.002, 0.006] {
            let found = response(&first_order(late_s, 9.0..9.0), Quantity::Speed, Some(5000.0))
                .expect("it is a response");
            let figures = found.figures;
            let rise_s = figures.rise_time_s.expect("it was reached");
            let sure_s = found.spread.rise_s.expect("it has one");
            println!("late {late_s}: {found:?}");
            assert!(figures.overshoot < 0.01, "{figures:?}");
            assert!((rise_s - 0.06 * 9f64.ln()).abs() < (3.0 * sure_s).max(0.004), "{rise_s} ± {sure_s}");
            assert!(sure_s < 0.03, "{sure_s}");
        }
    }

    #[test]
    fn readings_that_are_missing_in_the_rise_make_it_less_sure() {
        let seen =
            response(&first_order(0.001, 9.0..9.0), Quantity::Speed, Some(5000.0)).expect("it is a response");
        let missed =
            response(&first_order(0.001, 0.004..0.35), Quantity::Speed, Some(5000.0)).expect("it is one too");
        let sure = |found: &Response| found.spread.rise_s.unwrap_or(f64::INFINITY);
        assert!(sure(&missed) > 3.0 * sure(&seen), "{missed:?} {seen:?}");
    }

    #[test]
    fn the_overshoot_of_a_position_loop_is_found_with_how_sure_it_is() {
        // Damping 0.4 overshoots by 25.4 %.
        let shape = Shape::new(25.0, 0.4, 0.004);
        let mut seed = 3;
        let readings: Vec<Stamped> = (-20..200)
            .map(|index| f64::from(index) * 0.005)
            .map(|time_s| {
                let at_s = time_s + 0.002 * noise(&mut seed);
                Stamped { time_s, counts: (100.0 + 900.0 * shape.value(at_s)).floor(), spread_s: 0.0006 }
            })
            .collect();
        let found = response(&readings, Quantity::Position, Some(1000.0)).expect("it is a response");
        let off = (found.figures.overshoot - 0.254).abs();
        assert!(off < 0.01 && off < 4.0 * found.spread.overshoot + 0.004, "{found:?}");
        assert!((found.start - 100.0).abs() < 3.0, "{found:?}");
    }

    #[test]
    fn what_is_no_response_has_no_figures() {
        assert_eq!(response(&[], Quantity::Speed, None), None);
        let wild: Vec<Stamped> = (0..200)
            .map(|index| Stamped {
                time_s: f64::from(index) * 0.005,
                counts: f64::from(index * 7919 % 4001),
                spread_s: 0.0002,
            })
            .collect();
        assert_eq!(response(&wild, Quantity::Position, Some(100.0)), None);
    }
}

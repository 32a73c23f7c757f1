//! The linear loop at the firmware's tick: frequency response, maximum sensitivity, quantisation noise, closed-loop poles.
//!
//! The plant is given as a discrete state space from duty to counts, so that the tuner's first-order model and a benchmark's
//! detailed truth go through the same code.

use crate::law::Law;
use crate::model::{Gains, Lag, PlantModel};
use nalgebra::{Complex, DMatrix, DVector};

/// Frequencies of the grid.
const FREQUENCIES: usize = 140;

/// `x' = A x + B u`, counts `y = C x`, one step per tick, duty held in between.
#[derive(Clone, Debug)]
pub struct DiscretePlant {
    /// State matrix.
    pub a: DMatrix<f64>,
    /// Input column.
    pub b: DVector<f64>,
    /// Output row.
    pub c: DVector<f64>,
}

impl DiscretePlant {
    /// The first-order motor, exact.
    #[must_use]
    pub fn of(model: &PlantModel, tick_s: f64) -> Self {
        let (k, tau) = (model.gain_counts_per_s, model.tau_s);
        let decay = (-tick_s / tau).exp();
        Self {
            a: DMatrix::from_row_slice(2, 2, &[decay, 0.0, tau * (1.0 - decay), 1.0]),
            b: DVector::from_vec(vec![k * (1.0 - decay), k * (tick_s - tau * (1.0 - decay))]),
            c: DVector::from_vec(vec![0.0, 1.0]),
        }
    }

    fn response(&self, z: Complex<f64>) -> Complex<f64> {
        let n = self.a.nrows();
        if n == 2 {
            // Cramer's rule: a first-order motor is worked out again for each step of a fit.
            let (a, b, c) = (&self.a, &self.b, &self.c);
            let [free_0, free_1] = [z - a[(0, 0)], z - a[(1, 1)]];
            let (x_0, x_1) = (free_1 * b[0] + a[(0, 1)] * b[1], free_0 * b[1] + a[(1, 0)] * b[0]);
            return (x_0 * c[0] + x_1 * c[1]) / (free_0 * free_1 - a[(0, 1)] * a[(1, 0)]);
        }
        let shifted = DMatrix::from_fn(n, n, |r, c| {
            Complex::new(-self.a[(r, c)], 0.0) + if r == c { z } else { Complex::new(0.0, 0.0) }
        });
        let b = self.b.map(|x| Complex::new(x, 0.0));
        shifted
            .lu()
            .solve(&b)
            .map_or(Complex::new(f64::NAN, 0.0), |x| x.iter().zip(self.c.iter()).map(|(x, c)| x * *c).sum())
    }
}

/// A plant under a law, with its responses worked out once for many gains.
#[derive(Clone, Debug)]
pub struct LoopPlant {
    tick_s: f64,
    feed_forward: f64,
    filters_derivative: bool,
    lag: Lag,
    plant: DiscretePlant,
    omega: Vec<f64>,
    /// `1 - 1/z` over the tick.
    slope: Vec<Complex<f64>>,
    /// z / (z - 1) times the tick: an integral that counts the present tick.
    integral: Vec<Complex<f64>>,
    position: Vec<Complex<f64>>,
    speed: Vec<Complex<f64>>,
    filter: Vec<Complex<f64>>,
    delay: Vec<Complex<f64>>,
}

/// What a loop is worth, linearly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins {
    /// Maximum sensitivity.
    pub ms: f64,
    /// Root mean square of the duty that the rounding of counts alone causes.
    pub noise_duty: f64,
}

impl LoopPlant {
    /// Works the responses out. The lag is the model's or the truth's.
    #[must_use]
    pub fn new<L: Law>(plant: DiscretePlant, law: &L, lag: Lag) -> Self {
        let tick_s = law.tick_s();
        let top = std::f64::consts::PI / tick_s;
        let bottom = top * 2e-4;
        let omega: Vec<f64> = (0..FREQUENCIES)
            .map(|n| bottom * (top * 0.999 / bottom).powf(n as f64 / (FREQUENCIES - 1) as f64))
            .collect();
        let z: Vec<Complex<f64>> = omega.iter().map(|w| Complex::from_polar(1.0, w * tick_s)).collect();
        let one = Complex::new(1.0, 0.0);
        let slope: Vec<_> = z.iter().map(|z| (one - one / z) / tick_s).collect();
        let share = tick_s / (lag.filter_s + tick_s);
        let filter: Vec<_> = z.iter().map(|z| one * share / (one - one / z * (1.0 - share))).collect();
        let position: Vec<_> = z.iter().map(|z| plant.response(*z)).collect();
        let speed = position.iter().zip(&slope).zip(&filter).map(|((p, s), f)| p * s * f).collect();
        let delay = omega.iter().map(|w| Complex::from_polar(1.0, -w * tick_s * lag.delay_ticks)).collect();
        let integral = slope.iter().map(|s| one / s).collect();
        let (feed_forward, filters_derivative) = (law.feed_forward(), law.derivative_filter().is_some());
        Self {
            tick_s,
            feed_forward,
            filters_derivative,
            lag,
            plant,
            omega,
            slope,
            integral,
            position,
            speed,
            filter,
            delay,
        }
    }

    /// Maximum sensitivity and noise of a loop; the loop must be stable for them to mean anything.
    #[must_use]
    pub fn margins(&self, gains: &Gains, qpps: f64) -> Margins {
        let mut nearest_sqr = f64::INFINITY;
        let mut noise = 0.0;
        let mut before: Option<(f64, f64)> = None;
        for n in 0..self.omega.len() {
            let by = self.controllers(gains, n);
            let open = self.open(by, qpps, n);
            let (by_speed, by_position) = by;
            let distance_sqr = (open + 1.0).norm_sqr();
            nearest_sqr = nearest_sqr.min(distance_sqr);
            // What a rounding error of the count does to the duty.
            let path = (by_speed * self.slope[n] * self.filter[n] + by_position) / qpps;
            let power = path.norm_sqr() / distance_sqr;
            if let Some((w, p)) = before {
                noise += 0.5 * (p + power) * (self.omega[n] - w);
            }
            before = Some((self.omega[n], power));
        }
        let noise_duty = (noise * self.tick_s / std::f64::consts::PI / 12.0).sqrt();
        Margins { ms: nearest_sqr.sqrt().recip(), noise_duty }
    }

    /// Whether the maximum sensitivity is at most `bound`, as [`LoopPlant::margins`] has it, without the noise.
    pub(crate) fn keeps(&self, gains: &Gains, qpps: f64, bound: f64) -> bool {
        // A square above this is above the bound's whatever was rounded.
        let clear = 1.000_001 / (bound * bound);
        (0..self.omega.len()).all(|n| {
            let distance_sqr = (self.open(self.controllers(gains, n), qpps, n) + 1.0).norm_sqr();
            // A root is taken only where it may matter. What is no number counts as little as it does in a maximum.
            distance_sqr > clear || distance_sqr.sqrt().recip().max(0.0) <= bound
        })
    }

    /// The open loop over the grid: (angular frequency in 1/s, response).
    #[must_use]
    pub fn open_loop(&self, gains: &Gains, qpps: f64) -> Vec<(f64, Complex<f64>)> {
        let at = |n: usize| (self.omega[n], self.open(self.controllers(gains, n), qpps, n));
        (0..self.omega.len()).map(at).collect()
    }

    /// Largest magnitude of a closed-loop pole; below 1 is stable. Fractional delays count as the next whole one.
    #[must_use]
    pub fn spectral_radius(&self, gains: &Gains, qpps: f64) -> f64 {
        self.largest_pole(gains, qpps, 1.0)
    }

    /// The same with fractional delays as they are: for that part of a tick the duty before is still given.
    #[must_use]
    pub fn exact_spectral_radius(&self, gains: &Gains, qpps: f64) -> f64 {
        let ticks = self.lag.delay_ticks;
        self.largest_pole(gains, qpps, 1.0 - (ticks.ceil() - ticks))
    }

    /// Largest magnitude of a pole where the oldest of the duties under way is given for so much of a tick, and the next one for the rest.
    fn largest_pole(&self, gains: &Gains, qpps: f64, oldest: f64) -> f64 {
        let Some(matrix) = self.closed_loop(gains, qpps, oldest) else { return f64::INFINITY };
        matrix.complex_eigenvalues().iter().map(|pole| pole.norm()).fold(0.0, f64::max)
    }

    /// The open loop at one frequency, of what the controller makes of a speed and of a position there.
    fn open(
        &self,
        (by_speed, by_position): (Complex<f64>, Complex<f64>),
        qpps: f64,
        n: usize,
    ) -> Complex<f64> {
        (by_speed * self.speed[n] + by_position * self.position[n]) * self.delay[n] / qpps
    }

    /// What the controller makes of a speed and of a position at one frequency, before the division by QPPS.
    fn controllers(&self, gains: &Gains, n: usize) -> (Complex<f64>, Complex<f64>) {
        let velocity = gains.velocity;
        let mut by_speed = self.integral[n] * velocity.i + self.slope[n] * velocity.d + velocity.p;
        if gains.velocity_sum != 0.0 {
            by_speed += self.integral[n] * self.integral[n] * gains.velocity_sum;
        }
        let by_position = gains.position.map_or(Complex::new(0.0, 0.0), |position| {
            let slope = if self.filters_derivative { self.slope[n] * self.filter[n] } else { self.slope[n] };
            let wanted = self.integral[n] * position.i + slope * position.d + position.p;
            let forward = if is_simple(gains) { 1.0 } else { self.feed_forward };
            wanted * (by_speed + forward)
        });
        (by_speed, by_position)
    }

    /// The closed loop as one matrix over: plant, last count, filtered speed, velocity integral, last velocity error, position
    /// integral, duties under way.
    fn closed_loop(&self, gains: &Gains, qpps: f64, oldest: f64) -> Option<DMatrix<f64>> {
        let n = self.plant.a.nrows();
        let delay = self.lag.delay_ticks.ceil() as usize;
        let tick_s = self.tick_s;
        let size = n + 5 + delay;
        let (last, filtered, sum, error, position_sum, queue) = (n, n + 1, n + 2, n + 3, n + 4, n + 5);
        let unit = |k: usize| DVector::from_fn(size, |r, _| f64::from(u8::from(r == k)));
        let mut y = DVector::zeros(size);
        y.rows_mut(0, n).copy_from(&self.plant.c);
        let share = tick_s / (self.lag.filter_s + tick_s);
        let measured = unit(filtered) * (1.0 - share) + (&y - unit(last)) * (share / tick_s);
        let (mut wanted, mut new_position_sum) = (DVector::zeros(size), DVector::zeros(size));
        if let Some(position) = gains.position {
            new_position_sum = unit(position_sum) - &y * tick_s;
            let by_slope = if self.filters_derivative {
                &measured * position.d
            } else {
                (&y - unit(last)) * (position.d / tick_s)
            };
            wanted = &y * -position.p + &new_position_sum * position.i - by_slope;
        }
        let new_error = &wanted - &measured;
        let new_sum = unit(sum) + &new_error * tick_s;
        if gains.velocity_sum != 0.0 {
            new_position_sum = unit(position_sum) + &new_sum * tick_s;
        }
        let velocity = gains.velocity;
        let forward = if is_simple(gains) { 1.0 } else { self.feed_forward };
        let duty = if is_simple(gains) {
            wanted / qpps
        } else {
            (wanted * forward
                + &new_error * velocity.p
                + &new_sum * velocity.i
                + &new_position_sum * gains.velocity_sum
                + (&new_error - unit(error)) * (velocity.d / tick_s))
                / qpps
        };
        let applied = match delay {
            0 => duty.clone(),
            1 => unit(queue) * oldest + &duty * (1.0 - oldest),
            _ => unit(queue) * oldest + unit(queue + 1) * (1.0 - oldest),
        };
        let mut matrix = DMatrix::zeros(size, size);
        for r in 0..n {
            let mut row = applied.transpose() * self.plant.b[r];
            for c in 0..n {
                row[c] += self.plant.a[(r, c)];
            }
            matrix.set_row(r, &row);
        }
        matrix.set_row(last, &y.transpose());
        matrix.set_row(filtered, &measured.transpose());
        if velocity.i != 0.0 || gains.velocity_sum != 0.0 {
            matrix.set_row(sum, &new_sum.transpose());
        }
        matrix.set_row(error, &new_error.transpose());
        if gains.position.is_some_and(|p| p.i != 0.0) || gains.velocity_sum != 0.0 {
            matrix.set_row(position_sum, &new_position_sum.transpose());
        }
        for k in 0..delay {
            let row = if k + 1 < delay { unit(queue + k + 1) } else { duty.clone() };
            matrix.set_row(queue + k, &row.transpose());
        }
        if gains.position.is_none() {
            // The position itself is under no control: its pole at 1 is no fault. A velocity loop sees differences only.
            return self.speed_loop(matrix, n, last);
        }
        matrix.iter().all(|x| x.is_finite()).then_some(matrix)
    }

    /// The loop in differences of successive states, so that the free position drops out.
    fn speed_loop(&self, matrix: DMatrix<f64>, n: usize, last: usize) -> Option<DMatrix<f64>> {
        if !matrix.iter().all(|x| x.is_finite()) {
            return None;
        }
        // States shift by a common position: project that direction out. `e` is the position of every plant state and the last count.
        let size = matrix.nrows();
        let shift = self.free_shift(n, size, last);
        let scale = shift.norm_squared();
        if scale == 0.0 {
            return Some(matrix);
        }
        // Deflate the eigenvalue 1 of that direction (Wielandt): its left vector is taken as the shift itself.
        let image = &matrix * &shift;
        Some(&matrix - &image * (shift.transpose() / scale))
    }

    /// The direction in which every position moves by one count.
    fn free_shift(&self, n: usize, size: usize, last: usize) -> DVector<f64> {
        let mut best = DVector::zeros(size);
        let identity = DMatrix::identity(n, n);
        let svd = (&self.plant.a - identity).svd(false, true);
        if let Some(v) = svd.v_t {
            let row = v.row(n - 1).transpose();
            let counts = row.dot(&self.plant.c);
            if counts.abs() > 1e-12 {
                best.rows_mut(0, n).copy_from(&(row / counts));
                best[last] = 1.0;
            }
        }
        best
    }
}

/// A position loop that acts on the duty directly: the velocity gains are all zero.
fn is_simple(gains: &Gains) -> bool {
    let v = gains.velocity;
    gains.position.is_some() && v.p == 0.0 && v.i == 0.0 && v.d == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Pid;
    use crate::plain_law::PlainLaw;

    fn loop_of(tau_s: f64, lag: Lag) -> LoopPlant {
        let model = PlantModel {
            gain_counts_per_s: 10_000.0,
            tau_s,
            coulomb_duty: 0.0,
            load_duty: 0.0,
            drive_limit: None,
            brake_limit: None,
            sag: 0.0,
        };
        let law = PlainLaw::default();
        LoopPlant::new(DiscretePlant::of(&model, law.tick_s()), &law, lag)
    }

    fn velocity(p: f64, i: f64) -> Gains {
        Gains { velocity: Pid { p, i, d: 0.0 }, ..Gains::default() }
    }

    #[test]
    fn without_gains_the_sensitivity_is_one_and_the_pole_is_the_motors() {
        let free = loop_of(0.1, Lag::default());
        assert!((free.margins(&velocity(0.0, 0.0), 10_000.0).ms - 1.0).abs() < 1e-12);
        let pole = (-1.0_f64 / 30.0).exp();
        assert!((free.spectral_radius(&velocity(0.0, 0.0), 10_000.0) - pole).abs() < 1e-6);
    }

    #[test]
    fn a_slow_p_loop_has_the_pole_of_the_textbook() {
        // tau 2 s, P 9: the closed time constant is tau / 10.
        let slow = loop_of(2.0, Lag::default());
        let radius = slow.spectral_radius(&velocity(9.0, 0.0), 10_000.0);
        assert!((-1.0 / 300.0 / radius.ln() / 0.2 - 1.0).abs() < 0.03, "{radius}");
    }

    #[test]
    fn poles_and_sensitivity_agree_on_the_edge_of_stability() {
        for lag in [Lag::default(), Lag { filter_s: 0.01, delay_ticks: 1.0 }] {
            let plant = loop_of(0.1, lag);
            let (mut low, mut high) = (0.1, 1e4);
            for _ in 0..60 {
                let middle = f64::sqrt(low * high);
                if plant.spectral_radius(&velocity(middle, 0.0), 10_000.0) < 1.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let edge = plant.margins(&velocity(low, 0.0), 10_000.0).ms;
            assert!(edge > 20.0, "the sensitivity is without bound at the edge: {edge} at P {low}");
        }
    }

    #[test]
    fn a_bound_is_kept_where_the_maximum_sensitivity_is_no_higher_to_the_last_bit() {
        let plant = loop_of(0.1, Lag { filter_s: 0.004, delay_ticks: 1.3 });
        for n in 1..40 {
            let gains = velocity(0.3 * f64::from(n), 1.5 * f64::from(n));
            let ms = plant.margins(&gains, 10_000.0).ms;
            assert!(plant.keeps(&gains, 10_000.0, ms), "{n}: {ms}");
            assert!(!plant.keeps(&gains, 10_000.0, ms.next_down()), "{n}: {ms}");
        }
    }

    #[test]
    fn an_integral_of_the_integral_takes_phase_and_poles_and_sensitivity_agree_on_its_edge() {
        let plant = loop_of(0.1, Lag::default());
        let with = |velocity_sum: f64| Gains { velocity_sum, ..velocity(5.0, 20.0) };
        assert!(plant.spectral_radius(&with(20.0), 10_000.0) < 1.0);
        assert!(plant.margins(&with(200.0), 10_000.0).ms > plant.margins(&with(0.0), 10_000.0).ms);
        let (mut low, mut high) = (20.0, 1e6);
        for _ in 0..60 {
            let middle = f64::sqrt(low * high);
            if plant.spectral_radius(&with(middle), 10_000.0) < 1.0 { low = middle } else { high = middle }
        }
        let edge = plant.margins(&with(low), 10_000.0).ms;
        assert!(edge > 20.0, "{edge} at {low}");
    }

    #[test]
    fn a_position_loop_is_unstable_beyond_its_edge_and_stable_below() {
        let plant = loop_of(0.1, Lag::default());
        let pd = |p: f64| Gains { position: Some(Pid { p, i: 0.0, d: 0.0 }), ..Gains::default() };
        assert!(plant.spectral_radius(&pd(5.0), 10_000.0) < 1.0);
        assert!(plant.spectral_radius(&pd(2_000.0), 10_000.0) > 1.0);
    }
}

//! The best gains that the true plant allows: what every method is measured against.
//!
//! A global grid and a local search on the true plant and the exact simulation, under a maximum sensitivity of 1.6. The search
//! minimises the worst cost over gains moved by 2 %, so that it does not settle on a lucky point.

use crate::optimum::{Optima, Optimum};
use crate::trial::Outcome;
use crate::truth::Truth;
use crate::unit::{UnderTest, Unit};
use brushwork_tuning::law::Law;
use brushwork_tuning::model::{Gains, Pid};
use brushwork_tuning::score::{POSITION_OVERSHOOT, VELOCITY_OVERSHOOT};
use brushwork_tuning::tune::Method;

/// Highest sensitivity and duty noise of an oracle.
const MS: f64 = 1.6;
const NOISE_DUTY: f64 = 0.08;
/// How far gains are moved to see whether a point is firm.
const FIRMNESS: f64 = 0.02;

/// Duty that the integral of a PID may carry.
const INTEGRAL_DUTY: f64 = 0.5;

/// The cost of an outcome, as the oracle and the tables count it.
#[must_use]
pub fn cost(method: Method, outcome: &Outcome) -> f64 {
    let scale = if method == Method::Velocity { VELOCITY_OVERSHOOT } else { POSITION_OVERSHOOT };
    outcome.score.cost(scale)
}

/// Finds the optima of a plant.
#[must_use]
pub fn optima<U: Unit>(under_test: &UnderTest<U>) -> U::Optima {
    U::Optima::worked_out(|method| optimum(under_test, method))
}

/// The optima of its position loops alone, for a plant whose speed cannot be run freely.
#[must_use]
pub fn position_optima<U: Unit>(under_test: &UnderTest<U>) -> U::Optima {
    U::Optima::worked_out(|method| (method != Method::Velocity).then(|| optimum(under_test, method))?)
}

/// Finds the optimum of one method.
fn optimum<U: Unit>(under_test: &UnderTest<U>, method: Method) -> Option<Optimum> {
    Search { method, under_test, truth: &under_test.truth }.run()
}

struct Search<'a, U: Unit> {
    method: Method,
    under_test: &'a UnderTest<U>,
    truth: &'a Truth<U::Law>,
}

/// A point of the search: P, I or D, and the outer P.
type Point = [f64; 3];

impl<U: Unit> Search<'_, U> {
    fn gains(&self, point: &Point) -> Gains {
        let [a, b, c] = *point;
        match self.method {
            Method::Velocity => Gains { velocity: Pid { p: a, i: b, d: 0.0 }, ..Gains::default() },
            Method::Pd => Gains { position: Some(Pid { p: a, i: 0.0, d: b }), ..Gains::default() },
            Method::Pid => Gains {
                position: Some(Pid { p: a, i: c, d: b }),
                max_integral: if c > 0.0 { INTEGRAL_DUTY * self.truth.qpps / c } else { 0.0 },
                ..Gains::default()
            },
            Method::Piv => Gains {
                velocity: Pid { p: a, i: b, d: 0.0 },
                position: (c > 0.0).then_some(Pid { p: c, i: 0.0, d: 0.0 }),
                ..Gains::default()
            },
        }
    }

    fn allowed(&self, point: &Point) -> bool {
        let gains = self.gains(point);
        let margins = self.truth.nominal.margins(&gains, self.truth.qpps);
        margins.ms <= MS && margins.noise_duty <= NOISE_DUTY
    }

    fn stable(&self, point: &Point) -> bool {
        // The rounded QPPS is nothing beside the rounding of the gains.
        let gains = self.gains(point);
        let law = &self.truth.law;
        let registers = U::registers(law, &gains, self.truth.qpps);
        let gains = law.gains(&registers, self.truth.qpps, gains.position.is_some());
        self.truth.nominal.spectral_radius(&gains, self.truth.qpps) < 1.0
    }

    fn cost(&self, point: &Point) -> (f64, f64) {
        let registers = U::registers(&self.truth.law, &self.gains(point), self.truth.qpps);
        let outcome = U::trial(self.under_test, self.method, &registers);
        let cap = if self.method == Method::Velocity { 0.25 } else { 0.08 };
        let mut cost = cost(self.method, &outcome);
        if outcome.score.overshoot > cap {
            cost *= 1.0 + 20.0 * (outcome.score.overshoot - cap);
        }
        if outcome.hunting {
            cost *= 1.5;
        }
        (cost, outcome.duty_rms)
    }

    /// The worst cost over the point and its neighbours.
    fn firm(&self, point: &Point, best: f64) -> (f64, f64) {
        let (mut worst, duty) = self.cost(point);
        for n in 0..3 {
            for by in [1.0 + FIRMNESS, 1.0 - FIRMNESS] {
                if worst > best || point[n] == 0.0 {
                    continue;
                }
                let mut moved = *point;
                moved[n] *= by;
                worst = worst.max(self.cost(&moved).0);
            }
        }
        (worst, duty)
    }

    fn run(&self) -> Option<Optimum> {
        let mut grid: Vec<(f64, Point)> = Vec::new();
        for point in self.grid() {
            grid.push((self.cost(&point).0, point));
        }
        grid.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<(f64, f64, Point)> = None;
        for (_, point) in grid.iter().take(4) {
            let (cost, duty) = self.firm(point, f64::INFINITY);
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, duty, *point));
            }
        }
        let (cost, duty_rms, point) = self.descend(best?);
        Some(Optimum { cost, duty_rms, gains: self.gains(&point) })
    }

    fn descend(&self, mut best: (f64, f64, Point)) -> (f64, f64, Point) {
        let mut step: f64 = 1.25;
        for _ in 0..5 {
            for n in 0..8 {
                let mut point = best.2;
                let by = if n % 2 == 0 { step } else { 1.0 / step };
                match n / 2 {
                    3 => point.iter_mut().for_each(|gain| *gain *= by),
                    single => point[single] *= by,
                }
                if point == best.2 || !self.allowed(&point) || !self.stable(&point) {
                    continue;
                }
                let (cost, duty) = self.firm(&point, best.0);
                if cost < best.0 {
                    best = (cost, duty, point);
                }
            }
            step = step.sqrt();
        }
        best
    }

    /// The global grid: for each ratio of gains, shares of the highest gain that is allowed, going up from near zero.
    fn grid(&self) -> Vec<Point> {
        let lag = self.truth.lag.total_s(self.truth.law.tick_s()) + 1.5 * self.truth.law.tick_s();
        let longest = (12.0 * self.truth.tau_s).max(40.0 * lag);
        let mut points = Vec::new();
        let times =
            |n: usize, of: usize| 1.5 * lag * (longest / (1.5 * lag)).powf(n as f64 / (of - 1) as f64);
        match self.method {
            Method::Velocity => {
                for n in 0..12 {
                    let time = times(n, 12);
                    self.shares(|p| [p, p / time, 0.0], 400.0, &[1.0, 0.8, 0.6, 0.4, 0.2], &mut points);
                }
            }
            Method::Pid => {
                // Where friction and load are small, a PD is the best PID.
                self.plain_pd(&mut points);
                for n in 2..10 {
                    let derivative = 0.2 * f64::from(n) * self.truth.tau_s;
                    for integral in [1.0, 3.0, 9.0].map(|times| times * self.truth.tau_s.max(0.05)) {
                        let of = |p| [p, p * derivative, p / integral];
                        self.shares(of, 2000.0, &[1.0, 0.85, 0.7, 0.5, 0.3], &mut points);
                    }
                }
            }
            Method::Pd => self.plain_pd(&mut points),
            Method::Piv => {
                for n in 0..6 {
                    let time = times(n, 6);
                    let mut inner = Vec::new();
                    self.shares(|p| [p, p / time, 0.0], 400.0, &[1.0, 0.6, 0.3], &mut inner);
                    for [a, b, _] in inner {
                        self.shares(|p| [a, b, p], 300.0, &[1.0, 0.7, 0.5, 0.3], &mut points);
                    }
                }
            }
        }
        points
    }

    fn plain_pd(&self, points: &mut Vec<Point>) {
        for n in 0..13 {
            let time = 0.125 * f64::from(n) * self.truth.tau_s;
            self.shares(|p| [p, p * time, 0.0], 2000.0, &[1.0, 0.85, 0.7, 0.5, 0.3], points);
        }
    }

    fn shares(&self, of: impl Fn(f64) -> Point, top: f64, shares: &[f64], into: &mut Vec<Point>) {
        let mut p = top * 1e-4;
        // An integral under a weak loop is two integrals: a PID has to go up before it may begin.
        while self.method == Method::Pid && p < 0.1 * top && !self.allowed(&of(p)) {
            p *= 1.2;
        }
        if !self.allowed(&of(p)) {
            return;
        }
        while p < top && self.allowed(&of(p * 1.2)) {
            p *= 1.2;
        }
        into.extend(shares.iter().map(|share| of(p * share)).filter(|point| self.stable(point)));
    }
}

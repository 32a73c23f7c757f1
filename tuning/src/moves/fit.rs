//! A motor, the lag of its loop and the rate of that out of moves under known gains: an output-error fit of the counted places, as in Ljung, "System
//! Identification", 2nd edition, sections 7.3 and 13.4. Under feedback it needs no more than the law and the gains that were in force.
//!
//! Gains are taken as duties of the whole drive, so that the speed per duty comes out in those too, whatever a duty is in volts.

use crate::fit::Fit;
use crate::gains::Gains;
use crate::law::Law;
use crate::model::{Lag, PlantModel};
use crate::thresholds::thresholds;
use crate::ticks::{Setpoint, TickLoop};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn, OMatrix, U6, Vector6};

/// Gains are duties: a QPPS of 1 makes `P e` one.
pub(super) const OF_DUTY: f64 = 1.0;

thresholds! {
    /// The fit of motor, friction and lag to strokes: noises, priors and bounds.
    MOVES_FIT: Thresholds {
        /// Step by which slopes are taken, in units of each parameter.
        slope_step: f64 = 0.05,
        /// Prior standard deviation of the time from a command's stamp to its effect, in seconds.
        offset_sd_s: f64 = 0.002,
        /// Prior mean and standard deviation of the lag, in seconds.
        lag_s: (f64, f64) = (0.0007, 0.0008),
        /// Longest lag, in seconds.
        longest_lag_s: f64 = 0.004,
        /// Longest lag, in ticks of the loop, where that is shorter.
        most_lag_ticks: f64 = 13.0,
        /// Highest friction, and highest load either way, as a share of full duty.
        most_friction: f64 = 0.6,
        /// Standard deviation of a place from rounding, in counts.
        rounded_counts: f64 = 0.5,
        /// Standard deviation of the time stamp of a place, in seconds.
        stamp_s: f64 = 0.000_7,
        /// Standard deviation of what the model leaves out of a place, as a share of the length of the move: stiction, a springy shaft, the battery.
        left_out: f64 = 0.006,
        /// Ticks without any change of speed or drive after which there is none until the next move: more than a lag.
        still_ticks: u32 = 20,
        /// Standard deviations from which on a residual counts less and less.
        knee: f64 = 3.0,
        /// Relative change of misfit and parameters that ends a fit.
        enough: f64 = 1e-5,
        /// The same while rates and starts are told apart, whose misfits differ by far more. With 1e-3 a fit ended in a valley of its own, at a third of the true time constant, and the run was called tuned.
        enough_to_tell: f64 = 1e-4,
        /// How far a parameter may lie outside its bounds, as a standard deviation in units of the parameter.
        bound: f64 = 0.1,
        /// How much larger than the least the misfit of a rate may be for it to be as likely, in units of the reduced chi-square (of 1 where that is less).
        likely: f64 = 6.0,
        /// How many times that makes a rate so unlikely that quicker ones are not looked at, where the one before was as unlikely and less so than this one.
        hopeless: f64 = 4.0,
    }
}

/// Units of the parameters: logarithms of gain and time constant; friction and load, duties; time from a command's stamp to its effect and lag of the loop, s.
const UNITS: [f64; 6] = [0.05, 0.05, 0.01, 0.01, 1e-3, 5e-4];

/// Moves under some gains, from rest.
#[derive(Clone, Debug)]
pub(super) struct Stretch<L: Law> {
    /// Time and counts.
    pub points: Vec<(f64, f64)>,
    /// When it was commanded where, and how fast at the most; the first is what it was at before.
    pub moves: Vec<(f64, f64, f64)>,
    /// What was in force.
    pub registers: L::Registers,
}

/// What moves told.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// The motor.
    pub fit: Fit,
    /// The lag of the loop beyond its tick, s, and its standard deviation.
    pub lag_s: (f64, f64),
    /// Rate of the loop, Hz, and the slowest and quickest that are as likely.
    pub rate_hz: u32,
    pub likely_hz: (u32, u32),
    q: Vector6<f64>,
}

/// Where a fit begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start(Vector6<f64>);

impl Start {
    /// From a gain and a time constant.
    pub(super) fn of(gain_counts_per_s: f64, tau_s: f64, friction: f64) -> Self {
        let values = [gain_counts_per_s.max(1.0).ln(), tau_s.ln(), friction, 0.0, 0.001, MOVES_FIT.lag_s.0];
        Self(Vector6::from_fn(|n, _| values[n] / UNITS[n]))
    }

    /// From what was found before.
    pub(super) fn from(found: &Found) -> Self {
        Self(found.q)
    }
}

/// Fits what stretches say under a law at each of `rates_hz`; its own where there is none. `None` where nothing fits.
pub(super) fn fit_moves<L: Law>(
    stretches: &[Stretch<L>],
    law: &L,
    rates_hz: &[u32],
    starts: &[Start],
) -> Option<Found> {
    let own = [law.rate_hz()];
    let rates_hz = if rates_hz.is_empty() { &own } else { rates_hz };
    let readings = stretches.iter().map(|stretch| stretch.points.len()).sum::<usize>();
    if readings < 2 * UNITS.len() {
        return None;
    }
    let mut found: Vec<(f64, u32, Problem<'_, L>)> = Vec::new();
    let mut nearest = None;
    for rate_hz in rates_hz {
        let law = law.at_rate(*rate_hz);
        // The next rate is near to this one; but where it was far from the true one, a fit may have ended in a valley of its own.
        let told = |start: &Start| minimised(stretches, law, start.0, MOVES_FIT.enough_to_tell);
        let tries = starts.iter().chain(&nearest).map(told);
        let Some(best) = tries.flatten().min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        nearest = Some(Start(best.1.q));
        found.push((best.0, *rate_hz, best.1));
        if gets_hopeless(found.iter().map(|fit| fit.0), readings) {
            break;
        }
    }
    let least = found.iter().map(|one| one.0).fold(f64::INFINITY, f64::min);
    // Twice as far as is likely, since a fit that goes on ends lower.
    let may_be_likely = likely_to(least, readings, 2.0);
    for (misfit, _, problem) in found.iter_mut().filter(|one| one.0 <= may_be_likely) {
        if let Some(better) = minimised(stretches, problem.law, problem.q, MOVES_FIT.enough) {
            (*misfit, *problem) = better;
        }
    }
    let best = found.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let chi_square = best.0 / readings as f64;
    let likely = |misfit: f64| misfit <= likely_to(best.0, readings, 1.0);
    let likely_hz = || found.iter().filter(|other| likely(other.0)).map(|other| other.1);
    let likely_hz = (likely_hz().min().unwrap_or(best.1), likely_hz().max().unwrap_or(best.1));
    let (model, offset_s, lag_s) = parts(&best.2.q, best.1);
    let deviations = best.2.deviations(chi_square.max(1.0));
    let fit = Fit {
        model,
        offset_s,
        chi_square,
        sd_ln_gain: deviations[0],
        sd_ln_tau: deviations[1],
        sd_coulomb: deviations[2],
        ramp: 1.0,
    };
    Some(Found { fit, lag_s: (lag_s, deviations[5]), rate_hz: best.1, likely_hz, q: best.2.q })
}

/// The misfit up to which a rate is as likely as the one of the least, or so many times as far.
fn likely_to(least: f64, readings: usize, times: f64) -> f64 {
    least + times * MOVES_FIT.likely * (least / readings as f64).max(1.0)
}

/// Whether misfits of ever quicker rates go on growing where they are far too large already: three of four ticks of a fit are those of the quickest rates.
fn gets_hopeless(misfits: impl Iterator<Item = f64> + Clone, readings: usize) -> bool {
    let least = misfits.clone().fold(f64::INFINITY, f64::min);
    let most = likely_to(least, readings, MOVES_FIT.hopeless);
    let (mut before, mut last) = (f64::NAN, f64::NAN);
    for misfit in misfits {
        (before, last) = (last, misfit);
    }
    before > most && last > before
}

fn minimised<L: Law>(
    stretches: &[Stretch<L>],
    law: L,
    q: Vector6<f64>,
    enough: f64,
) -> Option<(f64, Problem<'_, L>)> {
    let problem = Problem::new(stretches, law, q);
    let (problem, report) =
        LevenbergMarquardt::new().with_patience(4).with_ftol(enough).with_xtol(enough).minimize(problem);
    report.objective_function.is_finite().then_some((2.0 * report.objective_function, problem))
}

/// Motor, offset and lag that parameters stand for.
fn parts(q: &Vector6<f64>, rate_hz: u32) -> (PlantModel, f64, f64) {
    let value = |n: usize| q[n] * UNITS[n];
    let model = PlantModel {
        gain_counts_per_s: value(0).clamp(0.0, 18.0).exp(),
        tau_s: value(1).clamp(-7.0, 2.5).exp(),
        coulomb_duty: value(2).clamp(0.0, MOVES_FIT.most_friction),
        load_duty: value(3).clamp(-MOVES_FIT.most_friction, MOVES_FIT.most_friction),
        drive_limit: None,
        brake_limit: None,
        sag: 0.0,
    };
    let longest_s = MOVES_FIT.longest_lag_s.min(MOVES_FIT.most_lag_ticks / f64::from(rate_hz));
    (model, value(4), value(5).clamp(0.0, longest_s))
}

struct Problem<'a, L: Law> {
    stretches: &'a [Stretch<L>],
    law: L,
    q: Vector6<f64>,
    /// The misfits there; a fit asks for them and then for their slopes.
    here: DVector<f64>,
}

impl<'a, L: Law> Problem<'a, L> {
    fn new(stretches: &'a [Stretch<L>], law: L, q: Vector6<f64>) -> Self {
        let mut problem = Self { stretches, law, q, here: DVector::zeros(0) };
        problem.here = problem.misfits(&q);
        problem
    }

    fn misfits(&self, q: &Vector6<f64>) -> DVector<f64> {
        let (model, offset_s, lag_s) = parts(q, self.law.rate_hz());
        let lag = Lag { filter_s: 0.0, delay_ticks: lag_s * f64::from(self.law.rate_hz()) };
        let mut all = Vec::new();
        for stretch in self.stretches {
            let gains = self.law.gains(&stretch.registers, OF_DUTY, true);
            follow(stretch, &self.law, &model, lag, &gains, offset_s, &mut all);
        }
        all.push(offset_s / MOVES_FIT.offset_sd_s);
        all.push((lag_s - MOVES_FIT.lag_s.0) / MOVES_FIT.lag_s.1);
        for (n, held) in [(2, model.coulomb_duty), (3, model.load_duty), (5, lag_s)] {
            all.push((q[n] - held / UNITS[n]) / MOVES_FIT.bound);
        }
        DVector::from_vec(all)
    }

    fn slopes(&self) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..UNITS.len())
            .map(|n| {
                let mut up = self.q;
                up[n] += MOVES_FIT.slope_step;
                (self.misfits(&up) - &self.here) / MOVES_FIT.slope_step
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Standard deviations of the parameters.
    fn deviations(&self, chi_square: f64) -> [f64; 6] {
        let slopes = self.slopes();
        let information = slopes.tr_mul(&slopes) + DMatrix::identity(UNITS.len(), UNITS.len()) * 1e-9;
        let Some(covariance) = information.try_inverse() else { return [f64::INFINITY; 6] };
        std::array::from_fn(|n| (covariance[(n, n)].max(0.0) * chi_square).sqrt() * UNITS[n])
    }
}

impl<L: Law> LeastSquaresProblem<f64, Dyn, U6> for Problem<'_, L> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U6>;
    type ParameterStorage = Owned<f64, U6>;

    fn set_params(&mut self, q: &Vector6<f64>) {
        self.q.copy_from(q);
        self.here = self.misfits(q);
    }

    fn params(&self) -> Vector6<f64> {
        self.q
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.here.clone())
    }

    fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U6>> {
        let slopes = self.slopes();
        Some(OMatrix::<f64, Dyn, U6>::from_fn(slopes.nrows(), |r, c| slopes[(r, c)]))
    }
}

/// What a loop makes of the moves of a stretch, held against the places that were read. A count is its lower edge, so that half a count further is
/// where the axis was on average, here and in the loop alike: both are told in counts.
fn follow<L: Law>(
    stretch: &Stretch<L>,
    law: &L,
    model: &PlantModel,
    lag: Lag,
    gains: &Gains,
    offset_s: f64,
    into: &mut Vec<f64>,
) {
    let Some((start_s, start)) = stretch.points.first().copied() else { return };
    let tick_s = law.tick_s();
    let mut twin = TickLoop::new(*model, *law, lag, *gains, OF_DUTY).smooth();
    // Friction may hold it a little beside what it was told: the loop pulls there from the first tick on.
    let mut moves = stretch.moves.iter().peekable();
    let at_first = moves.next().map_or(start, |before| before.1);
    twin.motion.position = at_first;
    let mut goal = Setpoint::Position(at_first, 0.0);
    twin.tick(goal, 0.0);
    twin.motion.position = start;
    let mut length = 1.0_f64;
    let (mut from, mut before) = (at_first, twin.motion);
    let (mut t, mut still) = (start_s, 0);
    for (at, counts) in &stretch.points {
        while t < *at {
            // What stands under a drive that stays goes on so until the next move.
            let next_s = moves.peek().map_or(f64::INFINITY, |given| given.0 + offset_s);
            if still >= MOVES_FIT.still_ticks && next_s > t {
                t = next_s.min(*at);
                continue;
            }
            while let Some((_, target, speed)) = moves.next_if(|given| given.0 + offset_s <= t) {
                goal = Setpoint::Position(*target, *speed);
                length = length.max((target - from).abs());
                from = *target;
            }
            before = twin.motion;
            let duty = twin.duty;
            twin.tick(goal, 0.0);
            let is_still = twin.motion.speed == 0.0 && before.speed == 0.0 && twin.duty == duty;
            still = if is_still { still + 1 } else { 0 };
            t += tick_s;
        }
        let share = (1.0 - (t - at) / tick_s).clamp(0.0, 1.0);
        let place = before.position + share * (twin.motion.position - before.position);
        let speed = twin.motion.speed;
        let sd = MOVES_FIT.rounded_counts.hypot(MOVES_FIT.stamp_s * speed).hypot(MOVES_FIT.left_out * length);
        into.push(soft((place - counts) / sd));
    }
}

/// A residual far out counts by its root (Huber).
fn soft(residual: f64) -> f64 {
    if residual.abs() <= MOVES_FIT.knee {
        residual
    } else {
        (2.0 * MOVES_FIT.knee * residual.abs() - MOVES_FIT.knee * MOVES_FIT.knee).sqrt().copysign(residual)
    }
}

#[cfg(test)]
mod tests {
    use super::gets_hopeless;

    #[test]
    fn quicker_rates_are_left_out_only_where_misfits_go_on_growing_far_above_the_least() {
        // 100 readings, so that a rate is as likely up to a misfit of 106 and hopeless above 124.
        let stops = |misfits: &[f64]| gets_hopeless(misfits.iter().copied(), 100);
        assert!(stops(&[300.0, 100.0, 125.0, 130.0]));
        assert!(!stops(&[300.0, 100.0, 123.0, 130.0]), "the one before was not so far off");
        assert!(!stops(&[300.0, 100.0, 140.0, 130.0]), "it falls again");
        assert!(!stops(&[300.0, 200.0]) && !stops(&[300.0]) && !stops(&[]));
    }
}

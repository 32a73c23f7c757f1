//! The lag that hides in the firmware's loop, measured on the closed loop.
//!
//! Polls at 50 to 100 Hz cannot see a few milliseconds in the counts of an open loop. In a closed one the duty is the
//! controller's own answer to the speed as it sees it: the loop of the gains that are tried is simulated, and filter, delay and winding are fitted to
//! the polled counts and duties (an output-error fit, as in Ljung, "System Identification", 2nd edition, section 7.3).
//!
//! What is called the lag is everything that the loop loses between the motion and the torque, beyond the hold and the count difference of a tick: the
//! mean delay of the filter on the speed, the ticks by which the duty comes late, and the time constant of the winding (inductance over resistance).

use crate::closed_loop_record::{
    CountAge, Flanks, RECORD, Stretch, misfits, noise, noise_of_setpoints, readings, soft,
};
use crate::law::{Law, Windup};
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Lag, PlantModel};
use crate::open_loop_record::are_in_step;
use crate::thresholds::thresholds;
use crate::ticks::TickLoop;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn, U6, Vector6};
use serde::{Deserialize, Serialize};

thresholds! {
    /// What the fit takes for granted. Chosen on 96 motors of another make (seeds 501 and 502 of `device/mcp/axis/tests/other_make`), where they give a lag within
    /// 0.6 ms in the median.
    LAG_PRIORS: LagPriors {
        /// Standard deviation of the logarithm of the time constant: as a multiple of that of the open-loop fit, and the lowest and highest value that it may have.
        tau: (f64, f64, f64) = (1.0, 0.02, 0.6),
        /// Standard deviation of the logarithm of the gain: the open-loop fit knows it well.
        gain: f64 = 0.01,
        /// Standard deviation of the time from a command's stamp to its effect, beyond the wait for a tick, in seconds: half the asymmetry of a line of 2 ms.
        offset_s: f64 = 0.001,
        /// Time constant of a winding and its standard deviation, in seconds: 0.2 to 3 ms in brushed motors.
        winding_s: (f64, f64) = (0.001, 0.001),
        /// Sum of filter and delay from which on a lag is unlikely, and the standard deviation of what lies beyond it, in seconds.
        long_s: (f64, f64) = (0.012, 0.008),
        /// Standard deviation of the logarithm of the duty's noise against what rounding makes of it under a lag: a filter lets through much less than a delay. Uneven
        /// edges of an encoder and speeds of whole counts a tick make it half or twice as loud.
        rounding: f64 = 0.5,
    }
}

thresholds! {
    /// How wide the interval is. Measured: with these 90 to 99 % of the intervals hold the lag (MEASURED.md, "Intervals").
    LAG_WIDTHS: LagWidths {
        /// Standard deviations on either side of the lag.
        deviations: f64 = 2.0,
        /// Misfit (reduced chi-square) below which a record tells its lag better than the noise that is taken for granted allows, and the least factor of the variance then, which is the
        /// misfit: quick motors, of which 0.7 times the width would have held the lag in 96 of 100 runs (seeds 7 and 11). Springy shafts are at 0.6 and more. It is so towards longer lags
        /// alone: filter, delay and winding cannot be less than nothing, so that where there is no delay the lag of coreless motors comes out 0.48 ms too long on average.
        well_explained: (f64, f64) = (0.5, 0.3),
        /// Misfit (reduced chi-square) from which on more turns than one rigid motor, and what that makes of the lag, as a standard deviation in seconds: without it
        /// 70 to 86 of 100 intervals of such loops held it (MEASURED.md, "The lag").
        soft: (f64, f64) = (1.0, 0.0015),
        /// What no record tells, as standard deviations: a part that does not change, in seconds, and a part that goes with the tick, as a share of it (how a filter is
        /// discretised, and whether a sum is taken before or after the present error is added where the record does not tell).
        unmodelled: (f64, f64) = (0.0004, 0.15),
        /// Least and greatest factor of that. Between them the factor is the reduced chi-square of the fit: a loop that the model explains to a third of its noise hides
        /// less than one that it explains badly. Of 400 motors (seeds 7 and 11) the lag of those with a chi-square below 0.5 was within 1.1 ms at the 95th percentile,
        /// above 1.3 within 5.2 ms.
        by_misfit: (f64, f64) = (0.3, 2.0),
        /// The least factor where counts are live: readings that are so sharp explain a loop to a fiftieth of what is taken for granted. Of 48 runs on coreless motors of a foreign controller
        /// with live counts (seeds 891 to 893) one had a lag 0.2 ms longer than its interval and a true Ms of 1.89 without a warning, with 0.3.
        of_live: f64 = 0.5,
        /// Noise of the duty, as a share of full, at which the standard deviation doubles: a loop that the rounding of counts drives into its limits is no longer linear.
        loud_duty: f64 = 0.25,
        /// How much larger than the least the misfit of another minimum may be for it to count, in units of the reduced chi-square (of 1 where that is less).
        likely: f64 = 4.0,
        /// The same of a shorter filter than the likeliest one, behind which a loop on the position is to keep its margin: three standard deviations, since cogs bend the record of
        /// a quick motor alike for all of it. With 4, of 458 PIV loops of another make (seeds 1003, 1007, 1014 and 1015) five had a true Ms above 1.8 without a warning (MEASURED.md).
        likely_filter: f64 = 9.0,
    }
}

thresholds! {
    /// When the fit of the lag ends, and what it is suspicious of.
    LAG: Thresholds {
        /// Misfit of the closed loop (reduced chi-square) above which its lag is not all that there may be: of 600 rigid motors (seeds 7, 11, 101 and 313) seven are above it, and arms with a
        /// springy shaft that were called tuned at a true Ms of 1.8 to 2.5 while it was 1.25 are at 1.14 to 1.27 (MEASURED.md, "The lag").
        unexplained: f64 = 1.1,
        /// What the sum makes in a tick, as a share of P, from which on it is asked whether it is taken before or after the present error is added, and from which on the lag of either
        /// counts where the record does not tell: taken to be the other, at 0.09 the lag of two motors of another make was off by 1.1 ms; below 0.1 the lags of both are mostly within
        /// 0.5 ms of each other (26 motors).
        least_sum: (f64, f64) = (0.04, 0.1),
        /// Noise of the duty on most plateaus, as a share of the root mean square over the setpoints, below which there is one setpoint of nearly whole counts in a tick: of 400 loops
        /// (seeds 7 and 11) one is below it, at 0.06, the others above 0.5. Taken for all of the noise, it made a chi-square of 13 of the record of a gearmotor with 64 counts a turn.
        quiet: f64 = 0.25,
        /// Shares of the fitted filter that the record is asked about, shortest first.
        filter_shares: [f64; 4] = [0.0, 0.25, 0.5, 0.75],
        /// Step by which slopes are taken, in units of each parameter.
        slope_step: f64 = 0.02,
        /// How far a parameter may lie outside its bounds, as a standard deviation in units of the parameter.
        bound: f64 = 0.1,
        /// Relative change of misfit and parameters that ends a fit, as in the fit of moves: a thousandth of what tells two starts apart.
        enough: f64 = 1e-5,
        /// Standard deviation of the times of counts below which they are read live, as a share of that of the age of a register that is refreshed once a tick. Simulated motors with such a register,
        /// polled in real time, are at 0.97 to 1.0 (ten runs), those of a foreign controller with live counts at 0.06 to 0.71 (46 runs).
        live: f64 = 0.7,
        /// Standard deviation of counts or duties about the model, as a share of what is taken for granted of it, below which they are known better than that. Of 196 motors
        /// (seeds 7 and 11) the counts of packet serial, which are up to a tick old, are at 0.73 to 1.0 (5th to 95th percentile); of 97 Motion Minds, whose counts come with the
        /// number of their tick, at 0.06 to 0.63. The duties of four coreless motors of a foreign controller with live counts are at 0.06 to 0.17, those of 28 other motors above 0.7.
        sharp: f64 = 0.65,
        /// Least standard deviation of such readings, as the same share. With it the lag of Motion Minds is within 0.83 ms on average instead of 0.98 (192 plants of seeds 7
        /// and 11).
        least_share: f64 = 0.3,
    }
}

thresholds! {
    /// When rising and falling flanks are told apart. Of 400 motors of the bench (seeds 7 and 11) 24 have flanks
    /// of one direction that tell of the lag alone; of 30 arms and steering gears of a foreign controller (seeds 811 to 818) 22 (MEASURED.md).
    FLANKS: FlankThresholds {
        /// Fewest readings of each of them: strokes to and fro have no flank that only rises.
        least_readings: usize = 40,
        /// How many times the misfit of the one is that of the other (reduced chi-square) for it to be left out where they differ: rigid motors have 0.6 to 1.6, arms and steering
        /// gears with backlash whose load has little friction 1.4 to 16.
        worse: f64 = 1.35,
        /// By how many standard deviations they are to differ for that.
        apart: f64 = 1.0,
        /// The same from which on it is left out in any case.
        much_worse: f64 = 2.0,
        /// Standard deviations by which they differ from which on the interval holds both: the five percent of a normal distribution.
        disagree: f64 = 2.0,
    }
}

/// Where the fit starts: filter, s, and delay, ticks.
const STARTS: [(f64, f64); 4] = [(0.001, 0.2), (0.006, 0.2), (0.001, 1.2), (0.010, 1.0)];
/// Units of the parameters: filter, delay and winding, s; logarithm of the time constant; time from a command's stamp to its effect, s; logarithm of the gain.
const UNITS: [f64; 6] = [1e-3, 1e-3, 1e-3, 0.05, 1e-3, 0.01];

/// The lag and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LagFit {
    /// The most likely lag.
    pub lag: Lag,
    /// The lag of the longest total that is still likely.
    pub worst: Lag,
    /// Shortest and longest likely total, s.
    pub interval_s: (f64, f64),
    /// Time constant that goes with the most likely lag, relative to the model's.
    pub tau_scale: f64,
    /// Reduced chi-square of the best.
    pub chi_square: f64,
    /// The shortest filter on the speed that is likely, s: what it does not make of the lag lies between the controller and the torque, where a loop on the position meets it
    /// too. `None` where it was not asked.
    #[serde(default)]
    pub least_filter_s: Option<f64>,
    /// Whether the loop takes its sum the other way than the law that was asked about ([`Law::with_other_sum`]).
    #[serde(default)]
    pub has_other_sum: bool,
    /// What its integral does while the duty is cut, as far as it showed.
    #[serde(default)]
    pub windup: Windup,
    /// How loud the duty of the loop was beside what the rounding of counts makes of it behind that lag.
    #[serde(default = "as_rounding")]
    pub loudness: f64,
}

fn as_rounding() -> f64 {
    1.0
}

impl LagFit {
    /// Whether the closed loop did what no lag explains, such as a springy shaft does.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        self.chi_square > LAG.unexplained
    }
}

/// What a fit is asked beside the lag.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// How short the filter on the speed may be, which matters to loops on the position.
    pub filter: bool,
    /// What of the law only a loop shows that turns the motor: whether it takes its sum before or after the present error is added to it, and what its integral does while the
    /// duty is cut. The latter the fit leaves open.
    pub law: bool,
    /// Whether one more start may be made to see what the integral does: loops that act on the duty directly have none on the speed.
    pub integral: bool,
}

/// Fits the lag. `sd_ln_tau` is how loosely the time constant is known.
#[must_use]
pub fn fit_lag<L: Law>(
    stretches: &[Stretch],
    plant: &PlantModel,
    law: &L,
    qpps: f64,
    sd_ln_tau: f64,
    asked: Asked,
) -> Option<LagFit> {
    let steps: usize = stretches.iter().map(|stretch| stretch.record.setpoints.len()).sum();
    let duties: usize = stretches.iter().map(|stretch| stretch.record.duties.len()).sum();
    if steps < 3 || duties < 20 {
        return None;
    }
    let tick_s = law.tick_s();
    let known = Known::new(stretches, plant, law, qpps, sd_ln_tau);
    let found = known.fits();
    let best = best_of(&found)?;
    let readings = known.readings.max(1) as f64;
    let doubted = |likely: f64, misfit: f64| likely * (misfit / readings).max(1.0);
    let doubt = |misfit: f64| doubted(LAG_WIDTHS.likely, misfit);
    let other_sum = if asked.law { with_other_sum(stretches, law) } else { None };
    let other_sum = other_sum.as_ref().map(|(law, gains)| Known::new(gains, plant, law, qpps, sd_ln_tau));
    // From every start too: where the sum is taken otherwise than was asked about, the filter that fits best makes up for it, and from there no way leads to a delay.
    let by_other_sum = other_sum.as_ref().map(Known::fits).unwrap_or_default();
    let (well, least_scale) = LAG_WIDTHS.well_explained;
    let scaled = |scale: f64| scale.max(if scale < well { least_scale } else { 1.0 });
    let has_other_sum = best_of(&by_other_sum)
        .is_some_and(|other| other.0 + LAG_WIDTHS.likely * scaled(other.0 / readings) < best.0);
    let (known, found, by_other_sum) = match &other_sum {
        Some(other) if has_other_sum => (other, by_other_sum, Vec::new()),
        _ if in_a_tick(law, stretches) > LAG.least_sum.1 => (&known, found, by_other_sum),
        _ => (&known, found, Vec::new()),
    };
    let best = best_of(&found)?;
    let chi_square = best.0 / readings;
    let least_filter_s = asked
        .filter
        .then(|| known.least_filter_s(&best.1.q, best.0 + doubted(LAG_WIDTHS.likely_filter, best.0)));
    let readings_are = known.readings_are(&best.1.q);
    let sharper = known.with(readings_are);
    let other_sum = other_sum.as_ref().map(|other| other.with(readings_are));
    let (known, found, by_other_sum) = if readings_are.trusted == [1.0; 2] {
        (known, found, by_other_sum)
    } else {
        // Both sums by the same measure.
        let by_other_sum = other_sum.as_ref().map(|other| other.fits_from(&by_other_sum)).unwrap_or_default();
        (&sharper, sharper.fits_from(&found), by_other_sum)
    };
    let best = best_of(&found)?;
    let flanks = [Flanks::Rising, Flanks::Falling].map(|flanks| known.of_flanks(flanks));
    let told = flanks.iter().filter(|known| known.readings >= FLANKS.least_readings);
    let by_flank: Vec<(f64, Problem<'_, L>)> = told.filter_map(|known| known.fit_from(best.1.q)).collect();
    let by_flank = told_apart(&by_flank);
    let best = by_flank.first().filter(|_| by_flank.len() == 1).copied().unwrap_or(best);
    let scale = best.0 / best.1.known.readings.max(1) as f64;
    // How much of it is the filter is known less well, and a loop on the position meets the rest alone.
    let least_scale = if scale < well && !asked.filter { least_scale } else { 1.0 };
    let loud = 1.0 + (known.loudest() / LAG_WIDTHS.loud_duty).powi(2);
    let (least, most) = LAG_WIDTHS.by_misfit;
    let least = if known.readings_are.age == CountAge::Live { LAG_WIDTHS.of_live } else { least };
    let floor_s =
        LAG_WIDTHS.unmodelled.0.hypot(LAG_WIDTHS.unmodelled.1 * tick_s) * chi_square.clamp(least, most);
    let (soft, of_soft_s) = LAG_WIDTHS.soft;
    let floor_s = if chi_square > soft { floor_s.hypot(of_soft_s) } else { floor_s };
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    let likely = best.0 + doubt(best.0);
    let whole = found.iter().chain(&by_other_sum).filter(|other| other.0 <= likely && by_flank.len() != 1);
    for (_, problem) in whole.chain(by_flank.iter().copied()) {
        let total = known.parts(&problem.q).iter().sum::<f64>();
        let deviation = problem.deviation();
        let width = |scale: f64| LAG_WIDTHS.deviations * loud * (deviation * scale.sqrt()).hypot(floor_s);
        shortest = shortest.min(total - width(scale.max(1.0)));
        longest = longest.max(total + width(scale.max(least_scale)));
    }
    let [filter_s, delay_s, winding_s] = known.parts(&best.1.q);
    let lag = Lag { filter_s, delay_ticks: (delay_s + winding_s) / tick_s };
    let total_s = lag.total_s(tick_s);
    let worst = Lag { delay_ticks: lag.delay_ticks + (longest - total_s).max(0.0) / tick_s, ..lag };
    let tau_scale = (best.1.q[3] * UNITS[3]).exp();
    Some(LagFit {
        lag,
        worst,
        interval_s: (shortest.max(0.0), longest),
        tau_scale,
        chi_square,
        least_filter_s: least_filter_s.map(|least_s| least_s.min(filter_s)),
        has_other_sum,
        windup: Windup::Open,
        loudness: as_rounding(),
    })
}

/// The fit of the least misfit.
fn best_of<'a, 'b, L: Law>(fits: &'b [(f64, Problem<'a, L>)]) -> Option<&'b (f64, Problem<'a, L>)> {
    fits.iter().min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The fits of rising and of falling flanks that tell of the lag in place of that of all, or beside it: the better one, where the model does not explain the other, since a load
/// that runs ahead through its backlash while the motor slows down is not the load that it drives; both, where they disagree and neither is the better; else none.
fn told_apart<'a, 'b, L: Law>(by_flank: &'b [(f64, Problem<'a, L>)]) -> Vec<&'b (f64, Problem<'a, L>)> {
    let [one, other] = by_flank else { return Vec::new() };
    let chi_square = |fit: &(f64, Problem<'a, L>)| fit.0 / fit.1.known.readings.max(1) as f64;
    let total_s = |fit: &(f64, Problem<'a, L>)| fit.1.known.parts(&fit.1.q).iter().sum::<f64>();
    let deviation = |fit: &(f64, Problem<'a, L>)| fit.1.deviation() * chi_square(fit).max(1.0).sqrt();
    let apart = (total_s(one) - total_s(other)).abs() / deviation(one).hypot(deviation(other));
    let (better, worse) = if chi_square(one) < chi_square(other) { (one, other) } else { (other, one) };
    let ratio = chi_square(worse) / chi_square(better);
    if ratio > FLANKS.much_worse || ratio > FLANKS.worse && apart > FLANKS.apart {
        vec![better]
    } else if apart > FLANKS.disagree {
        vec![one, other]
    } else {
        Vec::new()
    }
}

/// What the sum makes of an error in a tick, as a share of what P makes of it.
fn in_a_tick<L: Law>(law: &L, stretches: &[Stretch]) -> f64 {
    stretches.first().map_or(0.0, |stretch| {
        let velocity = stretch.gains.velocity;
        velocity.i * law.tick_s() / velocity.p.max(f64::MIN_POSITIVE)
    })
}

/// The law with the other sum, and what was polled with what its gains were under it; `None` where it makes no difference.
fn with_other_sum<L: Law>(stretches: &[Stretch], law: &L) -> Option<(L, Vec<Stretch>)> {
    let gains = stretches.first()?.gains;
    let (other, _) = law.with_other_sum(&gains).filter(|_| in_a_tick(law, stretches) > LAG.least_sum.0)?;
    let under_it =
        |stretch: &Stretch| Some(Stretch { gains: law.with_other_sum(&stretch.gains)?.1, ..stretch.clone() });
    Some((other, stretches.iter().map(under_it).collect::<Option<_>>()?))
}

/// What readings are.
#[derive(Clone, Copy, Debug)]
struct ReadingsAre {
    /// How old counts are.
    age: CountAge,
    /// Standard deviation of counts and of duties, as shares of what is taken for granted of them.
    trusted: [f64; 2],
}

/// What the fit goes by.
#[derive(Clone)]
struct Known<'a, L: Law> {
    stretches: &'a [Stretch],
    /// Noise of the duty of each.
    noises: Vec<f64>,
    plant: PlantModel,
    law: L,
    qpps: f64,
    sd_ln_tau: f64,
    readings: usize,
    /// The longest filter that the speed may have, s.
    longest_filter_s: f64,
    readings_are: ReadingsAre,
    /// The flanks that are judged.
    flanks: Flanks,
}

impl<'a, L: Law> Known<'a, L> {
    fn new(stretches: &'a [Stretch], plant: &PlantModel, law: &L, qpps: f64, sd_ln_tau: f64) -> Self {
        let (factor, least, most) = LAG_PRIORS.tau;
        Self {
            stretches,
            noises: stretches.iter().map(|stretch| duty_noise(plant, law, stretch, qpps)).collect(),
            plant: *plant,
            law: *law,
            qpps,
            sd_ln_tau: (factor * sd_ln_tau).clamp(least, most),
            readings: stretches.iter().flat_map(|stretch| readings(stretch, Flanks::All)).sum(),
            longest_filter_s: law.facts().filters_s.iter().copied().fold(0.0, f64::max),
            readings_are: ReadingsAre {
                age: stretches.first().map_or(CountAge::UpToATick, |one| one.record.age),
                trusted: [1.0; 2],
            },
            flanks: Flanks::All,
        }
    }

    /// The same by some flanks alone.
    fn of_flanks(&self, flanks: Flanks) -> Self {
        let readings = self.stretches.iter().flat_map(|stretch| readings(stretch, flanks)).sum();
        Self { readings, flanks, ..self.clone() }
    }

    /// The fits from each start, with their misfits.
    fn fits(&self) -> Vec<(f64, Problem<'_, L>)> {
        STARTS.iter().filter_map(|start| self.fit(*start)).collect()
    }

    /// The fit from a filter, s, and a delay, ticks, with its misfit.
    fn fit(&self, (filter_s, delay_ticks): (f64, f64)) -> Option<(f64, Problem<'_, L>)> {
        self.fit_from(self.inside(filter_s, delay_ticks * self.law.tick_s()))
    }

    /// The same from parameters.
    fn fit_from(&self, start: Vector6<f64>) -> Option<(f64, Problem<'_, L>)> {
        let search = LevenbergMarquardt::new().with_patience(4).with_ftol(LAG.enough).with_xtol(LAG.enough);
        let (problem, report) = search.minimize(Problem::at(self, start));
        report.objective_function.is_finite().then_some((2.0 * report.objective_function, problem))
    }

    /// The shortest filter whose misfit is at most `likely`, s, among shares of the one of these parameters.
    fn least_filter_s(&self, q: &Vector6<f64>, likely: f64) -> f64 {
        let [filter_s, delay_s, _] = self.parts(q);
        let is_likely = |share: &f64| {
            let shorter = Self { longest_filter_s: share * filter_s, ..self.clone() };
            // What the filter no longer makes of the lag is a delay.
            let mut start = *q;
            start[0] = share * filter_s / UNITS[0];
            start[1] = (delay_s + (1.0 - share) * filter_s).min(self.longest()[1]) / UNITS[1];
            shorter.fit_from(start).is_some_and(|other| other.0 <= likely)
        };
        LAG.filter_shares.into_iter().find(is_likely).unwrap_or(1.0) * filter_s
    }

    /// The same by readings of which something else is known.
    fn with(&self, readings_are: ReadingsAre) -> Self {
        Self { readings_are, ..self.clone() }
    }

    /// The fits from the parameters of others.
    fn fits_from(&self, others: &[(f64, Problem<'_, L>)]) -> Vec<(f64, Problem<'_, L>)> {
        others.iter().filter_map(|other| self.fit_from(other.1.q)).collect()
    }

    /// What the readings turn out to be where the model has these parameters. Counts are trusted more where their times are known better than is taken for granted, and duties where
    /// live counts leave no doubt of their times.
    fn readings_are(&self, q: &Vector6<f64>) -> ReadingsAre {
        let [of_counts, of_duties] = self.about(q);
        let spread_s = CountAge::spread_s(self.law.tick_s());
        let is_sharp = of_counts * RECORD.stamp_s.hypot(spread_s) < LAG.live * spread_s;
        let times_s =
            self.stretches.iter().flat_map(|stretch| stretch.record.counts.iter().map(|count| count.0));
        let is_live = self.readings_are.age == CountAge::UpToATick
            && is_sharp
            && !are_in_step(times_s, self.law.tick_s());
        let age = if is_live { CountAge::Live } else { self.readings_are.age };
        let trusted = |share: f64| if share < LAG.sharp { share.max(LAG.least_share) } else { 1.0 };
        let of_duties = if is_live { trusted(of_duties) } else { 1.0 };
        ReadingsAre { age, trusted: [trusted(of_counts), of_duties] }
    }

    /// Standard deviation of counts and of duties about the model of these parameters, as shares of what is taken for granted of them.
    fn about(&self, q: &Vector6<f64>) -> [f64; 2] {
        let residuals = self.residuals(q);
        let (mut from, mut squares, mut seen) = (0, [0.0; 2], [0_usize; 2]);
        for stretch in self.stretches {
            for (n, of) in readings(stretch, self.flanks).into_iter().enumerate() {
                squares[n] += residuals.iter().skip(from).take(of).map(|rest| rest * rest).sum::<f64>();
                seen[n] += of;
                from += of;
            }
            // One residual of each stretch is that of the duty's noise.
            from += 1;
        }
        [0, 1].map(|n| (squares[n] / seen[n].max(1) as f64).sqrt())
    }

    /// The loudest duty.
    fn loudest(&self) -> f64 {
        self.noises.iter().copied().fold(0.0, f64::max)
    }

    /// The longest filter and delay that the law may have, s.
    fn longest(&self) -> [f64; 2] {
        let longest_delay = self.law.facts().delays_ticks.iter().copied().fold(0.0, f64::max);
        [self.longest_filter_s, longest_delay * self.law.tick_s()]
    }

    /// Start values within the bounds.
    fn inside(&self, filter_s: f64, delay_s: f64) -> Vector6<f64> {
        let [longest_filter, longest_delay] = self.longest();
        let times = [filter_s.min(longest_filter), delay_s.min(longest_delay), LAG_PRIORS.winding_s.0];
        Vector6::from_fn(|n, _| times.get(n).map_or(0.0, |time_s| time_s / UNITS[n]))
    }

    /// Filter, delay and winding that parameters stand for, s.
    fn parts(&self, q: &Vector6<f64>) -> [f64; 3] {
        let [longest_filter, longest_delay] = self.longest();
        let most = [longest_filter, longest_delay, f64::INFINITY];
        std::array::from_fn(|n| (q[n] * UNITS[n]).clamp(0.0, most[n]))
    }

    fn residuals(&self, q: &Vector6<f64>) -> DVector<f64> {
        let [filter_s, delay_s, winding_s] = self.parts(q);
        let tick_s = self.law.tick_s();
        let lag = Lag { filter_s, delay_ticks: delay_s / tick_s };
        let model = PlantModel {
            tau_s: self.plant.tau_s * (q[3] * UNITS[3]).clamp(-2.0, 2.0).exp(),
            gain_counts_per_s: self.plant.gain_counts_per_s * (q[5] * UNITS[5]).clamp(-0.5, 0.5).exp(),
            ..self.plant
        };
        let offset_s = q[4] * UNITS[4];
        let mut all = Vec::with_capacity(self.readings + 12);
        for (stretch, noise) in self.stretches.iter().zip(&self.noises) {
            let mut twin = TickLoop::new(model, self.law, lag, stretch.gains, self.qpps).smooth();
            twin.winding_s = winding_s;
            if let Some(speed) = stretch.before {
                twin.start_steady(speed);
            }
            let from = all.len();
            misfits(
                stretch,
                (self.flanks, self.readings_are.age),
                twin,
                &self.law,
                offset_s,
                *noise,
                &mut all,
            );
            let [counts, _] = readings(stretch, self.flanks);
            let [of_counts, of_duties] = self.readings_are.trusted;
            all.iter_mut().skip(from).take(counts).for_each(|rest| *rest /= of_counts);
            all.iter_mut().skip(from + counts).for_each(|rest| *rest /= of_duties);
            let whole = Lag { delay_ticks: (delay_s + winding_s) / tick_s, ..lag };
            let predicted = LoopPlant::new(DiscretePlant::of(&model, tick_s), &self.law, whole)
                .margins(&stretch.gains, self.qpps)
                .noise_duty;
            all.push(soft((noise / predicted.hypot(RECORD.duty)).ln() / LAG_PRIORS.rounding));
        }
        all.push(q[3] * UNITS[3] / self.sd_ln_tau);
        all.push(offset_s / LAG_PRIORS.offset_s);
        all.push(q[5] * UNITS[5] / LAG_PRIORS.gain);
        all.push((winding_s - LAG_PRIORS.winding_s.0) / LAG_PRIORS.winding_s.1);
        all.push((filter_s + delay_s - LAG_PRIORS.long_s.0).max(0.0) / LAG_PRIORS.long_s.1);
        for (n, part) in [filter_s, delay_s, winding_s].into_iter().enumerate() {
            all.push((q[n] - part / UNITS[n]) / LAG.bound);
        }
        DVector::from_vec(all)
    }
}

struct Problem<'a, L: Law> {
    known: &'a Known<'a, L>,
    q: Vector6<f64>,
    /// The residuals there.
    here: DVector<f64>,
}

impl<'a, L: Law> Problem<'a, L> {
    fn at(known: &'a Known<'a, L>, q: Vector6<f64>) -> Self {
        Self { known, q, here: known.residuals(&q) }
    }

    fn slopes(&self) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..UNITS.len())
            .map(|n| {
                let mut up = self.q;
                up[n] += LAG.slope_step;
                (self.known.residuals(&up) - &self.here) / LAG.slope_step
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Standard deviation of the whole lag, s. A part that stands at its bound is held there by the others' uncertainty, not by its own.
    fn deviation(&self) -> f64 {
        let slopes = self.slopes();
        let information = slopes.tr_mul(&slopes) + DMatrix::identity(UNITS.len(), UNITS.len()) * 1e-9;
        let Some(covariance) = information.try_inverse() else { return f64::INFINITY };
        let parts = DVector::from_fn(UNITS.len(), |n, _| if n < 3 { UNITS[n] } else { 0.0 });
        (parts.transpose() * covariance * &parts)[0].max(0.0).sqrt()
    }
}

impl<L: Law> LeastSquaresProblem<f64, Dyn, U6> for Problem<'_, L> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, U6>;
    type ParameterStorage = Owned<f64, U6>;

    fn set_params(&mut self, q: &Vector6<f64>) {
        *self = Self::at(self.known, *q);
    }

    fn params(&self) -> Vector6<f64> {
        self.q
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.here.clone())
    }

    fn jacobian(&self) -> Option<nalgebra::OMatrix<f64, Dyn, U6>> {
        let slopes = self.slopes();
        Some(nalgebra::OMatrix::<f64, Dyn, U6>::from_fn(slopes.nrows(), |r, c| slopes[(r, c)]))
    }
}

/// Noise of the duty of a stretch. At a speed of whole counts in a tick, or nearly so, the count of each tick is the same, so that such a plateau is quiet and does not tell what rounding
/// does while the speed changes.
fn duty_noise<L: Law>(plant: &PlantModel, law: &L, stretch: &Stretch, qpps: f64) -> f64 {
    let tick_s = law.tick_s();
    let rounding = |lag: Lag| {
        LoopPlant::new(DiscretePlant::of(plant, tick_s), law, lag).margins(&stretch.gains, qpps).noise_duty
    };
    let heard = noise(&stretch.record);
    let of_setpoints = noise_of_setpoints(&stretch.record);
    let between_plateaus = if goes_by_whole_counts(law) {
        rounding(law.facts().usual_lag)
    } else if heard < LAG.quiet * of_setpoints {
        // What is louder than rounding can be is a shaft that rings.
        of_setpoints.min(rounding(Lag::default()))
    } else {
        0.0
    };
    heard.hypot(RECORD.duty).max(between_plateaus)
}

/// Whether each speed that can be commanded is a whole number of counts in a tick.
pub(crate) fn goes_by_whole_counts<L: Law>(law: &L) -> bool {
    law.facts().speed_step * law.tick_s() > 0.99
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_loop_record::ClosedLoopRecord;
    use crate::model::{Gains, Pid};
    use crate::plain_law::PlainLaw;
    use crate::setpoint::Setpoint;

    const PLANT: PlantModel = PlantModel {
        gain_counts_per_s: 40_000.0,
        tau_s: 0.12,
        coulomb_duty: 0.05,
        load_duty: 0.0,
        drive_limit: None,
        brake_limit: None,
        sag: 0.0,
    };
    const GAINS: Gains = Gains {
        velocity: Pid { p: 3.0, i: 20.0, d: 0.0 },
        velocity_sum: 0.0,
        position: None,
        max_integral: 0.0,
        deadzone_counts: 0.0,
    };

    /// Steps of a loop with a known lag, polled every 12.3 ms.
    fn known_record(lag: Lag) -> Stretch {
        dated(record_with(lag, 1.0, |_| 0.5))
    }

    /// The same with counts that are all half a tick old.
    fn dated(mut stretch: Stretch) -> Stretch {
        stretch.record.age = CountAge::Dated;
        stretch
    }

    /// The ages of counts of the last tick, in ticks. The fractional parts of multiples of the golden ratio fill a tick evenly.
    const OF_LAST_TICK: fn(usize) -> f64 = |n| (0.618 * n as f64).fract();

    /// The same with an encoder of as many times the counts, and with counts of a given age, ticks, in each poll.
    fn record_with(lag: Lag, finer: f64, age_ticks: fn(usize) -> f64) -> Stretch {
        let plant = PlantModel { gain_counts_per_s: finer * PLANT.gain_counts_per_s, ..PLANT };
        record_of(&plant, lag, age_ticks, CountAge::UpToATick)
    }

    /// The same of a motor, whose gains are as many times less as its time constant is shorter.
    fn record_of(plant: &PlantModel, lag: Lag, age_ticks: fn(usize) -> f64, age: CountAge) -> Stretch {
        let law = PlainLaw::default();
        let full_speed = plant.gain_counts_per_s;
        let p = GAINS.velocity.p * plant.tau_s / PLANT.tau_s;
        let gains = Gains { velocity: Pid { p, ..GAINS.velocity }, ..GAINS };
        let mut twin = TickLoop::new(*plant, law, lag, gains, full_speed);
        let mut record = ClosedLoopRecord::default();
        for n in 0..5 {
            let speed = full_speed * if n % 2 == 0 { 0.375 } else { 0.5 };
            record.setpoints.push((0.02 + 0.35 * f64::from(n), speed));
        }
        let mut poll = 0.0;
        for tick in 0..540_usize {
            let t = tick as f64 * law.tick_s();
            let goal = record.setpoints.iter().rev().find(|s| s.0 <= t).map(|s| s.1);
            let position = twin.motion.position;
            if let Some(goal) = goal {
                twin.tick(Setpoint::Speed(goal), 0.0);
            }
            if t >= poll {
                // A duty is half a tick old.
                let moved = if age == CountAge::Live { twin.motion.position - position } else { 0.0 };
                let count = (position + age_ticks(tick) * moved).floor();
                record.counts.push((t + age_ticks(tick) * law.tick_s(), count));
                record.duties.push((t + 0.5 * law.tick_s(), twin.duty));
                poll += 0.0123;
            }
        }
        Stretch { record, gains, before: None }
    }

    /// The fit of a record of [`PLANT`].
    fn fitted(stretch: Stretch) -> LagFit {
        let asked = Asked { filter: true, law: true, integral: false };
        fit_lag(&[stretch], &PLANT, &PlainLaw::default(), 40_000.0, 0.03, asked).expect("enough readings")
    }

    #[test]
    fn a_known_lag_is_found_again_and_lies_in_its_interval() {
        let law = PlainLaw::default();
        for lag in [
            Lag::default(),
            Lag { filter_s: 0.004, delay_ticks: 1.0 },
            Lag { filter_s: 0.010, delay_ticks: 0.0 },
            Lag { filter_s: 0.010, delay_ticks: 1.0 },
        ] {
            let found = fitted(known_record(lag));
            let (got, wanted) = (found.lag.total_s(law.tick_s()), lag.total_s(law.tick_s()));
            assert!((got - wanted).abs() < 0.0025, "{got} s instead of {wanted} s: {found:?}");
            assert!(found.chi_square < 1.5, "{found:?}");
        }
    }

    #[test]
    fn counts_whose_times_are_known_are_told_from_counts_of_the_last_tick() {
        let law = PlainLaw::default();
        let lag = Lag { filter_s: 0.004, delay_ticks: 0.0 };
        let of_last_tick = record_with(lag, 1.0, OF_LAST_TICK);
        let timed = dated(record_with(lag, 1.0, |n| 0.5 + 0.05 * (0.618 * n as f64).fract()));
        let about = |stretch: &Stretch| {
            let known = Known::new(std::slice::from_ref(stretch), &PLANT, &law, 40_000.0, 0.03);
            let (_, problem) = known.fit(STARTS[1]).expect("a fit");
            known.about(&problem.q)[0]
        };
        let (sharp, ticked) = (about(&timed), about(&of_last_tick));
        assert!(sharp < 0.5 * LAG.sharp && ticked > LAG.sharp, "{sharp} and {ticked}");
        for stretch in [timed, of_last_tick] {
            let found = fitted(stretch);
            let (low_s, high_s) = found.interval_s;
            assert!((low_s..=high_s).contains(&lag.total_s(law.tick_s())), "{found:?}");
        }
    }

    /// Counts that were read live, taken to be half a tick old, move the lag by that much: what a coreless motor of 7 ms has is half of its lag then.
    #[test]
    fn live_counts_are_not_taken_to_be_half_a_tick_old() {
        let law = PlainLaw::default();
        let lag = Lag { filter_s: 0.0, delay_ticks: 0.2 };
        let plant = PlantModel { gain_counts_per_s: 160_000.0, tau_s: 0.007, ..PLANT };
        let found = |stretch: &Stretch| {
            // The open loop knows such a time constant to a seventh.
            let known = Known::new(std::slice::from_ref(stretch), &plant, &law, 160_000.0, 0.14);
            let (_, by_old) = known.fit(STARTS[0]).expect("a fit");
            let readings_are = known.readings_are(&by_old.q);
            let asked = Asked::default();
            let found = fit_lag(std::slice::from_ref(stretch), &plant, &law, 160_000.0, 0.14, asked);
            let off_s = found.expect("enough readings").lag.total_s(law.tick_s()) - lag.total_s(law.tick_s());
            let as_old_s = known.parts(&by_old.q).iter().sum::<f64>() - lag.total_s(law.tick_s());
            (readings_are, off_s, as_old_s)
        };
        let (readings_are, off_s, as_old_s) = found(&record_of(&plant, lag, OF_LAST_TICK, CountAge::Live));
        assert!(readings_are.age == CountAge::Live && readings_are.trusted[1] < 1.0, "{readings_are:?}");
        assert!(off_s.abs() < 0.0002, "{off_s} s");
        assert!(as_old_s.abs() > 2.0 * off_s.abs(), "{as_old_s} s: the case shows nothing");
        // Polls in step with the ticks tell nothing.
        let in_step = record_of(&plant, lag, |_| 0.0, CountAge::Live);
        for stretch in [record_of(&plant, lag, OF_LAST_TICK, CountAge::UpToATick), in_step] {
            let (readings_are, ..) = found(&stretch);
            let is_open = readings_are.age == CountAge::UpToATick && readings_are.trusted[1] == 1.0;
            assert!(is_open, "{readings_are:?}");
        }
    }

    #[test]
    fn a_lag_without_a_filter_is_not_put_down_to_one_and_a_long_filter_is_seen() {
        for (lag, least_s) in [
            (Lag { filter_s: 0.0, delay_ticks: 0.5 }, 0.0..=0.0),
            (Lag { filter_s: 0.0, delay_ticks: 1.0 }, 0.0..=0.0),
            (Lag { filter_s: 0.010, delay_ticks: 0.0 }, 0.004..=0.010),
        ] {
            let found = fitted(known_record(lag));
            assert!(found.least_filter_s.is_some_and(|found| least_s.contains(&found)), "{lag:?}: {found:?}");
        }
    }

    #[test]
    fn a_load_that_runs_ahead_while_the_motor_slows_down_does_not_lengthen_the_lag() {
        let lag = Lag { filter_s: 0.004, delay_ticks: 0.0 };
        let law = PlainLaw::default();
        let rigid = known_record(lag);
        // An encoder behind backlash shows a slower speed some milliseconds late, and so does the duty that answers to it.
        let seen_late =
            |(t, value): (f64, f64)| (if Flanks::Falling.hold(&rigid, t) { t + 0.006 } else { t }, value);
        let late = |readings: &[(f64, f64)]| readings.iter().copied().map(seen_late).collect();
        let record = ClosedLoopRecord {
            counts: late(&rigid.record.counts),
            duties: late(&rigid.record.duties),
            ..rigid.record.clone()
        };
        let behind_backlash = Stretch { record, ..rigid.clone() };
        for stretch in [rigid, behind_backlash] {
            let found = fitted(stretch);
            let (low_s, high_s) = found.interval_s;
            assert!((low_s..=high_s).contains(&lag.total_s(law.tick_s())), "{found:?}");
            let off_s = found.lag.total_s(law.tick_s()) - lag.total_s(law.tick_s());
            assert!(off_s.abs() < 0.001, "{off_s} s: {found:?}");
        }
    }

    /// Polls see the same duty all the time at one of two setpoints, as they do at one of nearly whole counts in a tick.
    #[test]
    fn a_setpoint_of_whole_counts_in_a_tick_does_not_pass_for_a_quiet_loop() {
        let law = PlainLaw::default();
        let mut stretch = record_with(Lag { filter_s: 0.001, delay_ticks: 0.0 }, 0.1, |_| 0.5);
        for start in [0, 2, 4].map(|n| stretch.record.setpoints[n].0) {
            let is_late = |t: f64| t > start + 0.17 && t < start + 0.35;
            let late = || stretch.record.duties.iter().filter(|duty| is_late(duty.0));
            let mean = late().map(|duty| duty.1).sum::<f64>() / late().count() as f64;
            stretch.record.duties.iter_mut().filter(|duty| is_late(duty.0)).for_each(|duty| duty.1 = mean);
        }
        let heard = [noise(&stretch.record), noise_of_setpoints(&stretch.record)];
        assert!(heard[0] < LAG.quiet * heard[1] && heard[1] > 0.04, "{heard:?}");
        let plant = PlantModel { gain_counts_per_s: 4_000.0, ..PLANT };
        let found =
            fit_lag(&[stretch], &plant, &law, 4_000.0, 0.03, Asked::default()).expect("enough readings");
        assert!(found.chi_square < 1.5, "{found:?}");
    }

    #[test]
    fn a_record_without_steps_says_nothing() {
        assert!(fit_lag(&[], &PLANT, &PlainLaw::default(), 40_000.0, 0.1, Asked::default()).is_none());
    }
}

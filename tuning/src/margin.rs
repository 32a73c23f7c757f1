//! How far the gain of a loop can be raised on the machine before the loop gets rough: its gain margin, asked of the machine itself. A springy shaft oscillates faster
//! than polls can see and no model knows of it; the duty that is read back shows it anyhow.

use crate::cause::Cause;
use crate::design::Task;
use crate::experiment::rest;
use crate::experiment_guard::ExperimentGuard;
use crate::lag::goes_by_whole_counts;
use crate::law::{Facts, Law};
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, Pid};
use crate::oscillation::deviation;
use crate::request::Excitation;
use crate::setpoint::Setpoint;
use crate::thresholds::thresholds;
use crate::ticks::TickLoop;

thresholds! {
    /// The trials of raised gains: by how much, at which speeds, how long, and what counts as heard.
    pub(crate) MARGIN: Thresholds {
        /// The multiple that is wanted of a derivative alone: the proportional part takes phase where a shaft oscillates, and is not raised with it. With multiples up to
        /// 2, six of 800 runs are left above an Ms of 1.8 without a warning, with multiples up to 2.5 three (MEASURED.md).
        derivative_factor: f64 = 3.0,
        /// What is left of the proportional part beside it, as a share, where it cannot be given a target far away.
        /// With all of it 5 of 800 PD and PID loops of Motion Minds were left above an Ms of 2, with 0.3 and less none; with none one of them passed for an encoder that
        /// counts the wrong way.
        proportional_share: f64 = 0.3,
        /// Gains tried, as multiples of the proposed ones, up to the margin that is wanted.
        factors: [f64; 7] = [1.2, 1.4, 1.6, 1.8, 2.0, 2.5, derivative_factor],
        /// The same where each of them takes a stop, since registers are written at rest only.
        factors_at_rest: [f64; 3] = [1.4, 2.0, derivative_factor],
        /// The highest multiple that is wanted of a velocity loop that was not heard to oscillate.
        most_wanted: f64 = 2.0,
        /// Shares of the gains tried where they oscillate as they are.
        shares: [f64; 4] = [0.7, 0.5, 0.35, 0.25],
        /// A roughness that falls no lower than this, as a multiple of the share that is left of the gains, is noise and no oscillation: rms figures of some fourteen
        /// polls spread by a fifth.
        noise_share: f64 = 0.8,
        /// Maximum sensitivity (Ms) below which a model counts as calm.
        calm_ms: f64 = 2.8,
        /// The most that is asked of a loop that oscillates, as a multiple of its gains.
        most_factor: f64 = 2.5,
        /// The sensitivity that may really be, as a multiple of the one that was designed for: what lies beyond it is what the trial is to find.
        ms_allowed: f64 = 1.25,
        /// Speed of the trial, as a share of full speed.
        speed: f64 = 0.30,
        /// Least and greatest distance of the speeds before and after a step from that of the trial, as shares of full speed.
        step: (f64, f64) = (0.02, 0.08),
        /// Least speed of a loop that starts from rest each time, as a share of full speed.
        least_from_rest: f64 = 0.06,
        /// Duty that is left at the least to accelerate with, as a share of full.
        least_accelerating: f64 = 0.05,
        /// Duty that half of a step asks for at once at the highest gain tried, as a share of full: as much as leaves the backlash of a gear, where a shaft does not
        /// oscillate.
        step_duty: f64 = 0.3,
        /// How long a gain is tried, in lags of the loop.
        lags: f64 = 14.0,
        /// Shortest and longest time that a gain is tried by its lags, in seconds.
        tried_s: (f64, f64) = (0.22, 0.40),
        /// The last share of that time, which is listened to.
        heard: f64 = 0.65,
        /// Fewest polls in the part that is listened to.
        least_polls: f64 = 14.0,
        /// The duty is too rough when its noise is so many times what was to be expected.
        too_rough: f64 = 2.0,
        /// The duty is not too rough while its noise is below this, as a share of full duty.
        least_rough: f64 = 0.012,
        /// Multiples of the gains up to which the duty tells how loud it is beside what was predicted.
        first_factors: f64 = 1.5,
        /// By how much more than that it may be louder at the last multiples: what is more is listened to for longer. A loop that is unstable there, and that backlash
        /// holds to a few counts, is hardly louder than rounding: three loops of 960 (480 motors of five seeds) with a true Ms of 2 to 2.5 were at 1.3 to 1.5 times.
        growth: f64 = 1.2,
        /// How loud the duty of a derivative may be without any oscillation, as a multiple of what was predicted, which is the mean over all speeds: at half a count beyond whole counts in a tick
        /// its rounding has a variance of 1/4 of a count squared, where the mean is 1/6.
        of_half_counts: f64 = 1.225,
        /// For how many stays: their mean spreads by an eighth, where one spreads by a fifth.
        longer: u32 = 3,
        /// What may be left of a step, as a multiple of what the model leaves: it dies out as quickly to within a tenth or two.
        ringing: f64 = 1.3,
        /// Share of a travel that a stroke covers.
        inside_share: f64 = 0.35,
        /// The multiple that a loop whose gains are tried at rest is to stand when they are lowered. They go up in steps of 1.4, so that what is rough at one of them may be
        /// quiet just below it, and each stroke crosses the backlash, which a loop that holds a position or a speed seldom does. MEASURED.md, "Motion Mind 3", has what other
        /// values give.
        kept_at_rest: f64 = 1.6,
        /// How far away the target of a loop on the position is then, as a share of the travel.
        inside_far: f64 = 0.45,
        /// Counts in a tick from which on a derivative alone gives a duty: with fewer it gives pulses, and polls see some of them.
        least_of_derivative: f64 = 2.0,
        /// The travel in which a loop on the position goes to and fro where the motor turns freely: the way of so many seconds at full speed. At a steady speed a load
        /// without friction floats in its backlash: of 800 PD and PID runs on free axes (200 plants each of seeds 7 and 11) eight were tuned without a warning at a true
        /// Ms of 1.98 to 2.85, springy shafts whose oscillation a step between two speeds does not wake; by strokes it is three of two shafts, at 2.06 to 2.4.
        free_travel_s: f64 = 4.0,
        /// Highest maximum sensitivity (Ms) of gains that are given without a warning (Astrom and Murray, "Feedback Systems", 2nd edition, section 10.3: 1.2 to 2 are
        /// reasonable).
        most_ms: f64 = 1.8,
        /// Multiple of the bound beyond which the noise of a duty needs no second look.
        at_once: f64 = 4.0,
        /// Shares of the speed of a trial between which a motor turns as it was told to between two polls: neither jammed nor running away, and its encoder not lost.
        turning: (f64, f64) = (0.5, 1.6),
        /// How many times in a row it does so.
        turning_polls: usize = 5,
        /// Counts in a tick from which on a speed is laid between two whole numbers of them.
        least_per_tick: f64 = 6.0,
        /// Predicted noise of the duty, as a share of full, above which nothing can be heard beside it.
        loudest: f64 = 0.40,
    }
}

/// What a trial of raised gains found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Headroom {
    /// The highest multiple of the gains at which the duty was as quiet as predicted.
    pub(crate) quiet: f64,
    /// The multiple that was wanted, or the highest at which anything can be heard beside the rounding of a coarse encoder.
    pub(crate) wanted: f64,
    /// Nothing could be heard at some of the gains, or an oscillation once and not again: what is called quiet may be rough.
    pub(crate) is_doubtful: bool,
}

impl Headroom {
    /// The multiple that the gains are to stand when they are lowered for not standing the one that was wanted.
    pub(crate) fn kept(&self, facts: &Facts) -> f64 {
        if facts.writes_at_rest { self.wanted.min(MARGIN.kept_at_rest) } else { self.wanted }
    }
}

/// Whether gains may be too sensitive for all that was measured: with the longest lag that is still likely, or as long as the law may have it where
/// raising the gains on the machine told nothing.
pub(crate) fn may_be_short<L: Law>(task: &Task<L>, gains: &Gains, is_doubtful: bool) -> bool {
    let tick_s = task.law.tick_s();
    let longest = task.law.facts().longest_lag;
    let is_longer = longest.total_s(tick_s) > task.worst_lag.total_s(tick_s);
    let lag = if is_doubtful && is_longer { longest } else { task.worst_lag };
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, tick_s), &task.law, lag);
    plant.spectral_radius(gains, task.qpps) >= 1.0 || plant.margins(gains, task.qpps).ms > MARGIN.most_ms
}

/// The multiple of its gain up to which a loop with the sensitivity that is allowed stays stable.
fn wanted_factor(ms: f64) -> f64 {
    let allowed = MARGIN.ms_allowed * ms;
    (allowed / (allowed - 1.0)).min(MARGIN.most_wanted)
}

/// The multiple that a loop with the sensitivity that was designed for has, for one that was seen to oscillate below the other.
fn full_factor(ms: f64) -> f64 {
    (ms / (ms - 1.0)).min(MARGIN.most_factor)
}

/// The velocity loop of gains. A loop on the position that acts on the duty directly is one too: its derivative is a gain of the speed and
/// its gain an integral, but for the filter on the speed, which only a velocity loop has.
fn velocity_loop_of(gains: &Gains) -> Gains {
    let position = gains.position.unwrap_or_default();
    let is_direct = gains.velocity == Pid::default();
    let velocity = if is_direct { Pid { p: position.d, i: position.p, d: 0.0 } } else { gains.velocity };
    Gains { velocity, ..Gains::default() }
}

/// The velocity gains times a factor.
pub(crate) fn scaled(gains: &Gains, factor: f64) -> Gains {
    let v = gains.velocity;
    Gains { velocity: Pid { p: factor * v.p, i: factor * v.i, d: factor * v.d }, ..*gains }
}

/// What is raised of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// All of a velocity loop.
    Whole,
    /// Of a loop that acts on the duty directly its derivative alone, under a proportional part to a target so far away that it is a duty.
    DerivativeByPositions,
    /// The same by speeds, where speed commands act through the same gains.
    DerivativeBySpeeds,
}

/// A loop whose gains are raised: how it is written, and how the motor is kept turning under it.
struct Raised<'t, L: Law> {
    task: &'t Task<L>,
    /// The gains that are raised.
    inner: Gains,
    /// Which of them.
    part: Part,
    /// Setpoints of the steps, counts/s.
    speeds: (f64, f64),
    /// It goes to and fro about this count: in a travel, and wherever the position is the loop.
    about: Option<f64>,
    /// How far away the target is, counts.
    far: f64,
    side: f64,
    /// How long each stay is, s, but for the time that the motor takes to turn about.
    tried_s: f64,
    /// How long that is at the start of each stroke of an axis that turns freely, s, as far as the part that is not listened to does not cover it, and all of it where the loop did
    /// what its model does not explain: while such a shaft is turned about it swings, whatever its gains are.
    turning_s: f64,
}

impl<'t, L: Law> Raised<'t, L> {
    fn new(
        guard: &mut ExperimentGuard<'_, L>,
        task: &'t Task<L>,
        gains: &Gains,
        (excitation, is_odd): (Excitation, bool),
        tried_s: f64,
        plant: &LoopPlant,
    ) -> Result<Self, Cause> {
        let is_free = excitation == Excitation::Free;
        let is_fine = MARGIN.speed * task.qpps * task.law.tick_s() > MARGIN.least_of_derivative;
        let at_rest = guard.facts.writes_at_rest;
        let part = match gains.velocity == Pid::default() {
            true if at_rest => Part::DerivativeBySpeeds,
            true if is_fine && (!is_free || has_room(guard, task)) => Part::DerivativeByPositions,
            _ => Part::Whole,
        };
        let goes_to_and_fro = at_rest || is_odd || part == Part::DerivativeByPositions;
        if !is_free || goes_to_and_fro {
            guard.duty(0.0)?;
            rest(guard, task.plant.tau_s, task.qpps)?;
        }
        let tick_s = task.law.tick_s();
        let travel = match excitation {
            Excitation::Window(width) => Some(guard.room_counts().unwrap_or(width).min(width)),
            Excitation::Free => goes_to_and_fro.then_some(MARGIN.free_travel_s * task.qpps),
        };
        let inner = if part == Part::DerivativeByPositions { *gains } else { velocity_loop_of(gains) };
        let middle = between_counts(MARGIN.speed * task.qpps, tick_s);
        let steps = Self {
            task,
            inner,
            part,
            speeds: (middle, middle),
            about: None,
            far: 0.0,
            side: -1.0,
            tried_s,
            turning_s: 0.0,
        };
        if let Some(room) = travel {
            let most = if at_rest { fastest_from_rest(tried_s, task) } else { MARGIN.speed * task.qpps };
            let speed = between_counts((MARGIN.inside_share * room / tried_s).min(most), tick_s);
            let tried_s =
                if at_rest { tried_s.max(turning_s(speed, task) / (1.0 - MARGIN.heard)) } else { tried_s };
            let turning_s = if is_free && !at_rest { turning_s(speed, task) } else { 0.0 };
            // What is not listened to at the start of a stroke is mostly enough to turn about in.
            let turning_s =
                if is_odd { turning_s } else { (turning_s - (1.0 - MARGIN.heard) * tried_s).max(0.0) };
            let about = guard.points.last().map(|point| point.counts);
            return Ok(Self {
                speeds: (-speed, speed),
                about,
                far: MARGIN.inside_far * room,
                tried_s,
                turning_s,
                ..steps
            });
        }
        let wanted = steps.wanted(plant);
        let gain = inner.velocity.p.max(inner.position.map_or(0.0, |position| position.d));
        let step = (MARGIN.step_duty / (wanted * gain).max(1e-6)).clamp(MARGIN.step.0, MARGIN.step.1);
        let speed = |side: f64| between_counts((MARGIN.speed + side * step) * task.qpps, tick_s);
        Ok(Self { speeds: (speed(-1.0), speed(1.0)), ..steps })
    }

    /// The multiple that is wanted, as far as the model itself stays calm under it.
    fn wanted(&self, plant: &LoopPlant) -> f64 {
        let wanted = if self.part != Part::Whole {
            MARGIN.derivative_factor
        } else {
            wanted_factor(self.task.goal.ms)
        };
        wanted.min(self.highest_calm(plant))
    }

    /// The highest multiple that the model itself stays calm under.
    fn highest_calm(&self, plant: &LoopPlant) -> f64 {
        let is_calm = |factor: &f64| {
            let gains = self.gains(*factor);
            plant.spectral_radius(&gains, self.task.qpps) < 1.0
                && plant.margins(&gains, self.task.qpps).ms < MARGIN.calm_ms
        };
        MARGIN.factors.into_iter().take_while(is_calm).fold(1.0, f64::max)
    }

    /// The multiples that are tried.
    fn factors(&self) -> &'static [f64] {
        if self.task.law.facts().writes_at_rest { &MARGIN.factors_at_rest } else { &MARGIN.factors }
    }

    /// The gains of a multiple.
    fn gains(&self, factor: f64) -> Gains {
        if self.part == Part::DerivativeBySpeeds {
            let inner = self.inner.velocity;
            let velocity = Pid { p: factor * inner.p, i: MARGIN.proportional_share * inner.i, ..inner };
            return Gains { velocity, ..self.inner };
        }
        let Some(position) = self.inner.position.filter(|_| self.part == Part::DerivativeByPositions) else {
            return scaled(&self.inner, factor);
        };
        let d = factor * position.d;
        let plant = &self.task.plant;
        let speed = self.speeds.1;
        // To and fro a load helps as often as it does not.
        let pull = (speed / plant.gain_counts_per_s + plant.coulomb_duty) * self.task.qpps + d * speed;
        Gains { position: Some(Pid { p: pull / self.far, i: 0.0, d }), ..Gains::default() }
    }

    fn write(&self, guard: &mut ExperimentGuard<'_, L>, factor: f64) -> Result<(), Cause> {
        let gains = self.gains(factor);
        if guard.facts.writes_at_rest {
            guard.duty(0.0)?;
            rest(guard, self.task.plant.tau_s, self.task.qpps)?;
        }
        if self.part != Part::DerivativeByPositions {
            return guard.write_gains(&self.task.law, &gains, self.task.qpps).map(|_| ());
        }
        let travel = guard.proposed_travel(self.task.qpps);
        let registers = self.task.law.registers(&guard.setup.held, &gains, self.task.qpps, travel);
        guard.write_all(&registers, true)
    }

    /// Has the motor turn at the speed of a side.
    fn go(&self, guard: &mut ExperimentGuard<'_, L>) -> Result<(), Cause> {
        if let Some(about) = self.about.filter(|_| self.part == Part::DerivativeByPositions) {
            return guard.position(about + self.side * self.far, self.task.qpps as u32);
        }
        guard.speed(self.told())
    }

    /// The speed that the motor was given, counts/s.
    fn told(&self) -> f64 {
        if self.side > 0.0 { self.speeds.1 } else { self.speeds.0 }
    }

    /// Whether the motor turns about as it was told to.
    fn turns(&self, guard: &ExperimentGuard<'_, L>) -> bool {
        let (low, high) = MARGIN.turning;
        let told = self.told();
        let latest = &guard.points[guard.points.len().saturating_sub(MARGIN.turning_polls + 1)..];
        let mut shares = latest
            .windows(2)
            .map(|pair| (pair[1].counts - pair[0].counts) / (pair[1].t - pair[0].t).max(1e-6) / told);
        latest.len() > MARGIN.turning_polls && shares.all(|share| share > low && share < high)
    }

    /// How long after its start a stay is listened to, s.
    fn heard_from_s(&self) -> f64 {
        self.turning_s + (1.0 - MARGIN.heard) * self.tried_s
    }

    /// Deviation of the duty in the last part of a stay, infinite where it swings quicker than polls see: on the other side of a step, or once more on the same. To and fro
    /// it is always the other way.
    fn activity(&mut self, guard: &mut ExperimentGuard<'_, L>, is_step: bool) -> Result<f64, Cause> {
        if is_step || self.about.is_some() {
            self.side = -self.side;
        }
        self.go(guard)?;
        let from_s = guard.now_s() + self.heard_from_s();
        match guard.poll_for(self.turning_s + self.tried_s, true) {
            // Its duty, which swings quicker than polls see, does not explain its speed. The speed is the one that it was given, and no answer was late.
            Err(Cause::Stalled) if self.turns(guard) && guard.late_for(Cause::Stalled).is_none() => {
                return Ok(f64::INFINITY);
            }
            polled => polled?,
        }
        let duties: Vec<(f64, f64)> =
            guard.points.iter().filter_map(|point| point.duty).filter(|duty| duty.0 >= from_s).collect();
        Ok(deviation(&duties))
    }
}

/// The duty of a multiple of the gains, over what was predicted.
#[derive(Clone, Copy, Debug)]
struct Heard {
    factor: f64,
    ratio: f64,
}

/// How loud the duty was at each multiple that was quiet, lowest first.
#[derive(Clone, Debug)]
struct Loudness {
    all: Vec<Heard>,
    /// How loud it may be by its rounding.
    usual: f64,
}

impl Loudness {
    fn heard(&mut self, factor: f64, measured: f64, predicted: f64) {
        if predicted > MARGIN.least_rough {
            self.all.push(Heard { factor, ratio: measured / predicted });
        }
    }

    /// Those at the first multiples, at which even a loop that is too sensitive damps what swings, and those at the last ones.
    fn parts(&self) -> (&[Heard], &[Heard]) {
        self.all.split_at(self.all.partition_point(|heard| heard.factor <= MARGIN.first_factors))
    }

    /// The most that the duty may be beside what was predicted, as a multiple of it.
    fn most(&self) -> f64 {
        MARGIN.growth * root_mean_square(self.parts().0).max(self.usual)
    }

    /// Whether the last two are louder.
    fn grows(&self) -> bool {
        let (first, last) = self.parts();
        !first.is_empty() && root_mean_square(&last[last.len().saturating_sub(2)..]) > self.most()
    }

    /// The highest multiple below all that were.
    fn before_it_grew(&self) -> f64 {
        self.all.iter().take_while(|heard| heard.ratio <= self.most()).fold(1.0, |_, heard| heard.factor)
    }
}

/// Of what was heard; 0 of nothing.
fn root_mean_square(heard: &[Heard]) -> f64 {
    (heard.iter().map(|heard| heard.ratio.powi(2)).sum::<f64>() / heard.len().max(1) as f64).sqrt()
}

/// Raises the gains step by step while the motor turns, as far as the duty stays quiet: by strokes to and fro in a travel, and where the loop did what its model does not
/// explain (`is_odd`), which a steady speed does not always show. The motor is braked at the end; the raised gains stand in the registers then.
pub(crate) fn headroom<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    task: &Task<L>,
    gains: &Gains,
    (excitation, is_odd): (Excitation, bool),
) -> Result<Headroom, Cause> {
    let law = &task.law;
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, law.tick_s()), law, task.lag);
    let lag_s = task.lag.total_s(law.tick_s()) + 2.0 * law.tick_s();
    let tried_s = (MARGIN.lags * lag_s)
        .clamp(MARGIN.tried_s.0, MARGIN.tried_s.1)
        .max(MARGIN.least_polls * guard.options.poll_s / MARGIN.heard);
    let mut raised = Raised::new(guard, task, gains, (excitation, is_odd), tried_s, &plant)?;
    let tried_s = raised.tried_s;
    let wanted = raised.wanted(&plant);
    raised.write(guard, 1.0)?;
    raised.go(guard)?;
    // To and fro half a stroke first, so that the others go to and fro about the middle.
    let settle_s = (1.5 * task.plant.tau_s).clamp(0.15, 1.0);
    guard.poll_for(if raised.about.is_some() { 0.5 * tried_s } else { settle_s }, true)?;
    // At speeds of whole counts in a tick rounding makes no noise: more of it than is predicted may be an oscillation already, and is not allowed for.
    let louder = if goes_by_whole_counts(law) { 1.0 } else { task.noise_factor.max(1.0) };
    let predicted = |raised: &Raised<'_, L>, factor: f64| {
        louder * plant.margins(&raised.gains(factor), task.qpps).noise_duty
    };
    let bound = |raised: &Raised<'_, L>, factor: f64| {
        (MARGIN.too_rough * predicted(raised, factor)).max(MARGIN.least_rough)
    };
    let (mut is_doubtful, mut is_too_loud) = (false, false);
    let mut heard_above: Option<f64> = None;
    let (mut quiet, mut written) = (0.0, 1.0);
    let usual = if raised.part == Part::DerivativeByPositions { MARGIN.of_half_counts } else { 1.0 };
    let mut loudness = Loudness { all: Vec::new(), usual };
    for factor in std::iter::once(1.0).chain(raised.factors().iter().map(|factor| factor.min(wanted))) {
        if factor <= quiet {
            break;
        }
        if factor > 1.0 {
            if predicted(&raised, factor) > MARGIN.loudest {
                // The rounding of a coarse encoder alone makes such a noise.
                is_doubtful = quiet < wanted_factor(task.goal.ms);
                is_too_loud = true;
                break;
            }
            raised.write(guard, factor)?;
            written = factor;
        }
        let bound_here = bound(&raised, factor);
        let measured = raised.activity(guard, true)?;
        loudness.heard(factor, measured, predicted(&raised, factor));
        // Looked at twice: what oscillates goes on, unless it is so strong that it had better stop at once. After a step something may still be dying out.
        let after_step =
            (measured > bound_here).then(|| bound_here.hypot(MARGIN.ringing * ringing(&raised, factor)));
        let again = after_step.is_some_and(|most| measured <= MARGIN.at_once * most);
        let rough = if again { raised.activity(guard, false)? } else { measured };
        // Every stroke is a step.
        let bound_again = if raised.about.is_some() { after_step.unwrap_or(bound_here) } else { bound_here };
        // Heard once, not again, and not to be expected of a step: backlash may hold it back at a steady speed. Gains that stay below are kept, with a warning.
        if again && (after_step.is_some_and(|most| measured > most) || rough > bound_again) {
            is_doubtful = true;
            heard_above.get_or_insert(quiet.max(1.0));
        }
        if rough > bound_again {
            let full =
                if raised.part == Part::Whole { full_factor(task.goal.ms) } else { MARGIN.derivative_factor };
            let wanted = full.min(raised.highest_calm(&plant));
            if quiet == 0.0 {
                match lowered_until_quiet(guard, &mut raised, bound, rough)? {
                    Some(share) => quiet = share,
                    None => (quiet, is_doubtful) = (wanted, true),
                }
            }
            guard.duty(0.0)?;
            return Ok(Headroom { quiet, wanted, is_doubtful });
        }
        quiet = factor;
    }
    if heard_above.is_none() && !is_doubtful && loudness.grows() {
        let mut squares = 0.0;
        for _ in 0..MARGIN.longer {
            squares += raised.activity(guard, true)?.powi(2);
        }
        let most = loudness.most() * predicted(&raised, written);
        let after_step = MARGIN.ringing * ringing(&raised, written);
        if (squares / f64::from(MARGIN.longer)).sqrt() > most.hypot(after_step) {
            is_doubtful = true;
            heard_above = Some(loudness.before_it_grew());
        }
    }
    if raised.part != Part::Whole && heard_above.is_none() && !is_doubtful {
        quiet = quiet_for_longer(guard, &mut raised, bound, quiet)?;
    }
    guard.duty(0.0)?;
    let quiet = heard_above.unwrap_or(quiet);
    // Nothing was heard as far as anything could be.
    let wanted = if is_too_loud && quiet >= written { quiet } else { wanted };
    Ok(Headroom { quiet, wanted, is_doubtful })
}

/// The highest multiple that stays quiet for one stay more: an oscillation that grows by a hundredth in a tick is not heard in the first. From one that does not the
/// gains go down.
fn quiet_for_longer<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    raised: &mut Raised<'_, L>,
    bound: impl Fn(&Raised<'_, L>, f64) -> f64,
    highest: f64,
) -> Result<f64, Cause> {
    let is_quiet = |raised: &Raised<'_, L>, factor: f64, measured: f64| {
        measured <= bound(raised, factor).hypot(MARGIN.ringing * ringing(raised, factor))
    };
    let measured = raised.activity(guard, false)?;
    if is_quiet(raised, highest, measured) {
        return Ok(highest);
    }
    for &factor in raised.factors().iter().rev().filter(|factor| **factor < highest) {
        raised.write(guard, factor)?;
        // The first stay lets what went on before die out.
        raised.activity(guard, false)?;
        let measured = raised.activity(guard, false)?;
        if is_quiet(raised, factor, measured) {
            return Ok(factor);
        }
    }
    Ok(1.0)
}

/// Whether it can go to and fro within the limits of the position.
fn has_room<L: Law>(guard: &ExperimentGuard<'_, L>, task: &Task<L>) -> bool {
    let here = guard.points.last().map_or(0.0, |point| point.counts) + guard.origin_counts() as f64;
    let limits = guard.proposed_travel(task.qpps).or_else(|| L::position_limits(&guard.setup.held));
    let most = MARGIN.free_travel_s * task.qpps;
    limits.is_none_or(|(low, high)| here - most > low as f64 && here + most < high as f64)
}

/// Deviation of the duty in the same part of a step of the model's loop: what is still dying out there is no oscillation.
fn ringing<L: Law>(raised: &Raised<'_, L>, factor: f64) -> f64 {
    let task = raised.task;
    let mut twin = TickLoop::new(task.plant, task.law, task.lag, raised.gains(factor), task.qpps).smooth();
    twin.start_steady(raised.speeds.0);
    let tick_s = task.law.tick_s();
    let ticks = ((raised.turning_s + raised.tried_s) / tick_s) as usize;
    let to = if raised.part == Part::DerivativeByPositions {
        Setpoint::Position(raised.far, task.qpps)
    } else {
        Setpoint::Speed(raised.speeds.1)
    };
    let duties: Vec<(f64, f64)> = (0..ticks).map(|n| (n as f64 * tick_s, twin.tick(to, 0.0))).collect();
    deviation(&duties[(raised.heard_from_s() / tick_s) as usize..])
}

/// The highest share of gains that oscillate as they are at which they no longer do. `None` where no share is quiet and the duty falls with the gains
/// alone: an oscillation would have died out, and what is left is a noise of the encoder that is louder than its rounding.
fn lowered_until_quiet<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    raised: &mut Raised<'_, L>,
    bound: impl Fn(&Raised<'_, L>, f64) -> f64,
    rough: f64,
) -> Result<Option<f64>, Cause> {
    let lowest = MARGIN.shares[MARGIN.shares.len() - 1];
    let mut heard = rough;
    for share in MARGIN.shares {
        raised.write(guard, share)?;
        // The first stay lets what went on before die out.
        raised.activity(guard, true)?;
        heard = raised.activity(guard, true)?;
        if heard <= bound(raised, share).hypot(MARGIN.ringing * ringing(raised, share)) {
            return Ok(Some(share));
        }
    }
    let falls_with_gains = rough.is_finite() && heard >= MARGIN.noise_share * lowest * rough;
    Ok((!falls_with_gains).then_some(lowest))
}

/// The speed of a loop that starts from rest each time, counts/s: it has to be there, or to have turned about, when it is listened to. A slow motor is given more time
/// rather than less speed, at which a motor that opened would hardly be missed.
fn fastest_from_rest<L: Law>(tried_s: f64, task: &Task<L>) -> f64 {
    let reached = 0.5 * accelerating(task) * (1.0 - MARGIN.heard) * tried_s / task.plant.tau_s;
    reached.clamp(MARGIN.least_from_rest * task.qpps, MARGIN.speed * task.qpps)
}

/// How long the motor takes to turn about at a speed, s.
fn turning_s<L: Law>(speed: f64, task: &Task<L>) -> f64 {
    2.0 * speed * task.plant.tau_s / accelerating(task)
}

/// The speed that the motor would gain in a time constant with what the current limit and friction leave of the duty, counts/s.
fn accelerating<L: Law>(task: &Task<L>) -> f64 {
    let plant = &task.plant;
    let limit = plant.drive_limit.map_or(1.0, |limit| limit.min(1.0));
    (limit - plant.coulomb_duty - plant.load_duty.abs()).max(MARGIN.least_accelerating)
        * plant.gain_counts_per_s
}

/// A speed near this one at which each tick counts a half more than a whole number: the difference of two ticks is never the same, and
/// a loop that oscillates by less than a count shows it. At whole numbers it could stand still in the controller's eyes.
fn between_counts(speed: f64, tick_s: f64) -> f64 {
    let per_tick = speed * tick_s;
    if per_tick > MARGIN.least_per_tick { (per_tick.floor() + 0.5) / tick_s } else { speed }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(ratios: &[(f64, f64)]) -> Loudness {
        let mut loudness = Loudness { all: Vec::new(), usual: 1.0 };
        for (factor, ratio) in ratios {
            loudness.heard(*factor, 0.05 * ratio, 0.05);
        }
        loudness
    }

    #[test]
    fn a_duty_that_grows_above_its_prediction_with_the_gains_is_told_from_one_that_is_loud_throughout() {
        // A gearmotor with a true Ms of 2.5; a loop that is as loud as it should be; one whose encoder makes more noise than its rounding at any gain.
        let springy = heard(&[(1.0, 0.75), (1.2, 0.86), (1.4, 0.87), (1.6, 1.29), (1.8, 1.05), (2.0, 1.43)]);
        assert!(springy.grows());
        assert!((springy.before_it_grew() - 1.4).abs() < 1e-9);
        assert!(!heard(&[(1.0, 0.9), (1.2, 1.1), (1.4, 1.0), (1.6, 1.2), (1.8, 0.8), (2.0, 1.1)]).grows());
        assert!(!heard(&[(1.0, 1.6), (1.2, 1.7), (1.4, 1.5), (1.6, 1.7), (1.8, 1.8), (2.0, 1.7)]).grows());
    }

    /// A rover wheel of seed 101 (plant 57) at 8.5 counts in a tick, whose derivative turns a count into 0.18 to 0.55 of full duty.
    #[test]
    fn a_derivative_at_half_counts_in_a_tick_is_as_loud_as_it_should_be() {
        let wheel = [
            (1.0, 0.92),
            (1.2, 0.63),
            (1.4, 1.09),
            (1.6, 1.3),
            (1.8, 1.36),
            (2.0, 1.14),
            (2.5, 1.2),
            (3.0, 1.3),
        ];
        assert!(heard(&wheel).grows());
        assert!(!Loudness { usual: MARGIN.of_half_counts, ..heard(&wheel) }.grows());
    }

    #[test]
    fn a_duty_too_quiet_to_be_told_from_a_step_of_a_register_says_nothing_of_growth() {
        let mut quiet = Loudness { all: Vec::new(), usual: 1.0 };
        for (factor, measured) in [(1.0, 0.001), (1.4, 0.001), (2.0, 0.009)] {
            quiet.heard(factor, measured, 0.002);
        }
        assert!(!quiet.grows());
    }
}

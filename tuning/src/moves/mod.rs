//! Tuning of an axis that takes no duty: its loop always has the motor, and all that can be commanded is a place.
//!
//! From a drive that is hardly one the gain goes up until a move is one. Strokes under soft gains then tell the motor roughly, strokes under gains that
//! suit it tell it well, and the same with D tell how often the loop turns, since D is a time in turns. A stiff loop tells its lag. Every stretch goes
//! into one fit ([`fit`]); the design is the one of other axes, in the steps that the registers have, and is tried by the same moves.

pub(crate) mod experiment;
pub(crate) mod fit;

use crate::cause::Cause;
use crate::design::{Goal, Task, design_pd};
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, Lag, PlantModel};
use crate::proposal::{design_for, propose};
use crate::report::Report;
use crate::request::{Identification, Method, Request};
use crate::score::position_step;
use crate::thresholds::thresholds;
use crate::verify::check_moves;
use experiment::{Ground, Started, hold, of_duty, start, strokes};
use fit::{Found, Start, Stretch, fit_moves};

thresholds! {
    /// How strokes are repeated and judged until they suit a fit.
    MOVES: Thresholds {
        /// Drive that the first strokes may ask for, as a multiple of what started the motor.
        first_push: f64 = 3.0,
        /// Drive that the first strokes may ask for at the most, as a share of full.
        most_push: f64 = 0.8,
        /// How often the first strokes are tried: they grow where nothing came of them, and are softer where the loop swung.
        first_tries: usize = 6,
        /// Gain of the loop that suits a motor: its speed for a count's error, times its time constant. Half is a damping of 0.7.
        suiting: f64 = 0.5,
        /// Damping that D adds in the strokes that tell the rate, as a multiple of what the motor has by itself.
        damping: f64 = 1.0,
        /// Maximum sensitivity (Ms) of the loop that tells the lag.
        careful_ms: f64 = 1.4,
        /// Least drive that a stroke asks for, as a multiple of the friction, which must be a small part of it.
        least_push_ratio: f64 = 5.0,
        /// Highest reduced chi-square of a fit that is believed.
        worst_chi_square: f64 = 100.0,
        /// Loosest time constant of a fit that is believed, as the standard deviation of its logarithm.
        loosest_tau: f64 = 0.5,
        /// Reduced chi-square beyond which something swings or has backlash that the model knows nothing of.
        odd_chi_square: f64 = 3.0,
        /// What is then left of the excess of the goal's sensitivity over 1, as a share.
        odd_share: f64 = 0.6,
        /// Sensitivity that a design may have at a rate that is as likely, as a multiple of that of its goal.
        other_rate_ms: f64 = 1.2,
        /// How many designs are tried, each softer than the one before, until one keeps that.
        softenings: usize = 5,
        /// What is left of the excess of the goal's sensitivity over 1 from one of them to the next, as a share.
        softer: f64 = 0.8,
        /// Ratio of the quickest to the slowest likely rate beyond which the rate is unknown.
        unknown_rate: f64 = 2.5,
        /// By how many of its standard deviations the worst lag is longer than the likely one.
        lag_deviations: f64 = 2.0,
        /// Ends of the first strokes in turn, as shares of their length from the start.
        to_and_fro: [f64; 4] = [1.0, 0.0, 0.4, 0.0],
        /// Ends of the strokes that tell the rate and the lag in turn, as shares of their length from the start.
        back_and_forth: [f64; 6] = [1.0, 0.0, 0.6, 0.0, 0.3, 0.0],
    }
}

/// A whole run of such an axis, from the first move to gains that were tried.
pub(crate) fn by_moves<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    report: &mut Report<L>,
) -> Result<(), Cause> {
    if request.method == Method::Velocity {
        return Err(Cause::NoSuchLoop);
    }
    if request.identification != Identification::Fit {
        return Err(Cause::NoOpenLoop);
    }
    guard.progress("Looking for the least gain that moves the motor");
    let law = request.law;
    let ground = Ground::of(guard, request.excitation)?;
    let started = start(guard, &law, &ground)?;
    guard.progress("Measuring the motor by moves");
    let mut stretches = Vec::new();
    let found = first_strokes(guard, &law, &ground, &started, &mut stretches)?;
    let found = suiting_strokes(guard, &law, &ground, found, &mut stretches)?;
    guard.progress("Measuring the lag and the rate of the loop");
    let found = stiff_strokes(guard, request, &ground, found, &mut stretches)?;
    report.fit = Some(found.fit);
    believe(&found, guard.facts.longest_move_counts)?;
    report.seconds.0 = guard.now_s();
    let task = task_of(request, &found);
    report.qpps = Some(task.qpps);
    report.request.law = task.law;
    if found.fit.model.load_duty.abs() > found.fit.model.coulomb_duty + 0.02 {
        report.causes.push(Cause::HeavyLoad);
    }
    if f64::from(found.likely_hz.1) > MOVES.unknown_rate * f64::from(found.likely_hz.0) {
        report.causes.push(Cause::RateUnknown);
    }
    let request = &Request { law: task.law, ..*request };
    guard.law = task.law;
    guard.monitor.full_speed = task.qpps;
    guard.monitor.stopping_s = task.plant.tau_s;
    let (task, design) = design_over_rates(request.method, task, &found).ok_or(Cause::GainSteps)?;
    report.task = Some(task);
    propose(report, request, &task, design, guard.proposed_travel(task.qpps));
    if request.verify {
        guard.progress("Trying the gains on the machine");
        match check_moves(guard, request, &task, report) {
            Err(Cause::NotVerified) if request.method == Method::Pid => {
                without_integral(guard, request, &task, report)?;
            }
            other => other?,
        }
    }
    Ok(())
}

/// What swings with an integral, since the model leaves something out, is tried without one.
fn without_integral<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    task: &Task<L>,
    report: &mut Report<L>,
) -> Result<(), Cause> {
    let design = design_pd(task).ok_or(Cause::NotVerified)?;
    propose(report, request, task, design, guard.proposed_travel(task.qpps));
    check_moves(guard, &Request { method: Method::Pd, ..*request }, task, report)
}

/// Strokes by which the motor is known at all.
fn first_strokes<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    law: &L,
    ground: &Ground,
    started: &Started,
    stretches: &mut Vec<Stretch<L>>,
) -> Result<Found, Cause> {
    let push = (MOVES.first_push * started.push).min(MOVES.most_push.min(guard.options.max_duty));
    let mut length = (push / started.gain).min(ground.most);
    let mut gain = push / length;
    let (mut swung, mut is_least) = (None, false);
    for _ in 0..MOVES.first_tries {
        let registers = hold(guard, law, of_duty(gain, 0.0))?;
        let made = strokes(guard, ground, registers, (length, &MOVES.to_and_fro, 1.5))?;
        // It was to be less, and was raised until the motor stayed where it is.
        is_least = made.swings && swung == Some(registers);
        if made.swings {
            swung = Some(registers);
            gain *= 0.4;
            continue;
        }
        let top = made.stretches.iter().map(top_speed).fold(1.0, f64::max);
        let reached = made.stretches.iter().map(reach).fold(0.0, f64::max);
        stretches.extend(made.stretches);
        if reached < 0.3 * length && gain * length < 0.9 {
            // Friction holds it before it is anywhere.
            (gain, length) = (1.5 * gain, (1.2 * length).min(ground.most));
            continue;
        }
        let starts = [0.01, 0.03, 0.1, 0.4]
            .map(|tau_s| Start::of(top / (0.6 * gain * length), tau_s, 0.5 * started.push));
        if let Some(found) = fit_moves(stretches, law, &[], &starts) {
            return Ok(found);
        }
    }
    Err(if is_least { Cause::GainSteps } else { Cause::TooCoarse })
}

/// Strokes under gains that suit the motor, and the same with D.
fn suiting_strokes<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    law: &L,
    ground: &Ground,
    found: Found,
    stretches: &mut Vec<Stretch<L>>,
) -> Result<Found, Cause> {
    let model = found.fit.model;
    let length = stroke_length(&model, ground);
    let (k, tau_s) = (model.gain_counts_per_s, model.tau_s);
    let mut gain = MOVES.suiting / (k * (tau_s + 2.0 * law.tick_s()));
    // Friction must be a little part of what a stroke asks for, and the drive must not be all that it gets.
    let least = MOVES.least_push_ratio * model.coulomb_duty / length;
    gain = gain.max(least).min(1.5 / length);
    // The first strokes were for a start.
    let first = stretches.split_off(stretches.len().saturating_sub(1));
    *stretches = first;
    for d in [0.0, MOVES.damping / k] {
        let mut p = gain;
        for _ in 0..3 {
            let registers = hold(guard, law, of_duty(p, d))?;
            let longest_s = longest_s(&model, p);
            let made = strokes(guard, ground, registers, (length, &MOVES.back_and_forth, longest_s))?;
            if !made.swings {
                stretches.extend(made.stretches);
                break;
            }
            p *= 0.5;
        }
    }
    fit_moves(stretches, law, law.facts().rates_hz, &[Start::from(&found)]).ok_or(Cause::TooCoarse)
}

/// Strokes under a careful design: a stiffer loop than a motor is found with shows its lag.
fn stiff_strokes<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    ground: &Ground,
    found: Found,
    stretches: &mut Vec<Stretch<L>>,
) -> Result<Found, Cause> {
    let task = task_of(request, &found);
    let careful = Task { goal: Goal { ms: MOVES.careful_ms, ..task.goal }, ..task };
    let Some(design) = design_pd(&careful) else { return Ok(found) };
    let Some(position) = design.gains.position else { return Ok(found) };
    let (p, d) = (position.p / task.qpps, position.d / task.qpps);
    let registers = hold(guard, &task.law, of_duty(p, d))?;
    let length = stroke_length(&found.fit.model, ground);
    let longest_s = longest_s(&found.fit.model, p);
    let made = strokes(guard, ground, registers, (length, &MOVES.back_and_forth, longest_s))?;
    if made.swings {
        return Ok(found);
    }
    stretches.extend(made.stretches);
    let law = request.law;
    // What was unlikely before is not looked at again, but for the next on either side.
    let rates = law.facts().rates_hz;
    let place = |rate: u32| rates.iter().position(|known| *known == rate);
    let (low, high) = found.likely_hz;
    let near = match (place(low), place(high)) {
        (Some(low), Some(high)) => &rates[low.saturating_sub(1)..(high + 2).min(rates.len())],
        _ => rates,
    };
    Ok(fit_moves(stretches, &law, near, &[Start::from(&found)]).unwrap_or(found))
}

/// The length of a stroke for a motor.
fn stroke_length(model: &PlantModel, ground: &Ground) -> f64 {
    position_step(model.gain_counts_per_s, model.tau_s).min(ground.most)
}

/// How long a stroke may take.
fn longest_s(model: &PlantModel, gain: f64) -> f64 {
    (0.3 + 4.0 * model.tau_s + 3.0 / (model.gain_counts_per_s * gain)).clamp(0.3, 3.0)
}

fn top_speed<L: Law>(stretch: &Stretch<L>) -> f64 {
    let speeds = stretch.points.windows(2).filter(|pair| pair[1].0 > pair[0].0);
    speeds.map(|pair| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs()).fold(1.0, f64::max)
}

fn reach<L: Law>(stretch: &Stretch<L>) -> f64 {
    let counts = || stretch.points.iter().map(|point| point.1);
    counts().fold(f64::NEG_INFINITY, f64::max) - counts().fold(f64::INFINITY, f64::min)
}

fn believe(found: &Found, longest_move_counts: f64) -> Result<(), Cause> {
    if found.fit.chi_square > MOVES.worst_chi_square {
        return Err(Cause::PoorFit);
    }
    if found.fit.sd_ln_tau <= MOVES.loosest_tau {
        return Ok(());
    }
    // A motor that would have been moved farther, had the controller let it.
    let model = found.fit.model;
    let is_cut = position_step(model.gain_counts_per_s, model.tau_s) > longest_move_counts;
    Err(if is_cut { Cause::MovesTooShort } else { Cause::TooCoarse })
}

/// What gains are designed for.
fn task_of<L: Law>(request: &Request<L>, found: &Found) -> Task<L> {
    let model = found.fit.model;
    let law = request.law.at_rate(found.rate_hz);
    let (lag_s, sd_s) = found.lag_s;
    let lag = Lag { filter_s: 0.0, delay_ticks: lag_s / law.tick_s() };
    let worst_s = lag_s + MOVES.lag_deviations * sd_s;
    let mut goal = Goal::of_level(request.level);
    if found.fit.chi_square > MOVES.odd_chi_square {
        goal.ms = 1.0 + MOVES.odd_share * (goal.ms - 1.0);
    }
    let qpps = model.gain_counts_per_s * (1.0 - model.coulomb_duty);
    let worst_lag = Lag { filter_s: 0.0, delay_ticks: worst_s / law.tick_s() };
    Task { worst_lag, goal, sd_coulomb_duty: found.fit.sd_coulomb, ..Task::new(model, law, lag, qpps) }
}

/// A design whose registers keep their margin at every rate that is as likely.
fn design_over_rates<L: Law>(
    method: Method,
    task: Task<L>,
    found: &Found,
) -> Option<(Task<L>, crate::design::Design)> {
    let mut task = task;
    for _ in 0..MOVES.softenings {
        let design = design_for(method, &task)?;
        if keeps_margin(&task, &design.gains, found) {
            return Some((task, design));
        }
        task.goal = Goal { ms: 1.0 + MOVES.softer * (task.goal.ms - 1.0), ..task.goal };
    }
    None
}

fn keeps_margin<L: Law>(task: &Task<L>, gains: &Gains, found: &Found) -> bool {
    let registers = task.law.registers(&L::Held::default(), gains, task.qpps, None);
    let (slowest, quickest) = found.likely_hz;
    let rates = task.law.facts().rates_hz.iter().filter(|rate| (slowest..=quickest).contains(rate));
    rates.map(|rate| task.law.at_rate(*rate)).all(|law| {
        let lag = Lag { filter_s: 0.0, delay_ticks: found.lag_s.0 / law.tick_s() };
        let plant = LoopPlant::new(DiscretePlant::of(&task.plant, law.tick_s()), &law, lag);
        let gains = law.gains(&registers, task.qpps, true);
        plant.margins(&gains, task.qpps).ms <= MOVES.other_rate_ms * task.goal.ms
            && plant.spectral_radius(&gains, task.qpps) < 1.0
    })
}

//! How far the gain of a velocity loop can be raised on the machine before the loop gets rough: its gain margin, asked of the machine
//! itself. A springy shaft oscillates faster than polls can see and no model knows of it; the duty that is read back shows it anyhow.

use crate::cause::Cause;
use crate::design::Task;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{Gains, Pid};
use crate::oscillation::deviation;
use crate::setpoint::Setpoint;
use crate::ticks::TickLoop;

/// Gains tried, as multiples of the proposed ones, up to the margin that is wanted.
const FACTORS: [f64; 5] = [1.2, 1.4, 1.6, 1.8, 2.0];
/// Shares of the gains tried where they oscillate as they are.
const SHARES: [f64; 4] = [0.7, 0.5, 0.35, 0.25];
/// A duty that is still so large a part of what its share of the gains makes of noise is noise: rms figures of some fourteen polls spread by a fifth.
const NOISE_SHARE: f64 = 0.8;
/// The sensitivity up to which a model counts as calm.
const CALM_MS: f64 = 2.8;
/// The most that is asked of a loop that oscillates.
const MOST_FACTOR: f64 = 2.5;
/// The sensitivity that may really be where one was designed for: what lies beyond it is what the trial is to find.
const MS_ALLOWED: f64 = 1.25;
/// Setpoint of the trial and height of its steps, as shares of full speed.
const SPEED: f64 = 0.30;
const STEP: (f64, f64) = (0.02, 0.08);
/// The duty that a step asks for at once at the highest gain tried: as much as leaves the backlash of a gear, where a shaft does not oscillate.
const STEP_DUTY: f64 = 0.3;
/// How long a gain is tried, in lags of the loop, and the bounds, s.
const LAGS: f64 = 14.0;
const TRIED_S: (f64, f64) = (0.22, 0.40);
/// The last share of that is listened to, and how many polls it has at the least.
const HEARD: f64 = 0.65;
const LEAST_POLLS: f64 = 14.0;
/// The duty is too rough when it is so many times what was to be expected, and at least this.
const TOO_ROUGH: f64 = 2.0;
const LEAST_ROUGH: f64 = 0.012;
/// What is left of a step may be so many times what the model leaves: it dies out as quickly to within a tenth or two.
const RINGING: f64 = 1.3;

/// The highest sensitivity of gains that are given without a warning (Astrom and Murray, "Feedback Systems", 2nd edition, section 10.3: 1.2 to 2 are reasonable).
pub(crate) const MOST_MS: f64 = 1.8;

/// A duty that is beyond the bound so many times over needs no second look.
const AT_ONCE: f64 = 4.0;
/// Counts in a tick from which on a speed is laid between two whole numbers of them.
const LEAST_PER_TICK: f64 = 6.0;
/// Predicted noise from which on nothing can be heard beside it.
const LOUDEST: f64 = 0.15;

/// What a trial of raised gains found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Headroom {
    /// The highest multiple of the gains at which the duty was as quiet as predicted.
    pub(crate) quiet: f64,
    /// The multiple that was wanted.
    pub(crate) wanted: f64,
    /// Nothing could be heard at some of the gains, or an oscillation once and not again: what is called quiet may be rough.
    pub(crate) is_doubtful: bool,
}

/// Whether gains may be too sensitive for all that was measured: with the longest lag that is still likely, or as long as the law may have it where
/// raising the gains on the machine told nothing.
pub(crate) fn may_be_short<L: Law>(task: &Task<L>, gains: &Gains, is_doubtful: bool) -> bool {
    let tick_s = task.law.tick_s();
    let longest = task.law.facts().longest_lag;
    let is_longer = longest.total_s(tick_s) > task.worst_lag.total_s(tick_s);
    let lag = if is_doubtful && is_longer { longest } else { task.worst_lag };
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, tick_s), &task.law, lag);
    plant.spectral_radius(gains, task.qpps) >= 1.0 || plant.margins(gains, task.qpps).ms > MOST_MS
}

/// The multiple of its gain up to which a loop with the sensitivity that is allowed stays stable.
fn wanted_factor(ms: f64) -> f64 {
    let allowed = MS_ALLOWED * ms;
    (allowed / (allowed - 1.0)).min(FACTORS[FACTORS.len() - 1])
}

/// The multiple that a loop with the sensitivity that was designed for has, for one that was seen to oscillate below the other.
fn full_factor(ms: f64) -> f64 {
    (ms / (ms - 1.0)).min(MOST_FACTOR)
}

/// The velocity loop of gains. A loop on the position that acts on the duty directly is one too: its derivative is a gain of the speed and
/// its gain an integral, but for the filter on the speed, which only a velocity loop has.
fn velocity_loop_of(gains: &Gains) -> Gains {
    let position = gains.position.unwrap_or_default();
    let is_direct = gains.velocity == Pid::default();
    let velocity = if is_direct { Pid { p: position.d, i: position.p, d: 0.0 } } else { gains.velocity };
    Gains { velocity, ..Gains::default() }
}

/// The highest multiple of gains that the model itself stays calm under.
fn highest_calm(plant: &LoopPlant, inner: &Gains, qpps: f64) -> f64 {
    let is_calm = |factor: &f64| {
        let gains = scaled(inner, *factor);
        plant.spectral_radius(&gains, qpps) < 1.0 && plant.margins(&gains, qpps).ms < CALM_MS
    };
    FACTORS.into_iter().chain([MOST_FACTOR]).take_while(is_calm).fold(1.0, f64::max)
}

/// The velocity gains times a factor.
pub(crate) fn scaled(gains: &Gains, factor: f64) -> Gains {
    let v = gains.velocity;
    Gains { velocity: Pid { p: factor * v.p, i: factor * v.i, d: factor * v.d }, ..*gains }
}

/// Raises the velocity gains step by step at a steady speed, as far as the duty stays quiet. The motor is braked at the end; the raised
/// gains stand in the registers then.
pub(crate) fn headroom<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    task: &Task<L>,
    gains: &Gains,
) -> Result<Headroom, Cause> {
    let law = &task.law;
    let inner = velocity_loop_of(gains);
    let plant = LoopPlant::new(DiscretePlant::of(&task.plant, law.tick_s()), law, task.lag);
    let most = highest_calm(&plant, &inner, task.qpps);
    let wanted = wanted_factor(task.goal.ms).min(most);
    let predicted = |factor: f64| {
        task.noise_factor.max(1.0) * plant.margins(&scaled(&inner, factor), task.qpps).noise_duty
    };
    let lag_s = task.lag.total_s(law.tick_s()) + 2.0 * law.tick_s();
    let tried_s = (LAGS * lag_s).clamp(TRIED_S.0, TRIED_S.1).max(LEAST_POLLS * guard.options.poll_s / HEARD);
    let settle_s = (1.5 * task.plant.tau_s).clamp(0.15, 1.0);
    guard.write_gains(law, &inner, task.qpps)?;
    let step = (STEP_DUTY / (wanted * inner.velocity.p).max(1e-6)).clamp(STEP.0, STEP.1);
    let speed = |side: f64| between_counts((SPEED + side * step) * task.qpps, law.tick_s());
    guard.speed(speed(-1.0))?;
    guard.poll_for(settle_s, true)?;
    let bound = |factor: f64| (TOO_ROUGH * predicted(factor)).max(LEAST_ROUGH);
    // After a step, with what is still dying out.
    let bound_after_step = |factor: f64| {
        bound(factor)
            .hypot(RINGING * ringing(task, &scaled(&inner, factor), (speed(-1.0), speed(1.0)), tried_s))
    };
    let mut is_doubtful = false;
    let mut heard_above: Option<f64> = None;
    let mut side = 1.0;
    let mut quiet = 0.0;
    for factor in std::iter::once(1.0).chain(FACTORS.map(|factor| factor.min(wanted))) {
        if factor <= quiet {
            break;
        }
        if factor > 1.0 {
            if predicted(factor) > LOUDEST {
                // The rounding of a coarse encoder alone makes such a noise.
                quiet = wanted;
                is_doubtful = true;
                break;
            }
            guard.write_gains(law, &scaled(&inner, factor), task.qpps)?;
        }
        let measured = activity(guard, speed(side), tried_s)?;
        // Looked at twice: what oscillates goes on, unless it is so strong that it had better stop at once.
        let after_step = (measured > bound(factor)).then(|| bound_after_step(factor));
        let again = after_step.is_some_and(|most| measured <= AT_ONCE * most);
        let rough = if again { activity(guard, speed(side), tried_s)? } else { measured };
        // Heard once, not again, and not to be expected of a step: backlash may hold it back at a steady speed. Gains that stay below are kept, with a warning.
        if again && (after_step.is_some_and(|most| measured > most) || rough > bound(factor)) {
            is_doubtful = true;
            heard_above.get_or_insert(quiet.max(1.0));
        }
        if rough > bound(factor) {
            let wanted = full_factor(task.goal.ms).min(most);
            if quiet == 0.0 {
                match lowered_until_quiet(guard, task, &inner, (speed, bound), (tried_s, rough))? {
                    Some(share) => quiet = share,
                    None => (quiet, is_doubtful) = (wanted, true),
                }
            }
            guard.duty(0.0)?;
            return Ok(Headroom { quiet, wanted, is_doubtful });
        }
        quiet = factor;
        side = -side;
    }
    guard.duty(0.0)?;
    Ok(Headroom { quiet: heard_above.unwrap_or(quiet), wanted, is_doubtful })
}

/// Deviation of the duty in the same part of a step of the model's loop: what is still dying out there is no oscillation.
fn ringing<L: Law>(task: &Task<L>, gains: &Gains, (from, to): (f64, f64), tried_s: f64) -> f64 {
    let mut twin = TickLoop::new(task.plant, task.law, task.lag, *gains, task.qpps).smooth();
    twin.start_steady(from);
    let tick_s = task.law.tick_s();
    let ticks = (tried_s / tick_s) as usize;
    let duties: Vec<(f64, f64)> =
        (0..ticks).map(|n| (n as f64 * tick_s, twin.tick(Setpoint::Speed(to), 0.0))).collect();
    deviation(&duties[((1.0 - HEARD) * ticks as f64) as usize..])
}

/// The highest share of gains that oscillate as they are at which they no longer do. `None` where no share is quiet and the duty falls with the gains
/// alone: an oscillation would have died out, and what is left is a noise of the encoder that is louder than its rounding.
fn lowered_until_quiet<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    task: &Task<L>,
    inner: &Gains,
    (speed, bound): (impl Fn(f64) -> f64, impl Fn(f64) -> f64),
    (tried_s, rough): (f64, f64),
) -> Result<Option<f64>, Cause> {
    let lowest = SHARES[SHARES.len() - 1];
    let (mut side, mut heard) = (-1.0, rough);
    for share in SHARES {
        guard.write_gains(&task.law, &scaled(inner, share), task.qpps)?;
        // The first stay lets what went on before die out.
        activity(guard, speed(side), tried_s)?;
        heard = activity(guard, speed(-side), tried_s)?;
        if heard <= bound(share) {
            return Ok(Some(share));
        }
        side = -side;
    }
    let falls_with_gains = heard >= NOISE_SHARE * lowest * rough;
    Ok((!falls_with_gains).then_some(lowest))
}

/// A speed near this one at which each tick counts a half more than a whole number: the difference of two ticks is never the same, and
/// a loop that oscillates by less than a count shows it. At whole numbers it could stand still in the controller's eyes.
fn between_counts(speed: f64, tick_s: f64) -> f64 {
    let per_tick = speed * tick_s;
    if per_tick > LEAST_PER_TICK { (per_tick.floor() + 0.5) / tick_s } else { speed }
}

/// Deviation of the duty in the second half of a step.
fn activity<L: Law>(guard: &mut ExperimentGuard<'_, L>, speed: f64, tried_s: f64) -> Result<f64, Cause> {
    guard.speed(speed)?;
    let from_s = guard.now_s() + (1.0 - HEARD) * tried_s;
    guard.poll_for(tried_s, true)?;
    let duties: Vec<(f64, f64)> =
        guard.points.iter().filter_map(|point| point.duty).filter(|duty| duty.0 >= from_s).collect();
    Ok(deviation(&duties))
}

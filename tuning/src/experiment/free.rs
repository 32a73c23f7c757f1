//! The experiment on an axis that turns freely: full speed one way, steps and a relay on the speed, full speed the other way.
//! It gives QPPS at once and the record for the fit.

use super::Probe;
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::settle::{Settled, settled};
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// How an axis that turns freely is driven, and when its speed counts as settled.
    FREE: Thresholds {
        /// How often the relay switches.
        switches: usize = 8,
        /// Fewest switches in which a slow axis shows itself.
        few_switches: usize = 2,
        /// Time after which these few are enough, in seconds.
        enough_s: f64 = 1.5,
        /// Where the relay switches, as shares of the difference between its two speeds.
        switch_at: (f64, f64) = (0.28, 0.72),
        /// Longest time for one settling, in seconds.
        longest_settle_s: f64 = 20.0,
        /// Longest time for the relay, in seconds.
        longest_relay_s: f64 = 12.0,
        /// Least duty of the first step of the climb to full duty, as a share of full.
        climb_from: f64 = 0.2,
        /// Ratio of the duty of each step of the climb to that of the step before.
        climb_ratio: f64 = 1.5,
        /// Least time at each step of the climb, in seconds.
        climb_s: f64 = 0.05,
        /// Fewest polls at each step of the climb.
        climb_polls: usize = 2,
        /// Shortest and longest time braked after the climb, in seconds.
        climb_rest_s: (f64, f64) = (0.1, 0.6),
        /// Speed that is rest after the climb, as a share of the highest one in it.
        climb_still: f64 = 0.002,
        /// Half of the 95 % interval of a speed below which it counts as settled, as a share of it.
        interval: f64 = 0.01,
        /// How far the speed at the end may be from the one that it settles at, as a share of it.
        tail_error: f64 = 0.006,
        /// A fine encoder shows the end sooner: after so many time constants, with half of the interval below this share of the speed.
        early: (f64, f64) = (2.2, 0.002),
        /// What of the speed that was still missing at the end is not known, as a share: the battery sags less as the current falls and the current limit leaves a slope,
        /// so that the rise is no exponential to its end. Of 36 flywheels and robot bases of seeds 7 and 11 of the bench, 35 were within this share and all within 0.09;
        /// without it two thirds of the flywheels' intervals missed QPPS.
        extrapolated: f64 = 0.06,
    }
}

/// What the free run read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreeRun {
    /// Speed at the highest allowed duty, in each direction, counts/s, both positive.
    pub full_speeds: (f64, f64),
    /// Half of the 95 % interval of their mean, relative.
    pub interval: f64,
    /// Duty of those speeds.
    pub full_duty: f64,
    /// Time constant read off the settling, s; a start value.
    pub tau_s: f64,
    /// Duties of the relay.
    pub relay: (f64, f64),
    /// When the identification record starts, s.
    pub from_s: f64,
    /// Where the classic step begins: time, its duty before and after, and its end.
    pub step: (f64, f64),
}

/// Runs it. The motor is braked when it returns.
pub fn run_free<L: Law>(guard: &mut ExperimentGuard<'_, L>, probe: &Probe) -> Result<FreeRun, Cause> {
    let full_duty = guard.options.max_duty;
    guard.monitor.start_duty = probe.start_duty;
    guard.monitor.stall_amps = probe.stall_amps;
    guard.monitor.drive_limit = guard.drive_limit(probe.stall_amps);
    let mut from_s = guard.now_s();
    if guard.monitor.is_abrupt && climb(guard, full_duty)? {
        from_s = guard.now_s();
    }
    let driven_s = guard.now_s();
    let forward = settle_at(guard, full_duty)?;
    let rise = rise_s(guard, driven_s, forward.speed);
    guard.monitor.stopping_s = forward.tau_s.min(rise);
    guard.monitor.tau_bounds_s = Some(tau_bounds(forward.tau_s, rise));
    let low_duty = (probe.start_duty + 0.06).max(0.25).min(0.6 * full_duty);
    let high_duty = (probe.start_duty + 0.35).max(0.6).min(0.9 * full_duty);
    let step_from = guard.now_s();
    run_relay(guard, (low_duty, high_duty), forward.speed)?;
    let step_to = guard.now_s();
    let backward = settle_at(guard, -full_duty)?;
    guard.duty(0.0)?;
    guard.poll_for((3.0 * forward.tau_s).clamp(0.06, 0.5), false)?;
    let full_speeds = (forward.speed.abs(), backward.speed.abs());
    let mean = 0.5 * (full_speeds.0 + full_speeds.1);
    if (full_speeds.0 - full_speeds.1).abs() > 0.25 * mean {
        return Err(Cause::Lopsided);
    }
    let of = |run: &Settled| run.interval.hypot(FREE.extrapolated * run.remaining);
    let interval = 0.5 * of(&forward).hypot(of(&backward));
    Ok(FreeRun {
        full_speeds,
        interval,
        full_duty,
        tau_s: forward.tau_s,
        relay: (low_duty, high_duty),
        from_s,
        step: (step_from, step_to),
    })
}

/// Goes up to the full duty in steps where the controller has no ramp of its own: nobody knows yet how fast this motor is. Then it is
/// braked, so that it goes up once more from rest, which shows its time constant. Whether it came to rest: the record that the model is
/// fitted to begins then, since a quick motor may stick at a low duty, and no model says when.
fn climb<L: Law>(guard: &mut ExperimentGuard<'_, L>, full_duty: f64) -> Result<bool, Cause> {
    let mut duty = (guard.monitor.start_duty + 0.06).max(FREE.climb_from);
    let mut top: f64 = 0.0;
    while duty < 0.9 * full_duty {
        guard.duty(duty)?;
        let (seen, until_s) = (guard.points.len() + FREE.climb_polls, guard.now_s() + FREE.climb_s);
        while guard.now_s() < until_s || guard.points.len() < seen {
            guard.poll(false)?;
        }
        top = top.max(guard.recent_speed(FREE.climb_polls).map_or(0.0, f64::abs));
        duty *= FREE.climb_ratio;
    }
    guard.duty(0.0)?;
    let until_s = guard.now_s() + FREE.climb_rest_s.1;
    guard.poll_for(FREE.climb_rest_s.0, false)?;
    loop {
        let is_still = guard.recent_speed(3).is_some_and(|speed| speed.abs() <= FREE.climb_still * top);
        if is_still || guard.now_s() >= until_s {
            return Ok(is_still);
        }
        guard.poll(false)?;
    }
}

/// Holds a duty until the speed it settles at is known.
pub(super) fn settle_at<L: Law>(guard: &mut ExperimentGuard<'_, L>, duty: f64) -> Result<Settled, Cause> {
    guard.duty(duty)?;
    // The duty ramp of up to 0.1 s is no part of the exponential.
    let mut start =
        guard.now_s() + 0.02 + 0.05 * duty.abs() * if guard.monitor.full_speed > 0.0 { 1.4 } else { 1.0 };
    let begin = start;
    let mut polls = 0;
    loop {
        let point = guard.poll(false)?;
        if point.is_some_and(|point| point.limited) {
            // Nor is the climb at the current limit.
            start = guard.now_s();
        }
        if let Some(speed) = guard.recent_speed(4) {
            guard.monitor.full_speed = guard.monitor.full_speed.max(speed.abs());
        }
        polls += 1;
        let t = guard.now_s() - start;
        if polls % 5 != 0 || t < 0.1 {
            continue;
        }
        let from = guard.points.partition_point(|p| p.t < start);
        let Some(found) = settled(&guard.points[from..]) else { continue };
        let level = (found.speed - found.tail_speed).abs() < FREE.tail_error * found.speed.abs();
        let settled = level && t > 3.0 * found.tau_s && found.interval < FREE.interval;
        let clear = t > FREE.early.0 * found.tau_s && t > 0.5 && found.interval < FREE.early.1;
        if settled || clear {
            return Ok(found);
        }
        if guard.now_s() - begin > FREE.longest_settle_s {
            return Err(if found.interval < 0.05 { Cause::TimeLimit } else { Cause::TooCoarse });
        }
    }
}

/// Between which values the time constant lies, by the fit of the settling and by the rise. A load behind a spring makes the motor
/// alone quicker.
pub(super) fn tau_bounds(fitted: f64, rise: f64) -> (f64, f64) {
    (0.3 * fitted.min(rise), 1.6 * if rise.is_finite() { fitted.max(rise) } else { fitted })
}

/// Time to 63 % of a speed: no time constant is longer.
pub(super) fn rise_s<L: Law>(guard: &ExperimentGuard<'_, L>, from_s: f64, speed: f64) -> f64 {
    let driven = guard.points.iter().filter(|p| p.t >= from_s);
    let pairs = guard.points.windows(2).filter(|w| w[0].t >= from_s);
    let risen =
        pairs.into_iter().find(|w| (w[1].counts - w[0].counts) / (w[1].t - w[0].t).max(1e-3) >= 0.63 * speed);
    match (driven.map(|p| p.t).next(), risen) {
        (Some(start), Some(pair)) => (pair[1].t - start).max(0.01),
        _ => f64::INFINITY,
    }
}

/// Switches between two duties whenever the speed has come most of the way.
fn run_relay<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    duties: (f64, f64),
    full_speed: f64,
) -> Result<(), Cause> {
    let start = probe_share(guard);
    let speed_at = |duty: f64| full_speed * (duty - start) / (guard.options.max_duty - start).max(0.05);
    let (low, high) = (speed_at(duties.0), speed_at(duties.1));
    let down = low + FREE.switch_at.0 * (high - low);
    let up = low + FREE.switch_at.1 * (high - low);
    let mut rising = false;
    guard.duty(duties.0)?;
    let begin = guard.now_s();
    let mut since = begin;
    let mut switches = 0;
    while switches < FREE.switches {
        guard.poll(false)?;
        let now = guard.now_s();
        let Some(speed) = guard.recent_speed(2) else { continue };
        if now - since < 0.025 {
            continue;
        }
        if (rising && speed >= up) || (!rising && speed <= down) {
            rising = !rising;
            guard.duty(if rising { duties.1 } else { duties.0 })?;
            since = now;
            switches += 1;
        } else if now - begin > FREE.longest_relay_s
            || (switches >= FREE.few_switches && now - begin > FREE.enough_s)
        {
            break;
        }
    }
    Ok(())
}

/// A guess of the duty that friction eats: somewhat less than it took to start.
fn probe_share<L: Law>(guard: &ExperimentGuard<'_, L>) -> f64 {
    0.6 * guard.monitor.start_duty
}

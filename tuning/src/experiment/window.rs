//! The experiment inside a travel window: a relay on the position at two duties, never at full speed.

use super::Probe;
use crate::cause::Cause;
use crate::rig::Rig;
use serde::{Deserialize, Serialize};

/// Switches at each of the two duties.
const SWITCHES: usize = 10;
/// Duties above the starting one.
const DUTIES: [f64; 2] = [0.22, 0.50];
/// Where the relay switches, as a share of the window.
const SWITCH_AT: f64 = 0.22;
/// Duty above the starting one for going somewhere, and how far its end is looked ahead for, s.
const GOING_DUTY: f64 = 0.05;
const GOING_AHEAD_S: f64 = 0.05;
/// Longest time, s.
const LONGEST_S: f64 = 25.0;
/// A wide window is not used to its ends by a slow axis: longest way in one direction once the speed is steady, s, and what it
/// changes by then at the most.
const LONGEST_SWING_S: f64 = 0.7;
const STEADY: f64 = 0.08;

/// What the window run read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowRun {
    /// When the identification record starts, s.
    pub from_s: f64,
    /// Switches made.
    pub switches: usize,
    /// Highest speed seen, counts/s.
    pub top_speed: f64,
    /// Farthest way from the middle, counts.
    pub reach_counts: f64,
}

/// Runs it inside `width` counts around where the axis is now. The motor is braked when it returns.
pub fn run_window(rig: &mut Rig<'_>, probe: &Probe, width: f64) -> Result<WindowRun, Cause> {
    rig.watch.start_duty = probe.start_duty;
    rig.watch.stall_amps = probe.stall_amps;
    rig.watch.drive_limit = rig.drive_limit(probe.stall_amps);
    rig.poll_for(0.05, false)?;
    let middle = rig.points.last().map_or(0.0, |p| p.counts);
    let from_s = rig.now_s();
    let mut run = WindowRun { from_s, switches: 0, top_speed: 0.0, reach_counts: 0.0 };
    let mut brake_s = 0.03;
    for above in DUTIES {
        let duty = (probe.start_duty + above).min(rig.options.max_duty);
        swing(rig, duty, middle, width, &mut run, &mut brake_s)?;
    }
    rig.come_to_rest()?;
    if run.switches < 4 { Err(Cause::TooCoarse) } else { Ok(run) }
}

/// Drives to a place with little duty, and lets the axis come to rest there.
pub fn go_to(rig: &mut Rig<'_>, probe: &Probe, place: f64) -> Result<(), Cause> {
    let begin = rig.now_s();
    let here = |rig: &Rig<'_>| rig.points.last().map_or(0.0, |p| p.counts);
    let direction = (place - here(rig)).signum();
    rig.duty((probe.start_duty + GOING_DUTY).min(rig.options.max_duty) * direction)?;
    loop {
        rig.poll(false)?;
        let ahead = rig.recent_speed(2).unwrap_or(0.0) * GOING_AHEAD_S;
        if (place - here(rig) - ahead) * direction <= 0.0 {
            break;
        }
        if rig.now_s() - begin > LONGEST_S {
            return Err(Cause::TimeLimit);
        }
    }
    rig.come_to_rest()
}

/// Swings about the middle at one duty. The time it takes to turn round is learned from each swing.
fn swing(
    rig: &mut Rig<'_>,
    duty: f64,
    middle: f64,
    width: f64,
    run: &mut WindowRun,
    brake_s: &mut f64,
) -> Result<(), Cause> {
    let mut direction = if rig.points.last().map_or(0.0, |p| p.counts) > middle { -1.0 } else { 1.0 };
    rig.duty(duty * direction)?;
    let mut switches = 0;
    let (mut switched_at, mut switch_speed, mut farthest) = (0.0, 0.0_f64, 0.0_f64);
    let mut since_s = rig.now_s();
    while switches < SWITCHES {
        if rig.now_s() - run.from_s > LONGEST_S {
            return Ok(());
        }
        let Some(point) = rig.poll(false)? else { continue };
        let speed = rig.recent_speed(2).unwrap_or(0.0);
        let from_middle = point.counts - middle;
        run.top_speed = run.top_speed.max(speed.abs());
        rig.watch.full_speed = rig.watch.full_speed.max(speed.abs());
        run.reach_counts = run.reach_counts.max(from_middle.abs());
        farthest = farthest.max((point.counts - switched_at) * -direction);
        if from_middle.abs() > 0.5 * width {
            return Err(Cause::TravelLimit);
        }
        let ahead = from_middle * direction + (speed * direction).max(0.0) * *brake_s;
        let is_steady =
            rig.recent_speed(12).is_some_and(|before| (speed - before).abs() < STEADY * run.top_speed);
        let is_long = point.t - since_s > LONGEST_SWING_S && is_steady;
        if is_long || ahead >= SWITCH_AT * width {
            since_s = point.t;
            if switches > 0 && switch_speed > 0.0 && farthest > 0.0 {
                *brake_s = (0.5 * *brake_s + 0.5 * (farthest / switch_speed)).clamp(0.02, 0.6);
                rig.watch.stopping_s = *brake_s;
                rig.watch.tau_bounds_s = Some((0.1 * *brake_s, 10.0 * *brake_s));
            }
            switched_at = point.counts;
            switch_speed = speed * direction;
            farthest = 0.0;
            direction = -direction;
            rig.duty(duty * direction)?;
            switches += 1;
            run.switches += 1;
        }
    }
    Ok(())
}

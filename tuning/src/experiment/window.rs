//! The experiment inside a travel window: to and fro at two duties, never at full speed.

use super::Probe;
use super::step::{STEP, about};
use crate::cause::Cause;
use crate::experiment_guard::ExperimentGuard;
use crate::law::Law;
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};

thresholds! {
    /// The strokes within a travel: where they turn, and how long they go on.
    pub(crate) WINDOW: Thresholds {
        /// Switches at each of the two duties.
        switches: usize = 10,
        /// Duties above the starting one, as shares of full.
        duties: [f64; 2] = [0.22, 0.50],
        /// What is left of these where the current limit held the motor back for most of the run.
        gentler: f64 = 0.4,
        /// How far from the middle the axis is to turn round as long as nothing is known of its stopping distance, as a share of the window.
        first_turn_at: f64 = 0.20,
        /// How far from the middle it is to turn round later, as a share of the window.
        turn_at: f64 = 0.25,
        /// How often a run that the guard ended is begun anew.
        narrower: usize = 1,
        /// What it then uses of the width, as a share of what it used before.
        narrower_share: f64 = 0.8,
        /// How far from the middle the axis may have come for that, as a share of the width.
        nearest_share: f64 = 0.45,
        /// Time until a new duty acts, in seconds.
        acts_s: f64 = 0.03,
        /// Share of the distance from rest that the first stop may take.
        first_share: f64 = 0.7,
        /// Duty above the starting one for going somewhere, as a share of full.
        going_duty: f64 = 0.05,
        /// How far ahead the end of that way is looked for, in seconds.
        going_ahead_s: f64 = 0.05,
        /// Longest time for the strokes, and for going somewhere, in seconds.
        longest_s: f64 = 25.0,
        /// Longest travel in one direction once the speed is steady, in seconds: a wide window is not used to its ends by a slow axis.
        longest_half_cycle_s: f64 = 0.7,
        /// The most that a steady speed changes by over twelve polls, as a share of the top speed.
        steady: f64 = 0.08,
    }
}

/// What the window run read off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowRun {
    /// When the identification record starts, s.
    pub from_s: f64,
    /// Switches made.
    pub switches: usize,
    /// Highest speed seen, counts/s.
    pub top_speed: f64,
    /// Farthest distance from the middle, counts.
    pub reach_counts: f64,
    /// The duties, where a person chose what they lie about.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_duties: Option<(f64, f64)>,
}

/// Runs it inside `width` counts around where the axis is now, at two duties about one where that is given, and else at a share of the usual ones. The motor is braked
/// when it returns.
pub fn run_window<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    width: f64,
    (about_duty, share): (Option<f64>, f64),
) -> Result<WindowRun, Cause> {
    let chosen = about_duty.map(|duty| about(guard, probe, duty, STEP.half_height)).transpose()?;
    let usual = WINDOW.duties.map(|above| (probe.start_duty + share * above).min(guard.options.max_duty));
    let duties = chosen.map_or(usual, |(low, high)| [low, high]);
    guard.monitor.start_duty = probe.start_duty;
    guard.monitor.stall_amps = probe.stall_amps;
    guard.monitor.drive_limit = guard.drive_limit(probe.stall_amps);
    guard.poll_for(0.05, false)?;
    let middle = guard.points.last().map_or(0.0, |p| p.counts);
    let mut turn = Turn { acts_s: WINDOW.acts_s, last: None, share: 1.0 };
    for _ in 0..WINDOW.narrower {
        match oscillate(guard, duties, (middle, width), &mut turn) {
            Err(Cause::TravelLimit)
                if (guard.turned_at_counts() - middle).abs() < WINDOW.nearest_share * width =>
            {
                // The guard brought it to rest before the end. What it learned of the stopping distance stays, and it keeps farther away.
                guard.come_to_rest()?;
                go_to(guard, probe, middle)?;
                turn.share *= WINDOW.narrower_share;
            }
            other => return other.map(|run| WindowRun { step_duties: chosen, ..run }),
        }
    }
    oscillate(guard, duties, (middle, width), &mut turn).map(|run| WindowRun { step_duties: chosen, ..run })
}

/// Oscillates about the middle of a width at both duties.
fn oscillate<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    duties: [f64; 2],
    (middle, width): (f64, f64),
    turn: &mut Turn,
) -> Result<WindowRun, Cause> {
    let from_s = guard.now_s();
    let mut run = WindowRun { from_s, switches: 0, top_speed: 0.0, reach_counts: 0.0, step_duties: None };
    for duty in duties {
        oscillate_at(guard, duty, middle, width, &mut run, turn)?;
    }
    guard.come_to_rest()?;
    if run.switches < 4 { Err(Cause::TooCoarse) } else { Ok(run) }
}

/// Drives to a position with little duty, and lets the axis come to rest there.
pub fn go_to<L: Law>(guard: &mut ExperimentGuard<'_, L>, probe: &Probe, position: f64) -> Result<(), Cause> {
    let begin = guard.now_s();
    let here = |guard: &ExperimentGuard<'_, L>| guard.points.last().map_or(0.0, |p| p.counts);
    let direction = (position - here(guard)).signum();
    guard.duty((probe.start_duty + WINDOW.going_duty).min(guard.options.max_duty) * direction)?;
    loop {
        guard.poll(false)?;
        let ahead = guard.recent_speed(2).unwrap_or(0.0) * WINDOW.going_ahead_s;
        if (position - here(guard) - ahead) * direction <= 0.0 {
            break;
        }
        if guard.now_s() - begin > WINDOW.longest_s {
            return Err(Cause::TimeLimit);
        }
    }
    guard.come_to_rest()
}

/// How far the axis runs on when it is turned round: what the turns so far have shown.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// Time until a new duty acts, s.
    acts_s: f64,
    /// What is used of the width, over the usual.
    share: f64,
    /// Speed of the last turn and the distance it took, counts/s and counts.
    last: Option<(f64, f64)>,
}

impl Turn {
    /// The stopping distance from a speed, where the axis has come so far since it last stood.
    fn stopping_distance(&self, speed: f64, since_rest: f64) -> f64 {
        let speed = speed.max(0.0);
        match self.last {
            // Between a distance as the speed (a light motor) and as its square (a heavy one), whichever is longer.
            Some((before, distance)) => {
                let ratio = speed / before;
                distance * ratio * ratio.max(1.0)
            }
            // It needs no longer to stop than it needed to start.
            None => speed * self.acts_s + WINDOW.first_share * since_rest.max(0.0),
        }
    }

    fn learn(&mut self, speed: f64, distance: f64) {
        if speed > 0.0 && distance > 0.0 {
            let expected = self.last.map_or(distance, |(before, distance)| distance * speed / before);
            self.last = Some((speed, distance.max(0.5 * (distance + expected))));
        }
    }
}

/// Oscillates about the middle at one duty. The distance it takes to turn round is learned from each half cycle.
fn oscillate_at<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    duty: f64,
    middle: f64,
    width: f64,
    run: &mut WindowRun,
    turn: &mut Turn,
) -> Result<(), Cause> {
    let start = guard.points.last().map_or(middle, |p| p.counts);
    let mut direction = if start > middle { -1.0 } else { 1.0 };
    guard.duty(duty * direction)?;
    let mut switches = 0;
    let (mut switched_at, mut switch_speed, mut farthest) = (start, 0.0_f64, 0.0_f64);
    let mut since_s = guard.now_s();
    while switches < WINDOW.switches {
        if guard.now_s() - run.from_s > WINDOW.longest_s {
            return Ok(());
        }
        let Some(point) = guard.poll(false)? else { continue };
        let speed = guard.recent_speed(2).unwrap_or(0.0);
        let from_middle = point.counts - middle;
        run.top_speed = run.top_speed.max(speed.abs());
        guard.monitor.full_speed = guard.monitor.full_speed.max(speed.abs());
        run.reach_counts = run.reach_counts.max(from_middle.abs());
        farthest = farthest.max((point.counts - switched_at) * -direction);
        if from_middle.abs() > 0.5 * width {
            return Err(Cause::TravelLimit);
        }
        let turned_at = switched_at - direction * farthest;
        let runs_on = turn.stopping_distance(speed * direction, (point.counts - turned_at) * direction);
        let is_steady = guard
            .recent_speed(12)
            .is_some_and(|before| (speed - before).abs() < WINDOW.steady * run.top_speed);
        let is_long = point.t - since_s > WINDOW.longest_half_cycle_s && is_steady;
        if is_long || from_middle * direction + runs_on >= turn_at(turn) * width {
            since_s = point.t;
            if switches > 0 {
                learn(guard, turn, switch_speed, farthest, duty);
            }
            switched_at = point.counts;
            switch_speed = speed * direction;
            farthest = 0.0;
            direction = -direction;
            guard.duty(duty * direction)?;
            switches += 1;
            run.switches += 1;
        }
    }
    Ok(())
}

fn turn_at(turn: &Turn) -> f64 {
    turn.share * if turn.last.is_some() { WINDOW.turn_at } else { WINDOW.first_turn_at }
}

fn learn<L: Law>(guard: &mut ExperimentGuard<'_, L>, turn: &mut Turn, speed: f64, distance: f64, duty: f64) {
    turn.learn(speed, distance);
    if speed > 0.0 && distance > 0.0 {
        let seconds = (distance / speed).clamp(0.02, 0.6);
        guard.monitor.stopping_s = seconds;
        guard.monitor.tau_bounds_s = Some((0.1 * seconds, 10.0 * seconds));
        guard.monitor.turned(speed, duty, distance);
    }
}

//! Watches a driven motor poll by poll: has it stalled, lost its encoder, its leads, its direction?
//!
//! The rules compare what was counted with what the same motor did a moment ago, so they need no model and no data sheet.

use crate::cause::Cause;
use crate::rig::Point;
use std::collections::VecDeque;

/// How much steeper than it can be a change of speed must look to be none.
const JUMP: f64 = 1.6;
/// A quick motor has turned round after this, s.
const TURNING_S: f64 = 0.3;
/// Longest stretch looked back at, s.
const MEMORY_S: f64 = 0.6;
/// Counts that a turning motor must be expected to give before silence means anything.
const EXPECTED_COUNTS: f64 = 8.0;
/// Least and longest silence that means something, s.
const SILENCE_S: (f64, f64) = (0.12, 0.25);
/// Without current for this long, the motor is open, s.
const OPEN_S: f64 = 0.2;
/// Highest reading that counts as no current, A: the wire's resolution.
const NO_CURRENT_AMPS: f64 = 0.0151;

/// The watch over one motor.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Whether a duty is given, so that motion can be expected.
    armed: bool,
    /// The duty and since when.
    duty: f64,
    since_s: f64,
    /// When the duty last changed its sign.
    turned_s: f64,
    /// Time from braking to rest, s: how long a speed runs on.
    pub stopping_s: f64,
    /// Amperes at full duty with the shaft at rest; `None` before the probe.
    pub stall_amps: Option<f64>,
    /// Duty at which the motor began to move.
    pub start_duty: f64,
    /// Speed at full duty, counts/s, as far as it is known; 0 before.
    pub full_speed: f64,
    /// Smallest steady current of the running motor, A; `None` until one was seen.
    running_amps: Option<f64>,
    open_since_s: Option<f64>,
    /// Motion in the direction of the present duty has been seen.
    follows: bool,
    follows_since_s: f64,
    recent: VecDeque<Point>,
}

impl Watch {
    /// A duty was given.
    pub fn drive(&mut self, t: f64, duty: f64) {
        if duty == 0.0 || duty * self.duty <= 0.0 {
            // From rest or from the other direction: what was moving must first turn round.
            self.follows = false;
            self.since_s = t;
            self.turned_s = t;
        }
        self.armed = duty != 0.0;
        self.duty = duty;
    }

    /// A loop has the motor: only the rules that need no duty hold.
    pub fn release(&mut self, t: f64) {
        self.armed = false;
        self.follows = false;
        self.duty = 0.0;
        self.since_s = t;
    }

    /// Looks at a poll.
    pub fn see(&mut self, point: &Point) -> Result<(), Cause> {
        self.recent.push_back(*point);
        while self.recent.front().is_some_and(|old| point.t - old.t > MEMORY_S) {
            self.recent.pop_front();
        }
        if !self.armed || self.start_duty == 0.0 || self.duty.abs() < self.start_duty + 0.04 {
            self.open_since_s = None;
            return Ok(());
        }
        self.check_direction(point)?;
        self.check_current(point)?;
        self.check_motion(point)
    }

    fn over(&self, seconds: f64) -> Option<(Point, Point)> {
        let last = *self.recent.back()?;
        let first = *self.recent.iter().rev().find(|old| last.t - old.t >= seconds)?;
        Some((first, last))
    }

    /// A motor driven one way cannot, once it turns that way, turn the other.
    fn check_direction(&mut self, point: &Point) -> Result<(), Cause> {
        let Some((first, last)) = self.over(0.02) else { return Ok(()) };
        let speed = (last.counts - first.counts) / (last.t - first.t) * self.duty.signum();
        let floor = (0.04 * self.full_speed).max(4.0 / (last.t - first.t));
        if speed > floor {
            if !self.follows {
                self.follows_since_s = point.t;
            }
            self.follows = true;
        } else if self.follows && speed < -floor && point.t - self.since_s > 0.05 {
            return Err(Cause::EncoderFlipped);
        }
        let settling = point.t - self.turned_s < TURNING_S && self.stopping_s < TURNING_S;
        if settling { Ok(()) } else { self.check_jump() }
    }

    /// Speed that turns its sign at full height between two polls did not come from a motor.
    fn check_jump(&self) -> Result<(), Cause> {
        let newest: Vec<&Point> = self.recent.iter().rev().take(5).collect();
        let [e, d, _, b, a] = newest[..] else { return Ok(()) };
        let (before, after) = ((b.counts - a.counts) / (b.t - a.t), (e.counts - d.counts) / (e.t - d.t));
        let height = before.abs().min(after.abs());
        if self.stopping_s <= 0.0 || before * after > 0.0 || height < 0.15 * self.full_speed {
            return Ok(());
        }
        // The steepest that a motor of this time constant can be, driven from full speed one way to the other.
        let steepest = 2.0 * self.full_speed / self.stopping_s;
        let change = (after - before).abs() / (0.5 * (d.t + e.t - a.t - b.t));
        if change > JUMP * steepest && height * (e.t - d.t) > EXPECTED_COUNTS {
            return Err(Cause::EncoderFlipped);
        }
        Ok(())
    }

    fn check_current(&mut self, point: &Point) -> Result<(), Cause> {
        let Some(amps) = point.amps else { return Ok(()) };
        let steady = point.t - self.since_s > 0.3 && self.follows;
        if steady && amps.abs() > 2.5 * NO_CURRENT_AMPS {
            let lowest = self.running_amps.map_or(amps.abs(), |known| known.min(amps.abs()));
            self.running_amps = Some(lowest);
        }
        if amps.abs() > NO_CURRENT_AMPS {
            self.open_since_s = None;
            return Ok(());
        }
        let since = *self.open_since_s.get_or_insert(point.t);
        let draws = self.running_amps.is_some_and(|running| running > 2.5 * NO_CURRENT_AMPS)
            || self.stall_amps.is_some_and(|stall| stall * 0.015 > 2.0 * NO_CURRENT_AMPS);
        if draws && point.t - since > OPEN_S { Err(Cause::MotorOpened) } else { Ok(()) }
    }

    fn check_motion(&self, point: &Point) -> Result<(), Cause> {
        // What the motor would do at this duty at the least, in the stretch since it was given.
        let expected = 0.35 * self.full_speed * (self.duty.abs() - self.start_duty).max(0.0);
        if expected <= 0.0 {
            return Ok(());
        }
        let silence = (EXPECTED_COUNTS / expected).max(SILENCE_S.0);
        if silence > 3.0 * SILENCE_S.1 || point.t - self.since_s < silence + self.stopping_s.min(0.5) {
            return Ok(());
        }
        let silence = silence.min(MEMORY_S - 0.05);
        let counts = self.recent.iter().filter(|old| point.t - old.t <= silence).map(|old| old.counts);
        let (low, high) = counts.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
        let Some((first, last)) = self.over(silence) else { return Ok(()) };
        // A load behind a spring swings on while the motor is held.
        let gained = (last.counts - first.counts) * self.duty.signum();
        let held = self.follows
            && point.t - self.follows_since_s > silence + 0.05
            && self.pulls_hard()
            && gained < 0.1 * expected * silence;
        if high - low > 1.0 && !held {
            return Ok(());
        }
        let amps = self.recent.iter().rev().find_map(|old| old.amps).map(f64::abs);
        if amps.is_some_and(|amps| amps <= NO_CURRENT_AMPS) {
            return Err(Cause::MotorOpened);
        }
        Err(if self.pulls_hard() { Cause::Stalled } else { Cause::EncoderLost })
    }

    /// Whether the current is that of a motor that is held, or that pulls away from rest.
    #[must_use]
    pub fn pulls_hard(&self) -> bool {
        let Some(newest) = self.recent.back() else { return false };
        // The higher of the last two readings: the current of a load that swings back comes and goes.
        let latest = self.recent.iter().rev().filter_map(|old| old.amps).take(2);
        let amps = latest.map(f64::abs).reduce(f64::max);
        match (amps, self.stall_amps) {
            (Some(amps), Some(stall)) => amps > 0.45 * self.duty.abs() * stall || newest.limited,
            _ => newest.limited,
        }
    }
}

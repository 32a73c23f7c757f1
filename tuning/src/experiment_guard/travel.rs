//! The travel window: an experiment ends before it is left, and a motion near its end is driven back.

use super::{ExperimentGuard, retried};
use crate::axis::{AxisError, FULL_DUTY_RAW, Want};
use crate::cause::Cause;
use crate::law::Law;
use crate::poll::{Drive, Input, Point};
use crate::thresholds::thresholds;
use std::time::Duration;

thresholds! {
    /// When a motor has to turn back to stay within its travel.
    pub(crate) TRAVEL: Thresholds {
        /// Time that a duty takes to change its sign, as far as it counts for the stopping distance, in seconds.
        turning_s: f64 = 0.03,
        /// Longest time that a motion is driven against, in seconds.
        longest_turn_s: f64 = 2.0,
        /// Position limits of an axis that turns freely and has none: the way of so many seconds at full speed to either side of where it stood.
        free_reach_s: f64 = 60.0,
        /// Step to which that way is rounded up, in counts.
        reach_step: f64 = 1_000.0,
        /// How much longer than computed a stopping distance may be, as a factor.
        stopping_doubt: f64 = 1.15,
        /// Time that a lost command costs before it is sent again, in seconds.
        retry_s: f64 = 0.010,
    }
}

impl<L: Law> ExperimentGuard<'_, L> {
    /// How much room there is on either side, as twice the shorter distance to an end of the travel window, counts.
    #[must_use]
    pub fn room_counts(&self) -> Option<f64> {
        let (low, high) = self.travel_counts()?;
        let now = self.points.last()?.counts;
        Some(2.0 * (high - now).min(now - low))
    }

    /// The travel window in counts from the start of the run.
    #[must_use]
    pub fn travel_counts(&self) -> Option<(f64, f64)> {
        let (low, high) = self.options.travel?;
        let origin = self.origin_counts();
        Some(((low - origin) as f64, (high - origin) as f64))
    }

    /// The position limits that belong to the gains: the travel, or, where there is none and the controller's own limits leave no room, what is
    /// near the motor. `None` leaves those that the controller has.
    pub(crate) fn proposed_travel(&self, qpps: f64) -> Option<(i64, i64)> {
        if self.options.travel.is_some() {
            return self.options.travel;
        }
        let (low, high) = L::position_limits(&self.setup.held)?;
        // The casts saturate.
        let reach = ((TRAVEL.free_reach_s * qpps / TRAVEL.reach_step).ceil() * TRAVEL.reach_step) as i64;
        (low >= high).then(|| (self.origin_counts() - reach, self.origin_counts() + reach))
    }

    /// Where the guard last turned a motor back, counts.
    pub(crate) fn turned_at_counts(&self) -> f64 {
        self.turned_at_counts
    }

    /// Ends the run before the window is left: where the motor would come to rest if it were driven back now counts.
    pub(super) fn check_travel(&mut self, point: &Point) -> Result<(), Cause> {
        let Some((low, high)) = self.travel_counts() else { return Ok(()) };
        if self.points.len() == 1 && !(low..=high).contains(&point.counts) {
            return Err(Cause::OutsideTravel);
        }
        self.check_stopping_distance(point, self.recent_speed(2).unwrap_or(0.0))
    }

    fn check_stopping_distance(&mut self, point: &Point, speed: f64) -> Result<(), Cause> {
        let Some((low, high)) = self.travel_counts() else { return Ok(()) };
        let runs_on = match self.monitor.stopping_counts(speed.abs(), self.options.max_duty) {
            Some(counts) => TRAVEL.stopping_doubt * counts * speed.signum() + speed * TRAVEL.turning_s,
            // From rest a motor needs no longer distance to stop than it had to start.
            None => {
                0.7 * self.distance_since_drive(point) + speed * TRAVEL.turning_s.max(self.monitor.stopping_s)
            }
        };
        let rest = point.counts + speed * (self.options.poll_s + TRAVEL.retry_s) + runs_on;
        if (rest > high && speed > 0.0) || (rest < low && speed < 0.0) {
            self.turn_back(speed);
            return Err(Cause::TravelLimit);
        }
        Ok(())
    }

    /// The same while no reply comes: the motor goes on at least as it did, and gains speed as it did, up to what its duty gives.
    pub(super) fn check_unseen(&mut self) -> Result<(), Cause> {
        let (Some(last), Some(speed)) = (self.points.last().copied(), self.recent_speed(2)) else {
            return Ok(());
        };
        let now_s = self.now_s();
        let unseen_s = (now_s - last.t).max(0.0);
        let gained = self.pull(speed).map_or(0.0, |(pull, over_s)| pull * unseen_s.max(over_s));
        let (gain, _) = self.monitor.rough_model(0.0);
        let most = if gain > 0.0 { gain * self.monitor.duty_at(now_s).abs() } else { f64::INFINITY };
        let speed = speed + gained.min((most - speed.abs()).max(0.0)) * speed.signum();
        self.check_stopping_distance(&Point { counts: last.counts + speed * unseen_s, ..last }, speed)
    }

    /// By how much a speed, that of the last two polls, grows in a second, and over which time that was seen, s. `None` where it does not.
    fn pull(&self, speed: f64) -> Option<(f64, f64)> {
        let [a, b, c, d] = self.points.last_chunk::<4>()?;
        if b.t <= a.t {
            return None;
        }
        let before = (b.counts - a.counts) / (b.t - a.t);
        let over_s = 0.5 * (c.t + d.t - a.t - b.t);
        let grown = (speed - before) * speed.signum();
        (grown > 0.0 && over_s > 0.0).then(|| (grown / over_s, over_s))
    }

    /// Counts gone under the first duty from rest; 0 later.
    fn distance_since_drive(&self, point: &Point) -> f64 {
        let [.., Drive { input: Input::Duty(0.0), .. }, Drive { t: since, .. }] = self.drives[..] else {
            return 0.0;
        };
        let first = self.points.iter().rev().take_while(|old| old.t >= since).last();
        first.map_or(0.0, |first| point.counts - first.counts)
    }

    /// Drives against a motion until it is over, so that an axis near the end of its window does not run on beyond it.
    fn turn_back(&mut self, speed: f64) {
        if !self.facts.has_duty {
            let _ = retried(|| self.axis.drive_duty(0));
            return;
        }
        let raw = (-speed.signum() * self.options.max_duty * f64::from(FULL_DUTY_RAW)) as i16;
        if retried(|| self.axis.drive_duty(raw)).is_err() {
            return;
        }
        let until = self.axis.now() + Duration::from_secs_f64(TRAVEL.longest_turn_s);
        let mut before: Option<Point> = None;
        while self.axis.now() < until {
            match self.axis.sample(Want::default()).map(|sample| self.point_of(&sample)) {
                Ok(now) => {
                    if before.is_some_and(|before| (now.counts - before.counts) * speed <= 0.0) {
                        break;
                    }
                    self.turned_at_counts = now.counts;
                    before = Some(now);
                }
                Err(AxisError::NoReply | AxisError::Late) => {}
                Err(_) => break,
            }
            let next = self.axis.now() + Duration::from_secs_f64(0.5 * self.options.poll_s);
            if self.axis.wait_until(next).is_err() {
                break;
            }
        }
        let _ = self.axis.drive_duty(0);
        let now_s = self.now_s();
        self.monitor.forget(now_s);
    }
}

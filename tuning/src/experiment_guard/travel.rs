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
        /// Share of the way that a motor took to start which it takes at most to stop.
        started_share: f64 = 0.7,
        /// Least duty above the starting one that a motion is driven against with, as a share of full.
        least_push: f64 = 0.2,
        /// Share of a speed below which it counts as over.
        over_share: f64 = 0.1,
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
        let most_duty = self.options.max_duty;
        // How far it runs on, and what stops it within which way.
        let (runs_on, push) = match self.monitor.stopping_counts(speed.abs(), most_duty) {
            Some(counts) => {
                let counts = TRAVEL.stopping_doubt * counts;
                (counts * speed.signum() + speed * TRAVEL.turning_s, (most_duty, counts))
            }
            // From rest a motor needs no longer distance to stop than it had to start, at the duty that it had.
            None => {
                let started = TRAVEL.started_share * self.distance_since_drive(point);
                // What went the other way since is no way that it took to start in this one.
                let runs_on = (started * speed.signum()).max(0.0) * speed.signum();
                let now_s = self.now_s();
                let least_duty = self.monitor.start_duty + TRAVEL.least_push;
                let duty = self.monitor.duty_at(now_s).abs().max(least_duty).min(most_duty);
                (runs_on + speed * TRAVEL.turning_s.max(self.monitor.stopping_s), (duty, started.abs()))
            }
        };
        // No push is shorter than a command takes.
        let runs_on = runs_on.abs().max(0.5 * self.options.poll_s * speed.abs()) * speed.signum();
        let rest = point.counts + speed * (self.options.poll_s + TRAVEL.retry_s) + runs_on;
        if (rest > high && speed > 0.0) || (rest < low && speed < 0.0) {
            self.turn_back(speed, push);
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
        // One that is being turned round has its newest speed, or less, and not that of the polls before.
        let is_turned = self.monitor.duty_at(last.t) * speed < 0.0;
        let speed = self.recent_speed(1).filter(|_| is_turned).unwrap_or(speed);
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

    /// Drives against a motion until it is over, so that an axis near the end of its window does not run on beyond it: at a duty, for as long as the way takes that it needs to
    /// stop then. Where that is shorter than the time between two polls nobody sees when it is over, and a motor that is driven on would be out at the other end; where it is
    /// shorter than a command may take, less duty does it in that time.
    fn turn_back(&mut self, speed: f64, (duty, stopping_counts): (f64, f64)) {
        if !self.facts.has_duty {
            let _ = retried(|| self.axis.drive_duty(0));
            return;
        }
        let full_raw = -speed.signum() * duty * f64::from(FULL_DUTY_RAW);
        let until = self.axis.now() + Duration::from_secs_f64(TRAVEL.longest_turn_s);
        // A constant force takes twice as long to stop a speed as the speed takes for the way.
        let ramp_s = if self.monitor.is_abrupt { 0.0 } else { TRAVEL.turning_s };
        let mut push_s = ramp_s + 2.0 * stopping_counts / speed.abs();
        self.turned_at_counts = self.points.last().map_or(0.0, |last| last.counts);
        while self.axis.now() < until {
            let end = self.axis.now() + Duration::from_secs_f64(push_s);
            let raw = (full_raw * (push_s / self.options.poll_s).min(1.0)) as i16;
            // A command whose reply is lost may have been heard, and waiting for the reply took longer than the push.
            if !matches!(self.axis.drive_duty(raw), Ok(_) | Err(AxisError::NoReply | AxisError::Late)) {
                break;
            }
            let is_over = self.watched_until(end, speed);
            if retried(|| self.axis.drive_duty(0)).is_err() || is_over {
                break;
            }
            let share = self.speed_now().map_or(0.0, |now| now / speed);
            if share < TRAVEL.over_share {
                break;
            }
            push_s = ramp_s + (push_s - ramp_s) * share.min(1.0);
        }
        let _ = self.axis.drive_duty(0);
        // What it was pushed back too far, the brake takes.
        let is_fast = |now: f64| now.abs() > TRAVEL.over_share * speed.abs();
        while self.axis.now() < until && self.speed_now().is_some_and(is_fast) {}
        let now_s = self.now_s();
        self.monitor.forget(now_s);
    }

    /// Whether a motion is seen to be over before `end`; nobody looks where no answer would come in time.
    fn watched_until(&mut self, end: Duration, speed: f64) -> bool {
        let poll = Duration::from_secs_f64(self.options.poll_s);
        let mut before: Option<Point> = None;
        while self.axis.now() + poll < end {
            match self.axis.sample(Want::default()).map(|sample| self.point_of(&sample)) {
                Ok(now) => {
                    if before.is_some_and(|before| (now.counts - before.counts) * speed <= 0.0) {
                        return true;
                    }
                    self.turned_at_counts = now.counts;
                    before = Some(now);
                }
                Err(AxisError::NoReply | AxisError::Late) => {}
                Err(_) => return true,
            }
            let next = self.axis.now() + poll / 2;
            if self.axis.wait_until(next).is_err() {
                return true;
            }
        }
        self.axis.wait_until(end).is_err()
    }

    /// The speed of a motor that is braked, counts/s; `None` where nothing answers.
    fn speed_now(&mut self) -> Option<f64> {
        let first = self.seen_now()?;
        let next = self.axis.now() + Duration::from_secs_f64(0.5 * self.options.poll_s);
        self.axis.wait_until(next).ok()?;
        let second = self.seen_now()?;
        (second.t > first.t).then(|| (second.counts - first.counts) / (second.t - first.t))
    }

    /// What one poll shows now; it stays among those of the run, so that a motion nobody polled is no reset later.
    fn seen_now(&mut self) -> Option<Point> {
        let sample = retried(|| self.axis.sample(Want::default())).ok()?;
        let point = self.point_of(&sample);
        self.turned_at_counts = point.counts;
        self.points.push(point);
        Some(point)
    }
}

//! One poll after the other, and what each is held against: the link, the status, the battery, the current, a reset.

use super::{ExperimentGuard, cause_of, retried};
use crate::axis::{
    ABSOLUTE_COUNTS, AMPS_PER_RAW, AxisError, EncoderClass, Exchange, FULL_DUTY_RAW, Sample, VOLTS_PER_RAW,
    Want,
};
use crate::cause::Cause;
use crate::law::Law;
use crate::pace::quantile;
use crate::poll::{Drive, Input, Point};
use crate::thresholds::thresholds;
use std::time::Duration;

thresholds! {
    /// What one poll may show: current, late answers, lost answers, a reset.
    POLLING: Thresholds {
        /// Time between close polls, as a share of that between the usual ones, where the line is that quick: counts and duty alone take two exchanges of four.
        close_share: f64 = 0.4,
        /// Reading beyond which the current was not held, as a multiple of the highest current that is allowed.
        peak_over_limit: f64 = 1.25,
        /// What is added to that, in amperes.
        peak_amps: f64 = 0.1,
        /// How many such readings in a row end a run.
        beyond_polls: u32 = 3,
        /// How many of the latest polls the usual time of an exchange is taken from.
        usual_polls: usize = 17,
        /// How much longer than the usual one a prompt exchange may take, in seconds.
        late_s: f64 = 0.004,
        /// Silence after which the link counts as lost, in seconds.
        link_lost_s: f64 = 0.15,
        /// Polls in a row that must have gone without a reply too: on a slow line a few lost replies take as long.
        link_lost_polls: u32 = 5,
        /// How long after the last good reading a driven motor is off at the latest, in seconds (SAFETY.md: a motion command lives 250 ms).
        off_within_s: f64 = 0.25,
        /// Longest time between two readings with which that can be kept, in seconds: one reading, one that is waited for in vain, and the command.
        slowest_reading_s: f64 = 0.1,
        /// Readings that show a line to be slower than that: each of so many in a row would have to be late on a quicker line.
        line_readings: usize = 5,
        /// Counts that began anew are told from a motor that moved by a jump of more than this many times what full speed makes in the time since the
        /// last poll: twice, since that time is known to a poll at each end and full speed to a few percent.
        reset_reach: f64 = 2.0,
        /// Where hardly any time went by, so many counts are no jump: a step of the duty and the rounding of the time make a few.
        reset_counts: f64 = 60.0,
    }
}

impl<L: Law> ExperimentGuard<'_, L> {
    /// The next poll when its time has come; `None` when its reply was lost. `with_duty` reads the duty each time.
    pub fn poll(&mut self, with_duty: bool) -> Result<Option<Point>, Cause> {
        let want = Want {
            duty: with_duty,
            current: !self.turn.wrapping_add(1).is_multiple_of(4),
            volts: self.turn.wrapping_add(1).is_multiple_of(4),
        };
        self.poll_for_all_of(want, self.options.poll_s)
    }

    /// Polls counts and duty for so long, as closely as the line goes: what else is read takes every fourth turn. A slow line is polled as usual: closer is not
    /// to be had, and a current that is read too seldom looks like an open motor. So are controllers whose registers are written at rest only, on lines of text.
    pub fn poll_closely_for(&mut self, seconds: f64) -> Result<(), Cause> {
        if self.facts.writes_at_rest
            || self.usual_exchange_s().is_none_or(|usual_s| usual_s > self.options.poll_s)
        {
            return self.poll_for(seconds, true);
        }
        let end = self.now_s() + seconds;
        while self.now_s() < end {
            let want = Want { duty: true, current: self.turn.is_multiple_of(4), volts: false };
            self.poll_for_all_of(want, POLLING.close_share * self.options.poll_s)?;
        }
        Ok(())
    }

    /// One poll, and the earliest time of the next.
    fn poll_for_all_of(&mut self, want: Want, every_s: f64) -> Result<Option<Point>, Cause> {
        self.axis.wait_until(self.next_poll).map_err(|error| cause_of(&error))?;
        let now = self.axis.now();
        self.next_poll = now.max(self.next_poll) + Duration::from_secs_f64(every_s);
        let now_s = now.as_secs_f64() - self.epoch_s;
        if now_s > self.options.time_limit_s {
            return Err(Cause::TimeLimit);
        }
        self.turn = self.turn.wrapping_add(1);
        let sample = self.axis.sample(want);
        self.note_stolen();
        let sample = match sample {
            Ok(sample) => sample,
            Err(AxisError::NoReply | AxisError::Late) => {
                // Counted from the first poll without a reply: between experiments nobody asks for a while.
                let since_s = *self.silent_since_s.get_or_insert(now_s);
                self.silent_polls += 1;
                let silent_s = self.now_s() - since_s;
                let is_lost = silent_s > POLLING.link_lost_s && self.silent_polls >= POLLING.link_lost_polls;
                if is_lost || self.cannot_wait(now_s) {
                    // Whose the silence was is asked when the motor has been stopped.
                    return Err(Cause::LinkLost);
                }
                return self.check_unseen().map(|()| None);
            }
            Err(error) => return Err(cause_of(&error)),
        };
        (self.silent_since_s, self.silent_polls) = (None, 0);
        let before = self.points.last().map(|point| (point.t, point.counts));
        let point = self.point_of(&sample);
        if before.is_some_and(|before| self.counts_anew(before, &point, sample.counts_at)) {
            return Err(Cause::WasReset);
        }
        let unreported = [
            want.duty && sample.duty_raw.is_none(),
            want.current && sample.current_raw.is_none(),
            want.volts && sample.volts_raw.is_none(),
        ];
        for (known, found) in self.unreported.iter_mut().zip(unreported) {
            if found && !std::mem::replace(known, true) {
                // It was asked in vain, several times after the counts, which is nobody's lateness.
                self.pace.pause();
            }
        }
        if sample.status.fault {
            return Err(L::fault(&self.setup.held, sample.status.raw));
        }
        let floor = f64::from(self.setup.min_volts_raw) * VOLTS_PER_RAW + self.options.volts_margin;
        let sagging = self.setup.min_volts_raw > 0 && point.volts.is_some_and(|volts| volts < floor);
        if sample.status.battery_low || sagging {
            return Err(Cause::BatteryLow);
        }
        self.check_highest_current(&point)?;
        self.points.push(point);
        let took = sample.counts_at.received.saturating_sub(sample.counts_at.sent);
        self.exchanges.push((point.t, took.as_secs_f64()));
        self.check_travel(&point)?;
        if !self.is_prompt(took.as_secs_f64()) {
            self.monitor.read_duty(&point);
            return Ok(Some(point));
        }
        match self.monitor.see(&point) {
            Err(guess) => Err(self.name_fault(guess)),
            Ok(()) => Ok(Some(point)),
        }
    }

    /// Polls for a time.
    pub fn poll_for(&mut self, seconds: f64, with_duty: bool) -> Result<(), Cause> {
        let end = self.now_s() + seconds;
        while self.now_s() < end {
            self.poll(with_duty)?;
        }
        Ok(())
    }

    /// Puts the next poll off.
    pub(crate) fn defer(&mut self, seconds: f64) {
        self.next_poll = self.axis.now() + Duration::from_secs_f64(seconds);
    }

    /// The unfiltered speed.
    pub fn raw_speed(&mut self) -> Result<i32, Cause> {
        retried(|| self.axis.raw_speed())
    }

    /// Refuses a line on which a motor could not be switched off in time after lost replies: the quickest of some readings of a motor that has not
    /// been driven shows what the line takes by itself. A computer that was late for most of that time was not kept waiting by the line.
    pub(crate) fn refuse_slow_line(&mut self) -> Result<(), Cause> {
        if self.setup.stream_timeout_ms.is_none() {
            return Ok(());
        }
        loop {
            let gaps = self.points.windows(2).map(|pair| pair[1].t - pair[0].t);
            let quickest_s = gaps.fold(f64::INFINITY, f64::min);
            if quickest_s <= POLLING.slowest_reading_s {
                return Ok(());
            }
            if self.points.len() > POLLING.line_readings {
                let too_slow = Cause::LineTooSlow { reading_ms: (1e3 * quickest_s).round() as u32 };
                return Err(self.pace.computer_late().map_or(too_slow, |late| self.answered_late(late)));
            }
            self.poll(false)?;
        }
    }

    /// Whether another silent poll as long as the one that began at `began_s` would leave a driven motor driven for too long after the last good reading. The
    /// controller's own time-out does not help: where only replies are lost, these polls feed it.
    fn cannot_wait(&mut self, began_s: f64) -> bool {
        let is_driven = self.drives.last().is_some_and(|last| last.input != Input::Duty(0.0));
        let Some(last_s) = self.points.last().map(|point| point.t) else { return false };
        let now_s = self.now_s();
        let next_s = now_s - began_s + self.options.poll_s + self.usual_exchange_s().unwrap_or(0.0);
        // Between experiments nobody asks for a while, which is no silence.
        let silent_s = now_s - last_s.max(began_s - 2.0 * self.options.poll_s);
        self.setup.stream_timeout_ms.is_some() && is_driven && silent_s + next_s > POLLING.off_within_s
    }

    /// Whether an exchange took hardly longer than its predecessors: when the counts of a longer one were read is open, which would
    /// look like a jerk of the motor.
    fn is_prompt(&self, took_s: f64) -> bool {
        self.usual_exchange_s().is_none_or(|usual| took_s <= usual + POLLING.late_s)
    }

    /// How long an exchange took of late, s: the one that a quarter were quicker than, since a busy host makes only longer ones.
    pub(super) fn usual_exchange_s(&self) -> Option<f64> {
        let recent = &self.exchanges[self.exchanges.len().saturating_sub(POLLING.usual_polls)..];
        let took_s: Vec<f64> = recent.iter().map(|exchange| exchange.1).collect();
        quantile(&took_s, 0.25)
    }

    /// Speed over the last `polls` polls, counts/s; `None` with fewer.
    #[must_use]
    pub fn recent_speed(&self, polls: usize) -> Option<f64> {
        let last = self.points.last()?;
        let earlier = self.points.get(self.points.len().checked_sub(polls + 1)?)?;
        (last.t > earlier.t).then(|| (last.counts - earlier.counts) / (last.t - earlier.t))
    }

    /// Mean battery voltage so far; `None` before the first reading.
    #[must_use]
    pub fn mean_volts(&self, from_s: f64, to_s: f64) -> Option<f64> {
        let volts: Vec<f64> =
            self.points.iter().filter(|p| p.t >= from_s && p.t <= to_s).filter_map(|p| p.volts).collect();
        (!volts.is_empty()).then(|| volts.iter().sum::<f64>() / volts.len() as f64)
    }

    /// The controller holds the current at its limit but for short peaks; what stays beyond it was not held.
    fn check_highest_current(&mut self, point: &Point) -> Result<(), Cause> {
        let (Some(most), Some(amps)) = (self.options.max_amps, point.amps) else { return Ok(()) };
        self.beyond =
            if amps.abs() > POLLING.peak_over_limit * most + POLLING.peak_amps { self.beyond + 1 } else { 0 };
        if self.beyond >= POLLING.beyond_polls { Err(Cause::OverCurrent) } else { Ok(()) }
    }

    /// Whether the counts are near 0 where no motor could have gone to since the poll before: the controller was reset, and its gains and its
    /// time-out are those of its EEPROM.
    /// When in an exchange the counts were read is open, so that the time between is the longest that there can have been. A motor whose time constant is
    /// not known yet may still gather speed the way it is driven, past 0 too.
    pub(super) fn counts_anew(
        &self,
        (before_s, counts): (f64, f64),
        point: &Point,
        counts_at: Exchange,
    ) -> bool {
        let full_speed = self.monitor.full_speed;
        let took_before_s = self.exchanges.last().map_or(0.0, |exchange| exchange.1);
        let longest_s = counts_at.received.as_secs_f64() - self.epoch_s - before_s + 0.5 * took_before_s;
        // Strokes in a travel have never shown it, only what a lower duty gives.
        let fastest = full_speed.max(self.monitor.rough_model(0.0).0);
        let reach = POLLING.reset_reach * fastest * longest_s + POLLING.reset_counts;
        let step = point.counts - counts;
        let gathers_speed = self.monitor.tau_bounds_s.is_none()
            && matches!(self.drives.last(), Some(Drive { input: Input::Duty(duty), .. }) if duty * step > 0.0);
        self.setup.encoder == EncoderClass::Quadrature
            && full_speed > 0.0
            && step.abs() > reach
            && !gathers_speed
            && (self.last_raw as f64).abs() < reach.min(0.5 * step.abs())
    }

    /// Counts from the start of the run, beyond the wrap of the register or of the absolute encoder.
    fn unwrap(&mut self, raw: i32) -> i64 {
        let raw = i64::from(raw);
        let Some(first) = self.first_counts else {
            self.first_counts = Some(raw);
            self.last_raw = raw;
            return 0;
        };
        let turn = match self.setup.encoder {
            EncoderClass::Quadrature => 1_i64 << 32,
            EncoderClass::AbsoluteWrapping => ABSOLUTE_COUNTS,
            EncoderClass::Absolute => i64::MAX,
        };
        let half = turn / 2;
        let mut step = raw - self.last_raw.rem_euclid(turn);
        if self.setup.encoder == EncoderClass::Quadrature {
            step = i64::from((raw as i32).wrapping_sub(self.last_raw as i32));
        } else if self.setup.encoder == EncoderClass::Absolute {
            step = raw - self.last_raw;
        } else if step > half {
            step -= turn;
        } else if step < -half {
            step += turn;
        }
        self.last_raw += step;
        self.last_raw - first
    }

    pub(super) fn point_of(&mut self, sample: &Sample) -> Point {
        self.pace.answered(&sample.counts_at);
        let counts = self.unwrap(sample.counts[self.options.motor.min(1)]);
        let epoch_s = self.epoch_s;
        Point {
            t: sample.counts_at.middle_s() - epoch_s,
            counts: counts as f64,
            duty: sample
                .duty_raw
                .map(|(at, raw)| (at.middle_s() - epoch_s, f64::from(raw) / f64::from(FULL_DUTY_RAW))),
            amps: sample.current_raw.map(|raw| f64::from(raw) * AMPS_PER_RAW),
            volts: sample.volts_raw.map(|raw| f64::from(raw) * VOLTS_PER_RAW),
            limited: sample.status.over_current,
        }
    }
}

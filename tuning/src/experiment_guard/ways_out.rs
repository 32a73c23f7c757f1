//! The ways out: to rest, to the name of a fault, and back to what the controller held.

use super::travel::TRAVEL;
use super::{ExperimentGuard, cause_of, retried, wait_for_rest};
use crate::axis::{AxisError, Want};
use crate::cause::Cause;
use crate::diagnosis::{DIAGNOSIS, diagnose};
use crate::law::{Ending, Law};
use crate::poll::Point;
use crate::thresholds::thresholds;
use std::time::Duration;

thresholds! {
    /// How a motor is held and brought to rest when a run ends early.
    WAYS_OUT: Thresholds {
        /// Time that a motor runs on for beyond which it is heavy, in seconds.
        heavy_s: f64 = 0.05,
        /// Duty above the starting one that brings a heavy motor to rest, as a share of full.
        resting_duty: f64 = 0.25,
        /// How long a motor is watched then, in seconds.
        resting_s: f64 = 0.15,
    }
}

impl<L: Law> ExperimentGuard<'_, L> {
    /// The last act on every way out: duty 0 three times; the old gains, unless the run keeps its own; the old time-out.
    pub fn finish(&mut self, keep_gains: bool) {
        for _ in 0..3 {
            // Whatever the answer: there is nothing else to try, and the stream time-out stands behind it.
            let _ = self.axis.drive_duty(0);
        }
        self.put_back(keep_gains);
    }

    /// Puts back what the run has changed. What cannot be said now is left to whoever owns the link.
    pub(super) fn put_back(&mut self, keep_gains: bool) {
        let before = self.setup;
        let ending = Ending {
            kept: self.kept.as_ref().filter(|_| keep_gains),
            is_touched: self.gains_touched,
            stays_off: self.stays_off,
        };
        for write in L::ending(&before.held, ending) {
            let _ = retried(|| self.axis.write(write));
        }
        if self.limits_touched {
            let _ =
                retried(|| self.axis.write_current_limits(before.max_current_raw, before.min_current_raw));
        }
        if self.winding_touched {
            wait_for_rest(self.axis);
            let _ = retried(|| self.axis.write_winding(before.inductance_resistance_raw));
        }
        if let (true, Some(timeout_ms)) = (self.timeout_touched, before.stream_timeout_ms) {
            let _ = retried(|| self.axis.set_stream_timeout(timeout_ms));
        }
    }

    /// Brings the motor to rest: a heavy one runs on for long when it is only braked, so it is driven against first.
    pub fn come_to_rest(&mut self) -> Result<(), Cause> {
        let speed = self.recent_speed(2).unwrap_or(0.0);
        let heavy = self.monitor.stopping_s > WAYS_OUT.heavy_s
            || self.monitor.tau_bounds_s.is_some_and(|tau| tau.1 > WAYS_OUT.heavy_s);
        if heavy && speed.abs() > 0.02 * self.monitor.full_speed {
            let duty = (self.monitor.start_duty + WAYS_OUT.resting_duty).min(self.options.max_duty);
            self.duty(-speed.signum() * duty)?;
            let until = self.now_s() + TRAVEL.longest_turn_s;
            while self.now_s() < until && self.recent_speed(2).is_some_and(|now| now * speed > 0.0) {
                self.poll(false)?;
            }
        }
        self.duty(0.0)?;
        self.poll_for(WAYS_OUT.resting_s, false)
    }

    /// The motor left where a loop was to hold it: takes the duty away and names why.
    pub(crate) fn strayed(&mut self) -> Cause {
        self.name_fault(Cause::EncoderFlipped)
    }

    /// Takes the duty away and watches what the motor does then, which distinguishes the faults. `guess` stands where nothing more
    /// is heard.
    pub(super) fn name_fault(&mut self, guess: Cause) -> Cause {
        if guess == Cause::MotorOpened {
            return guess;
        }
        let alarm_s = match retried(|| self.axis.drive_duty(0)) {
            Ok(exchange) => exchange.middle_s() - self.epoch_s,
            Err(cause) => return cause,
        };
        self.monitor.drive(alarm_s, 0.0);
        let mut after: Vec<Point> = self.points.last().copied().into_iter().collect();
        let mut heard = 0;
        while self.now_s() < alarm_s + DIAGNOSIS.diagnosis_s {
            let next = self.axis.now() + Duration::from_secs_f64(self.options.poll_s);
            match self.axis.sample(Want { current: true, ..Want::default() }) {
                Ok(sample) => {
                    after.push(self.point_of(&sample));
                    heard += 1;
                }
                Err(AxisError::NoReply | AxisError::Late) => {}
                Err(error) => return cause_of(&error),
            }
            if let Err(error) = self.axis.wait_until(next) {
                return cause_of(&error);
            }
        }
        // What is not heard any more has shown nothing.
        if heard == 0 {
            return Cause::LinkLost;
        }
        // A motor that has never turned any other way shows no change that could be diagnosed.
        if guess == Cause::EncoderFlipped && self.monitor.never_turned() {
            return guess;
        }
        diagnose(&self.monitor, alarm_s, &after)
    }
}

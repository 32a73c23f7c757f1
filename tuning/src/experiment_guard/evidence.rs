//! What a run concludes: a cause that names the machine stands only on answers that came in time and currents that are clear of their noise.

use super::{ExperimentGuard, retried, wait_for_rest};
use crate::cause::{Cause, Whose};
use crate::current_silence::SILENCE;
use crate::law::Law;
use crate::motor_monitor::MotorMonitor;
use crate::pace::{Late, Pace};
use crate::poll::{Drive, Input, Point};
use crate::thresholds::thresholds;

thresholds! {
    /// Which readings of a motor that is driven count as evidence.
    EVIDENCE: Thresholds {
        /// Readings of the current that are looked at before a fault is named by it.
        driven_readings: usize = 6,
        /// How many times the highest reading at rest their median must be: noise that reached 1 among the dozen readings at rest does not have its middle at 3.
        above_rest: f64 = 3.0,
    }
}

impl<L: Law> ExperimentGuard<'_, L> {
    /// What a run is refused for. A cause that names the machine stands only if all answers were on time, since the bounds of the guard
    /// and the model come from the whole run; and one that was named by the current only if that was clear of its noise.
    pub(crate) fn concluded(&mut self, cause: Cause) -> Cause {
        if cause == Cause::LinkLost {
            return self.silence_named();
        }
        // Without a duty no current names anything, and places are dated.
        if !self.options.weighs_evidence || !self.facts.has_duty {
            return cause;
        }
        // Answers on time that tell the same as late ones did before are to be believed: the motor was brought to rest in between, and what had struck was there from
        // the start then.
        let seen_before = self.kept_cause.filter(|kept| *kept == cause || kept.at_the_start() == Some(cause));
        let kept = self.kept_late.filter(|_| seen_before.is_none());
        let late = self.late_for(cause).or(kept).filter(|_| cause.is_of_motion());
        if let Some(late) = late {
            return self.answered_late(late);
        }
        let cause = seen_before.unwrap_or(cause);
        // An open motor is named by a current that was clear before, and is none now.
        let by_latest = cause.is_by_current() && cause != Cause::MotorOpened;
        if by_latest && self.is_current_unclear() { Cause::CurrentUnclear } else { cause }
    }

    /// What of the answers of this stretch was too late to conclude a cause from them.
    pub(crate) fn late_for(&mut self, cause: Cause) -> Option<Late> {
        let now_s = self.axis.now().as_secs_f64();
        let took_s: Vec<f64> =
            self.exchanges[self.stretch_from..].iter().map(|exchange| exchange.1).collect();
        // What struck in mid-run was told by the last polls.
        let late = if cause.at_the_start().is_some() {
            self.pace.late_gap_before(now_s)
        } else {
            self.pace.late_gap()
        };
        late.or_else(|| self.pace.unsteady(&took_s))
    }

    pub(super) fn answered_late(&self, late: Late) -> Cause {
        let (longest_gap_ms, at_ms) = self.milliseconds(late);
        Cause::AnsweredLate { longest_gap_ms, at_ms, whose: late.whose() }
    }

    /// A gap and when it ended, from the start of the run, ms.
    fn milliseconds(&self, late: Late) -> (u32, u32) {
        let ms = |seconds: f64| (1e3 * seconds).round().max(0.0) as u32;
        (ms(late.longest_s), ms(late.at_s - self.epoch_s))
    }

    /// Does a stretch of the run, and does it again, up to a number of times and as long as the time limit allows, where this computer answered late meanwhile: what was
    /// seen then says nothing. The last time, or where the limit cuts the next one short, figures that came of it count, and are marked. `anew` says whether nothing is known of the motor before.
    pub(crate) fn stretch<T, R: Clone>(
        &mut self,
        anew: bool,
        report: &mut R,
        mark: impl Fn(&mut R, Cause),
        mut work: impl FnMut(&mut Self, &mut R) -> Result<T, Cause>,
    ) -> Result<T, Cause> {
        if self.options.late_tries == 0 {
            return work(self, report);
        }
        let (before, monitor) = (report.clone(), self.monitor.clone());
        // What came late and was done again all the same.
        let mut kept = None;
        loop {
            (self.pace, self.stretch_from) = (Pace::default(), self.exchanges.len());
            let began_s = self.now_s();
            let seen = work(self, report);
            let cause = seen.as_ref().err().copied();
            let outcome = seen.map_err(|cause| self.concluded(cause));
            let late = self.pace.late_gap();
            let is_late = match outcome {
                Ok(_) => late.is_some(),
                Err(cause) => matches!(cause, Cause::AnsweredLate { .. }),
            };
            let would_end_s = 2.0 * self.now_s() - began_s;
            let is_time_left = would_end_s < self.options.time_limit_s;
            if is_late && self.tries < self.options.late_tries && is_time_left {
                self.tries += 1;
                // What is concluded after that is held against it too: the motor may have been left in another state than a run leaves it in.
                self.kept_late = self.kept_late.or(late).or(self.pace.longest());
                self.kept_cause = cause;
                let seen = std::mem::replace(report, before.clone());
                let whose = match &outcome {
                    Err(Cause::AnsweredLate { whose, .. }) => *whose,
                    Ok(_) | Err(_) => late.map_or(Whose::default(), |late| late.whose()),
                };
                self.begin_again(anew, &monitor, whose)?;
                kept = outcome.ok().zip(late).map(|(outcome, late)| (seen, outcome, late)).or(kept);
                continue;
            }
            let (outcome, late) = match kept.filter(|_| cause == Some(Cause::TimeLimit)) {
                Some((seen, outcome, late)) => {
                    *report = seen;
                    (Ok(outcome), Some(late))
                }
                None => (outcome, late),
            };
            self.kept_cause = self.kept_cause.filter(|_| outcome.is_err());
            if let Some(late) = late.filter(|_| outcome.is_ok()) {
                let (longest_gap_ms, at_ms) = self.milliseconds(late);
                mark(report, Cause::TakenLate { longest_gap_ms, at_ms, whose: late.whose() });
                self.kept_late = Some(late);
            }
            return outcome;
        }
    }

    /// Brings the motor to rest and forgets what was seen of it since a stretch began.
    fn begin_again(&mut self, anew: bool, monitor: &MotorMonitor, whose: Whose) -> Result<(), Cause> {
        self.progress(match whose {
            Whose::Computer => "This computer answered late: doing that again",
            Whose::Line => "Replies came late: doing that again",
        });
        retried(|| self.axis.drive_duty(0))?;
        wait_for_rest(self.axis);
        self.monitor = monitor.clone();
        (self.silent_since_s, self.silent_polls, self.beyond) = (None, 0, 0);
        let now_s = self.now_s();
        self.monitor.forget(now_s);
        if anew {
            self.points.clear();
            self.drives.clear();
            self.exchanges.clear();
        } else {
            self.drives.push(Drive { t: now_s, input: Input::Duty(0.0) });
        }
        self.next_poll = self.axis.now();
        Ok(())
    }

    /// Whether the current of the driven motor, as last read, could be the noise of readings at rest.
    fn is_current_unclear(&self) -> bool {
        let noise_amps = self.monitor.highest_rest_amps;
        if noise_amps <= SILENCE.no_current_amps {
            return false;
        }
        let is_driven =
            |point: &&Point| self.monitor.duty_at(point.t).abs() > self.monitor.start_duty.max(0.03);
        let driven = self.points.iter().rev().filter(is_driven).filter_map(|point| point.amps);
        let mut driven: Vec<f64> = driven.map(f64::abs).take(EVIDENCE.driven_readings).collect();
        driven.sort_by(f64::total_cmp);
        driven.get(driven.len() / 2).is_none_or(|amps| *amps <= EVIDENCE.above_rest * noise_amps)
    }
}

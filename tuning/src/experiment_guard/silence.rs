//! A controller that stopped answering: lost, or late, and through whom.
//!
//! Silence alone tells neither. So the motor is stopped first, and the controller asked some more: what never answers is lost; what answers
//! again was late, and the times at which this computer asked and read say whether it was late itself.

use super::ExperimentGuard;
use crate::axis::{AxisError, Want};
use crate::cause::Cause;
use crate::law::Law;
use crate::pace::Late;
use crate::thresholds::thresholds;
use std::time::Duration;

thresholds! {
    /// How often and how long an answer is asked for again.
    UNANSWERED: Thresholds {
        /// How often a silent controller is asked again at the least, each time for as long as the line waits for a reply.
        asked_again: u32 = 5,
        /// For how long it is asked at the least, in seconds: a computer or a radio that stands still for a third of a second comes back within that.
        asked_again_s: f64 = 0.5,
    }
}

/// What came of asking.
enum Answer {
    /// An answer, and the silence before it.
    After(Late),
    /// None, or what ended the asking.
    Ended(Cause),
}

impl<L: Law> ExperimentGuard<'_, L> {
    /// What a silence was.
    pub(super) fn silence_named(&mut self) -> Cause {
        if self.is_lost {
            return Cause::LinkLost;
        }
        let begun_s = match (self.silent_since_s, self.points.last()) {
            (Some(since_s), _) => self.epoch_s + since_s,
            (None, Some(last)) => self.epoch_s + last.t,
            (None, None) => self.axis.now().as_secs_f64(),
        };
        match self.stopped_and_asked_again(begun_s) {
            Answer::After(late) => self.answered_late(late),
            Answer::Ended(cause) => {
                self.is_lost = cause == Cause::LinkLost;
                cause
            }
        }
    }

    /// Stops the motor, whoever hears it, and asks until something comes back.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn stopped_and_asked_again(&mut self, begun_s: f64) -> Answer {
        for _ in 0..3 {
            let answer = self.axis.drive_duty(0);
            self.note_stolen();
            match answer {
                Ok(exchange) => return self.answered_after(begun_s, exchange.received),
                Err(AxisError::NoReply | AxisError::Late) => {}
                Err(AxisError::Stopped) => return Answer::Ended(Cause::Stopped),
                Err(_) => return Answer::Ended(Cause::LinkLost),
            }
        }
        let until = self.axis.now() + Duration::from_secs_f64(UNANSWERED.asked_again_s);
        let mut asked = 0;
        loop {
            let answer = self.axis.sample(Want::default());
            self.note_stolen();
            let now = self.axis.now();
            match answer {
                Ok(sample) => {
                    let before = self.points.last().map(|point| (point.t, point.counts));
                    let answer = self.answered_after(begun_s, sample.counts_at.received);
                    let point = self.point_of(&sample);
                    if before.is_some_and(|before| self.counts_anew(before, &point, sample.counts_at)) {
                        return Answer::Ended(Cause::WasReset);
                    }
                    return answer;
                }
                // What is too late to be of use shows that there is somebody.
                Err(AxisError::Late) => return self.answered_after(begun_s, now),
                Err(AxisError::NoReply) => asked += 1,
                Err(AxisError::Stopped) => return Answer::Ended(Cause::Stopped),
                Err(_) => return Answer::Ended(Cause::LinkLost),
            }
            if asked >= UNANSWERED.asked_again && now >= until {
                return Answer::Ended(Cause::LinkLost);
            }
            if self.axis.wait_until(now + Duration::from_secs_f64(self.options.poll_s)).is_err() {
                return Answer::Ended(Cause::Stopped);
            }
        }
    }

    fn answered_after(&self, begun_s: f64, now: Duration) -> Answer {
        Answer::After(self.pace.silence(begun_s, now.as_secs_f64()))
    }

    /// Takes note of what this computer took of the last call.
    pub(super) fn note_stolen(&mut self) {
        let stolen_s = self.axis.stolen().as_secs_f64();
        self.pace.stole(stolen_s);
    }
}

//! The guard around every experiment: polls, remembers, and ends the run when anything is wrong.
//!
//! An experiment drives only through an [`ExperimentGuard`]. Each poll is checked for the link, the status, the battery, the travel
//! window, stalls, lost encoders and open motors before the experiment sees it.

use crate::axis::{
    ABSOLUTE_COUNTS, AMPS_PER_RAW, Axis, AxisError, EncoderClass, FULL_DUTY_RAW, Sample, VOLTS_PER_RAW, Want,
};
use crate::cause::Cause;
use crate::diagnosis::{DIAGNOSIS_S, diagnose};
use crate::gains::Gains;
use crate::law::{Ending, Facts, Law};
use crate::motor_monitor::{MotorMonitor, NO_CURRENT_AMPS};
use crate::open_loop_record::Actuation;
use crate::pace::{Late, Pace, quantile};
pub use crate::poll::{Drive, Input, Point};
use crate::setup::{LoopAxis, Setup};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The stream time-out during a run, ms: assumed to take the drive from the motor this long after the program died. With the unit's own
/// tick the motor is off within 250 ms of a link that drops, which the bench holds; a computer that is silent for so long counts as late
/// anyway.
pub const RUN_STREAM_TIMEOUT_MS: u32 = 200;
/// Time between close polls over that between the usual ones, where the line is that quick: counts and duty alone take two exchanges of four.
const CLOSE_SHARE: f64 = 0.4;
/// Time a duty takes to change its sign, as far as it counts for the stopping distance, s; and the longest that a motion is driven against.
const TURNING_S: f64 = 0.03;
const LONGEST_TURN_S: f64 = 2.0;
/// How much longer than computed a stopping distance may be.
const STOPPING_DOUBT: f64 = 1.15;
/// Time that a lost command costs before it is sent again, s.
const RETRY_S: f64 = 0.010;
/// A motor that runs on for longer than this is heavy, s; the duty above the starting one that brings it to rest, and how long it
/// is watched then, s.
const HEAVY_S: f64 = 0.05;
const RESTING_DUTY: f64 = 0.25;
const RESTING_S: f64 = 0.15;
/// Readings beyond the highest current that end a run: how far, and how many in a row.
const PEAK_OVER_LIMIT: f64 = 1.25;
const PEAK_AMPS: f64 = 0.1;
const BEYOND_POLLS: u32 = 3;
/// How long a braked motor may take to stand, and how often it is looked at.
const LONGEST_REST: Duration = Duration::from_secs(3);
const REST_LOOK: Duration = Duration::from_millis(40);
/// Polls whose exchanges are the usual ones, and how much longer a prompt one may take, s.
const USUAL_POLLS: usize = 17;
const LATE_S: f64 = 0.004;
/// Silence after which the link counts as lost, s, and so many polls in a row: on a slow line a few lost replies take as long.
const LINK_LOST_S: f64 = 0.15;
const LINK_LOST_POLLS: u32 = 5;
/// How often stretches of a run are done again: on a computer with six busy programs beside it one in ten is late.
const LATE_TRIES: u32 = 4;
/// How long after the last good reading a driven motor is off at the latest, s (SAFETY.md: a motion command lives 250 ms).
const OFF_WITHIN_S: f64 = 0.25;
/// The longest time between two readings with which that can be kept: one reading, one that is waited for in vain, and the command.
const SLOWEST_READING_S: f64 = 0.1;
/// Readings of the current that are looked at before a fault is named by it, and how far above the highest one at rest they must be:
/// noise that reached 1 among the dozen readings at rest does not have its middle at 3.
const DRIVEN_READINGS: usize = 6;
const ABOVE_REST: f64 = 3.0;

/// What the guard has to keep to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GuardOptions {
    /// Which of the two motors, 0 or 1.
    pub motor: usize,
    /// Highest duty that may be given, 0 to 1.
    pub max_duty: f64,
    /// Travel in counts, relative to the encoder's reading; `None` for an axis that turns freely.
    pub travel: Option<(i64, i64)>,
    /// Time between polls, s.
    pub poll_s: f64,
    /// Longest run, s.
    pub time_limit_s: f64,
    /// Volts above the controller's lower limit at which the run ends.
    pub volts_margin: f64,
    /// Highest current, A. The controller is set to it, and the run ends when it is exceeded nevertheless.
    pub max_amps: Option<f64>,
    /// Whether inductance and resistance, where both are set, may be cleared for the run. They are put back after it.
    #[serde(default)]
    pub clear_winding: bool,
    /// Whether a refusal names the machine only where answers were on time and currents clear of their noise. Reports from before
    /// this was looked at do not have it, and replay as they were.
    #[serde(default)]
    pub weighs_evidence: bool,
    /// How often a stretch of the run is done again because this computer answered late meanwhile. Reports from before replay as they
    /// were.
    #[serde(default)]
    pub late_tries: u32,
}

impl Default for GuardOptions {
    fn default() -> Self {
        Self {
            motor: 0,
            max_duty: 1.0,
            travel: None,
            poll_s: 0.010,
            time_limit_s: 180.0,
            volts_margin: 0.2,
            max_amps: None,
            clear_winding: false,
            weighs_evidence: true,
            late_tries: LATE_TRIES,
        }
    }
}

/// Counts that began anew are told from a motor that moved by a jump of more than this many times what full speed makes in the time since the
/// last poll: twice, since that time is known to a poll at each end and full speed to a few percent.
const RESET_REACH: f64 = 2.0;
/// Where hardly any time went by, so many counts are no jump: a step of the duty and the rounding of the time make a few.
const RESET_COUNTS: f64 = 60.0;

/// The guard around an experiment on an axis.
pub struct ExperimentGuard<'a, L: Law> {
    axis: &'a mut dyn LoopAxis<L>,
    /// What it has to keep to.
    pub options: GuardOptions,
    /// What the controller held at the start.
    pub setup: Setup<L>,
    /// Its law, as far as it is known.
    pub(crate) law: L,
    /// Properties of that.
    pub(crate) facts: &'static Facts,
    /// Every poll.
    pub points: Vec<Point>,
    /// How long the exchange of each poll took, s, and when it was: what its time is worth.
    pub(crate) exchanges: Vec<(f64, f64)>,
    /// Every command.
    pub drives: Vec<Drive>,
    /// What monitors it for stalls and lost signals.
    pub monitor: MotorMonitor,
    pace: Pace,
    /// Where the exchanges of the present stretch begin.
    stretch_from: usize,
    /// The longest gap of earlier stretches whose figures are in use.
    kept_late: Option<Late>,
    /// How often stretches were done again.
    tries: u32,
    epoch_s: f64,
    first_counts: Option<i64>,
    last_raw: i64,
    next_poll: Duration,
    silent_since_s: Option<f64>,
    silent_polls: u32,
    /// Whether the controller was found to report no duty, current or voltage.
    unreported: [bool; 3],
    turn: u8,
    /// Where the guard last had driven a motor back, counts.
    turned_at_counts: f64,
    /// Polls in a row with a current beyond the highest.
    beyond: u32,
    max_current_raw: u32,
    kept: Option<L::Registers>,
    stays_off: bool,
    gains_touched: bool,
    timeout_touched: bool,
    limits_touched: bool,
    winding_touched: bool,
}

impl<'a, L: Law> ExperimentGuard<'a, L> {
    /// Takes an axis over: reads its setup, refuses torque mode unless it may be left, makes the controller stop by itself when
    /// the host dies, and gives it the highest current. What was changed is put back when it fails.
    pub fn new(axis: &'a mut dyn LoopAxis<L>, options: GuardOptions) -> Result<Self, Cause> {
        let setup = retried(|| axis.read_setup())?;
        let now = axis.now();
        let law = L::default().of_unit(&setup.held);
        let mut guard = Self {
            axis,
            options,
            setup,
            law,
            facts: law.facts(),
            points: Vec::new(),
            exchanges: Vec::new(),
            drives: Vec::new(),
            monitor: MotorMonitor::default(),
            pace: Pace::default(),
            stretch_from: 0,
            kept_late: None,
            tries: 0,
            epoch_s: now.as_secs_f64(),
            first_counts: None,
            last_raw: 0,
            next_poll: now,
            silent_since_s: None,
            silent_polls: 0,
            unreported: [false; 3],
            turn: 0,
            turned_at_counts: 0.0,
            beyond: 0,
            max_current_raw: setup.max_current_raw,
            kept: None,
            stays_off: false,
            gains_touched: false,
            timeout_touched: false,
            limits_touched: false,
            winding_touched: false,
        };
        match guard.get_ready() {
            Ok(()) => Ok(guard),
            Err(cause) => {
                guard.put_back(false);
                Err(cause)
            }
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn get_ready(&mut self) -> Result<(), Cause> {
        let setup = self.setup;
        L::ready(&setup.held)?;
        self.monitor.is_abrupt = self.actuation().slew_per_s.is_infinite();
        if let Some(travel) = self.options.travel.filter(|_| self.facts.keeps_travel) {
            retried(|| self.axis.set_travel(travel))?;
        }
        if setup.is_torque_mode() {
            if !self.options.clear_winding {
                return Err(Cause::TorqueMode);
            }
            self.winding_touched = true;
            retried(|| self.axis.write_winding([0, 0]))?;
        }
        if setup.stream_timeout_ms.is_some() {
            self.timeout_touched = true;
            retried(|| self.axis.set_stream_timeout(RUN_STREAM_TIMEOUT_MS))?;
        }
        if let Some(amps) = self.options.max_amps {
            let raw = ((amps / AMPS_PER_RAW).round() as u32).max(1);
            if setup.max_current_raw == 0 || raw < setup.max_current_raw {
                self.limits_touched = true;
                self.max_current_raw = raw;
                let taken = retried(|| self.axis.write_current_limits(raw, setup.min_current_raw));
                taken.map_err(|cause| match cause {
                    Cause::Refused | Cause::LinkLost => Cause::LimitNotTaken,
                    other => other,
                })?;
            }
        }
        Ok(())
    }

    /// Tells whoever waits what is going on.
    pub fn progress(&mut self, text: &str) {
        // Between two stages the run computes.
        self.pause();
        self.axis.progress(text);
    }

    /// The run computes before it speaks to the axis again: the time that takes is its own, and no answer is late for it.
    pub(crate) fn pause(&mut self) {
        self.pace.pause();
    }

    /// A controller whose registers are written at rest first has all of them written where it is given another kind of command, or has
    /// had no duty.
    fn pause_for(&mut self, input: Input) {
        let kind = |input: &Input| std::mem::discriminant(input);
        let is_another = self
            .drives
            .last()
            .is_none_or(|last| last.input == Input::Duty(0.0) || kind(&last.input) != kind(&input));
        // A move of an axis without duty is several commands: its pace, whether it may, and where to.
        if (self.facts.writes_at_rest && is_another) || !self.facts.has_duty {
            self.pause();
        }
    }

    /// What a run is refused for. A cause that names the machine stands only if all answers were on time, since the bounds of the guard
    /// and the model come from the whole run; and one that was named by the current only if that was clear of its noise.
    pub(crate) fn concluded(&self, cause: Cause) -> Cause {
        // Without a duty no current names anything, and places are dated.
        if !self.options.weighs_evidence || !self.facts.has_duty {
            return cause;
        }
        let took_s: Vec<f64> =
            self.exchanges[self.stretch_from..].iter().map(|exchange| exchange.1).collect();
        let late = self.pace.late(&took_s).or(self.kept_late).filter(|_| cause.is_of_motion());
        // What is silent beside a crowded computer may be that computer.
        let silent = self.pace.unsteady(&took_s).filter(|_| cause == Cause::LinkLost);
        if let Some(late) = late.or(silent) {
            return self.answered_late(late);
        }
        if cause.is_by_current() && self.is_current_unclear() { Cause::CurrentUnclear } else { cause }
    }

    fn answered_late(&self, late: Late) -> Cause {
        let (longest_gap_ms, at_ms) = self.milliseconds(late);
        Cause::AnsweredLate { longest_gap_ms, at_ms }
    }

    /// A gap and when it ended, from the start of the run, ms.
    fn milliseconds(&self, late: Late) -> (u32, u32) {
        let ms = |seconds: f64| (1e3 * seconds).round().max(0.0) as u32;
        (ms(late.longest_s), ms(late.at_s - self.epoch_s))
    }

    /// Does a stretch of the run, and does it again, up to a number of times, where this computer answered late meanwhile: what was seen then
    /// says nothing. The last time figures that came of it count, and are marked. `anew` says whether nothing is known of the motor before.
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
        loop {
            (self.pace, self.stretch_from) = (Pace::default(), self.exchanges.len());
            let outcome = work(self, report).map_err(|cause| self.concluded(cause));
            let late = self.pace.late_gap();
            let is_late = match outcome {
                Ok(_) => late.is_some(),
                Err(cause) => matches!(cause, Cause::AnsweredLate { .. }),
            };
            if is_late && self.tries < self.options.late_tries {
                self.tries += 1;
                // What is concluded after that is held against it too: the motor may have been left in another state than a run leaves it in.
                self.kept_late = self.kept_late.or(late).or(self.pace.longest());
                report.clone_from(&before);
                self.begin_again(anew, &monitor)?;
                continue;
            }
            if let Some(late) = late.filter(|_| outcome.is_ok()) {
                let (longest_gap_ms, at_ms) = self.milliseconds(late);
                mark(report, Cause::TakenLate { longest_gap_ms, at_ms });
                self.kept_late = Some(late);
            }
            return outcome;
        }
    }

    /// Brings the motor to rest and forgets what was seen of it since a stretch began.
    fn begin_again(&mut self, anew: bool, monitor: &MotorMonitor) -> Result<(), Cause> {
        self.progress("This computer answered late: doing that again");
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
        let driven_s = self.drives.iter().find(|drive| drive.input != Input::Duty(0.0)).map(|drive| drive.t);
        let driven_s = driven_s.unwrap_or(f64::INFINITY);
        let at_rest =
            self.points.iter().take_while(|point| point.t < driven_s).filter_map(|point| point.amps);
        let noise_amps = at_rest.map(f64::abs).fold(0.0, f64::max);
        if noise_amps <= NO_CURRENT_AMPS {
            return false;
        }
        let is_driven =
            |point: &&Point| self.monitor.duty_at(point.t).abs() > self.monitor.start_duty.max(0.03);
        let driven = self.points.iter().rev().filter(is_driven).filter_map(|point| point.amps);
        let mut driven: Vec<f64> = driven.map(f64::abs).take(DRIVEN_READINGS).collect();
        driven.sort_by(f64::total_cmp);
        driven.get(driven.len() / 2).is_none_or(|amps| *amps <= ABOVE_REST * noise_amps)
    }

    /// Time from the start of the run, s.
    pub fn now_s(&mut self) -> f64 {
        self.axis.now().as_secs_f64() - self.epoch_s
    }

    /// Drives at a duty, cut to the highest allowed.
    pub fn duty(&mut self, duty: f64) -> Result<(), Cause> {
        let duty = duty.clamp(-self.options.max_duty, self.options.max_duty);
        let raw = (duty * f64::from(FULL_DUTY_RAW)).round() as i16;
        self.pause_for(Input::Duty(duty));
        let exchange = self.acknowledged(|axis| axis.drive_duty(raw))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Duty(f64::from(raw) / f64::from(FULL_DUTY_RAW)) });
        let took_s = exchange.received.saturating_sub(exchange.sent).as_secs_f64();
        self.monitor.doubt_s = 0.5 * self.usual_exchange_s().map_or(0.0, |usual| (took_s - usual).max(0.0));
        self.monitor.drive(t, duty);
        Ok(())
    }

    /// Commands a speed in counts/s.
    pub fn speed(&mut self, counts_per_s: f64) -> Result<(), Cause> {
        let whole = self.whole_speed(counts_per_s) as i32;
        self.pause_for(Input::Speed(counts_per_s));
        let first_s = self.now_s();
        let exchange = self.acknowledged(|axis| axis.command_speed(whole))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Speed(f64::from(whole)) });
        self.monitor.release(first_s, t);
        Ok(())
    }

    /// The nearest speed that can be commanded, counts/s.
    #[must_use]
    pub fn whole_speed(&self, counts_per_s: f64) -> f64 {
        let step = self.speed_step();
        (counts_per_s / step).round() * step
    }

    /// The step of a speed command, counts/s.
    #[must_use]
    pub fn speed_step(&self) -> f64 {
        self.facts.speed_step
    }

    /// Commands a position in counts from the start of the run.
    pub fn position(&mut self, counts: f64, speed: u32) -> Result<(), Cause> {
        let origin = self.first_counts.unwrap_or(0);
        let whole = (origin + counts.round() as i64) as i32;
        self.pause_for(Input::Position(counts, f64::from(speed)));
        let first_s = self.now_s();
        let exchange = self.acknowledged(|axis| axis.command_position(whole, speed))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Position(counts.round(), f64::from(speed)) });
        self.monitor.release(first_s, t);
        Ok(())
    }

    /// Up to four tries. A controller that goes on reporting its counts has not lost the link: it does not take this command.
    fn acknowledged<T>(
        &mut self,
        mut call: impl FnMut(&mut dyn LoopAxis<L>) -> Result<T, AxisError>,
    ) -> Result<T, Cause> {
        let result = retried(|| call(self.axis));
        if matches!(result, Err(Cause::LinkLost)) && self.axis.sample(Want::default()).is_ok() {
            return Err(Cause::Refused);
        }
        result
    }

    /// Writes registers to RAM; they are put back unless the run keeps its own.
    pub fn write(&mut self, write: L::Write) -> Result<(), Cause> {
        self.gains_touched = true;
        if let Some(step_duty) = self.law.step_duty(&write) {
            self.monitor.hold(step_duty);
        }
        if self.facts.writes_at_rest {
            self.pause();
            return retried(|| self.axis.write(write));
        }
        self.acknowledged(|axis| axis.write(write))
    }

    /// Writes the registers that speed moves need, or position moves.
    pub fn write_all(&mut self, registers: &L::Registers, is_position: bool) -> Result<(), Cause> {
        L::writes(registers, is_position).into_iter().try_for_each(|write| self.write(write))
    }

    /// Writes the gains of a velocity loop, and gives them as registers.
    pub(crate) fn write_gains(&mut self, law: &L, gains: &Gains, qpps: f64) -> Result<L::Registers, Cause> {
        let registers = law.registers(&self.setup.held, gains, qpps, None);
        self.write_all(&registers, false).map(|()| registers)
    }

    /// The highest current during the run, 10 mA; 0 = none.
    pub(crate) fn max_current_raw(&self) -> u32 {
        self.max_current_raw
    }

    /// How the controller takes a duty.
    pub(crate) fn actuation(&self) -> Actuation {
        L::actuation(&self.setup.held, self.max_current_raw)
    }

    /// What the controller is to hold at the end of the run.
    pub fn keep(&mut self, registers: L::Registers) -> Result<(), Cause> {
        self.kept = Some(registers);
        L::keeping(&registers).into_iter().try_for_each(|write| self.write(write))
    }

    /// Leaves a loop that goes on after the run off where something is wrong with the machine: it would hold the motor by a signal
    /// that is not there, or drive it away. Whether there is such a loop, and it was on.
    pub(crate) fn leave_off(&mut self, cause: Cause) -> bool {
        self.stays_off = L::goes_on(&self.setup.held) && cause.is_of_machine();
        self.stays_off
    }

    /// The unfiltered speed.
    pub fn raw_speed(&mut self) -> Result<i32, Cause> {
        retried(|| self.axis.raw_speed())
    }

    /// The encoder reading at the start of the run.
    #[must_use]
    pub fn origin_counts(&self) -> i64 {
        self.first_counts.unwrap_or(0)
    }

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
            self.poll_for_all_of(want, CLOSE_SHARE * self.options.poll_s)?;
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
        let sample = match self.axis.sample(want) {
            Ok(sample) => sample,
            Err(error @ (AxisError::NoReply | AxisError::Late)) => {
                if error == AxisError::Late {
                    self.pace.came_late();
                }
                // Counted from the first poll without a reply: between experiments nobody asks for a while.
                let since_s = *self.silent_since_s.get_or_insert(now_s);
                self.silent_polls += 1;
                let silent_s = self.now_s() - since_s;
                let is_lost = silent_s > LINK_LOST_S && self.silent_polls >= LINK_LOST_POLLS;
                if is_lost || self.cannot_wait(now_s) {
                    let late = self
                        .answered_late(Late { longest_s: silent_s, at_s: self.epoch_s + since_s + silent_s });
                    // One long silence may be the computer's as well as the line's.
                    return Err(if self.pace.is_coming_late() || !is_lost { late } else { Cause::LinkLost });
                }
                return self.check_unseen().map(|()| None);
            }
            Err(error) => return Err(cause_of(&error)),
        };
        (self.silent_since_s, self.silent_polls) = (None, 0);
        let before = self.points.last().map(|point| (point.t, point.counts));
        let point = self.point_of(&sample);
        if before.is_some_and(|before| self.counts_anew(before, &point)) {
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

    /// Refuses a line on which a motor could not be switched off in time after lost replies: the quickest of the readings so far, of a motor that has not
    /// been driven, shows what it takes by itself.
    pub(crate) fn refuse_slow_line(&self) -> Result<(), Cause> {
        let gaps = self.points.windows(2).map(|pair| pair[1].t - pair[0].t);
        let quickest_s = gaps.fold(f64::INFINITY, f64::min);
        if self.setup.stream_timeout_ms.is_some() && quickest_s.is_finite() && quickest_s > SLOWEST_READING_S
        {
            return Err(Cause::LineTooSlow { reading_ms: (1e3 * quickest_s).round() as u32 });
        }
        Ok(())
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
        self.setup.stream_timeout_ms.is_some() && is_driven && silent_s + next_s > OFF_WITHIN_S
    }

    /// Whether an exchange took hardly longer than its predecessors: when the counts of a longer one were read is open, which would
    /// look like a jerk of the motor.
    fn is_prompt(&self, took_s: f64) -> bool {
        self.usual_exchange_s().is_none_or(|usual| took_s <= usual + LATE_S)
    }

    /// How long an exchange took of late, s: the one that a quarter were quicker than, since a busy host makes only longer ones.
    fn usual_exchange_s(&self) -> Option<f64> {
        let recent = &self.exchanges[self.exchanges.len().saturating_sub(USUAL_POLLS)..];
        let took_s: Vec<f64> = recent.iter().map(|exchange| exchange.1).collect();
        quantile(&took_s, 0.25)
    }

    /// The current limit over the stall current at full duty.
    #[must_use]
    pub fn drive_limit(&self, stall_amps: Option<f64>) -> Option<f64> {
        let limit = f64::from(self.max_current_raw) * AMPS_PER_RAW;
        stall_amps.filter(|stall| limit > 0.0 && *stall > 0.0).map(|stall| limit / stall)
    }

    /// Puts the next poll off.
    pub(crate) fn defer(&mut self, seconds: f64) {
        self.next_poll = self.axis.now() + Duration::from_secs_f64(seconds);
    }

    /// Polls for a time.
    pub fn poll_for(&mut self, seconds: f64, with_duty: bool) -> Result<(), Cause> {
        let end = self.now_s() + seconds;
        while self.now_s() < end {
            self.poll(with_duty)?;
        }
        Ok(())
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

    /// The last act on every way out: duty 0 three times; the old gains, unless the run keeps its own; the old time-out.
    pub fn finish(&mut self, keep_gains: bool) {
        for _ in 0..3 {
            // Whatever the answer: there is nothing else to try, and the stream time-out stands behind it.
            let _ = self.axis.drive_duty(0);
        }
        self.put_back(keep_gains);
    }

    /// Puts back what the run has changed. What cannot be said now is left to whoever owns the link.
    fn put_back(&mut self, keep_gains: bool) {
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

    /// The controller holds the current at its limit but for short peaks; what stays beyond it was not held.
    fn check_highest_current(&mut self, point: &Point) -> Result<(), Cause> {
        let (Some(most), Some(amps)) = (self.options.max_amps, point.amps) else { return Ok(()) };
        self.beyond = if amps.abs() > PEAK_OVER_LIMIT * most + PEAK_AMPS { self.beyond + 1 } else { 0 };
        if self.beyond >= BEYOND_POLLS { Err(Cause::OverCurrent) } else { Ok(()) }
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

    /// Takes the duty away and watches what the motor does then, which distinguishes the faults. `guess` stands where nothing more
    /// is heard.
    fn name_fault(&mut self, guess: Cause) -> Cause {
        if guess == Cause::MotorOpened {
            return guess;
        }
        let alarm_s = match retried(|| self.axis.drive_duty(0)) {
            Ok(exchange) => exchange.middle_s() - self.epoch_s,
            Err(cause) => return cause,
        };
        self.monitor.drive(alarm_s, 0.0);
        let mut after: Vec<Point> = self.points.last().copied().into_iter().collect();
        while self.now_s() < alarm_s + DIAGNOSIS_S {
            let next = self.axis.now() + Duration::from_secs_f64(self.options.poll_s);
            match self.axis.sample(Want { current: true, ..Want::default() }) {
                Ok(sample) => after.push(self.point_of(&sample)),
                Err(AxisError::NoReply | AxisError::Late) => {}
                Err(error) => return cause_of(&error),
            }
            if let Err(error) = self.axis.wait_until(next) {
                return cause_of(&error);
            }
        }
        diagnose(&self.monitor, alarm_s, &after)
    }

    /// Whether the counts are near 0 where no motor could have gone to since the poll before: the controller was reset, and its gains and its
    /// time-out are those of its EEPROM.
    fn counts_anew(&self, (before_s, counts): (f64, f64), point: &Point) -> bool {
        let full_speed = self.monitor.full_speed;
        let reach = RESET_REACH * full_speed * (point.t - before_s) + RESET_COUNTS;
        self.setup.encoder == EncoderClass::Quadrature
            && full_speed > 0.0
            && (point.counts - counts).abs() > reach
            && (self.last_raw as f64).abs() < reach.min(0.5 * (point.counts - counts).abs())
    }

    fn point_of(&mut self, sample: &Sample) -> Point {
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

    /// Where the guard last turned a motor back, counts.
    pub(crate) fn turned_at_counts(&self) -> f64 {
        self.turned_at_counts
    }

    /// Ends the run before the window is left: where the motor would come to rest if it were driven back now counts.
    fn check_travel(&mut self, point: &Point) -> Result<(), Cause> {
        let Some((low, high)) = self.travel_counts() else { return Ok(()) };
        if self.points.len() == 1 && !(low..=high).contains(&point.counts) {
            return Err(Cause::OutsideTravel);
        }
        self.check_stopping_distance(point, self.recent_speed(2).unwrap_or(0.0))
    }

    fn check_stopping_distance(&mut self, point: &Point, speed: f64) -> Result<(), Cause> {
        let Some((low, high)) = self.travel_counts() else { return Ok(()) };
        let runs_on = match self.monitor.stopping_counts(speed.abs(), self.options.max_duty) {
            Some(counts) => STOPPING_DOUBT * counts * speed.signum() + speed * TURNING_S,
            // From rest a motor needs no longer distance to stop than it had to start.
            None => 0.7 * self.distance_since_drive(point) + speed * TURNING_S.max(self.monitor.stopping_s),
        };
        let rest = point.counts + speed * (self.options.poll_s + RETRY_S) + runs_on;
        if (rest > high && speed > 0.0) || (rest < low && speed < 0.0) {
            self.turn_back(speed);
            return Err(Cause::TravelLimit);
        }
        Ok(())
    }

    /// The same while no reply comes: the motor goes on at least as it did, and gains speed as it did, up to what its duty gives.
    fn check_unseen(&mut self) -> Result<(), Cause> {
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

    /// Brings the motor to rest: a heavy one runs on for long when it is only braked, so it is driven against first.
    pub fn come_to_rest(&mut self) -> Result<(), Cause> {
        let speed = self.recent_speed(2).unwrap_or(0.0);
        let heavy =
            self.monitor.stopping_s > HEAVY_S || self.monitor.tau_bounds_s.is_some_and(|tau| tau.1 > HEAVY_S);
        if heavy && speed.abs() > 0.02 * self.monitor.full_speed {
            let duty = (self.monitor.start_duty + RESTING_DUTY).min(self.options.max_duty);
            self.duty(-speed.signum() * duty)?;
            let until = self.now_s() + LONGEST_TURN_S;
            while self.now_s() < until && self.recent_speed(2).is_some_and(|now| now * speed > 0.0) {
                self.poll(false)?;
            }
        }
        self.duty(0.0)?;
        self.poll_for(RESTING_S, false)
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
        let until = self.axis.now() + Duration::from_secs_f64(LONGEST_TURN_S);
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

/// Waits until a braked motor stands, for a few seconds at the most: where duty is a current, duty 0 no longer brakes it.
pub fn wait_for_rest<A: Axis + ?Sized>(axis: &mut A) {
    let until = axis.now() + LONGEST_REST;
    let mut before = None;
    while axis.now() < until {
        let counts = axis.sample(Want::default()).ok().map(|sample| sample.counts);
        if counts.is_some() && counts == before {
            return;
        }
        before = counts.or(before);
        let next = axis.now() + REST_LOOK;
        if axis.wait_until(next).is_err() {
            return;
        }
    }
}

/// Up to four tries, since a reply may be lost.
fn retried<T>(mut call: impl FnMut() -> Result<T, AxisError>) -> Result<T, Cause> {
    for _ in 0..3 {
        match call() {
            Err(AxisError::NoReply | AxisError::Late) => {}
            other => return other.map_err(|error| cause_of(&error)),
        }
    }
    call().map_err(|error| cause_of(&error))
}

fn cause_of(error: &AxisError) -> Cause {
    match error {
        AxisError::NoReply | AxisError::Late | AxisError::LinkLost(_) => Cause::LinkLost,
        AxisError::Stopped => Cause::Stopped,
        AxisError::Refused(_) => Cause::Refused,
    }
}

//! The guard around every experiment: polls, remembers, and ends the run when anything is wrong.
//!
//! An experiment drives only through an [`ExperimentGuard`]. Each poll is checked for the link, the status, the battery, the travel
//! window, stalls, lost encoders and open motors before the experiment sees it.

mod commands;
pub(crate) mod evidence;
pub(crate) mod polling;
pub(crate) mod silence;
pub(crate) mod travel;
pub(crate) mod ways_out;

use crate::axis::{AMPS_PER_RAW, Axis, AxisError, Want};
use crate::cause::Cause;
use crate::law::{Facts, Law};
use crate::motor_monitor::MotorMonitor;
use crate::open_loop_record::Actuation;
use crate::pace::{Late, Pace};
pub use crate::poll::{Drive, Input, Point};
use crate::setup::{LoopAxis, Setup};
use crate::thresholds::thresholds;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The stream time-out during a run, ms: assumed to take the drive from the motor this long after the program died. With the unit's own
/// tick the motor is off within 250 ms of a link that drops, which the bench holds; a computer that is silent for so long counts as late
/// anyway.
pub const RUN_STREAM_TIMEOUT_MS: u32 = 200;

thresholds! {
    /// How a motor is brought to rest, and how often a late answer is asked for again.
    GUARD: Thresholds {
        /// How long a braked motor may take to stand.
        longest_rest: Duration = Duration::from_secs(3),
        /// Time between two looks at whether it stands.
        rest_look: Duration = Duration::from_millis(40),
        /// How often stretches of a run are done again: on a computer with six busy programs beside it one in ten is late.
        late_tries: u32 = 4,
    }
}

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
            late_tries: GUARD.late_tries,
        }
    }
}

/// The guard around an experiment on an axis.
pub struct ExperimentGuard<'a, L: Law> {
    axis: &'a mut dyn LoopAxis<L>,
    /// What it has to keep to.
    pub options: GuardOptions,
    /// What the controller held at the start.
    pub setup: Setup<L>,
    /// Its law, as far as it is known.
    pub(crate) law: L,
    /// How many times more often than that law says the loop may compute.
    pub(crate) rate_doubt: f64,
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
    /// What the last stretch that was done again had ended with, where it was refused.
    kept_cause: Option<Cause>,
    /// How often stretches were done again.
    tries: u32,
    epoch_s: f64,
    first_counts: Option<i64>,
    last_raw: i64,
    next_poll: Duration,
    silent_since_s: Option<f64>,
    silent_polls: u32,
    /// Whether the link was asked again after a silence, and is lost.
    is_lost: bool,
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
    /// The registers in force.
    registers: L::Registers,
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
            rate_doubt: 1.0,
            facts: law.facts(),
            points: Vec::new(),
            exchanges: Vec::new(),
            drives: Vec::new(),
            monitor: MotorMonitor::default(),
            pace: Pace::default(),
            stretch_from: 0,
            kept_late: None,
            kept_cause: None,
            tries: 0,
            epoch_s: now.as_secs_f64(),
            first_counts: None,
            last_raw: 0,
            next_poll: now,
            silent_since_s: None,
            silent_polls: 0,
            is_lost: false,
            unreported: [false; 3],
            turn: 0,
            turned_at_counts: 0.0,
            beyond: 0,
            max_current_raw: setup.max_current_raw,
            kept: None,
            stays_off: false,
            gains_touched: false,
            registers: L::before(&setup.held),
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
        self.pause();
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

    /// The run computes before it speaks to the axis again: the time that takes is its own, and no answer is late for it, nor for what this
    /// computer took until now.
    pub(crate) fn pause(&mut self) {
        self.axis.stolen();
        self.pace.pause();
    }

    /// Time from the start of the run, s.
    pub fn now_s(&mut self) -> f64 {
        self.axis.now().as_secs_f64() - self.epoch_s
    }

    /// The highest current during the run, 10 mA; 0 = none.
    pub(crate) fn max_current_raw(&self) -> u32 {
        self.max_current_raw
    }

    /// How the controller takes a duty.
    pub(crate) fn actuation(&self) -> Actuation {
        L::actuation(&self.setup.held, self.max_current_raw)
    }

    /// The encoder reading at the start of the run.
    #[must_use]
    pub fn origin_counts(&self) -> i64 {
        self.first_counts.unwrap_or(0)
    }

    /// The current limit over the stall current at full duty.
    #[must_use]
    pub fn drive_limit(&self, stall_amps: Option<f64>) -> Option<f64> {
        let limit = f64::from(self.max_current_raw) * AMPS_PER_RAW;
        stall_amps.filter(|stall| limit > 0.0 && *stall > 0.0).map(|stall| limit / stall)
    }
}

/// Waits until a braked motor stands, for a few seconds at the most: where duty is a current, duty 0 no longer brakes it.
pub fn wait_for_rest<A: Axis + ?Sized>(axis: &mut A) {
    let until = axis.now() + GUARD.longest_rest;
    let mut before = None;
    while axis.now() < until {
        let counts = axis.sample(Want::default()).ok().map(|sample| sample.counts);
        if counts.is_some() && counts == before {
            return;
        }
        before = counts.or(before);
        let next = axis.now() + GUARD.rest_look;
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
        AxisError::OnlySimulated => Cause::OwnTestOnSimulated,
        AxisError::Refused(_) => Cause::Refused,
    }
}

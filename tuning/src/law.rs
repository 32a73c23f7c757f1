//! The control law of a controller: what its loop computes, which registers it has, and what a run must know of it.
//!
//! A family implements [`Law`] beside its axis. Where experiments, design and verification go different ways, they ask for a property of
//! the law ([`Facts`]) and never whose it is. [`PlainLaw`](crate::plain_law::PlainLaw) is the
//! plainest there can be.

use crate::axis::AxisError;
use crate::cause::Cause;
use crate::duty_limiter::DutyLimit;
use crate::gains::Gains;
use crate::model::{DerivativeFilter, Lag, Motion, PlantModel};
use crate::open_loop_record::Actuation;
use crate::setpoint::Setpoint;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// Properties of a law that runs and designs go by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    /// The controller takes a duty. Where it does not, its loop always has the motor, and all that is learned of it is learned from moves.
    pub has_duty: bool,
    /// There is a velocity loop under the position loop.
    pub has_cascade: bool,
    /// What the manual does not say of the law can be read off the duty that it gives at a standstill.
    pub can_be_probed: bool,
    /// Registers are written with the motor off only, and all of them whenever another kind of command follows.
    pub writes_at_rest: bool,
    /// The controller itself can keep the motor within its travel.
    pub keeps_travel: bool,
    /// The longest move that the controller takes at once, counts: it lets the motor go where the position lags further behind than this.
    pub longest_move_counts: f64,
    /// The step of a speed command, counts/s.
    pub speed_step: f64,
    /// The lag that is assumed before it is measured, and where it cannot be.
    pub usual_lag: Lag,
    /// The longest that it may be where an axis has no room to measure it.
    pub longest_lag: Lag,
    /// Filters on the speed that the loop may have, s.
    pub filters_s: &'static [f64],
    /// Delays that it may have, ticks.
    pub delays_ticks: &'static [f64],
    /// Ticks in a second that the loop may have, where no manual says it and moves have to; else none.
    pub rates_hz: &'static [u32],
    /// Lag that the model leaves out, s: a springy shaft, which knows nothing of the controller's ticks.
    pub unmodelled_s: f64,
    /// The longest integral time of a position loop that is tried, in time constants of the motor, and the ratio from one to the next.
    pub integral_times: (f64, f64),
}

/// When readings were taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stamps {
    /// Standard deviation of their times beyond that of the exchange, s.
    pub open_s: f64,
    /// Each comes with the controller's own time, so that it is known to much less than a tick.
    pub are_dated: bool,
}

/// What the integral of a velocity loop does while its duty is cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Windup {
    /// Not known: taken to be tracked, and designed for both.
    #[default]
    Open,
    /// It follows what is left of the duty, by full duty and by the current limit (back-calculation).
    Tracked,
    /// It stands still as long as more than full duty is asked for (conditional integration), and goes on while the current limit cuts the duty, which the loop does not
    /// know of.
    Held,
}

/// The law that a loop may follow as well while its duty is cut, where that is open.
pub(crate) fn other_windup<L: Law>(law: &L) -> Option<L> {
    if law.windup() == Windup::Open { law.with_windup(Windup::Held) } else { None }
}

/// What a tick of the loop sees.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The motor, for what its current limit leaves.
    pub plant: &'a PlantModel,
    /// How it moves.
    pub motion: &'a Motion,
    /// The count.
    pub count: f64,
    /// The filtered speed, counts/s.
    pub speed: f64,
    /// Highest duty that a limit of the duty leaves.
    pub most_duty: f64,
    /// The rounding of the arithmetic is left out.
    pub is_smooth: bool,
}

impl Seen<'_> {
    /// What the current limit leaves of the duty, down and up.
    #[must_use]
    pub fn duty_bounds(&self) -> (f64, f64) {
        if self.plant.drive_limit.is_none() {
            return (-1.0, 1.0);
        }
        let emf = self.motion.speed / self.plant.gain_counts_per_s;
        let down = self.plant.push_limit_at(-1.0, emf).map_or(-1.0, |limit| emf - limit);
        let up = self.plant.push_limit_at(1.0, emf).map_or(1.0, |limit| emf + limit);
        (down.clamp(-1.0, 1.0), up.clamp(-1.0, 1.0))
    }
}

/// How a run ends.
#[derive(Clone, Copy, Debug)]
pub struct Ending<'a, L: Law> {
    /// The registers that it keeps.
    pub kept: Option<&'a L::Registers>,
    /// Gains were written.
    pub is_touched: bool,
    /// The loop is to be left without output: something is wrong with the machine.
    pub stays_off: bool,
}

/// A control law. The value is the law as far as it is known; what is of the controller that has it comes as `held`.
pub trait Law:
    Copy + Debug + Default + PartialEq + Send + Sync + Serialize + DeserializeOwned + 'static
{
    /// What the controller holds of its loops before a run.
    type Held: Copy + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned;
    /// The registers of its loops; none of them by default.
    type Registers: Copy + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned;
    /// What goes over in one write of registers.
    type Write: Copy + Debug + PartialEq + Send;
    /// A write with its answer, as the raw record has it.
    type Note: Clone + Debug + PartialEq + Send + Serialize + DeserializeOwned;
    /// What a probe of the law finds.
    type Findings: Copy + Debug + PartialEq + Send + Serialize + DeserializeOwned;
    /// The state of the loop in simulation.
    type Loop: Copy + Debug + Default;

    /// Its properties.
    fn facts(&self) -> &'static Facts;
    /// Loop rate, Hz.
    fn rate_hz(&self) -> u32;
    /// Length of a tick, s.
    fn tick_s(&self) -> f64 {
        1.0 / f64::from(self.rate_hz())
    }
    /// The law at another rate of [`Facts::rates_hz`].
    #[must_use]
    fn at_rate(&self, _rate_hz: u32) -> Self {
        *self
    }
    /// How much of the setpoint over QPPS is added to the duty: 1 is all of it.
    fn feed_forward(&self) -> f64;
    /// The filter of the speed that the derivative of a position sees, where it sees that of the velocity loop and no differences of counts.
    fn derivative_filter(&self) -> Option<DerivativeFilter> {
        None
    }
    /// The law whose velocity loop takes its sum before the present error is added to it, or after it, whichever this one does not, and what gains of this law are under
    /// it; `None` where it is known which.
    fn with_other_sum(&self, _gains: &Gains) -> Option<(Self, Gains)> {
        None
    }
    /// What its integral does while the duty is cut.
    fn windup(&self) -> Windup {
        Windup::Tracked
    }
    /// The law that does otherwise there; `None` where it is known what it does.
    fn with_windup(&self, _windup: Windup) -> Option<Self> {
        None
    }
    /// The limit of the duty by which the current is held, where it is not the current itself that is limited.
    fn duty_limit(&self) -> Option<DutyLimit> {
        None
    }

    /// One tick in simulation: the duty.
    fn tick(&self, state: &mut Self::Loop, gains: (&Gains, f64), setpoint: Setpoint, seen: &Seen<'_>) -> f64;
    /// The steady state of a speed in simulation, with the motor at position 0: `duty` is what the speed takes.
    fn steady(&self, gains: (&Gains, f64), speed: f64, duty: f64) -> Self::Loop;
    /// Gains as the registers can hold them, where these are so coarse that it makes a difference.
    fn rounded(&self, gains: &Gains, _qpps: f64) -> Gains {
        *gains
    }
    /// Where the registers are so coarse that it makes a difference: the gains a step or some around these, themselves among them.
    fn steps_around(&self, _gains: &Gains, _qpps: f64) -> Vec<Gains> {
        Vec::new()
    }
    /// The bounds that a position integral may be given where it needs `wanted`, counts x s.
    fn sum_bounds(&self, wanted: f64) -> Vec<f64> {
        vec![wanted]
    }

    /// Gains as registers; `travel` bounds the positions where registers do.
    fn registers(
        &self,
        held: &Self::Held,
        gains: &Gains,
        qpps: f64,
        travel: Option<(i64, i64)>,
    ) -> Self::Registers;
    /// The gains that registers stand for: of position moves, or of speed moves.
    fn gains(&self, registers: &Self::Registers, qpps: f64, is_position: bool) -> Gains;
    /// The law with what registers say of it.
    #[must_use]
    fn with_registers(&self, _registers: &Self::Registers) -> Self {
        *self
    }
    /// Registers for people: name, held, proposed, and what is on the wire; none where nothing is proposed.
    fn rows(&self, _held: &Self::Held, _proposed: &Self::Registers) -> Vec<[String; 4]> {
        Vec::new()
    }
    /// Why these registers cannot be tried, if so.
    fn refuse(_registers: &Self::Registers) -> Result<(), Cause> {
        Ok(())
    }
    /// What has to be written for speed moves, or for position moves.
    fn writes(registers: &Self::Registers, is_position: bool) -> Vec<Self::Write>;
    /// The registers in force before a run, for whoever draws what was tried.
    fn before(held: &Self::Held) -> Self::Registers;
    /// The same after a write.
    fn take(registers: &mut Self::Registers, write: &Self::Write);
    /// The duty that one count more in a tick makes under these registers, as a share of full.
    fn step_duty(&self, _registers: &Self::Registers) -> f64 {
        0.0
    }
    /// A write with its answer.
    fn note(write: Self::Write, answer: Result<(), AxisError>) -> Self::Note;
    /// The two apart again.
    fn noted(note: &Self::Note) -> (Self::Write, Result<(), AxisError>);

    /// The law of this controller, where `self` was asked for.
    #[must_use]
    fn of_unit(&self, _held: &Self::Held) -> Self {
        *self
    }
    /// The law with what depends on the motor and on the current limit, 10 mA.
    #[must_use]
    fn of_motor(&self, _qpps: f64, _max_current_raw: u32) -> Self {
        *self
    }
    /// The law that gives these findings; `None` when no known law does.
    #[must_use]
    fn found(&self, _findings: &Self::Findings, _is_position: bool) -> Option<Self> {
        None
    }

    /// Why these findings give no law.
    #[must_use]
    fn why_not_found(_findings: &Self::Findings) -> Cause {
        Cause::UnknownLaw
    }

    /// Whether these findings say how often in a second the loop computes.
    #[must_use]
    fn is_rate_known(_findings: &Self::Findings) -> bool {
        true
    }

    /// Whether these findings say what the derivative of a position multiplies.
    #[must_use]
    fn is_derivative_known(_findings: &Self::Findings) -> bool {
        true
    }

    /// How much louder than the rounding of counts makes it the duty of a position's derivative was, where these findings say so.
    #[must_use]
    fn derivative_noise(_findings: &Self::Findings) -> Option<f64> {
        None
    }

    /// Why a controller cannot be tuned as it is set, if so.
    fn ready(_held: &Self::Held) -> Result<(), Cause> {
        Ok(())
    }
    /// Between which counts its position loop keeps the motor.
    fn position_limits(_held: &Self::Held) -> Option<(i64, i64)> {
        None
    }
    /// What a fault is, by the status word.
    fn fault(_held: &Self::Held, _status_raw: u32) -> Cause {
        Cause::ControllerFault
    }
    /// How the controller takes a duty under a current limit, 10 mA.
    fn actuation(_held: &Self::Held, _max_current_raw: u32) -> Actuation {
        Actuation::default()
    }
    /// When its readings are taken.
    fn stamps(_held: &Self::Held) -> Stamps {
        Stamps::default()
    }
    /// Whether its loop goes on at the end of a run, so that it may have to be left off.
    fn goes_on(_held: &Self::Held) -> bool {
        false
    }
    /// What has to be written for registers to be kept, while the run has the motor still.
    fn keeping(_registers: &Self::Registers) -> Vec<Self::Write> {
        Vec::new()
    }
    /// What is written last of all.
    fn ending(held: &Self::Held, ending: Ending<'_, Self>) -> Vec<Self::Write>;
}

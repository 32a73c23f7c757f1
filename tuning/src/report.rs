//! What a run leaves: verdict, model, gains, predictions and the raw record.

use crate::cause::Cause;
use crate::design::{Design, Task};
use crate::experiment::{
    Backlash, FreeRun, OwnPositionTestRun, OwnTestRun, PositionRelayRun, Probe, RelayRun, StepRun, WindowRun,
};
use crate::fit::Fit;
use crate::lag::LagFit;
use crate::law::Law;
use crate::promise::Promise;
use crate::record::Entry;
use crate::request::Request;
use crate::rules::Classic;
use crate::setup::Setup;
use crate::trajectory::Trajectory;
use crate::winding::{Winding, WindingUnknown};
use serde::{Deserialize, Serialize};

/// Version of the form of a report. Reports without one are of the first.
pub const FORMAT: u32 = 1;

fn first_format() -> u32 {
    FORMAT
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Gains that were measured to be as good as predicted.
    Tuned,
    /// Gains, with something to know about them.
    TunedWithWarnings,
    /// No gains; the causes say why.
    Refused,
}

/// What a verification measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Overshoot over the step.
    pub overshoot: f64,
    /// Root mean square of the duty on plateaus.
    pub duty_rms: f64,
    /// Peak to peak of the position or speed at rest, over the step.
    pub ripple: f64,
    /// Multiple of the gains up to which the velocity loop stayed quiet; `None` where it was not tried.
    #[serde(default)]
    pub headroom: Option<f64>,
}

/// Everything a run found and did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Report<L: Law> {
    /// The form of this report: what the program that wrote it calls [`FORMAT`].
    #[serde(default = "first_format")]
    pub format: u32,
    /// What was asked for.
    pub request: Request<L>,
    /// How it ended.
    pub verdict: Verdict,
    /// Why, and what to know.
    pub causes: Vec<Cause>,
    /// What the controller held before.
    pub before: Option<Setup<L>>,
    /// The probe.
    pub probe: Option<Probe>,
    /// The free run.
    pub free: Option<FreeRun>,
    /// The run inside a window.
    pub window: Option<WindowRun>,
    /// The step.
    #[serde(default)]
    pub step: Option<StepRun>,
    /// The relay.
    #[serde(default)]
    pub relay: Option<RelayRun>,
    /// The relay about a position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_relay: Option<PositionRelayRun>,
    /// The controller's own relay test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_test: Option<OwnTestRun>,
    /// The same of its position loop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub own_position_test: Option<OwnPositionTestRun>,
    /// What the textbook experiments see in the same record.
    pub classic: Option<Classic>,
    /// The open-loop fit.
    pub fit: Option<Fit>,
    /// Speed at full duty, counts/s.
    pub qpps: Option<f64>,
    /// What the law probe found.
    #[serde(default)]
    pub law: Option<L::Findings>,
    /// Resistance of the winding.
    #[serde(default)]
    pub winding: Option<Winding>,
    /// Why that is not known, where an open-loop run could have.
    #[serde(default)]
    pub winding_unknown: Option<WindingUnknown>,
    /// Backlash of the mechanics, of a position run.
    #[serde(default, rename = "slack")]
    pub backlash: Option<Backlash>,
    /// The lag of the loop.
    pub lag: Option<LagFit>,
    /// What the design was made for: the model with all that the run learned of the loop.
    #[serde(default)]
    pub task: Option<Task<L>>,
    /// The design.
    pub design: Option<Design>,
    /// What the last verification measured.
    pub measured: Option<Measured>,
    /// Position limits proposed with the gains of an axis that turns freely and had none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free_limits: Option<(i64, i64)>,
    /// Registers proposed; none where it was refused.
    #[serde(flatten)]
    pub proposed: L::Registers,
    /// Length of identification and of the whole run, s.
    pub seconds: (f64, f64),
    /// The raw record.
    pub record: Vec<Entry<L>>,
}

impl<L: Law> Report<L> {
    /// What the gains of this run promise, as ranges; `None` where it found none.
    #[must_use]
    pub fn promise(&self) -> Option<Promise> {
        Some(Promise::of(&self.task?, &self.design?.gains, &self.fit?, self.lag.as_ref()))
    }

    /// The trapezoid that the motor follows with the gains of this run; `None` where it has none.
    #[must_use]
    pub fn trajectory(&self) -> Option<Trajectory> {
        self.task.filter(|_| self.verdict != Verdict::Refused).and_then(|task| Trajectory::of(&task.plant))
    }
}

//! The laws of all families as one, so that a run, its report and its file are the same whatever controller is at the wire.
//!
//! Everything here says for each family in turn what its crate does; what belongs to none of them is left empty.

use brushwork_mcp_axis::{McpHeld, McpLaw, McpNote, McpRegisters, McpWrite, probe_law};
use brushwork_motion_mind_axis::law::{
    LOOPS_PER_S, MotionMindHeld, MotionMindLaw, MotionMindNote, MotionMindPart, MotionMindProposal,
    MotionMindWrite, PositionLoop,
};
use brushwork_tuning::axis::AxisError;
use brushwork_tuning::cascade::Cascade;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::duty_limiter::DutyLimit;
use brushwork_tuning::experiment_guard::ExperimentGuard;
use brushwork_tuning::law::{Ending, Facts, Law, Seen, Stamps};
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::model::Gains;
use brushwork_tuning::open_loop_record::Actuation;
use brushwork_tuning::setpoint::Setpoint;
use serde::{Deserialize, Serialize};

pub use brushwork_mcp_axis::{LawFindings, PositionRegisters, VelocityRegisters};
pub use brushwork_motion_mind_axis::law::{MotionMindRegisters, MotionMindSetup, bits};

/// The report of a run.
pub type Report = brushwork_tuning::report::Report<AnyLaw>;
/// What a run is asked for.
pub type Request = brushwork_tuning::tune::Request<AnyLaw>;
/// What a controller holds before a run.
pub type Setup = brushwork_tuning::setup::Setup<AnyLaw>;
/// What a design is made for.
pub type Task = brushwork_tuning::design::Task<AnyLaw>;
/// A run as a picture shows it.
pub type Trace = brushwork_tuning::trace::Trace<AnyLaw>;
/// Gains tried by themselves.
pub type Trial = brushwork_tuning::trial::Trial<AnyLaw>;
/// What is to be tried.
pub type TrialRequest = brushwork_tuning::trial::TrialRequest<AnyLaw>;

/// Something of each family, of which that of the controller at the wire is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct OfEach<P, M> {
    /// Of an MCP or RoboClaw; of a law, what reports say of every one.
    #[serde(flatten)]
    pub mcp: P,
    /// Of a Motion Mind.
    #[serde(flatten)]
    pub mind: M,
}

/// The law of whatever controller is at the wire.
pub type AnyLaw = OfEach<McpLaw, MotionMindPart<MotionMindLaw>>;
/// What it holds before a run.
pub type AnyHeld = OfEach<McpHeld, MotionMindHeld>;
/// Its registers.
pub type AnyRegisters = OfEach<McpRegisters, MotionMindProposal>;

/// What goes over in one write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnyWrite {
    /// To an MCP or RoboClaw.
    Mcp(McpWrite),
    /// To a Motion Mind.
    Mind(MotionMindWrite),
}

/// The same with its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AnyNote {
    /// Of an MCP or RoboClaw.
    Mcp(McpNote),
    /// Of a Motion Mind.
    Mind(MotionMindNote),
}

impl From<McpHeld> for AnyHeld {
    fn from(mcp: McpHeld) -> Self {
        Self { mcp, ..Self::default() }
    }
}

impl From<MotionMindHeld> for AnyHeld {
    fn from(mind: MotionMindHeld) -> Self {
        Self { mind, ..Self::default() }
    }
}

impl From<McpRegisters> for AnyRegisters {
    fn from(mcp: McpRegisters) -> Self {
        Self { mcp, ..Self::default() }
    }
}

impl From<MotionMindProposal> for AnyRegisters {
    fn from(mind: MotionMindProposal) -> Self {
        Self { mind, ..Self::default() }
    }
}

impl From<McpWrite> for AnyWrite {
    fn from(write: McpWrite) -> Self {
        Self::Mcp(write)
    }
}

impl TryFrom<AnyWrite> for McpWrite {
    type Error = AnyWrite;

    fn try_from(write: AnyWrite) -> Result<Self, AnyWrite> {
        match write {
            AnyWrite::Mcp(write) => Ok(write),
            AnyWrite::Mind(_) => Err(write),
        }
    }
}

impl TryFrom<AnyWrite> for MotionMindWrite {
    type Error = AnyWrite;

    fn try_from(write: AnyWrite) -> Result<Self, AnyWrite> {
        match write {
            AnyWrite::Mind(write) => Ok(write),
            AnyWrite::Mcp(_) => Err(write),
        }
    }
}

impl<P, T> OfEach<P, MotionMindPart<T>> {
    fn is_mind(&self) -> bool {
        self.mind.motion_mind.is_some()
    }
}

impl From<MotionMindLaw> for AnyLaw {
    fn from(law: MotionMindLaw) -> Self {
        let mcp = McpLaw { rate_hz: LOOPS_PER_S, per_tick: true, position_scale: 1.0, feed_forward: true };
        Self { mcp, mind: MotionMindPart { motion_mind: Some(law) } }
    }
}

/// What the law of the controller's family says.
macro_rules! of_family {
    ($of:ident.$what:ident($($with:expr),*)) => {
        if $of.is_mind() {
            MotionMindLaw::$what(&$of.mind, $($with),*)
        } else {
            McpLaw::$what(&$of.mcp, $($with),*)
        }
    };
}

fn of_mcp(writes: Vec<McpWrite>) -> Vec<AnyWrite> {
    writes.into_iter().map(AnyWrite::Mcp).collect()
}

fn of_mind(writes: Vec<MotionMindWrite>) -> Vec<AnyWrite> {
    writes.into_iter().map(AnyWrite::Mind).collect()
}

impl Law for AnyLaw {
    type Held = AnyHeld;
    type Registers = AnyRegisters;
    type Write = AnyWrite;
    type Note = AnyNote;
    type Findings = LawFindings;
    type Loop = OfEach<Cascade, PositionLoop>;

    fn facts(&self) -> &'static Facts {
        self.mind.motion_mind.map_or_else(|| self.mcp.facts(), |law| law.facts())
    }

    fn rate_hz(&self) -> u32 {
        self.mcp.rate_hz
    }

    fn feed_forward(&self) -> bool {
        self.mcp.feed_forward
    }

    fn duty_limit(&self) -> Option<DutyLimit> {
        self.mind.motion_mind.and_then(|law| law.duty_limit())
    }

    fn tick(&self, state: &mut Self::Loop, gains: (&Gains, f64), setpoint: Setpoint, seen: &Seen<'_>) -> f64 {
        match self.mind.motion_mind {
            Some(law) => law.tick(&mut state.mind, gains, setpoint, seen),
            None => self.mcp.tick(&mut state.mcp, gains, setpoint, seen),
        }
    }

    fn steady(&self, gains: (&Gains, f64), speed: f64, duty: f64) -> Self::Loop {
        match self.mind.motion_mind {
            Some(law) => OfEach { mind: law.steady(gains, speed, duty), ..OfEach::default() },
            None => OfEach { mcp: self.mcp.steady(gains, speed, duty), ..OfEach::default() },
        }
    }

    fn rounded(&self, gains: &Gains, qpps: f64) -> Gains {
        self.mind.motion_mind.map_or(*gains, |law| law.rounded(gains, qpps))
    }

    fn sum_bounds(&self, wanted: f64) -> Vec<f64> {
        self.mind.motion_mind.map_or_else(|| self.mcp.sum_bounds(wanted), |law| law.sum_bounds(wanted))
    }

    fn registers(
        &self,
        held: &AnyHeld,
        gains: &Gains,
        qpps: f64,
        travel: Option<(i64, i64)>,
    ) -> AnyRegisters {
        match self.mind.motion_mind {
            Some(law) => law.registers(&held.mind, gains, qpps, travel).into(),
            None => self.mcp.registers(&held.mcp, gains, qpps, travel).into(),
        }
    }

    fn gains(&self, registers: &AnyRegisters, qpps: f64, is_position: bool) -> Gains {
        match self.mind.motion_mind {
            Some(law) => law.gains(&registers.mind, qpps, is_position),
            None => self.mcp.gains(&registers.mcp, qpps, is_position),
        }
    }

    fn with_registers(&self, registers: &AnyRegisters) -> Self {
        self.mind.motion_mind.map_or(*self, |law| law.with_registers(&registers.mind).into())
    }

    fn refuse(registers: &AnyRegisters) -> Result<(), Cause> {
        of_family!(registers.refuse())
    }

    fn writes(registers: &AnyRegisters, is_position: bool) -> Vec<AnyWrite> {
        if registers.is_mind() {
            of_mind(MotionMindLaw::writes(&registers.mind, is_position))
        } else {
            of_mcp(McpLaw::writes(&registers.mcp, is_position))
        }
    }

    fn before(held: &AnyHeld) -> AnyRegisters {
        if held.is_mind() {
            MotionMindLaw::before(&held.mind).into()
        } else {
            McpLaw::before(&held.mcp).into()
        }
    }

    fn take(registers: &mut AnyRegisters, write: &AnyWrite) {
        match write {
            AnyWrite::Mcp(write) => McpLaw::take(&mut registers.mcp, write),
            AnyWrite::Mind(write) => MotionMindLaw::take(&mut registers.mind, write),
        }
    }

    fn step_duty(write: &AnyWrite) -> Option<f64> {
        match write {
            AnyWrite::Mcp(write) => McpLaw::step_duty(write),
            AnyWrite::Mind(write) => MotionMindLaw::step_duty(write),
        }
    }

    fn note(write: AnyWrite, answer: Result<(), AxisError>) -> AnyNote {
        match write {
            AnyWrite::Mcp(write) => AnyNote::Mcp(McpLaw::note(write, answer)),
            AnyWrite::Mind(write) => AnyNote::Mind(MotionMindLaw::note(write, answer)),
        }
    }

    fn noted(note: &AnyNote) -> (AnyWrite, Result<(), AxisError>) {
        match note {
            AnyNote::Mcp(note) => {
                let (write, answer) = McpLaw::noted(note);
                (AnyWrite::Mcp(write), answer)
            }
            AnyNote::Mind(note) => {
                let (write, answer) = MotionMindLaw::noted(note);
                (AnyWrite::Mind(write), answer)
            }
        }
    }

    fn of_unit(&self, held: &AnyHeld) -> Self {
        if held.is_mind() { MotionMindLaw::default().of_unit(&held.mind).into() } else { *self }
    }

    fn of_motor(&self, qpps: f64, max_current_raw: u32) -> Self {
        self.mind.motion_mind.map_or(*self, |law| law.of_motor(qpps, max_current_raw).into())
    }

    fn found(&self, findings: &LawFindings, is_position: bool) -> Option<Self> {
        self.mcp.found(findings, is_position).map(|mcp| Self { mcp, ..*self })
    }

    fn ready(held: &AnyHeld) -> Result<(), Cause> {
        of_family!(held.ready())
    }

    fn position_limits(held: &AnyHeld) -> Option<(i64, i64)> {
        of_family!(held.position_limits())
    }

    fn fault(held: &AnyHeld, status_raw: u32) -> Cause {
        of_family!(held.fault(status_raw))
    }

    fn actuation(held: &AnyHeld, max_current_raw: u32) -> Actuation {
        of_family!(held.actuation(max_current_raw))
    }

    fn stamps(held: &AnyHeld) -> Stamps {
        of_family!(held.stamps())
    }

    fn goes_on(held: &AnyHeld) -> bool {
        of_family!(held.goes_on())
    }

    fn keeping(registers: &AnyRegisters) -> Vec<AnyWrite> {
        of_mcp(McpLaw::keeping(&registers.mcp))
    }

    fn ending(held: &AnyHeld, ending: Ending<'_, Self>) -> Vec<AnyWrite> {
        let Ending { kept, is_touched, stays_off } = ending;
        if held.is_mind() {
            let kept = kept.map(|kept| &kept.mind);
            of_mind(MotionMindLaw::ending(&held.mind, Ending { kept, is_touched, stays_off }))
        } else {
            let kept = kept.map(|kept| &kept.mcp);
            of_mcp(McpLaw::ending(&held.mcp, Ending { kept, is_touched, stays_off }))
        }
    }
}

impl LawProbe for AnyLaw {
    fn probe(
        guard: &mut ExperimentGuard<'_, Self>,
        start_duty: f64,
        is_position: bool,
    ) -> Result<Option<LawFindings>, Cause> {
        let position = guard.setup.held.mcp.position;
        probe_law(guard, start_duty, is_position.then_some((position.min, position.max)))
    }
}

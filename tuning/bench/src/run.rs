//! Runs the tuner on one plant, in virtual time over the wire, and judges what came out on the true plant.

use crate::bounds::{MOST_MS, most_overshoot};
use crate::line::SimulatedLine;
use crate::oracle::{Optimum, cost, trial};
use crate::population::Specimen;
use crate::trial::{Outcome, Registers, linear};
use crate::truth::Truth;
use brushwork_mcp_axis::{McpLaw, PacketAxis};
use brushwork_mcp_sim::controller::Controller;
use brushwork_plant::EncoderKind;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::law::Law;
use brushwork_tuning::linear::{LoopPlant, Margins};
use brushwork_tuning::report::{self, Verdict};
use brushwork_tuning::tune::{self, Excitation, Method, tune};
use brushwork_values::Motor;

/// What a run is asked for, and what it leaves.
pub type Request = tune::Request<McpLaw>;
/// The report of a run.
pub type Report = report::Report<McpLaw>;
/// An axis over the simulated machine.
pub type SimulatedAxis = PacketAxis<SimulatedLine>;

/// The axis of a plant, switched on half a second ago.
#[must_use]
pub fn axis_of(specimen: &Specimen) -> SimulatedAxis {
    let unit = Controller::new(specimen.controller_config()).expect("every drawn figure is in its range");
    let mut line = SimulatedLine::new(unit, specimen.link);
    line.idle(std::time::Duration::from_millis(500));
    PacketAxis::new(line, Motor::M1, encoder_of(specimen))
}

/// What a person would say of its encoder.
fn encoder_of(specimen: &Specimen) -> EncoderClass {
    let encoder = &specimen.axis.encoder;
    match (encoder.kind, encoder.wraps) {
        (EncoderKind::Quadrature, _) => EncoderClass::Quadrature,
        (_, false) => EncoderClass::Absolute,
        (_, true) => EncoderClass::AbsoluteWrapping,
    }
}

/// What the bench asks for.
#[must_use]
pub fn request_of<L: Law>(specimen: &Specimen, method: Method) -> tune::Request<L> {
    tune::Request {
        method,
        excitation: Excitation::Free,
        guard: GuardOptions { poll_s: specimen.link.poll_s, ..GuardOptions::default() },
        ..tune::Request::default()
    }
}

/// A tuning run of a plant.
#[must_use]
pub fn tune_plant(specimen: &Specimen, request: &Request) -> (Report, SimulatedAxis) {
    let mut axis = axis_of(specimen);
    let report = tune(&mut axis, request);
    (report, axis)
}

/// What gains are worth on the true plant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judgement {
    /// Cost over the optimum's; infinite for a refusal.
    pub j: f64,
    /// Whether the loop is stable on the true plant and stays so at half and at half as much more inertia.
    pub stable: bool,
    /// Maximum sensitivity on the true plant.
    pub ms: f64,
    /// The larger of those at half and at half as much more inertia.
    pub ms_varied: f64,
    /// Overshoot of the true response.
    pub overshoot: f64,
    /// Duty at rest, root mean square.
    pub duty_rms: f64,
    /// Goes on oscillating: a limit cycle.
    pub hunting: bool,
    /// By how much of the step, and how often, Hz.
    pub ripple: (f64, f64),
    /// No gains at all.
    pub refused: Option<Cause>,
    /// Meets every bound.
    pub accept: bool,
    /// Accepted and within half as much more of the optimum.
    pub good: bool,
}

/// Judges registers.
#[must_use]
pub fn judge(
    method: Method,
    specimen: &Specimen,
    truth: &Truth,
    optimum: &Optimum,
    registers: &Registers,
) -> Judgement {
    let of = |plant: &LoopPlant| linear(plant, truth, registers);
    let outcome = trial(method, specimen, truth, registers);
    weigh(method, optimum, of(&truth.nominal), truth.varied.each_ref().map(of), &outcome)
}

/// Judges by margins and largest pole of the true loop, of the loop with less and with more inertia, and by what a trial showed.
#[must_use]
pub fn weigh(
    method: Method,
    optimum: &Optimum,
    (margins, radius): (Margins, f64),
    varied: [(Margins, f64); 2],
    outcome: &Outcome,
) -> Judgement {
    let stable = radius < 1.0;
    let most = most_overshoot(method);
    let quiet = outcome.duty_rms <= (1.5 * optimum.duty_rms).max(0.12);
    let accept =
        stable && !outcome.hunting && margins.ms <= MOST_MS && outcome.score.overshoot <= most && quiet;
    let j = cost(method, outcome) / optimum.cost;
    Judgement {
        j,
        stable,
        ms: margins.ms,
        ms_varied: varied.iter().map(|v| if v.1 < 1.0 { v.0.ms } else { f64::INFINITY }).fold(0.0, f64::max),
        overshoot: outcome.score.overshoot,
        duty_rms: outcome.duty_rms,
        hunting: outcome.hunting,
        ripple: (outcome.ripple, outcome.ripple_hz),
        refused: None,
        accept,
        good: accept && j <= 1.5,
    }
}

/// A refusal.
#[must_use]
pub fn refusal<L: Law>(report: &report::Report<L>) -> Judgement {
    let refused = report.causes.first().copied().or(Some(Cause::TooCoarse));
    Judgement { j: f64::INFINITY, stable: true, refused, ..Judgement::default() }
}

/// Judges a report.
#[must_use]
pub fn judge_report(specimen: &Specimen, truth: &Truth, optimum: &Optimum, report: &Report) -> Judgement {
    let registers = match (report.verdict, report.proposed.velocity) {
        (Verdict::Refused, _) | (_, None) => return refusal(report),
        (_, Some(velocity)) => Registers { velocity, position: report.proposed.position },
    };
    judge(report.request.method, specimen, truth, optimum, &registers)
}

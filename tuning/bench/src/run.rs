//! Runs the tuner on one plant, in virtual time over the wire, and judges what came out on the true plant.

use crate::bounds::{MOST_MS, most_overshoot};
use crate::optimum::Optimum;
use crate::oracle::cost;
use crate::population::Specimen;
use crate::unit::{Registers, Report, Request, UnderTest, Unit};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::GuardOptions;
use brushwork_tuning::law::Law;
use brushwork_tuning::linear::{LoopPlant, Margins};
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{self, Excitation, Method, tune};

/// What the bench asks for.
#[must_use]
pub fn request_of<U, L: Law>(specimen: &Specimen<U>, method: Method) -> tune::Request<L> {
    tune::Request {
        method,
        excitation: Excitation::Free,
        guard: GuardOptions { poll_s: specimen.link.poll_s, ..GuardOptions::default() },
        ..tune::Request::default()
    }
}

/// A tuning run of a plant.
#[must_use]
pub fn tune_plant<U: Unit>(specimen: &Specimen<U>, request: &Request<U>) -> (Report<U>, U::Axis) {
    let mut axis = U::axis(specimen);
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

/// Margins and largest pole that registers give a loop.
pub(crate) fn linear<U: Unit>(
    plant: &LoopPlant,
    under_test: &UnderTest<U>,
    method: Method,
    registers: &Registers<U>,
) -> (Margins, f64) {
    let truth = &under_test.truth;
    let gains = truth.law.gains(registers, truth.qpps, method != Method::Velocity);
    let qpps = U::held_qpps(registers).unwrap_or(truth.qpps);
    (plant.margins(&gains, qpps), plant.spectral_radius(&gains, qpps))
}

/// Judges registers, by margins and largest pole of the true loop, of the loop with less and with more inertia, and by what a trial
/// shows.
#[must_use]
pub fn judge<U: Unit>(
    method: Method,
    under_test: &UnderTest<U>,
    optimum: &Optimum,
    registers: &Registers<U>,
) -> Judgement {
    let of = |plant: &LoopPlant| linear(plant, under_test, method, registers);
    let (margins, radius) = of(&under_test.truth.nominal);
    let varied = under_test.truth.varied.each_ref().map(of);
    let outcome = U::trial(under_test, method, registers);
    let stable = radius < 1.0;
    let most = most_overshoot(method);
    let quiet = outcome.duty_rms <= (1.5 * optimum.duty_rms).max(0.12);
    let accept =
        stable && !outcome.hunting && margins.ms <= MOST_MS && outcome.score.overshoot <= most && quiet;
    let j = cost(method, &outcome) / optimum.cost;
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

/// Judges a report.
#[must_use]
pub fn judge_report<U: Unit>(under_test: &UnderTest<U>, optimum: &Optimum, report: &Report<U>) -> Judgement {
    if report.verdict == Verdict::Refused || report.proposed == Registers::<U>::default() {
        let refused = report.causes.first().copied().or(Some(Cause::TooCoarse));
        return Judgement { j: f64::INFINITY, stable: true, refused, ..Judgement::default() };
    }
    judge(report.request.method, under_test, optimum, &report.proposed)
}

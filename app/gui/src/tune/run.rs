//! One run as the window keeps it: its report, what it looked like, and the gains that are considered now.

use std::cell::OnceCell;

use brushwork_core::tune::law::{AnyLaw, AnyRegisters, Report, Task, Trace, Trial, TrialRequest};
use brushwork_link::exchange::Interruption;
use brushwork_tuning::alternatives::{Alternative, alternatives};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::law::Law;
use brushwork_tuning::load_change::LoadChange;
use brushwork_tuning::model::Gains;
use brushwork_tuning::promise::Promise;
use brushwork_tuning::registers::RegisterTable as _;
use brushwork_tuning::report::{Measured, Verdict};
use brushwork_tuning::trace::{Predicted, Stretch};
use brushwork_tuning::trial::on_model;
use brushwork_tuning::tune::Excitation;
use brushwork_tuning::whatif::{Forecast, LoopPoint, forecast, frequency_response, redesign_registers};

use super::measured::{self, Figures};

/// Speeds are taken over this long while counts are coarse, s.
pub const SPEED_OVER_S: f64 = 0.02;

/// Gains on the model: what they promise, and the loop over frequency.
#[derive(Clone, Debug)]
pub struct Shown {
    pub registers: AnyRegisters,
    pub gains: Gains,
    pub forecast: Forecast,
    pub frequency: Vec<LoopPoint>,
    /// The ranges of its figures; `None` where the motor was not fitted.
    pub promise: Option<Promise>,
    /// Worked out where it is drawn: it takes longer than all the rest.
    stood: OnceCell<Option<LoadChange>>,
}

impl Shown {
    /// What change of its load the loop stands, on the model of `report`.
    pub fn stood(&self, report: &Report) -> Option<&LoadChange> {
        let work_out = || {
            let (task, gains) = considered(report, &self.registers)?;
            LoadChange::of(&task, &gains)
        };
        self.stood.get_or_init(work_out).as_ref()
    }
}

/// A stretch of the machine in which some gains were tried.
#[derive(Clone, Debug)]
pub struct Tried {
    pub trace: Trace,
    pub stretch: Stretch,
    pub registers: AnyRegisters,
    /// What the model predicts for the same commands, with the gains that were tried.
    pub predicted: Vec<Predicted>,
    /// The same with the gains that are considered, where they are others.
    pub considered: Vec<Predicted>,
    /// Of the steps as measured, and as predicted.
    pub figures: Option<Figures>,
    pub promised: Option<Figures>,
    /// Of the duty on plateaus, as measured.
    pub duty_rms: Option<f64>,
}

/// One run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Counted from 1.
    pub number: usize,
    pub report: Report,
    /// What broke into it.
    pub interrupted: Option<Interruption>,
    /// What was tried on the machine last: by the run itself or by a verification.
    pub tried: Option<Tried>,
    /// What a verification said.
    pub verified: Option<Result<(), Cause>>,
    /// Where the slider stands.
    pub level: f64,
    /// What is considered, by the level or by hand.
    pub shown: Option<Shown>,
    /// What the run proposed.
    pub first: Option<AnyRegisters>,
    /// The whole run, where it was refused: what was seen.
    pub seen: Option<Trace>,
    /// What textbook rules would set on its model.
    pub rules: Vec<Alternative<AnyLaw>>,
    /// Drawn under other runs.
    pub is_overlaid: bool,
    /// What is drawn of the gains that the controller holds.
    current: Option<Shown>,
    pub looked_at: Option<AnyRegisters>,
}

impl Run {
    pub fn new(number: usize, report: Report) -> Self {
        let motor = report.request.guard.motor;
        let trace = Trace::of(motor, &report.record);
        let seen = (report.verdict == Verdict::Refused).then(|| trace.clone());
        let first = proposed(&report);
        let tried = tried(trace, report.measured, &report);
        let mut run = Self {
            number,
            interrupted: None,
            tried,
            verified: None,
            level: report.request.level,
            shown: None,
            first,
            seen,
            rules: alternatives(&report),
            is_overlaid: true,
            current: None,
            looked_at: None,
            report,
        };
        run.shown = first.and_then(|registers| run.on_model(registers));
        run.predict_considered();
        run
    }

    /// Another run has come: this one shows what it was, not what was considered after it, unless the machine has tried that.
    pub fn settle(&mut self) {
        let tried = self.tried.as_ref().zip(self.shown.as_ref());
        let is_tried = tried.is_some_and(|(tried, shown)| shown.registers.same_gains(&tried.registers));
        if !is_tried {
            self.reset();
        }
    }

    pub fn is_refused(&self) -> bool {
        self.report.verdict == Verdict::Refused
    }

    pub fn task(&self) -> Option<&Task> {
        self.report.task.as_ref()
    }

    /// What gains do on this run's model.
    pub fn on_model(&self, registers: AnyRegisters) -> Option<Shown> {
        let (task, gains) = considered(&self.report, &registers)?;
        Some(Shown {
            registers,
            gains,
            forecast: forecast(&task, &gains),
            promise: self.report.fit.map(|fit| Promise::of(&task, &gains, &fit, self.report.lag.as_ref())),
            frequency: frequency_response(&task, &gains),
            stood: OnceCell::new(),
        })
    }

    /// The slider was moved: the gains of that level, with no new experiment.
    pub fn set_level(&mut self, level: f64) {
        self.level = level;
        if let Some(registers) = redesign_registers(&self.report, level).filter(|_| self.first.is_some()) {
            self.consider(registers);
        }
    }

    /// A gain was entered by hand.
    pub fn consider(&mut self, registers: AnyRegisters) {
        self.shown = self.on_model(registers);
        self.predict_considered();
    }

    /// What the considered gains would have made of the commands of the trial.
    fn predict_considered(&mut self) {
        let Some(tried) = &mut self.tried else { return };
        let shown = self.shown.as_ref().filter(|shown| !shown.registers.same_gains(&tried.registers));
        let with = shown.and_then(|shown| considered(&self.report, &shown.registers));
        tried.considered =
            with.map(|(task, gains)| tried.trace.predict(&task, &gains, &tried.stretch)).unwrap_or_default();
    }

    /// Back to what the run proposed.
    pub fn reset(&mut self) {
        self.level = self.report.request.level;
        if let Some(first) = self.first {
            self.consider(first);
        }
    }

    /// Whether what is considered is what the run proposed.
    pub fn is_as_proposed(&self) -> bool {
        self.shown.as_ref().map(|shown| shown.registers) == self.first
    }

    /// What the gains that the controller holds do on this model; worked out when they change.
    pub fn look_at_held(&mut self, held: Option<AnyRegisters>) {
        let wanted = held;
        if self.looked_at != wanted {
            let held = held.filter(AnyRegisters::has_a_loop);
            self.current = held.and_then(|registers| self.on_model(registers));
            self.looked_at = wanted;
        }
    }

    pub fn current(&self) -> Option<&Shown> {
        self.current.as_ref()
    }

    /// What to try on the machine.
    pub fn trial(&self) -> Option<TrialRequest> {
        let registers = self.shown.as_ref()?.registers;
        Some(TrialRequest {
            request: self.report.request,
            task: self.report.task?,
            probe: self.report.probe?,
            registers,
        })
    }

    /// A verification has ended.
    pub fn was_tried(&mut self, trial: &Trial) {
        self.verified = Some(trial.cause.map_or(Ok(()), Err));
        let trace = Trace::of(self.report.request.guard.motor, &trial.record);
        if let Some(tried) = tried(trace, trial.measured, &self.report) {
            self.tried = Some(tried);
        }
        self.predict_considered();
    }
}

/// What a run proposes.
fn proposed(report: &Report) -> Option<AnyRegisters> {
    let proposed = report.proposed;
    (proposed != AnyRegisters::default()).then_some(proposed)
}

/// The model with what registers say of its law, and the gains that they stand for.
fn considered(report: &Report, registers: &AnyRegisters) -> Option<(Task, Gains)> {
    let task = report.task?;
    let (task, gains) = on_model(&task, registers, report.request.method);
    match registers.raw("velocity.qpps") {
        Some(qpps) => Some((Task { qpps: (qpps as f64).max(1.0), ..task }, gains)),
        None => Some((task, gains)),
    }
}

/// The last stretch in which a loop held the motor, and with which gains.
fn tried(trace: Trace, measured: Option<Measured>, report: &Report) -> Option<Tried> {
    let stretch = *trace.stretches().last()?;
    let before = report.before.unwrap_or_default();
    let mut registers = AnyLaw::before(&before.held);
    for (_, written) in trace.writes.iter().filter(|(at, _)| *at <= stretch.from_s) {
        AnyLaw::take(&mut registers, written);
    }
    if !stretch.is_position {
        registers = registers.of_speed();
    }
    let values = |place: f64, speed: f64| if stretch.is_position { place } else { speed };
    let with = considered(report, &registers);
    let predicted = with.map(|(task, gains)| trace.predict(&task, &gains, &stretch)).unwrap_or_default();
    let (seen, rounding) = if stretch.is_position {
        (trace.points.iter().map(|point| (point.t, point.counts)).collect(), 1.0)
    } else {
        (trace.speeds(SPEED_OVER_S), 1.0 / SPEED_OVER_S)
    };
    let course: Vec<(f64, f64)> = predicted.iter().map(|p| (p.t, values(p.counts, p.speed))).collect();
    let mut figures = measured::figures(&trace, &stretch, &seen, rounding);
    let promised = measured::figures(&trace, &stretch, &course, 0.0);
    // Its flanks laid over each other see a speed go past its setpoint better than each by itself; strokes in a travel have no such flanks.
    let has_flanks = !stretch.is_position && report.request.excitation == Excitation::Free;
    if let (Some(figures), Some(measured)) = (figures.as_mut(), measured.filter(|_| has_flanks)) {
        figures.overshoot = measured.overshoot;
    }
    let duty_rms = measured.map(|measured| measured.duty_rms).filter(|rms| *rms > 0.0);
    let considered = Vec::new();
    Some(Tried { trace, stretch, registers, predicted, considered, figures, promised, duty_rms })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_overshoot_of_a_speed_is_that_of_its_flanks_laid_over_each_other() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reports/velocity.json");
        let report = brushwork_core::tune::file::read(Path::new(path)).expect("a report");
        let measured = report.measured.expect("a trial");
        let figures =
            |report: Report| Run::new(1, report).tried.and_then(|tried| tried.figures).expect("steps");
        assert!((figures(report.clone()).overshoot - measured.overshoot).abs() < 1e-12);
        let none = Report { measured: Some(Measured { overshoot: 0.0, ..measured }), ..report.clone() };
        assert_eq!(figures(none).overshoot, 0.0, "a trial that saw none");
        let alone = figures(Report { measured: None, ..report });
        assert!(alone.overshoot > 0.0 && alone.overshoot != measured.overshoot, "{alone:?}");
    }
}

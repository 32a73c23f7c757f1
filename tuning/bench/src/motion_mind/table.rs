//! The table of the benchmark for the Motion Mind: our methods and the textbook rules on the same records.

pub use super::axis::{Report, Request, SimulatedMind, axis_in, axis_of};
use super::faults::fault_rows;
use super::plant_under_test::MindPlantUnderTest;
use super::population::{MindSpecimen, population};
use crate::cache::{MindOptima, known_mind};
use crate::faults::FaultRow;
use crate::oracle::{Optimum, PlantUnderTest, optimum};
use crate::run::{Judgement, refusal, weigh};
use crate::table::{
    Identification, Judged, Row, Table, WINDOW_S, error_percent, identification_of, row, window_summary,
};
use brushwork_motion_mind_axis::law::MotionMindRegisters;
use brushwork_tuning::linear::LoopPlant;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::rules::{pd_rules, pid_rules, velocity_rules};
use brushwork_tuning::tune::{Excitation, Method, tune};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The methods and their names in the table. There is no cascade in this family.
pub const TASKS: [(&str, Method); 3] =
    [("velocity", Method::Velocity), ("pd", Method::Pd), ("pid", Method::Pid)];

/// One plant with its optima, in the order of [`TASKS`].
pub struct Case {
    /// The plant and its truth.
    pub under_test: MindPlantUnderTest,
    /// Its optima.
    pub optima: [Option<Optimum>; 3],
}

/// The plants of a seed with their optima, known ones from the repository.
#[must_use]
pub fn cases(seed: u64, plants: usize, fresh: bool) -> Vec<Case> {
    let cached = if fresh { MindOptima::new() } else { known_mind(seed) };
    population(seed, plants)
        .into_par_iter()
        .map(|specimen| {
            let number = specimen.plant.number;
            let under_test = MindPlantUnderTest::new(specimen);
            let work_out = || TASKS.map(|(_, method)| optimum(&under_test, method));
            let optima = cached.get(&number).copied().unwrap_or_else(work_out);
            Case { under_test, optima }
        })
        .collect()
}

/// The optima of cases, to be kept.
#[must_use]
pub fn optima_of(cases: &[Case]) -> MindOptima {
    cases.iter().map(|case| (case.under_test.specimen.plant.number, case.optima)).collect()
}

/// What the bench asks for.
#[must_use]
pub fn request_of(specimen: &MindSpecimen, method: Method) -> Request {
    crate::run::request_of(&specimen.plant, method)
}

/// A tuning run of a plant.
#[must_use]
pub fn tune_plant(specimen: &MindSpecimen, request: &Request) -> (Report, SimulatedMind) {
    let mut axis = axis_of(specimen);
    let report = tune(&mut axis, request);
    (report, axis)
}

/// Runs everything. `faults` leaves the fault runs out when false.
#[must_use]
pub fn table(seed: u64, cases: &[Case], faults: bool) -> Table {
    let mut tasks = BTreeMap::new();
    let mut velocity_reports = Vec::new();
    for (nth, (name, method)) in TASKS.into_iter().enumerate() {
        let reports: Vec<(Report, f64)> = cases
            .par_iter()
            .map(|case| {
                let specimen = &case.under_test.specimen;
                let (report, axis) = tune_plant(specimen, &request_of(specimen, method));
                let stall = specimen.plant.axis.stall_amps(specimen.plant.volts());
                (report, axis.carrier.line.truth.peak_amps / stall)
            })
            .collect();
        tasks.insert(name, rows(nth, cases, &reports));
        if method == Method::Velocity {
            velocity_reports = reports;
        }
    }
    let mut identification = identify(cases, &velocity_reports);
    identification.ms_varied_p95 = tasks["velocity"].first().map_or(0.0, |row: &Row| row.ms_varied_p95);
    let plants = || cases.iter().map(|case| case.under_test.specimen.clone()).collect::<Vec<_>>();
    let faults: Vec<FaultRow> = if faults { fault_rows(&plants(), &[]) } else { Vec::new() };
    Table { seed, plants: cases.len(), tasks, absolute: BTreeMap::new(), identification, faults }
}

fn rows(nth: usize, cases: &[Case], reports: &[(Report, f64)]) -> Vec<Row> {
    let (_, method) = TASKS[nth];
    let judged = |case: &Case, result: Judgement, seconds: f64| {
        Judged::new(method, &case.under_test.specimen.plant, &case.under_test.truth, result, seconds)
    };
    let ours: Vec<Judged> = cases
        .par_iter()
        .zip(reports)
        .filter_map(|(case, (report, _))| {
            let optimum = case.optima[nth]?;
            Some(judged(case, judge_report(&case.under_test, &optimum, report), report.seconds.1))
        })
        .collect();
    let mut rows = vec![row("brushwork", ours.iter())];
    let ruled: Vec<Vec<(&'static str, Judged)>> = cases
        .par_iter()
        .zip(reports)
        .filter_map(|(case, (report, _))| {
            let optimum = case.optima[nth]?;
            let of = |(name, registers)| {
                let result = judge(method, &case.under_test, &optimum, &registers);
                (name, judged(case, result, report.seconds.0))
            };
            Some(by_rules(method, &case.under_test, report)?.into_iter().map(of).collect())
        })
        .collect();
    let names: Vec<&str> =
        ruled.first().map(|all| all.iter().map(|rule| rule.0).collect()).unwrap_or_default();
    for (n, name) in names.iter().enumerate() {
        rows.push(row(name, ruled.iter().filter_map(|all| all.get(n)).map(|rule| &rule.1)));
    }
    rows
}

/// What each rule makes of the record of a run, as registers. The factory's are those of this family.
fn by_rules(
    method: Method,
    under_test: &MindPlantUnderTest,
    report: &Report,
) -> Option<Vec<(&'static str, MotionMindRegisters)>> {
    let (classic, qpps) = (report.classic?, report.qpps?);
    let law = &under_test.truth.law;
    let rules = match method {
        Method::Velocity => velocity_rules(&classic, law, qpps),
        Method::Pd | Method::Piv => pd_rules(&classic, law, qpps),
        Method::Pid => pid_rules(&classic, law, qpps),
    };
    let of_rules = rules.into_iter().filter(|rule| rule.0 != "factory");
    let factory = std::iter::once(("factory", under_test.factory(method)));
    Some(factory.chain(of_rules.map(|(name, gains)| (name, under_test.registers(&gains, qpps)))).collect())
}

/// Judges registers on the true plant.
#[must_use]
pub fn judge(
    method: Method,
    under_test: &MindPlantUnderTest,
    optimum: &Optimum,
    registers: &MotionMindRegisters,
) -> Judgement {
    let truth = under_test.truth();
    let gains: Gains = registers.gains(truth.qpps, method != Method::Velocity);
    let of =
        |plant: &LoopPlant| (plant.margins(&gains, truth.qpps), plant.spectral_radius(&gains, truth.qpps));
    let outcome = under_test.trial(method, registers);
    weigh(method, optimum, of(&truth.nominal), truth.varied.each_ref().map(of), &outcome)
}

/// Judges a report.
#[must_use]
pub fn judge_report(under_test: &MindPlantUnderTest, optimum: &Optimum, report: &Report) -> Judgement {
    match report.proposed.motion_mind {
        Some(registers) if report.verdict != Verdict::Refused => {
            judge(report.request.method, under_test, optimum, &registers)
        }
        _ => refusal(report),
    }
}

fn identify(cases: &[Case], reports: &[(Report, f64)]) -> Identification {
    let found =
        || cases.iter().zip(reports).map(|(case, (report, peak))| (&case.under_test.truth, report, *peak));
    let ms = cases.iter().zip(reports).filter_map(|(case, (report, _))| {
        let truth = &case.under_test.truth;
        let gains = report.proposed.motion_mind?.gains(truth.qpps, false);
        Some((truth.nominal.margins(&gains, truth.qpps).ms - report.design?.ms).abs())
    });
    let windows: Vec<(Option<f64>, f64)> =
        cases.par_iter().map(|case| window_run(&case.under_test)).collect();
    window_summary(identification_of(found(), &ms.collect::<Vec<_>>()), &windows)
}

/// The error of QPPS found inside the window, and the farthest reach over half the window, both in percent.
fn window_run(under_test: &MindPlantUnderTest) -> (Option<f64>, f64) {
    let width = (WINDOW_S * under_test.truth.qpps).round();
    let request = Request {
        excitation: Excitation::Window(width),
        verify: false,
        ..request_of(&under_test.specimen, Method::Pd)
    };
    let (report, _) = tune_plant(&under_test.specimen, &request);
    let error = report.qpps.map(|qpps| error_percent(qpps, under_test.truth.qpps));
    (error, report.window.map_or(0.0, |window| 200.0 * window.reach_counts / width))
}

//! The table of the benchmark: our methods and every textbook rule, side by side on the same records.

use crate::bounds::PROMISED_MS;
use crate::faults::{FaultRow, fault_rows};
use crate::optimum::{Optima as _, OptimaByPlant};
use crate::oracle::{optima, position_optima};
pub use crate::quantile::quantile;
use crate::reject::group;
use crate::run::{Judgement, judge, judge_report, linear, request_of, tune_plant};
use crate::truth::Truth;
use crate::unit::{Registers, Report, Request, UnderTest, Unit, population};
use brushwork_tuning::law::Law;
use brushwork_tuning::report::{self, Verdict};
use brushwork_tuning::rules::{pd_rules, pid_rules, piv_rules, velocity_rules};
use brushwork_tuning::tune::{Excitation, Method};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Cost that stands for no gains at all.
const REFUSED_COST: f64 = 1000.0;
/// The travel window of the identification, s of full speed.
const WINDOW_S: f64 = 0.2;

/// The rule that sets nothing.
const FACTORY: &str = "factory";
/// One machine with an absolute encoder for so many others.
const SHARE_OF_ABSOLUTE: usize = 8;

/// One row: shares and overshoot in percent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// "brushwork" or the name of a rule.
    pub method: String,
    /// Stable, no limit cycle, maximum sensitivity, overshoot and duty noise within bounds, %.
    pub accept: f64,
    /// Accepted and at most half as costly again as the optimum, %.
    pub good: f64,
    /// Cost over the optimum's, median.
    pub j_median: f64,
    /// The same, 95th percentile; 1000 stands for a refusal.
    pub j_p95: f64,
    /// Loops that are unstable on the true plant, %.
    pub unstable: f64,
    /// Maximum sensitivity on the true plant, 95th percentile.
    pub ms_p95: f64,
    /// The same with the inertia at half and at half as much again, whichever is worse. JSON has it with the identification.
    #[serde(skip)]
    pub ms_varied_p95: f64,
    /// True overshoot, 95th percentile, %.
    pub overshoot_p95: f64,
    /// Gains without a warning, %; `None` of a rule, which never warns.
    pub unwarned: Option<f64>,
    /// Gains without a warning that are unstable on the true plant or have a maximum sensitivity above 1.8, %.
    pub overpromised: Option<f64>,
    /// Length of the run, s.
    pub seconds_median: f64,
    /// What was not accepted, by what was measured and on what machine, and how many of each.
    pub rejects: BTreeMap<String, usize>,
}

/// Errors of the identification in percent, and what it costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Identification {
    /// QPPS on a free axis.
    pub qpps_error_median: f64,
    /// QPPS on a free axis.
    pub qpps_error_p95: f64,
    /// Gain.
    pub gain_error_median: f64,
    /// Gain.
    pub gain_error_p95: f64,
    /// Time constant of plants slower than 30 ms.
    pub tau_error_median: f64,
    /// Time constant of plants slower than 30 ms.
    pub tau_error_p95: f64,
    /// Lag of firmware and winding, ms.
    pub lag_error_ms_median: f64,
    /// Lag of firmware and winding, ms.
    pub lag_error_ms_p95: f64,
    /// Runs whose interval of QPPS holds it, %.
    pub qpps_inside: f64,
    /// Whole width of that interval, median, %.
    pub qpps_width: f64,
    /// Runs whose interval of the gain holds it, %.
    pub gain_inside: f64,
    /// Whole width of that interval, median, %.
    pub gain_width: f64,
    /// Runs whose interval of the time constant holds it, %.
    pub tau_inside: f64,
    /// Whole width of that interval, median, %.
    pub tau_width: f64,
    /// Runs whose interval of the lag holds it, %.
    pub lag_inside: f64,
    /// Whole width of that interval, median, ms.
    pub lag_width_ms: f64,
    /// Runs whose interval of the friction holds it, %.
    pub friction_inside: f64,
    /// Whole width of that interval, median, % duty.
    pub friction_width: f64,
    /// Runs whose range of the maximum sensitivity holds the true one, %.
    pub ms_inside: f64,
    /// Whole width of that range, median.
    pub ms_width: f64,
    /// Runs whose range of the settling time holds the one of a trial, %.
    pub settling_inside: f64,
    /// Whole width of that range over the likely settling time, median, %.
    pub settling_width: f64,
    /// Predicted against true maximum sensitivity of the velocity loop.
    pub ms_error_p95: f64,
    /// Maximum sensitivity of our velocity loop at half or half as much more inertia.
    pub ms_varied_p95: f64,
    /// Length of the identification, s.
    pub seconds_median: f64,
    /// Highest current over the stall current, %.
    pub peak_current_p95: f64,
    /// QPPS inside a window of 0.2 s of full-speed travel.
    pub window_qpps_error_median: f64,
    /// QPPS inside that window.
    pub window_qpps_error_p95: f64,
    /// Plants that the window run refused, %.
    pub window_refused: f64,
    /// Farthest reach in the window over half its width, %.
    pub window_reach_p95: f64,
}

/// The whole table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Seed of the population.
    pub seed: u64,
    /// Size of the population.
    pub plants: usize,
    /// Rows by task.
    pub tasks: BTreeMap<&'static str, Vec<Row>>,
    /// Machines with absolute encoders, rows by task: they are tuned in position.
    pub absolute: BTreeMap<&'static str, Vec<Row>>,
    /// Identification.
    pub identification: Identification,
    /// Faults.
    pub faults: Vec<FaultRow>,
}

/// One plant and all that is known of it.
pub struct Case<U: Unit> {
    /// The plant and its truth.
    pub under_test: UnderTest<U>,
    /// Its optima.
    pub optima: U::Optima,
}

/// The plants of a seed with their optima, known ones from the repository.
#[must_use]
pub fn cases<U: Unit>(seed: u64, plants: usize, fresh: bool) -> Vec<Case<U>> {
    let text = if fresh { "" } else { U::known(seed) };
    let cached: OptimaByPlant<U::Optima> = serde_json::from_str(text).unwrap_or_default();
    population(seed, plants)
        .into_par_iter()
        .map(|specimen| {
            let under_test = UnderTest::new(specimen);
            let known = cached.get(&under_test.specimen.number).copied();
            Case { optima: known.unwrap_or_else(|| optima(&under_test)), under_test }
        })
        .collect()
}

/// The optima of cases, to be kept.
#[must_use]
pub fn optima_of<U: Unit>(cases: &[Case<U>]) -> OptimaByPlant<U::Optima> {
    cases.iter().map(|case| (case.under_test.specimen.number, case.optima)).collect()
}

/// Runs everything. `faults` leaves the fault runs out when false.
#[must_use]
pub fn table<U: Unit>(seed: u64, cases: &[Case<U>], faults: bool) -> Table {
    let mut tasks = BTreeMap::new();
    let mut velocity_reports = Vec::new();
    for (name, method) in U::TASKS {
        let reports = reports(*method, cases);
        tasks.insert(*name, rows(*method, cases, &reports));
        if *method == Method::Velocity {
            velocity_reports = reports;
        }
    }
    let mut identification = identification(cases, &velocity_reports);
    identification.ms_varied_p95 =
        tasks.get("velocity").and_then(|rows| rows.first()).map_or(0.0, |row: &Row| row.ms_varied_p95);
    let plants = || cases.iter().map(|case| case.under_test.specimen.clone()).collect::<Vec<_>>();
    let faults = if faults { fault_rows(&plants()) } else { Vec::new() };
    let absolute = absolute_rows::<U>(seed, cases.len() / SHARE_OF_ABSOLUTE);
    Table { seed, plants: cases.len(), tasks, absolute, identification, faults }
}

/// A run of a method on each plant, with its highest current over the stall current.
fn reports<U: Unit>(method: Method, cases: &[Case<U>]) -> Vec<(Report<U>, f64)> {
    let run = |case: &Case<U>| {
        let specimen = &case.under_test.specimen;
        let (report, mut axis) = tune_plant(specimen, &request_of(specimen, method));
        let stall = specimen.axis.stall_amps(specimen.volts());
        (report, U::line(&mut axis).truth.peak_amps / stall)
    };
    cases.par_iter().map(run).collect()
}

/// The rows of so many machines with absolute encoders. Their optima are worked out each time.
#[must_use]
pub fn absolute_rows<U: Unit>(seed: u64, plants: usize) -> BTreeMap<&'static str, Vec<Row>> {
    let Some(specimen) = U::ABSOLUTE else { return BTreeMap::new() };
    let worked_out = |number| {
        let under_test = UnderTest::new(specimen(seed, number));
        Case { optima: position_optima(&under_test), under_test }
    };
    let cases: Vec<Case<U>> = (0..plants).into_par_iter().map(worked_out).collect();
    let of =
        |(name, method): &(&'static str, Method)| (*name, rows(*method, &cases, &reports(*method, &cases)));
    U::TASKS.iter().filter(|(_, method)| *method != Method::Velocity).map(of).collect()
}

fn rows<U: Unit>(method: Method, cases: &[Case<U>], reports: &[(Report<U>, f64)]) -> Vec<Row> {
    let ours: Vec<Judged> = cases
        .par_iter()
        .zip(reports)
        .filter_map(|(case, (report, _))| {
            let optimum = case.optima.of(method)?;
            let judged = judge_report(&case.under_test, &optimum, report);
            let is_unwarned = Some(report.verdict == Verdict::Tuned);
            Some(Judged { is_unwarned, ..Judged::new(method, &case.under_test, judged, report.seconds.1) })
        })
        .collect();
    let mut rows = vec![row("brushwork", ours.iter())];
    let ruled: Vec<Vec<(&'static str, Judged)>> = cases
        .par_iter()
        .zip(reports)
        .filter_map(|(case, (report, _))| by_rules(method, case, report))
        .collect();
    let names: Vec<&str> =
        ruled.first().map(|all| all.iter().map(|rule| rule.0).collect()).unwrap_or_default();
    for (n, name) in names.iter().enumerate() {
        rows.push(row(name, ruled.iter().filter_map(|all| all.get(n)).map(|rule| &rule.1)));
    }
    rows
}

/// What each rule makes of the record of a run.
fn by_rules<U: Unit>(
    method: Method,
    case: &Case<U>,
    report: &Report<U>,
) -> Option<Vec<(&'static str, Judged)>> {
    let classic = report.classic?;
    let qpps = report.qpps?;
    let optimum = case.optima.of(method)?;
    let truth = &case.under_test.truth;
    let law = &truth.law;
    let rules = match method {
        Method::Velocity => velocity_rules(&classic, law, qpps),
        Method::Pd => pd_rules(&classic, law, qpps),
        Method::Pid => pid_rules(&classic, law, qpps),
        Method::Piv => piv_rules(&classic, law, qpps),
    };
    let factory = U::factory(truth, method).map(|registers| (FACTORY, registers));
    let of_rules = rules
        .into_iter()
        .filter(|(name, _)| factory.is_none() || *name != FACTORY)
        .map(|(name, gains)| (name, U::registers(law, &gains, qpps)));
    let judged = factory.into_iter().chain(of_rules).map(|(name, registers)| {
        let judged = judge(method, &case.under_test, &optimum, &registers);
        (name, Judged::new(method, &case.under_test, judged, report.seconds.0))
    });
    Some(judged.collect())
}

/// A judgement, the length of its run, and its group if it was not accepted.
struct Judged {
    result: Judgement,
    seconds: f64,
    reject: Option<String>,
    /// Whether a run gave its gains without a warning.
    is_unwarned: Option<bool>,
}

impl Judged {
    fn new<U: Unit>(method: Method, under_test: &UnderTest<U>, result: Judgement, seconds: f64) -> Self {
        let reject = group(method, &under_test.specimen, &under_test.truth, &result);
        Self { result, seconds, reject, is_unwarned: None }
    }
}

fn row<'a>(method: &str, judged: impl Iterator<Item = &'a Judged>) -> Row {
    let all: Vec<&Judged> = judged.collect();
    let percent = |of: fn(&Judgement) -> bool| {
        100.0 * all.iter().filter(|j| of(&j.result)).count() as f64 / all.len().max(1) as f64
    };
    let of_runs = |is_counted: fn(&Judged) -> bool| {
        let has_runs = all.iter().any(|j| j.is_unwarned.is_some());
        let counted = || all.iter().filter(|j| j.is_unwarned == Some(true) && is_counted(j)).count();
        has_runs.then(|| round(100.0 * counted() as f64 / all.len() as f64, 1))
    };
    let given = || all.iter().map(|j| &j.result).filter(|j| j.refused.is_none());
    let j: Vec<f64> = all.iter().map(|j| j.result.j.min(REFUSED_COST)).collect();
    let mut rejects = BTreeMap::new();
    for reject in all.iter().filter_map(|j| j.reject.clone()) {
        *rejects.entry(reject).or_insert(0) += 1;
    }
    Row {
        method: method.to_owned(),
        accept: round(percent(|j| j.accept), 1),
        good: round(percent(|j| j.good), 1),
        j_median: round(quantile(j.iter().copied(), 0.5), 3),
        j_p95: round(quantile(j.iter().copied(), 0.95), 3),
        unstable: round(percent(|j| !j.stable), 1),
        ms_p95: round(quantile(given().map(|j| j.ms), 0.95), 3),
        ms_varied_p95: round(quantile(given().map(|j| j.ms_varied.min(REFUSED_COST)), 0.95), 3),
        overshoot_p95: round(100.0 * quantile(given().map(|j| j.overshoot), 0.95), 1),
        unwarned: of_runs(|_| true),
        overpromised: of_runs(|j| !j.result.stable || j.result.ms > PROMISED_MS),
        seconds_median: round(quantile(all.iter().map(|j| j.seconds), 0.5), 2),
        rejects,
    }
}

fn identification<U: Unit>(cases: &[Case<U>], reports: &[(Report<U>, f64)]) -> Identification {
    let found =
        || cases.iter().zip(reports).map(|(case, (report, peak))| (&case.under_test.truth, report, *peak));
    let kept = |(case, (report, _)): (&Case<U>, &(Report<U>, f64))| kept(&case.under_test, report);
    let kept: Vec<Kept> = cases.par_iter().zip(reports).filter_map(kept).collect();
    window_summary(identification_of(found(), &kept), &window_runs(cases))
}

/// What gains promised and what the true plant made of it.
struct Kept {
    ms_error: f64,
    /// Whether the range held the truth, and its width.
    ms: (bool, f64),
    /// The same, the width over the likely value.
    settling: (bool, f64),
}

fn kept<U: Unit>(under_test: &UnderTest<U>, report: &Report<U>) -> Option<Kept> {
    let proposed = Some(&report.proposed).filter(|proposed| **proposed != Registers::<U>::default())?;
    let (design, promise) = (report.design?, report.promise()?);
    let ms = linear(&under_test.truth.nominal, under_test, Method::Velocity, proposed).0.ms;
    let settling_s = U::trial(under_test, Method::Velocity, proposed).score.settling_s;
    let of =
        |(low, high): (f64, f64), truth: f64, unit: f64| ((low..=high).contains(&truth), (high - low) / unit);
    Some(Kept {
        ms_error: (ms - design.ms).abs(),
        ms: of(promise.ms, ms, 1.0),
        settling: of(promise.settling_s, settling_s, design.score.settling_s.max(1e-3)),
    })
}

fn error_percent(got: f64, wanted: f64) -> f64 {
    100.0 * (got / wanted - 1.0).abs()
}

/// How far a report is from the truth.
type ErrorOf<L> = dyn Fn(&Truth<L>, &report::Report<L>) -> Option<f64>;

/// Whether an interval of a report holds the truth.
type HoldsOf<L> = dyn Fn(&Truth<L>, &report::Report<L>) -> Option<bool>;

/// What the velocity runs found against the truth: (truth, report, peak current over the stall current) of each plant, and what became of their promises.
fn identification_of<'a, L: Law>(
    found: impl Iterator<Item = (&'a Truth<L>, &'a report::Report<L>, f64)>,
    kept: &[Kept],
) -> Identification {
    let found: Vec<_> = found.collect();
    let of = |error: &ErrorOf<L>, share: f64| {
        quantile(found.iter().filter_map(|(truth, report, _)| error(truth, report)), share)
    };
    let qpps = |truth: &Truth<L>, report: &report::Report<L>| Some(error_percent(report.qpps?, truth.qpps));
    let gain = |truth: &Truth<L>, report: &report::Report<L>| {
        Some(error_percent(report.fit?.model.gain_counts_per_s, truth.gain_counts_per_s))
    };
    let tau = |truth: &Truth<L>, report: &report::Report<L>| {
        let error = error_percent(report.fit?.time_constant().seconds, truth.tau_s);
        (truth.tau_s > 0.03).then_some(error)
    };
    let lag = |truth: &Truth<L>, report: &report::Report<L>| {
        let tick_s = truth.law.tick_s();
        Some(1e3 * (report.lag?.lag.total_s(tick_s) - truth.whole_lag_s()).abs())
    };
    let inside = |holds: &HoldsOf<L>| {
        let all: Vec<bool> = found.iter().filter_map(|(truth, report, _)| holds(truth, report)).collect();
        100.0 * all.iter().filter(|holds| **holds).count() as f64 / all.len().max(1) as f64
    };
    let width = |of: &dyn Fn(&report::Report<L>) -> Option<f64>| {
        quantile(found.iter().filter_map(|(_, report, _)| of(report)), 0.5)
    };
    Identification {
        qpps_error_median: round(of(&qpps, 0.5), 3),
        qpps_error_p95: round(of(&qpps, 0.95), 3),
        gain_error_median: round(of(&gain, 0.5), 2),
        gain_error_p95: round(of(&gain, 0.95), 2),
        tau_error_median: round(of(&tau, 0.5), 2),
        tau_error_p95: round(of(&tau, 0.95), 2),
        lag_error_ms_median: round(of(&lag, 0.5), 2),
        lag_error_ms_p95: round(of(&lag, 0.95), 2),
        qpps_inside: round(
            inside(&|truth, report| {
                let (found, free) = (report.qpps?, report.free?);
                Some((found / truth.qpps - 1.0).abs() <= free.interval)
            }),
            1,
        ),
        qpps_width: round(width(&|report| Some(200.0 * report.free?.interval)), 2),
        gain_inside: round(
            inside(&|truth, report| {
                let fit = report.fit?;
                let error = (fit.model.gain_counts_per_s / truth.gain_counts_per_s).ln().abs();
                Some(error <= 2.0 * fit.sd_ln_gain)
            }),
            1,
        ),
        gain_width: round(width(&|report| Some(400.0 * report.fit?.sd_ln_gain)), 2),
        tau_inside: round(
            inside(&|truth, report| {
                let found = report.fit?.time_constant();
                Some((found.seconds / truth.tau_s).ln().abs() <= 2.0 * found.sd_ln)
            }),
            1,
        ),
        tau_width: round(width(&|report| Some(400.0 * report.fit?.time_constant().sd_ln)), 2),
        lag_inside: round(
            inside(&|truth, report| {
                let (low, high) = report.lag?.interval_s;
                Some((low..=high).contains(&truth.whole_lag_s()))
            }),
            1,
        ),
        lag_width_ms: round(
            width(&|report| report.lag.map(|lag| 1e3 * (lag.interval_s.1 - lag.interval_s.0))),
            2,
        ),
        friction_inside: round(
            inside(&|truth, report| {
                let fit = report.fit?;
                Some((fit.model.coulomb_duty - truth.coulomb_duty).abs() <= 2.0 * fit.sd_coulomb)
            }),
            1,
        ),
        friction_width: round(width(&|report| Some(400.0 * report.fit?.sd_coulomb)), 2),
        ms_inside: share_of(kept, |kept| kept.ms.0),
        ms_width: round(quantile(kept.iter().map(|kept| kept.ms.1), 0.5), 3),
        settling_inside: share_of(kept, |kept| kept.settling.0),
        settling_width: round(100.0 * quantile(kept.iter().map(|kept| kept.settling.1), 0.5), 1),
        ms_error_p95: round(quantile(kept.iter().map(|kept| kept.ms_error), 0.95), 3),
        seconds_median: round(quantile(found.iter().map(|(_, report, _)| report.seconds.0), 0.5), 2),
        peak_current_p95: round(100.0 * quantile(found.iter().map(|(_, _, peak)| *peak), 0.95), 1),
        ..Identification::default()
    }
}

fn share_of(kept: &[Kept], holds: fn(&Kept) -> bool) -> f64 {
    round(100.0 * kept.iter().filter(|kept| holds(kept)).count() as f64 / kept.len().max(1) as f64, 1)
}

/// With the runs inside a window: for each the error of QPPS, and the farthest reach over half the window, both in percent.
fn window_summary(found: Identification, windows: &[(Option<f64>, f64)]) -> Identification {
    let qpps: Vec<f64> = windows.iter().filter_map(|w| w.0).collect();
    let refused = windows.iter().filter(|w| w.0.is_none()).count() as f64 / windows.len().max(1) as f64;
    Identification {
        window_qpps_error_median: round(quantile(qpps.iter().copied(), 0.5), 2),
        window_qpps_error_p95: round(quantile(qpps.iter().copied(), 0.95), 2),
        window_refused: round(100.0 * refused, 1),
        window_reach_p95: round(quantile(windows.iter().map(|w| w.1), 0.95), 1),
        ..found
    }
}

/// For each plant: the error of QPPS found inside the window, and the farthest reach over half the window, both in percent.
fn window_runs<U: Unit>(cases: &[Case<U>]) -> Vec<(Option<f64>, f64)> {
    let run = |case: &Case<U>| {
        let (specimen, qpps) = (&case.under_test.specimen, case.under_test.truth.qpps);
        let width = (WINDOW_S * qpps).round();
        let request = Request::<U> {
            excitation: Excitation::Window(width),
            verify: false,
            ..request_of(specimen, Method::Pd)
        };
        let (report, _) = tune_plant(specimen, &request);
        let error = report.qpps.map(|found| error_percent(found, qpps));
        (error, report.window.map_or(0.0, |window| 200.0 * window.reach_counts / width))
    };
    cases.par_iter().map(run).collect()
}

fn round(value: f64, digits: i32) -> f64 {
    let scale = 10.0_f64.powi(digits);
    (value * scale).round() / scale
}

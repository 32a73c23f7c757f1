//! Every way to tune an axis, turning freely and in a travel: how often gains are found, and whether what is said of them is true. It needs no optima.

use crate::bounds::{MOST_MS, PROMISED_MS};
use crate::optimum::Optimum;
use crate::population::Specimen;
use crate::quantile::quantile;
use crate::run::{judge_report, request_of, tune_plant};
use crate::unit::{Report, Request, UnderTest, Unit, population};
use brushwork_tuning::law::Law as _;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Excitation, Identification, Method};
use rayon::prelude::*;
use serde::Serialize;

/// The travel, s of full speed.
const TRAVEL_S: f64 = 0.5;

/// One way on all plants.
#[derive(Clone, Debug, Serialize)]
pub struct WayRow {
    /// How the motor was identified.
    pub identification: Identification,
    /// The loop.
    pub method: Method,
    /// In a travel; else it turned freely.
    pub in_travel: bool,
    /// Plants.
    pub plants: usize,
    /// Gains were found, %.
    pub found: f64,
    /// ... without a warning, %.
    pub unwarned: f64,
    /// They are accepted on the true plant, %.
    pub accepted: f64,
    /// They are unstable or have a true maximum sensitivity above 2, %.
    pub beyond: f64,
    /// They have one above 1.8 and no warning, %.
    pub overpromised: f64,
    /// Length of a run in the median, s.
    pub seconds_median: f64,
}

/// What became of one run.
struct Outcome {
    is_found: bool,
    is_unwarned: bool,
    is_accepted: bool,
    is_beyond: bool,
    is_overpromised: bool,
    seconds: f64,
}

/// The rows of the plants of a seed.
#[must_use]
pub fn way_rows<U: Unit>(seed: u64, plants: usize) -> Vec<WayRow> {
    let specimens = population::<U>(seed, plants);
    let has_duty = U::Law::default().facts().has_duty;
    let experiments = [Identification::Step, Identification::Relay].into_iter().filter(|_| has_duty);
    let mut rows = Vec::new();
    for identification in std::iter::once(Identification::Fit).chain(experiments) {
        for (_, method) in U::TASKS {
            for in_travel in [false, true] {
                let ask = |specimen: &Specimen<U>| outcome(specimen, identification, *method, in_travel);
                let outcomes: Vec<Outcome> = specimens.par_iter().map(ask).collect();
                rows.push(row((identification, *method, in_travel), &outcomes));
            }
        }
    }
    rows
}

fn outcome<U: Unit>(
    specimen: &Specimen<U>,
    identification: Identification,
    method: Method,
    in_travel: bool,
) -> Outcome {
    let under_test = UnderTest::<U>::new(specimen.clone());
    let width = TRAVEL_S * under_test.truth.qpps;
    let asked: Request<U> = request_of(specimen, method);
    let excitation = if in_travel { Excitation::Window(width) } else { asked.excitation };
    let (report, _) = tune_plant::<U>(specimen, &Request::<U> { identification, excitation, ..asked });
    judged(&under_test, &report)
}

fn judged<U: Unit>(under_test: &UnderTest<U>, report: &Report<U>) -> Outcome {
    // Acceptance asks nothing of an optimum but its noise, which is at least so much.
    let optimum = Optimum { cost: 1.0, duty_rms: 0.0, gains: brushwork_tuning::model::Gains::default() };
    let judged = judge_report(under_test, &optimum, report);
    let is_found = report.verdict != Verdict::Refused;
    let is_unwarned = report.verdict == Verdict::Tuned;
    Outcome {
        is_found,
        is_unwarned,
        is_accepted: judged.accept,
        is_beyond: is_found && (!judged.stable || judged.ms > MOST_MS),
        is_overpromised: is_unwarned && (!judged.stable || judged.ms > PROMISED_MS),
        seconds: report.seconds.1,
    }
}

fn row((identification, method, in_travel): (Identification, Method, bool), outcomes: &[Outcome]) -> WayRow {
    let plants = outcomes.len();
    let percent = |of: fn(&Outcome) -> bool| {
        let count = outcomes.iter().filter(|outcome| of(outcome)).count();
        (1_000.0 * count as f64 / plants.max(1) as f64).round() / 10.0
    };
    WayRow {
        identification,
        method,
        in_travel,
        plants,
        found: percent(|outcome| outcome.is_found),
        unwarned: percent(|outcome| outcome.is_unwarned),
        accepted: percent(|outcome| outcome.is_accepted),
        beyond: percent(|outcome| outcome.is_beyond),
        overpromised: percent(|outcome| outcome.is_overpromised),
        seconds_median: (10.0 * quantile(outcomes.iter().map(|outcome| outcome.seconds), 0.5)).round() / 10.0,
    }
}

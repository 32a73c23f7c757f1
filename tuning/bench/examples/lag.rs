//! What not knowing the lag costs: `cargo run --release -p brushwork-tuning-bench --example lag -- SEED PLANTS velocity|pd|pid|piv [motion-mind]`. For each
//! plant the lag that was measured beside the true one, and what the gains of the run cost beside those of designs for the true lag and for the likely lag alone, which
//! are not tried on the machine, the last one without what raised gains showed there.
#![expect(clippy::print_stdout, reason = "a tool talks to the terminal")]

use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_tuning::design::Task;
use brushwork_tuning::law::Law as _;
use brushwork_tuning::model::Lag;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Method, design_for};
use brushwork_tuning_bench::mcp::laws::MOST_TUNED_MS;
use brushwork_tuning_bench::motion_mind::population::MindSetup;
use brushwork_tuning_bench::optimum::Optima as _;
use brushwork_tuning_bench::reject::{MOST_MS, group};
use brushwork_tuning_bench::run::{Judgement, judge, judge_report, request_of, tune_plant};
use brushwork_tuning_bench::table::{Case, cases, quantile};
use brushwork_tuning_bench::unit::Unit;
use rayon::prelude::*;

/// Whose gains are compared.
const OF: [&str; 4] = ["run", "true lag", "likely lag", "likely lag, gains not raised on the machine"];

struct Found {
    text: String,
    judged: [Option<Judgement>; OF.len()],
    verdict: Verdict,
    /// Whether the interval holds the lag, and its width, ms.
    interval: Option<(bool, f64)>,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.get(3).map(String::as_str) {
        Some("motion-mind") => show::<MindSetup>(&words),
        _ => show::<ControlLaw>(&words),
    }
}

fn show<U: Unit>(words: &[String]) {
    let number = |n: usize, usual: u64| words.get(n).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let (seed, plants) = (number(0, 7), number(1, 24) as usize);
    let wanted = words.get(2).map_or("velocity", String::as_str);
    let Some((_, method)) = U::TASKS.iter().find(|(name, _)| *name == wanted) else {
        println!("no method {wanted}");
        return;
    };
    let all = cases::<U>(seed, plants, false);
    let found: Vec<Found> = all.par_iter().filter_map(|case| find(case, *method)).collect();
    for one in &found {
        println!("{}", one.text);
    }
    for (n, name) in OF.iter().enumerate() {
        let of = || found.iter().filter_map(|one| one.judged[n]);
        let share = |is: fn(&Judgement) -> bool| 100.0 * of().filter(is).count() as f64 / all.len() as f64;
        println!(
            "{name}: accepted {:.1} %, good {:.1} %, J median {:.2}, 95th percentile {:.2}, {} unstable, {} with a true Ms above 2",
            share(|one| one.accept),
            share(|one| one.good),
            quantile(of().map(|one| one.j), 0.5),
            quantile(of().map(|one| one.j), 0.95),
            of().filter(|one| !one.stable).count(),
            of().filter(|one| one.ms > MOST_MS).count()
        );
    }
    let tuned = || found.iter().filter(|one| one.verdict == Verdict::Tuned);
    let intervals = || found.iter().filter_map(|one| one.interval);
    println!(
        "{} tuned without a warning, {} of them above a true Ms of {MOST_TUNED_MS}; the interval holds the lag in {} of {}, its median width is {:.2} ms",
        tuned().count(),
        tuned().filter(|one| one.judged[0].is_some_and(|judged| judged.ms > MOST_TUNED_MS)).count(),
        intervals().filter(|interval| interval.0).count(),
        intervals().count(),
        quantile(intervals().map(|interval| interval.1), 0.5)
    );
}

fn find<U: Unit>(case: &Case<U>, method: Method) -> Option<Found> {
    let (truth, specimen) = (&case.under_test.truth, &case.under_test.specimen);
    let optimum = case.optima.of(method)?;
    let (report, _) = tune_plant(specimen, &request_of(specimen, method));
    let run = judge_report(&case.under_test, &optimum, &report);
    let tick_s = truth.law.tick_s();
    let of = |task: Task<U::Law>| {
        let gains = design_for(method, &task)?.gains;
        let registers = U::registers(&task.law, &gains, task.qpps);
        Some(judge(method, &case.under_test, &optimum, &registers))
    };
    let whole = Lag { delay_ticks: truth.lag.delay_ticks + truth.winding_s / tick_s, ..truth.lag };
    let by_truth = report.task.and_then(|task| of(Task { lag: whole, worst_lag: whole, ..task }));
    let by_likely = report.task.and_then(|task| of(Task { worst_lag: task.lag, ..task }));
    let not_raised =
        report.task.and_then(|task| of(Task { worst_lag: task.lag, most_speed_gain: None, ..task }));
    let judged = [Some(run), by_truth, by_likely, not_raised];
    let costs = judged.map(|one| one.map_or_else(String::new, |one| format!("{:.2}", one.j)));
    let outcome = group(method, specimen, truth, &run).unwrap_or_default();
    let interval = report.lag.map(|lag| lag.interval_s);
    let is_inside = |(low, high): (f64, f64)| (low..=high).contains(&truth.whole_lag_s());
    let seen = report.lag.map_or_else(String::new, |lag| {
        format!(
            "lag {:.1} of {:.1} ms ({:.1} to {:.1}), chi-square {:.2}",
            1e3 * lag.lag.total_s(tick_s),
            1e3 * truth.whole_lag_s(),
            1e3 * lag.interval_s.0,
            1e3 * lag.interval_s.1,
            lag.chi_square
        )
    });
    let text = format!(
        "{} {:?} {:?} {:?}: {seen}; true Ms {:.2}, overshoot {:.2}, J {} {outcome}",
        specimen.number,
        specimen.kind,
        report.verdict,
        report.causes,
        run.ms,
        run.overshoot,
        costs.join(" / ")
    );
    let interval = interval.map(|ends| (is_inside(ends), 1e3 * (ends.1 - ends.0)));
    Some(Found { text, judged, verdict: report.verdict, interval })
}

//! `brushwork bench tuning` with a threshold of the tuner changed.

use crate::cli::{DONE, Run, USAGE, program, run};

fn bench(arguments: &[&str]) -> Run {
    run(program().arg("bench").args(arguments))
}

/// Of one plant, the share of runs of PD positions without a warning, %.
fn unwarned(arguments: &[&str]) -> f64 {
    let ran = bench(&[&["tuning", "--plants", "1", "--quick", "--json"], arguments].concat());
    ran.ended_with(DONE).json()["tasks"]["pd"][0]["unwarned"].as_f64().expect("a share")
}

#[test]
fn a_threshold_that_is_scaled_changes_what_the_bench_finds() {
    assert_eq!(unwarned(&[]), 100.0);
    assert_eq!(unwarned(&["--scale", "MARGIN.most_ms=0.6"]), 0.0, "no margin is wide enough for that");
}

#[test]
fn the_sensitivity_of_a_stage_is_a_row_for_each_of_its_thresholds() {
    let ran = bench(&["tuning", "--plants", "1", "--sensitivity", "search"]).ended_with(DONE);
    let rows: Vec<&str> = ran.stdout.lines().collect();
    let begins = ["| SEARCH.rise | 0.25 | ", "| SEARCH.worst_ms | 1.12 | ", "| SEARCH.light_ms | 1.4 | "];
    assert_eq!(rows.len(), begins.len(), "{ran:#?}");
    assert!(rows.iter().zip(begins).all(|(row, begin)| row.starts_with(begin)), "{ran:#?}");
}

#[test]
fn what_changes_nothing_is_refused_with_what_there_is() {
    bench(&["tuning", "--scale", "MARGIN.no_such=2"])
        .ended_with(USAGE)
        .explains("There is no threshold MARGIN.no_such.");
    bench(&["tuning", "--scale", "MARGIN.most_ms"]).ended_with(USAGE).explains("MARGIN.most_ms=1.25");
    bench(&["tuning", "--sensitivity", "NO_SUCH"]).ended_with(USAGE).explains("There is no stage NO_SUCH.");
    for options in
        [&["--scale", "MARGIN.most_ms=2"][..], &["--sensitivity", "MARGIN"], &["--faults"], &["--ways"]]
    {
        let ran = bench(&[&["sim"], options].concat()).ended_with(USAGE);
        ran.explains(&format!("{} is an option of `bench tuning`", options[0]));
    }
}

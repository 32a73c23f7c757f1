//! The first 24 plants of seeds 7 and 11, bounded on both sides: a change of method shows as a change of numbers here.
//!
//! `brushwork bench tuning --plants 24 --seed 7` prints the same figures.

use brushwork_mcp_axis::McpLaw;
use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_tuning::model::Gains;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::Method;
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::optimum::{Optima as _, Optimum};
use brushwork_tuning_bench::run::{Judgement, judge_report, request_of, tune_plant};
use brushwork_tuning_bench::table::{Identification, Row, cases, table};
use brushwork_tuning_bench::unit::UnderTest;

/// Lowest and highest figure that is as usual.
type Range = (f64, f64);

/// Method, accepted %, good %, median cost. Gains are designed for the longest lag that is still likely, and raised as far as a springy shaft can be heard beside a coarse encoder: both
/// cost some speed.
type Bounds = [(&'static str, Range, Range, Range); 4];

const SEED_7: Bounds = [
    ("velocity", (95.0, 100.0), (79.0, 100.0), (0.9, 1.25)),
    ("pd", (99.0, 100.0), (74.0, 96.0), (0.9, 1.3)),
    ("pid", (99.0, 100.0), (70.0, 96.0), (1.0, 1.4)),
    ("piv", (99.0, 100.0), (79.0, 96.0), (0.8, 1.15)),
];

const SEED_11: Bounds = [
    ("velocity", (91.0, 100.0), (79.0, 100.0), (0.9, 1.2)),
    ("pd", (99.0, 100.0), (83.0, 100.0), (0.9, 1.2)),
    ("pid", (99.0, 100.0), (75.0, 98.0), (1.0, 1.3)),
    ("piv", (99.0, 100.0), (75.0, 96.0), (0.8, 1.2)),
];

fn ours(rows: &[Row]) -> &Row {
    rows.iter().find(|row| row.method == "brushwork").expect("our row is in every table")
}

fn table_within(seed: u64, bounds: &Bounds) -> Identification {
    let table = table(seed, &cases::<ControlLaw>(seed, 24, false), false);
    for (task, accept, good, median) in *bounds {
        let row = ours(&table.tasks[task]);
        assert_eq!(row.unstable, 0.0, "{task}: no loop of ours is unstable: {row:?}");
        assert!((accept.0..=accept.1).contains(&row.accept), "{task}: accepted {} %: {row:?}", row.accept);
        assert!((good.0..=good.1).contains(&row.good), "{task}: good {} %: {row:?}", row.good);
        assert!((median.0..=median.1).contains(&row.j_median), "{task}: median cost {}", row.j_median);
    }
    let found = table.identification;
    assert!((87.5..=100.0).contains(&found.lag_inside), "interval of the lag: {found:?}");
    assert!(found.lag_width_ms <= 4.6, "interval of the lag: {found:?}");
    found
}

#[test]
fn twenty_four_plants_come_out_as_they_did() {
    let found = table_within(7, &SEED_7);
    assert!(found.qpps_error_p95 <= 1.0, "QPPS within 1 %: {}", found.qpps_error_p95);
    assert!(found.tau_error_p95 <= 6.0 && found.tau_error_p95 >= 1.5, "tau: {} %", found.tau_error_p95);
    assert!(found.gain_error_p95 <= 2.0, "gain: {} %", found.gain_error_p95);
    assert!(found.lag_error_ms_p95 <= 3.0, "lag: {} ms", found.lag_error_ms_p95);
    assert!(found.window_qpps_error_p95 <= 6.0, "QPPS inside a window: {} %", found.window_qpps_error_p95);
    assert!(found.window_reach_p95 <= 100.0, "the window is never left: {} %", found.window_reach_p95);
}

#[test]
fn twenty_four_plants_of_another_seed_do_too() {
    let found = table_within(11, &SEED_11);
    assert!(found.lag_error_ms_p95 <= 3.6, "lag: {} ms", found.lag_error_ms_p95);
}

/// Shafts that swing at 35 to 110 Hz, which polls cannot see: raising the gains finds the oscillation, also where the gains oscillate as they are. That of plant 175 of
/// seed 11 is not heard, but its loop does what no model of it explains, which is warned of. Those of seed 808 swing in their backlash hardly louder than rounding: their
/// duty only grows with the gains, and they passed with a true Ms of 2 to 2.5.
#[test]
fn springy_shafts_are_never_called_tuned_beyond_the_margin() {
    for (seed, number, method, most_ms) in [
        (7, 31, Method::Velocity, 2.6),
        (7, 39, Method::Velocity, 2.6),
        (7, 72, Method::Velocity, 2.6),
        (7, 87, Method::Velocity, 2.0),
        (7, 103, Method::Velocity, 2.6),
        (11, 175, Method::Velocity, 3.3),
        (808, 8, Method::Piv, 1.8),
        (808, 80, Method::Velocity, 2.0),
        (808, 87, Method::Velocity, 1.8),
    ] {
        let under_test = UnderTest::new(specimen(seed, number));
        let (report, _) = tune_plant(&under_test.specimen, &request_of(&under_test.specimen, method));
        let nothing = Optimum { cost: 1.0, duty_rms: 0.08, gains: Gains::default() };
        let judged = judge_report(&under_test, &nothing, &report);
        println!("{number}: {:?} {:?}, true Ms {:.2}", report.verdict, report.causes, judged.ms);
        assert!(judged.stable && judged.ms < most_ms, "plant {number}: a true Ms of {:.2}", judged.ms);
        let is_promised = report.verdict == Verdict::Tuned;
        assert!(!is_promised || judged.ms <= 1.8, "plant {number} is called tuned at {:.2}", judged.ms);
    }
}

/// A run on a plant of a seed, and what its gains are by the true plant.
fn run_on(seed: u64, number: usize, method: Method) -> (Report<McpLaw>, Judgement) {
    let cases = cases::<ControlLaw>(seed, number + 1, false);
    let case = cases.iter().find(|case| case.under_test.specimen.number == number).expect("it is among them");
    let (report, _) = tune_plant(&case.under_test.specimen, &request_of(&case.under_test.specimen, method));
    let optimum = case.optima.of(method).expect("there is one");
    let judged = judge_report(&case.under_test, &optimum, &report);
    (report, judged)
}

/// Turned about at once, they swing for a while under any gains, which passed for an oscillation of the loop: a J of 4.6 then.
#[test]
fn springy_shafts_that_swing_while_they_are_turned_about_are_not_lowered_for_it() {
    let (_, judged) = run_on(11, 95, Method::Velocity);
    assert!(judged.accept && judged.j < 2.5, "a J of {:.2}", judged.j);
}

/// Two coarse encoders and a quick motor, whose lag is hardly known after careful steps: a PD that kept its distance from the longest likely one had a J of 1.83, 1.57 and 1.60.
#[test]
fn a_lag_that_would_cost_a_position_loop_much_is_measured_again() {
    for number in [16, 56, 123] {
        let (report, judged) = run_on(7, number, Method::Pd);
        assert!(judged.good, "plant {number}: {:?}, a J of {:.2}", report.causes, judged.j);
    }
}

/// A robot base that takes longer to turn about than the part of a stroke that is not listened to: its PD was lowered to a J of 1.66 for that.
#[test]
fn a_heavy_motor_that_still_turns_about_is_no_loop_that_oscillates() {
    let (report, judged) = run_on(11, 58, Method::Pd);
    assert!(report.verdict == Verdict::Tuned && judged.good, "a J of {:.2}", judged.j);
}

#[test]
fn a_replay_of_the_record_gives_the_same_report_to_the_last_bit_also_after_a_file() {
    for (number, method) in [(0, Method::Velocity), (3, Method::Piv), (7, Method::Pd)] {
        let plant = specimen(7, number);
        let (report, _) = tune_plant(&plant, &request_of(&plant, method));
        assert_ne!(report.verdict, Verdict::Refused, "plant {number}: {:?}", report.causes);
        let text = serde_json::to_string(&report).expect("a report is plain data");
        let read: Report<McpLaw> = serde_json::from_str(&text).expect("and reads back");
        assert!(read == report, "plant {number}: the file keeps every bit");
        assert!(read.replay().as_ref() == Some(&report), "plant {number}: the replay differs");
    }
}

#[test]
fn a_record_that_was_changed_is_found_out() {
    let plant = specimen(7, 2);
    let (mut report, _) = tune_plant(&plant, &request_of(&plant, Method::Velocity));
    report.record.remove(40);
    assert!(report.replay().is_none());
}

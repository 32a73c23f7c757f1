//! The first 24 plants of seed 7, bounded on both sides: a change of method shows as a change of numbers here.
//!
//! `brushwork bench tuning --plants 24 --seed 7` prints the same figures.

use brushwork_mcp_axis::McpLaw;
use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::Method;
use brushwork_tuning_bench::mcp::population::specimen;
use brushwork_tuning_bench::run::{request_of, tune_plant};
use brushwork_tuning_bench::table::{Row, cases, table};

/// Lowest and highest figure that is as usual.
type Range = (f64, f64);

/// Method, accepted %, good %, median cost. Gains are designed for the longest lag that is still likely, which costs some speed.
const BOUNDS: [(&str, Range, Range, Range); 4] = [
    ("velocity", (91.0, 100.0), (58.0, 80.0), (0.9, 1.45)),
    ("pd", (95.0, 100.0), (58.0, 90.0), (0.9, 1.55)),
    ("pid", (95.0, 100.0), (45.0, 75.0), (1.0, 1.75)),
    ("piv", (95.0, 100.0), (62.0, 92.0), (0.8, 1.35)),
];

fn ours(rows: &[Row]) -> &Row {
    rows.iter().find(|row| row.method == "brushwork").expect("our row is in every table")
}

#[test]
fn twenty_four_plants_come_out_as_they_did() {
    let table = table(7, &cases::<ControlLaw>(7, 24, false), false);
    for (task, accept, good, median) in BOUNDS {
        let row = ours(&table.tasks[task]);
        println!("{task}: {row:?}");
        assert_eq!(row.unstable, 0.0, "{task}: no loop of ours is unstable");
        assert!((accept.0..=accept.1).contains(&row.accept), "{task}: accepted {} %", row.accept);
        assert!((good.0..=good.1).contains(&row.good), "{task}: good {} %", row.good);
        assert!((median.0..=median.1).contains(&row.j_median), "{task}: median cost {}", row.j_median);
    }
    let found = &table.identification;
    println!("{found:?}");
    assert!(found.qpps_error_p95 <= 1.0, "QPPS within 1 %: {}", found.qpps_error_p95);
    assert!(found.tau_error_p95 <= 6.0 && found.tau_error_p95 >= 1.5, "tau: {} %", found.tau_error_p95);
    assert!(found.gain_error_p95 <= 2.0, "gain: {} %", found.gain_error_p95);
    assert!(found.lag_error_ms_p95 <= 3.0, "lag: {} ms", found.lag_error_ms_p95);
    assert!(found.window_qpps_error_p95 <= 6.0, "QPPS inside a window: {} %", found.window_qpps_error_p95);
    assert!(found.window_reach_p95 <= 100.0, "the window is never left: {} %", found.window_reach_p95);
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

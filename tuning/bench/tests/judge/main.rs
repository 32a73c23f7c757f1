//! The tuner against plants whose truth is known, small enough for every run of the tests.

mod absolute;
mod board_late;
mod board_table;
mod busy_host;
mod late_host;
mod laws;
mod load_change;
mod loads;
mod methods;
mod mind_guard;
mod mind_table;
mod mind_trial;
mod noisy_current;
mod other_make;
mod own_test;
mod small_faults;
mod small_table;
mod trajectory;
mod ways_out;

use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::report::Report;

/// Which of many runs are replayed: it takes as long as they did.
const REPLAYED: usize = 4;

/// Holds a run of a number against its replay, one of four.
#[track_caller]
fn assert_replays<L: LawProbe + PartialEq>(number: usize, report: &Report<L>, case: &str) {
    let is_left_out = !number.is_multiple_of(REPLAYED);
    assert!(is_left_out || report.replay().as_ref() == Some(report), "{case}: the replay differs");
}

//! Every class of faults on the first 16 plants of a seed: the motor is off in time on each, and nearly each is named right.
//!
//! `brushwork bench tuning --faults` prints the same figures for as many plants as wanted.

use brushwork_mcp_sim::motion::ControlLaw;
use brushwork_tuning_bench::faults::rows_of;
use brushwork_tuning_bench::motion_mind::population::specimen;
use brushwork_tuning_bench::unit::population;

const CLASSES: [&str; 12] = [
    "encoder_reversed",
    "encoder_dead",
    "motor_open",
    "shaft_locked",
    "encoder_lost",
    "stall",
    "motor_opened",
    "encoder_flipped",
    "battery_low",
    "link_drop",
    "end_stop",
    "travel_window",
];

#[test]
fn each_fault_ends_with_the_motor_off_in_time_and_is_named() {
    let rows = rows_of::<ControlLaw>(&population(5, 16), &CLASSES);
    assert_eq!(rows.len(), CLASSES.len());
    for row in rows {
        println!("{row:?}");
        assert_eq!(
            row.off_in_time, 100.0,
            "{}: off within {} s: {:?}",
            row.fault, row.deadline_s, row.misses
        );
        assert!(row.named > 93.0, "{}: named {} %: {:?}", row.fault, row.named, row.misses);
    }
}

/// While a loop has the motor. The clock runs from when the loop next drives the motor clearly; between two polls a loop does more than is read.
#[test]
fn each_fault_in_a_trial_ends_with_the_motor_off_and_is_named() {
    let classes =
        ["encoder_lost_in_trial", "stall_in_trial", "motor_opened_in_trial", "encoder_flipped_in_trial"];
    let rows = rows_of::<ControlLaw>(&population(5, 16), &classes);
    assert_eq!(rows.len(), classes.len());
    for row in rows {
        println!("{row:?}");
        assert!(row.off_in_time > 93.0, "{}: off in time {} %: {:?}", row.fault, row.off_in_time, row.misses);
        assert!(row.off_max_s < 1.5, "{}: off after {} s: {:?}", row.fault, row.off_max_s, row.misses);
        assert!(row.named > 93.0, "{}: named {} %: {:?}", row.fault, row.named, row.misses);
    }
}

/// Motion Minds that were told wrong until currents were paired with the duties that they belong to: jams under a loop as lost encoders, encoders that turned round before the
/// motor moved as nothing at all, and a lost encoder on a line that was late as one that never counted.
#[test]
fn a_motion_mind_s_faults_are_named_by_currents_of_their_own_time() {
    let numbers: [(&str, &[usize]); 5] = [
        ("stall_in_trial", &[1, 3, 11]),
        ("encoder_lost", &[9, 23, 48]),
        ("encoder_flipped", &[35, 147, 184]),
        ("end_stop", &[94, 95]),
        ("encoder_lost_in_trial", &[27]),
    ];
    for (class, numbers) in numbers {
        let plants: Vec<_> = numbers.iter().map(|number| specimen(7, *number)).collect();
        for row in rows_of(&plants, &[class]) {
            println!("{row:?}");
            assert_eq!(row.named, 100.0, "{class}: {:?}", row.misses);
        }
    }
}

/// Motion Minds that left a window of a tenth of a second of full speed while a motor at its end was driven back until a poll showed it over.
#[test]
fn a_motor_driven_back_from_an_end_of_its_travel_does_not_leave_it_at_the_other() {
    let numbers = [3, 8, 20, 30, 47, 48, 75, 103];
    let plants: Vec<_> = numbers.iter().map(|number| specimen(7, *number)).collect();
    for row in rows_of(&plants, &["travel_window"]) {
        println!("{row:?}");
        assert_eq!(row.off_in_time, 100.0, "{:?}", row.misses);
    }
}

//! Limit switches, reference and find-edge (SuprMotr manual, connector J4 and command FE).

use crate::place;
use brushwork_plant::machine::Machine;
use brushwork_plant::world::{SwitchKind, WorldAction};
use brushwork_suprmotr_wire::{inputs, limits, motion};
use brushwork_values::Motor;

use crate::tests::bench::Bench;

fn encoder(bench: &Bench) -> i64 {
    bench.unit().view().axes[0].encoder_counts
}

/// 10 ms at 20,000 counts/s is more than a stop from the limit takes.
const OVERRUN_COUNTS: i64 = 400;

#[test]
fn a_limit_stops_motion_towards_it_and_no_other() {
    for (line, back, limit, bit) in [
        ("MA200000", "MR-5000", place::POSITIVE_LIMIT_COUNTS, inputs::POSITIVE),
        ("MA-200000", "MR5000", place::NEGATIVE_LIMIT_COUNTS, inputs::NEGATIVE),
    ] {
        let mut bench = Bench::new();
        bench.begin(line);
        bench.until_complete();
        bench.ms(200);
        let position = bench.number("TP");
        assert!((position - limit).abs() < OVERRUN_COUNTS, "{line}: {position}");
        let status = bench.status();
        assert_eq!(status.inputs & (inputs::POSITIVE | inputs::NEGATIVE), bit, "{line}");
        assert_eq!(status.motion & motion::MOVE_ERROR, motion::MOVE_ERROR, "{line}");
        // Further that way there is nothing to be had.
        bench.begin(line);
        bench.ms(500);
        assert!((bench.number("TP") - position).abs() < 30 && bench.unit().is_motion_complete(), "{line}");
        bench.begin(back);
        bench.ms(1_000);
        let status = bench.status();
        assert_eq!(status.inputs & (inputs::POSITIVE | inputs::NEGATIVE), 0, "{back}");
        assert_eq!(status.motion & motion::MOVE_ERROR, 0, "{back}");
    }
}

#[test]
fn limits_that_are_off_let_the_carriage_run_to_its_end() {
    let mut bench = Bench::new();
    bench.tell("LF,MA200000");
    bench.until(|unit| !unit.is_motor_on());
    let end = place::POSITIVE_LIMIT_COUNTS + place::BEHIND_SWITCH_COUNTS;
    assert!((encoder(&bench) - end).abs() <= 1, "{}", encoder(&bench));
    let status = bench.status();
    assert_eq!((status.limits & limits::ENABLED, status.inputs & inputs::POSITIVE), (0, inputs::POSITIVE));
}

/// The switches close to ground: taken as active high, both are on where neither is pressed.
#[test]
fn limits_of_the_wrong_polarity_let_nothing_move() {
    let mut bench = Bench::new();
    bench.tell("LH,MA3000");
    bench.ms(500);
    let status = bench.status();
    assert_eq!(status.inputs & (inputs::POSITIVE | inputs::NEGATIVE), inputs::POSITIVE | inputs::NEGATIVE);
    assert_eq!(status.limits, limits::ENABLED | limits::ACTIVE_HIGH);
    assert_eq!(bench.number("TP"), 0);
    bench.tell("LL,MA3000");
    bench.ms(500);
    assert!(bench.number("TP") > 2_900);
}

#[test]
fn the_reference_is_on_below_its_place() {
    let mut bench = Bench::new();
    assert_eq!(bench.status().inputs & inputs::REFERENCE, inputs::REFERENCE);
    bench.tell("MA35000");
    bench.ms(3_000);
    assert_eq!(bench.status().inputs & inputs::REFERENCE, 0);
}

/// The manual's example, as one line.
#[test]
fn homing_as_the_manual_shows_it() {
    let mut bench = Bench::new();
    bench.begin("DV10000,FE1,WS,DV500,FE4,WS,DH");
    bench.ms(100);
    let status = bench.status();
    assert_eq!(status.limits & (limits::FIND_EDGE | limits::EDGE_STATE), limits::FIND_EDGE);
    // 60,000 counts at 10,000 counts/s, a second, and the way back at 500 counts/s.
    bench.ms(10_000);
    let status = bench.status();
    assert_eq!((status.limits & limits::FIND_EDGE, status.motion & motion::COMPLETE), (0, motion::COMPLETE));
    assert_eq!(status.motion & motion::MOVE_ERROR, 0, "the edge was looked for");
    // The switch opens at the count after its place; the tick and the lag of the loop are a few counts.
    let home = encoder(&bench) - bench.unit().position();
    assert!((home - (place::NEGATIVE_LIMIT_COUNTS + 1)).abs() <= 25, "{home}");
}

#[test]
fn the_positive_edge_is_found_forward() {
    let mut bench = Bench::new();
    bench.begin("FE0");
    bench.until_complete();
    bench.ms(100);
    assert!((bench.number("TP") - place::POSITIVE_LIMIT_COUNTS).abs() < OVERRUN_COUNTS);
    assert_eq!(bench.status().motion & motion::MOVE_ERROR, 0);
}

#[test]
fn an_edge_is_found_with_limits_off_and_at_once_where_it_is() {
    let mut bench = Bench::new();
    bench.begin("LF,FE1");
    bench.until_complete();
    bench.ms(100);
    let position = bench.number("TP");
    assert!((position - place::NEGATIVE_LIMIT_COUNTS).abs() < OVERRUN_COUNTS, "{position}");
    bench.begin("FE1");
    bench.ms(2);
    assert!(bench.unit().is_motion_complete());
    let mut bench = Bench::new();
    bench.begin("FE4");
    bench.ms(2);
    assert!(bench.unit().is_motion_complete(), "the negative limit is off");
}

#[test]
fn a_search_is_ended_by_a_stop_a_move_or_motor_off() {
    for (line, target) in [("AB", None), ("MA100", Some(100)), ("MF", None)] {
        let mut bench = Bench::new();
        bench.begin("FE1");
        bench.ms(200);
        assert_eq!(bench.number("TT"), -1_073_741_823);
        let position = bench.unit().position();
        bench.begin(line);
        assert_eq!(bench.status().limits & limits::FIND_EDGE, 0, "{line}");
        assert_eq!(bench.number("TT"), target.unwrap_or(position), "{line}");
    }
}

#[test]
fn a_switch_that_a_person_holds_counts_too() {
    let mut bench = Bench::new();
    bench.begin("MA5000");
    bench.ms(150);
    let held = WorldAction::HoldSwitch { motor: Motor::M1, switch: SwitchKind::Forward, closed: true };
    bench.bus.apply(0, &held);
    bench.ms(200);
    assert!(bench.number("TP") < 4_000);
    assert_eq!(bench.status().inputs & inputs::POSITIVE, inputs::POSITIVE);
}

//! The complete listings of the manual, with what it says that they do.

use crate::What;
use crate::tests::bench::{Bench, assert_times};
use brushwork_script::mecc::{codes, compile};

const FLASH: &str = include_str!("../../../../../assets/mecc/flash.mecc");
const LIMIT_SWITCH: &str = include_str!("../../../../../assets/mecc/limit_switch.mecc");
const WAIT_CLOCK: &str = include_str!("../../../../../assets/mecc/wait_clock.mecc");
const MOTORS: &str = include_str!("../../../../../assets/mecc/motors.mecc");
const SEND_RECEIVE: &str = include_str!("../../../../../assets/mecc/send_receive.mecc");

/// Codes of what is said, with the lines.
fn said(text: &str) -> Vec<(&'static str, u32)> {
    let lines = brushwork_script::text::Lines::of(text);
    compile(text).diagnostics.iter().map(|said| (said.code, lines.line_of(said.span.start))).collect()
}

#[test]
fn every_listing_compiles_and_what_is_warned_of_is_what_the_manual_warns_of() {
    assert_eq!(said(FLASH), []);
    assert_eq!(said(LIMIT_SWITCH), [(codes::LONG_WAIT, 12)]);
    assert_eq!(said(WAIT_CLOCK), []);
    assert_eq!(said(MOTORS), []);
    assert_eq!(said(SEND_RECEIVE), [(codes::SHORT_BUFFER, 26), (codes::SHORT_BUFFER, 36)]);
}

#[test]
fn the_display_flashes_half_a_second_in_two_and_a_half_from_the_first_tick_on() {
    let mut bench = Bench::new(FLASH);
    let shown = bench.run(10.1).shown();
    let texts: Vec<&str> = shown.iter().map(|(_, text)| *text).collect();
    assert_eq!(texts, ["OO", "  ", "OO", "  ", "OO", "  ", "OO", "  ", "OO"]);
    let times: Vec<f64> = shown.iter().map(|(t, _)| *t).collect();
    let tick = 1.0 / 128.0;
    let at = |on: u32| tick + 2.5 * f64::from(on);
    let expected: Vec<f64> = (0..5).flat_map(|on| [at(on), at(on) + 0.5]).take(9).collect();
    assert_times(&times, &expected);
    // Timers fire to the tick.
    let fired = bench.times(|what| matches!(what, What::Timer { .. }));
    assert_eq!(fired[..3], [tick, tick + 0.5, tick + 2.5]);
}

#[test]
fn a_change_during_the_wait_is_shown_only_when_the_wait_is_over() {
    let mut bench = Bench::new(LIMIT_SWITCH);
    bench.run(1.0);
    bench.board.set_on_off(3, true);
    bench.run(8.0);
    assert_times(
        &bench.times(|what| matches!(what, What::Beep { pitch: 100, length: 10 })),
        &[0.0, 3.906_25, 7.8125],
    );
    let shown = bench.shown();
    assert_eq!(shown.iter().map(|(_, text)| *text).collect::<Vec<_>>(), ["A0", "O3"]);
    assert_times(&[shown[1].0], &[3.906_25]);
}

#[test]
fn beeps_of_the_wait_over_the_clock_are_two_seconds_apart() {
    let mut bench = Bench::new(WAIT_CLOCK);
    // The clock goes through 65535 after 64 s: the differences stay right.
    let beeps = bench.run(70.0).times(|what| matches!(what, What::Beep { pitch: 50, length: 1 }));
    assert_eq!(beeps.len(), 34);
    for pair in beeps.windows(2) {
        // `Until clockdone > 2048` takes the tick after.
        assert!((2.0..2.003).contains(&(pair[1] - pair[0])), "{pair:?}");
    }
}

#[test]
fn events_are_served_while_a_program_waits_over_the_clock() {
    let text = WAIT_CLOCK.replace("Begin Program", "Declare EventHandler h()\nDisplayChars \"O\", \"3\"\nEnd EventHandler\nBegin Program\nSetEvent OnOff3Event, h\nEnable Events");
    let mut bench = Bench::new(&text);
    bench.run(1.0);
    bench.board.set_on_off(3, true);
    bench.run(2.5);
    assert_times(&[bench.shown()[0].0], &[1.0]);
}

#[test]
fn motors_are_set_by_constants_and_by_variables() {
    let mut bench = Bench::new(MOTORS);
    bench.run(0.1);
    assert_eq!(bench.board.motors(), [60, -50, 0, 0]);
    assert!(!bench.board.is_running() && bench.board.fault().is_none());
}

#[test]
fn frames_run_across_the_declarations_and_count_both_ways() {
    let mut bench = Bench::new(SEND_RECEIVE);
    bench.run(1.0).send("I003").run(2.0);
    assert_eq!(bench.sent(), ["073084088032000082088032000", "073003000000000000000000000"]);
    assert_eq!(bench.shown()[0].1, "03");
    bench.run(6.0);
    // Two frames were out before this one, and one came.
    assert_eq!(bench.sent()[2], "073084088032002082088032001");
    let starts = bench.times(|what| matches!(what, What::Transmit { .. }));
    assert_times(&[starts[0], starts[2]], &[1.0 / 128.0, 1.0 / 128.0 + 5.0]);
}

#[test]
fn the_twenty_first_frame_is_that_of_the_manual() {
    let mut bench = Bench::new(SEND_RECEIVE);
    bench.run(1.0).send("I001002003").run(101.0);
    // One of the frames is the answer to what came, so that the one after 100 s finds 21 out and 1 come.
    assert!(bench.sent().contains(&"073001002003000000000000000"));
    assert!(bench.sent().contains(&"073084088032021082088032001"));
}

//! Macros: the manual's examples, run with their times and counts (SuprMotr manual, "Macro Commands", "Some more macros").

use brushwork_suprmotr_wire::{ErrorCode, operation};

use crate::tests::bench::{Bench, number_in};

/// How often the axis sets out for another place until nothing runs any more.
fn moves(bench: &mut Bench, most_ms: u64) -> usize {
    let mut count = 0;
    let mut was_complete = true;
    for _ in 0..most_ms {
        bench.ms(1);
        let is_complete = bench.unit().is_motion_complete();
        count += usize::from(was_complete && !is_complete);
        was_complete = is_complete;
    }
    count
}

/// RP49 makes 50 runs: there and back, but the first finds the axis at 0.
#[test]
fn the_demo_line_runs_fifty_times() {
    let mut bench = Bench::new();
    bench.begin("MA0,WS500,MR500,WS100,RP49");
    // A run is 0.1 s there, 0.5 s, 0.1 s back, 0.1 s, of which two are waits after stops.
    assert_eq!(moves(&mut bench, 50 * 820), 99);
    assert_eq!(bench.status().operation & operation::WAIT, 0);
}

#[test]
fn macro_3_runs_six_times() {
    let mut bench = Bench::new();
    bench.tell("MD3,MR1000,WS500,MR-1000,WS,RP5");
    bench.begin("MC3");
    assert!(bench.unit().is_in_macro());
    // 2 sqrt(1000 / 200,000) = 0.1414 s each way, 0.5 s and a second.
    assert_eq!(moves(&mut bench, 6 * 1_800), 12);
    assert!(!bench.unit().is_in_macro());
}

/// 20,000 counts take 1 + 0.1 s; then a millisecond, and output 1 for 200 ms.
#[test]
fn macro_10_switches_an_output_for_200_ms() {
    let mut bench = Bench::new();
    bench.tell("MD10,MR20000,WS1,CN1,WA200,CF1");
    bench.begin("EM10");
    assert_eq!(bench.until(|unit| unit.outputs() == 1), 1_101);
    assert_eq!(bench.until(|unit| unit.outputs() == 0), 200);
}

#[test]
fn macro_11_moves_by_500_ten_times() {
    let mut bench = Bench::new();
    bench.tell("MD11, MR500,WS100,RP9");
    assert_eq!(bench.ask("TM11"), "MD11, MR+0000000500,WS+0000000100,RP+0000000009\r\n\u{3}");
    bench.begin("MC11");
    assert_eq!(moves(&mut bench, 10 * 220), 10);
    // Each begins where the motor is, a little short of the last target.
    let position = bench.unit().position();
    assert!((4_700..=5_000).contains(&position), "{position}");
}

#[test]
fn macro_2_calls_others_and_repeats_for_long() {
    let mut bench = Bench::new();
    for line in [
        "MD2, EM10,EM11,EM12,MA,WS500,RP",
        "MD10,MR2000,WS1,CN1,WA200,CF1",
        "MD11,MR500,WS100,RP9",
        "MD12,MR-500,WS100,RP9",
    ] {
        bench.tell(line);
    }
    bench.begin("MC2");
    // A round: 1 move, 10, 10 and the one back to 0.
    let round_ms = 200 + 1 + 200 + 20 * 201 + 250 + 500;
    let count = moves(&mut bench, 3 * round_ms);
    assert!((55..=68).contains(&count), "{count}");
    assert!(bench.unit().is_in_macro());
    // The counter of the 65,535 repeats.
    let left = number_in(&bench.raw(b"\\"));
    assert!((65_530..65_535).contains(&left), "{left}");
    bench.raw(b"\x08");
    assert!(!bench.unit().is_in_macro(), "backspace ended it");
}

/// IO1 every millisecond: 0 to 255 and again from 0.
#[test]
fn the_saw_tooth_rises_each_millisecond_and_begins_anew() {
    let mut bench = Bench::new();
    bench.begin("IO1,WA1,RP");
    let begun = bench.unit().analog_output();
    bench.ms(100);
    assert_eq!(bench.unit().analog_output(), begun + 100);
    bench.ms(156);
    assert_eq!(bench.unit().analog_output(), begun, "256 steps later");
}

#[test]
fn the_counter_tells_the_repeats_still_to_be_done() {
    let mut bench = Bench::new();
    bench.begin("WA100,RP9");
    bench.ms(150);
    assert_eq!(bench.raw(b"\\"), "0X0:+0000000008\r\n\u{3}");
    bench.ms(2_000);
    assert_eq!(bench.number("TI"), 0);
}

#[test]
fn a_wait_for_the_stop_lasts_a_second_unless_it_says_otherwise() {
    let mut bench = Bench::new();
    bench.begin("MA500,WS,CN1");
    assert_eq!(bench.until(|unit| unit.outputs() == 1), 1_100);
    bench.begin("CF,WS250,CN1");
    assert_eq!(bench.until(|unit| unit.outputs() == 1), 250);
    bench.begin("CF,MA0,WS0,CN1");
    assert_eq!(bench.until(|unit| unit.outputs() == 1), 100);
}

#[test]
fn macros_are_listed_one_or_all_and_erased_one_or_all() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask("TM"), "\r\n\u{3}", "there are none");
    bench.tell("MD5,MA,WS");
    bench.tell("MD0,CN1");
    bench.tell("MD14,mr-7");
    assert_eq!(bench.ask("TM"), "MD0, CN+0000000001\r\nMD5, MA,WS\r\nMD14, MR-0000000007\r\n\u{3}");
    assert_eq!(bench.ask("TM0"), bench.ask("TM"));
    assert_eq!(bench.ask("TM5"), "MD5, MA,WS\r\n\u{3}");
    assert_eq!(bench.ask("TZ"), "MD0, CN+0000000001\r\n\u{3}");
    bench.tell("MD5,GH");
    assert_eq!(bench.ask("TM5"), "MD5, GH\r\n\u{3}", "no warning");
    bench.tell("RM5");
    assert_eq!(bench.ask("TM"), "MD0, CN+0000000001\r\nMD14, MR-0000000007\r\n\u{3}");
    bench.tell("RZ");
    assert_eq!(bench.ask("TM"), "MD14, MR-0000000007\r\n\u{3}");
    bench.tell("RM");
    assert_eq!(bench.ask("TM"), "\r\n\u{3}");
}

#[test]
fn a_macro_that_is_not_there_does_nothing() {
    let mut bench = Bench::new();
    bench.begin("MC7,CN2");
    assert_eq!((bench.unit().outputs(), bench.status().error), (2, 0));
}

#[test]
fn a_macro_that_calls_itself_runs_for_ever_at_its_end_and_too_deep_before() {
    let mut bench = Bench::new();
    bench.tell("MD1,WA10,MC1");
    bench.begin("MC1");
    bench.ms(10_000);
    assert!(bench.unit().is_in_macro());
    assert_eq!(bench.status().error, 0);
    bench.tell("MD1,WA10,MC1,CN1");
    bench.begin("MC1");
    bench.ms(1_000);
    assert!(!bench.unit().is_in_macro());
    assert_eq!(bench.status().error, ErrorCode::LineOverflow.number());
}

#[test]
fn a_line_ends_a_macro_and_single_characters_do_not() {
    let mut bench = Bench::new();
    bench.tell("MD4,CN1,WA50,CF1,WA50,RP");
    bench.begin("MC4");
    bench.ms(500);
    bench.raw(b"'?\\%#!");
    assert!(bench.unit().is_in_macro());
    let status = bench.status();
    assert_eq!(status.operation & (operation::MACRO | operation::WAIT), operation::MACRO | operation::WAIT);
    bench.ask("TP");
    assert!(!bench.unit().is_in_macro());
    assert_eq!(bench.status().operation & (operation::MACRO | operation::WAIT), 0);
}

#[test]
fn a_bare_carriage_return_ends_a_macro_and_begins_the_last_line_again() {
    let mut bench = Bench::new();
    bench.tell("MD4,MR100,WS,RP");
    bench.begin("MC4");
    bench.ms(500);
    let target = bench.unit().position();
    bench.raw(b"\r");
    assert!(bench.unit().is_in_macro(), "the last line was MC4");
    assert!(bench.number("TT") >= target + 90);
}

#[test]
fn fifteen_commands_make_a_macro_and_sixteen_do_not() {
    let mut bench = Bench::new();
    let fifteen = ["CN1"; 15].join(",");
    bench.tell(&format!("MD9,{fifteen}"));
    assert_eq!(bench.unit().eeprom().macro_of(9).len(), 15);
    bench.tell(&format!("MD8,{fifteen},CN1"));
    assert_eq!(bench.unit().eeprom().macro_of(8).len(), 0);
    assert_eq!(bench.status().error, ErrorCode::MacroOverflow.number());
    bench.tell(&format!("{fifteen},CN2"));
    assert_eq!(bench.unit().outputs(), 0, "nothing of a line that is too long is done");
    assert_eq!(bench.status().error, ErrorCode::LineOverflow.number());
}

#[test]
fn a_macro_with_a_mistake_is_not_stored() {
    let mut bench = Bench::new();
    bench.tell("MD3,CN1");
    bench.tell("MD3,CN2,QQ");
    assert_eq!(bench.ask("TM3"), "MD3, CN+0000000001\r\n\u{3}");
}

#[test]
fn reports_in_a_loop_come_no_faster_than_the_wire_lets_them() {
    let mut bench = Bench::new();
    // 17 bytes at 9600 baud take 17.7 ms.
    let reply = bench.bus.exchange(b"TP,RP\r", std::time::Duration::from_secs(1));
    let count = reply.iter().filter(|byte| **byte == 3).count();
    assert!((50..=57).contains(&count), "{count}");
}

/// What runs is told with its macro and its place in it.
#[test]
fn each_command_that_begins_can_be_looked_at() {
    use crate::{SuprMotr, SuprMotrConfig};
    use brushwork_suprmotr_wire::{Address, Radix};
    use std::time::Duration;
    let mut unit = SuprMotr::new(SuprMotrConfig::new(Address::FACTORY)).expect("the slide is sound");
    unit.advance(Duration::from_millis(1));
    unit.receive(b"\x010MD3,CN1,WA10,CF1,RP1\r");
    unit.start_trace();
    unit.receive(b"CN2,MC3\r");
    unit.advance(Duration::from_millis(100));
    let steps: Vec<_> = unit
        .take_trace()
        .into_iter()
        .map(|step| (step.at.as_millis(), step.of_macro, step.index, step.command.text(Radix::Decimal)))
        .collect();
    let expected = [
        (1, None, 0, "CN2"),
        (1, None, 1, "MC3"),
        (1, Some(3), 0, "CN1"),
        (1, Some(3), 1, "WA10"),
        (11, Some(3), 2, "CF1"),
        (11, Some(3), 3, "RP1"),
        (11, Some(3), 0, "CN1"),
        (11, Some(3), 1, "WA10"),
        (21, Some(3), 2, "CF1"),
        (21, Some(3), 3, "RP1"),
    ];
    assert_eq!(steps, expected.map(|(at, of_macro, index, text)| (at, of_macro, index, text.to_owned())));
    assert!(!unit.is_busy() && unit.error().is_none() && unit.take_trace().is_empty());
}

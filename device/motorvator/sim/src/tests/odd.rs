//! Programs as people write them who have the manual alone: in odd spacing, with everything in an unusual place. Times and values are worked
//! out by hand.

use crate::What;
use crate::tests::bench::{Bench, assert_times};

#[test]
fn case_spaces_comments_and_line_ends_do_not_matter() {
    let text = ";;; Begin Program\r\n\tDECLARE byte X=1\r\ndeclare   BYTE y   =   2 ; tail\r\n Begin   program ; ; \"\r\n\tx=x+y;no blanks\r\n   displayhex X\r\n\tdisplaychars \";\" , \"'\"\r\n\tEND PROGRAM";
    let mut bench = Bench::new(text);
    assert_eq!(bench.run(0.1).shown().iter().map(|(_, text)| *text).collect::<Vec<_>>(), ["03", ";'"]);
}

#[test]
fn motors_are_named_turned_and_set_by_variables_in_a_loop() {
    let text = "Declare Byte m\nDeclare Byte dir = \"F\"\nBegin Program\nm = 1\nDo\nSetMotor m, dir, m * 20\nIf dir = \"F\" Then\ndir = \"B\"\nElse\ndir = \"F\"\nEnd If\nIncrement m\nUntil m > 4\nWait 128\nStopMotor 3\nWait 64\nStopMotors\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(0.5);
    assert_eq!(bench.board.motors(), [20, -40, 60, -80]);
    bench.run(1.2);
    assert_eq!(bench.board.motors(), [20, -40, 0, -80]);
    bench.run(1.6);
    assert_eq!(bench.board.motors(), [0; 4]);
    let stopped = bench.times(|what| matches!(what, What::Motor { motor: 3, speed: 0, .. }));
    assert_times(&stopped, &[1.0, 1.5]);
}

#[test]
fn a_second_over_the_wrap_of_the_clock_is_a_second() {
    // 8150 ticks are 63.672 s, where the clock stands at 65200; 1024 later it has gone through 0.
    let text = "Declare Word start\nDeclare Word now\nDeclare Word gone\nBegin Program\nWait 8150\nstart = GetClock()\nDo\nnow = GetClock()\ngone = now - start\nUntil gone > 1023\nDisplayChars \"O\",\"K\"\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(66.0);
    // The clock tells whole parts of 1/1024 s.
    let late = bench.shown()[0].0 - (8150.0 / 128.0 + 1.0);
    assert!((0.0..0.002).contains(&late), "{late}");
}

#[test]
fn letters_are_told_apart_by_a_select_and_sent_across_a_short_table() {
    let text = "Declare Byte k = \"B\"\nDeclare Byte r\nDeclare DataTable t\nReserve 1\nEnd DataTable\nDeclare Byte r2\nDeclare DataPointer p\nBegin Program\nSelect k\nCase \"A\"\nr = 1\nCase \"B\"\nr = 2\nCase \"C\", \"D\"\nr = 3\nEnd Select\nr2 = r\np = SetPointer(t)\nTransmit p\nEnd Program\n";
    let mut bench = Bench::new(text);
    // The table lies at 2, behind k and r; r2 is 2, and the pointer that stands at 2 has its low byte first.
    assert_eq!(bench.run(0.2).sent(), ["073000002002000000000000000"]);
}

#[test]
fn what_comes_is_sent_back_and_what_is_no_frame_is_told_so() {
    let text = "Declare DataTable r\nReserve 8\nEnd DataTable\nDeclare DataPointer p\nDeclare EventHandler got()\np = SetPointer(r)\nReceive p\np = SetPointer(r)\nTransmit p\nEnd EventHandler\nBegin Program\nEnable Events\nSetEvent ReceiveEvent, got\nLoop\nEnd Loop\nEnd Program\n";
    let mut bench = Bench::new(text);
    for (at, line) in [
        (0.1, "I001002003"),
        (0.2, "I1"),
        (0.3, "I256"),
        (0.4, "I"),
        (0.5, "I001001001001001001001001009"),
        (0.6, "i007"),
    ] {
        bench.run(at).send(line);
    }
    bench.run(0.8);
    let sent = bench.sent();
    let expected =
        ["073001002003000000000000000", "073001001001001001001001001", "073007000000000000000000000"];
    assert_eq!(sent, expected, "{}", bench.words);
    assert_eq!(bench.words.matches('?').count(), 3);
}

#[test]
fn a_stepper_goes_on_from_its_own_event_until_it_has_made_three_moves() {
    let text = "Declare Byte runs\nDeclare EventHandler s1()\nIncrement runs\nIf runs < 3 Then\nSetStepper 1,\"B\",100\nElse\nDisplayChars \"E\",\"N\"\nEnd If\nEnd EventHandler\nBegin Program\nSetEvent Stepper1Event, s1\nEnable Events\nConfigStepper 1,4,12,30\nSetStepper 1,\"F\",200\nLoop\nEnd Loop\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(3.0);
    assert_eq!(bench.board.steps(), [0, 0]);
    // Waits from 12 down to 5 and back, twice 68, and 4 between: of 200 steps 184, of 100 steps 84.
    let ticks = [136 + 184 * 4, 136 + 84 * 4, 136 + 84 * 4];
    let mut at = 0.0;
    let expected: Vec<f64> = ticks
        .map(|ticks| {
            at += f64::from(ticks) / 1024.0;
            at
        })
        .to_vec();
    let done = bench.times(|what| matches!(what, What::Stepper { state: "done", .. }));
    assert_eq!(done.len(), 3);
    for (done, expected) in done.iter().zip(&expected) {
        assert!((done - expected).abs() < 0.002, "{done} instead of {expected}");
    }
    assert_eq!(bench.shown().last().map(|(_, text)| *text), Some("EN"));
}

#[test]
fn two_timers_that_fire_in_one_wait_are_served_by_number_after_it() {
    let text = "Declare Byte n\nDeclare EventHandler a()\nn = n * 4 + 1\nDisplayHex n\nEnd EventHandler\nDeclare EventHandler b()\nn = n * 4 + 2\nDisplayHex n\nEnd EventHandler\nBegin Program\nSetEvent UserTimer2Event, a\nSetEvent UserTimer1Event, b\nSetTimer 2,10\nSetTimer 1,20\nEnable Events\nWait 100\nBeep 1,1\nWait 1\nEnd Program\n";
    let mut bench = Bench::new(text);
    bench.run(1.0);
    // Timer 1 comes first though timer 2 has fired before: 2, then 2 * 4 + 1.
    assert_eq!(bench.shown().iter().map(|(_, text)| *text).collect::<Vec<_>>(), ["02", "09"]);
    assert_times(&bench.times(|what| matches!(what, What::Timer { .. })), &[10.0 / 128.0, 20.0 / 128.0]);
}

#[test]
fn a_pointer_is_moved_by_hand_and_reads_on_to_a_mark() {
    let text = "Declare DataTable t\n\"ABCDEFGH\"\n\"IJ\", 0, 13\nEnd DataTable\nDeclare DataPointer p\nDeclare Byte c\nBegin Program\np = SetPointer(t)\np = p + 2\nTransmit p\nDo\nc = ReadData(p)\nUntil c = 13\nDisplayHex c\nEnd Program\n";
    let mut bench = Bench::new(text);
    assert_eq!(bench.run(0.2).sent(), ["073067068069070071072073074"]);
    assert_eq!(bench.board.display(), *b"0D");
}

#[test]
fn functions_stand_in_functions_calls_and_clip_what_they_are_given() {
    let text = "Declare Function Twice(a as Word) Returns Word\nReturn a + a\nEnd Function\nDeclare Function Clip(v As Word, top As Word) Returns Word\nIf v > top Then\nClip = top\nElse\nClip = v\nEnd If\nEnd Function\nDeclare Word x\nBegin Program\nx = Clip(Twice(Twice(70)), 255)\nDisplayHex x\nx = Twice(Clip(300, 200)) + 1\nDisplayHex x\nEnd Program\n";
    let mut bench = Bench::new(text);
    // 280 clipped at 255; 401 has 91H in its low byte.
    assert_eq!(bench.run(0.2).shown().iter().map(|(_, text)| *text).collect::<Vec<_>>(), ["FF", "91"]);
}

#[test]
fn debug_is_seen_and_does_nothing() {
    let mut bench =
        Bench::new("Declare Byte a\nBegin Program\na = 1\nDebug\na = 2\ndebug\nDisplayHex a\nEnd Program\n");
    bench.run(0.1);
    assert_eq!(bench.times(|what| matches!(what, What::Debug)).len(), 2);
    assert_eq!(bench.board.display(), *b"02");
}

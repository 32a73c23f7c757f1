//! The host library that comes with the program, on the simulated board: `assets/mecc/host.mecc`.

use crate::tests::bench::Bench;
use brushwork_motorvator_wire::{line_of_host, parse_line_of_board};
use brushwork_script::diagnostic::Severity;
use brushwork_script::mecc::compile;

const HOST: &str = include_str!("../../../../../assets/mecc/host.mecc");

/// A board with the library, which has begun.
fn bench() -> Bench {
    let mut bench = Bench::new(HOST);
    bench.run(0.1);
    bench
}

/// Sends an order and lets so much time pass; what came back meanwhile, without the `R`.
fn ask(bench: &mut Bench, order: &[u8], seconds: f64) -> Vec<Vec<u8>> {
    let (from, count) = (bench.board.now().as_secs_f64(), bench.frames.len());
    bench.board.receive(&line_of_host(order));
    bench.run(from + seconds);
    let answers =
        bench.frames[count..].iter().map(|(_, line)| parse_line_of_board(line.as_bytes()).expect("a frame"));
    answers
        .map(|frame| {
            assert_eq!(frame[0], b'R');
            frame[1..].to_vec()
        })
        .collect()
}

#[test]
fn it_compiles_with_no_error_and_warns_of_what_it_does_on_purpose() {
    let said = compile(HOST).diagnostics;
    assert!(said.iter().all(|said| said.severity() == Severity::Warning));
    let mut codes: Vec<&str> = said.iter().map(|said| said.code).collect();
    codes.dedup();
    // Its answers run across the seven bytes behind a table of one.
    assert_eq!(codes, ["W406"], "{said:?}");
}

#[test]
fn every_order_is_answered_with_its_number() {
    let mut bench = bench();
    assert_eq!(ask(&mut bench, b"P\x07", 0.05), [[b'P', 7, 2, 0, 0, 0, 0]]);
    assert_eq!(ask(&mut bench, b"S\x08", 0.05), [[b'S', 8, 0, 0, 0, 0, 0]]);
    assert_eq!(ask(&mut bench, b"?\x09", 0.05), [[b'?', 9, 0, 0, 0, 0, 64]]);
    assert_eq!(ask(&mut bench, b"S\x0A", 0.05), [[b'S', 10, 0, 0, 0, 0, 0]]);
}

#[test]
fn motors_are_driven_while_orders_come_and_stop_250_ms_after_the_last() {
    let mut bench = bench();
    assert_eq!(ask(&mut bench, &[b'M', 1, 1, b'F', 60], 0.1), [[b'M', 1, 60, 0, 0, 0, 0]]);
    assert_eq!(ask(&mut bench, &[b'M', 2, 3, b'B', 200], 0.1), [[b'M', 2, 60, 0, 228, 0, 0]]);
    for number in 3..13 {
        ask(&mut bench, &[b'S', number], 0.2);
    }
    assert_eq!(bench.board.motors(), [60, 0, -100, 0]);
    let last = bench.board.now().as_secs_f64() - 0.2;
    bench.run(last + 0.24);
    assert_eq!(bench.board.motors(), [60, 0, -100, 0]);
    bench.run(last + 0.26);
    assert_eq!(bench.board.motors(), [0; 4]);
    assert_eq!(ask(&mut bench, b"S\x63", 0.05), [[b'S', 99, 0, 0, 0, 0, 128]]);
    // The next order to a motor takes the flag back.
    assert_eq!(ask(&mut bench, &[b'M', 100, 2, b'F', 5], 0.05), [[b'M', 100, 0, 5, 0, 0, 0]]);
}

#[test]
fn stop_stops_motors_and_steppers() {
    let mut bench = bench();
    ask(&mut bench, &[b'C', 1, 2, 4, 4, 50], 0.05);
    ask(&mut bench, &[b'M', 2, 1, b'F', 60], 0.05);
    assert_eq!(ask(&mut bench, &[b'T', 3, 2, b'B', 0x10, 0x27], 0.05), [[b'T', 3, 60, 0, 0, 0, 2]]);
    assert_eq!(ask(&mut bench, b"X\x04", 0.05)[0][..6], [b'X', 4, 0, 0, 0, 0]);
    let steps = bench.board.steps();
    assert!(steps[1] < 0 && bench.board.motors() == [0; 4]);
    assert_eq!(ask(&mut bench, b"S\x05", 0.05), [[b'S', 5, 0, 0, 0, 0, 0]]);
    assert_eq!(bench.board.steps(), steps);
}

#[test]
fn a_stepper_tells_when_it_has_arrived() {
    let mut bench = bench();
    ask(&mut bench, &[b'C', 1, 1, 4, 4, 50], 0.05);
    assert_eq!(ask(&mut bench, &[b'T', 2, 1, b'F', 50, 0], 0.05), [[b'T', 2, 0, 0, 0, 0, 1]]);
    // 50 steps of 4/1024 s.
    assert_eq!(ask(&mut bench, b"S\x03", 0.2), [[b'S', 3, 0, 0, 0, 0, 1]]);
    assert_eq!(ask(&mut bench, b"S\x04", 0.05), [[b'S', 4, 0, 0, 0, 0, 0]]);
    assert_eq!(bench.board.steps(), [50, 0]);
}

#[test]
fn an_order_that_comes_while_an_answer_is_under_way_is_answered_after_it() {
    let mut bench = bench();
    let from = bench.board.now().as_secs_f64();
    bench.board.receive(&line_of_host(b"P\x01"));
    bench.run(from + 0.01);
    assert_eq!(ask(&mut bench, b"P\x02", 0.1), [[b'P', 1, 2, 0, 0, 0, 0], [b'P', 2, 2, 0, 0, 0, 0]]);
}

#[test]
fn it_tells_every_half_second_that_it_runs_while_nobody_asks() {
    let mut bench = Bench::new(HOST);
    bench.run(1.2);
    assert_eq!(bench.sent(), ["073082066000002000000000000"; 3]);
    // Not while orders come.
    for number in 0..5 {
        assert_eq!(ask(&mut bench, &[b'S', number], 0.3).len(), 1);
    }
}

#[test]
fn steppers_display_inputs_and_analog_inputs_are_told() {
    let mut bench = bench();
    assert_eq!(ask(&mut bench, &[b'Q', 1, 2], 0.05), [[b'Q', 1, 2, 10, 20, 0, 0]]);
    assert_eq!(ask(&mut bench, &[b'C', 2, 2, 3, 5, 40], 0.05), [[b'C', 2, 2, 3, 5, 40, 0]]);
    assert_eq!(ask(&mut bench, &[b'Q', 3, 2], 0.05), [[b'Q', 3, 2, 3, 5, 40, 0]]);
    assert_eq!(ask(&mut bench, &[b'Q', 4, 1], 0.05), [[b'Q', 4, 1, 10, 20, 0, 0]]);
    bench.board.set_on_off(3, true);
    assert_eq!(ask(&mut bench, b"D\x05", 0.05), [[b'D', 5, b'H', b'2', 4, 0, 0]]);
    assert_eq!(ask(&mut bench, b"D\x06OK", 0.05), [[b'D', 6, b'O', b'K', 4, 0, 0]]);
    assert_eq!(bench.board.display(), *b"OK");
    bench.board.set_on_off(3, false);
    bench.board.set_analog(2, 77);
    assert_eq!(ask(&mut bench, b"D\x07", 0.05), [[b'D', 7, b'O', b'K', 0, 0, 0]]);
    assert_eq!(ask(&mut bench, &[b'A', 8, 1], 0.05), [[b'A', 8, 0, 77, 0, 0, 0]]);
}

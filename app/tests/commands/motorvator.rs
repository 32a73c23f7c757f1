//! The commands on a simulated MotorVator: one that runs the host library, and one that does not.

use crate::cli::{DONE, NO_LINK, REFUSED, Run, Simulated, USAGE, name, program, run};
use serde_json::Value;

/// A program of the manual.
const FLASH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/mecc/flash.mecc");

fn line() -> Simulated {
    Simulated::start(&["--model", "motorvator-3"])
}

fn on(line: &Simulated, words: &[&str]) -> Run {
    run(program().args(words).args(["--connect", &format!("{},family=motorvator", line.port())]))
}

#[test]
fn both_halves_of_a_board_are_listed_and_told() {
    let line = line();
    let listed = on(&line, &["list", "--scan", "--json"]).ended_with(DONE).json();
    let units = listed["ports"][0]["units"].as_array().expect("one line").clone();
    let halves: Vec<_> = units.iter().map(|unit| unit["motorvator"]["motors"].clone()).collect();
    assert_eq!(halves, ["A and B", "C and D"]);
    assert!(units.iter().all(|unit| unit["motorvator"]["host_library"] == 2));
    on(&line, &["list", "--scan"]).ended_with(DONE).prints("motors c and d MotorVator V3");
    on(&line, &["status"]).ended_with(DONE).prints("Host library 2 runs; motors A and B, or stepper 1.");
    let told = on(&line, &["status", "--address", "2", "--json"]).ended_with(DONE).json();
    assert_eq!(
        (&told["readings"]["m1_pwm"], &told["readings"]["m2_pwm"]),
        (&Value::from(0.0), &Value::from(0.0))
    );
}

#[test]
fn motors_are_driven_by_duty_and_nothing_else() {
    let line = line();
    let driven = on(&line, &["drive", "--address", "2", "--motor", "2", "--duty", "-40", "--for", "1"]);
    driven.ended_with(DONE).explains("does not tell how fast a motor turns").prints("-40.0");
    on(&line, &["drive", "--speed", "100"]).ended_with(REFUSED).explains("takes duties and nothing else");
    on(&line, &["drive", "--duty", "10", "--accel", "5"]).ended_with(REFUSED).explains("at once");
    on(&line, &["stop"]).ended_with(DONE).prints("motors A and B: both motors stopped");
    run(program().args(["drive", "--connect", "sim:motorvator-3", "--duty", "30", "--for", "0.5"]))
        .ended_with(DONE);
}

#[test]
fn nothing_is_driven_where_the_host_library_does_not_answer() {
    let line = Simulated::start(&["--model", "motorvator-3", "--program", FLASH, "--started", "yes"]);
    on(&line, &["status"]).ended_with(DONE).prints("The host library does not answer");
    on(&line, &["drive", "--duty", "40", "--for", "1"])
        .ended_with(REFUSED)
        .explains("the host library does not answer")
        .explains("assets/mecc/host.mecc");
    let type_in = |typed: &str| on(&line, &["terminal", typed]);
    type_in("H").ended_with(DONE).prints("MotorVator AWOS 2.32");
    for may_move in ["G", "I077001001070060"] {
        type_in(may_move).ended_with(REFUSED).explains("not armed");
    }
}

#[test]
fn a_program_in_the_boards_memory_is_started_at_the_owners_word_and_driven_if_it_is_the_library() {
    let waiting =
        |words: &[&str]| Simulated::start(&[&["--model", "motorvator-3", "--started", "no"], words].concat());
    let line = waiting(&[]);
    on(&line, &["drive", "--duty", "40", "--for", "1"]).ended_with(REFUSED).explains("does not answer");
    on(&line, &["mecc", "start"])
        .ended_with(REFUSED)
        .explains("It may move motors at once")
        .explains("--yes");
    on(&line, &["mecc", "start", "--yes"]).ended_with(DONE).prints("The host library 2 runs on the board");
    on(&line, &["drive", "--duty", "40", "--for", "0.5"]).ended_with(DONE).prints("40.0 %");
    let other = waiting(&["--program", FLASH]);
    on(&other, &["mecc", "start", "--yes"]).ended_with(DONE).prints("The host library does not answer");
    run(program().args(["mecc", "start", "--yes", "--connect", "sim:mcp266"]))
        .ended_with(REFUSED)
        .explains("is no MotorVator");
}

/// The library tells twice a second that it runs, sooner than silence is silence on this line.
#[test]
fn a_program_that_goes_on_sending_is_started_on_a_line_that_may_be_late() {
    let board = Simulated::start(&["--model", "motorvator-3", "--started", "no"]);
    let target = board.port().replace("latency=60", "latency=400");
    assert_ne!(target, board.port());
    let late = |words: &[&str]| {
        run(program().args(words).args(["--connect", &format!("{target},family=motorvator")]))
    };
    late(&["mecc", "start", "--yes"]).ended_with(DONE).prints("The host library 2 runs on the board");
    late(&["terminal", "H"]).ended_with(DONE).prints("MotorVator AWOS 2.32");
}

#[test]
fn a_stepper_is_configured_through_the_settings_which_are_not_kept() {
    let line = line();
    let read = || on(&line, &["settings", "read", "--address", "2", "--json"]).ended_with(DONE).json();
    let values = || {
        let json = read();
        let rows = json["settings"].as_array().expect("rows").clone();
        rows.into_iter().map(|row| row["value"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(values(), [10, 20, 0]);
    let write =
        |changes: &[&str]| on(&line, &[&["settings", "write", "--address", "2", "--yes"], changes].concat());
    write(&["stepper.min_wait=5", "stepper.hold_current=40"]).ended_with(DONE).prints("ConfigStepper");
    assert_eq!(values(), [5, 20, 40]);
    write(&["stepper.min_wait=30"]).explains("would be above MaxWait");
    on(&line, &["settings", "save", "--address", "2", "--yes"]).explains("is kept over a restart");
    on(&line, &["settings", "defaults", "--address", "2", "--yes"]).ended_with(DONE);
    assert_eq!(values(), [10, 20, 0]);
}

#[test]
fn traffic_typed_lines_and_the_protocol_are_told_in_words() {
    let line = line();
    on(&line, &["terminal", "I080001", "I077002001070060"])
        .ended_with(REFUSED)
        .prints("order 1: ping")
        .prints("host library, version 2, answer 1")
        .explains("not armed");
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("traffic.txt");
    std::fs::write(&file, "49 30 30 31 30 30 32 0D\n47 0D\n").expect("it takes it");
    run(program().args(["monitor", "--family", "motorvator", "--decode", name(&file)]))
        .ended_with(DONE)
        .prints("data for the program: 1 2 0 0 0 0 0 0")
        .prints("start the program");
    run(program().args(["protocol", "--family", "motorvator", "M"])).ended_with(DONE).prints("order 77 (M)");
    run(program().args(["protocol", "--family", "motorvator", "Z"])).ended_with(USAGE);
}

#[test]
fn a_simulated_board_runs_the_program_that_its_target_names_or_says_where_that_is_wrong() {
    let on = |program_file: &str, words: &[&str]| {
        run(program().args(words).args(["--connect", &format!("sim:motorvator-3,program={program_file}")]))
    };
    on(FLASH, &["status"]).ended_with(DONE).prints("The host library does not answer");
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("wrong.mecc");
    std::fs::write(&path, "Begin Program\n    Bep 1, 2\n    Wait\nEnd Program\n").expect("it takes it");
    on(name(&path), &["status"])
        .ended_with(NO_LINK)
        .explains(&format!("{}:2:5: error E210: `Bep` is no command (and 1 more error).", name(&path)));
    on("/nowhere/a.mecc", &["status"]).ended_with(NO_LINK).explains("/nowhere/a.mecc cannot be read");
}

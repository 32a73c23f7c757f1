//! The commands on a line of three simulated SuprMotrs.

use crate::cli::{DONE, NOT_TAKEN, REFUSED, Run, Simulated, name, program, run};
use serde_json::Value;

fn line() -> Simulated {
    Simulated::start(&["--model", "suprmotr-v9", "--address", "0,3,F"])
}

fn on(line: &Simulated, words: &[&str]) -> Run {
    run(program().args(words).args(["--connect", &format!("{},family=suprmotr", line.port())]))
}

/// The readings and indicators of a unit.
fn status(line: &Simulated, address: &str) -> Value {
    on(line, &["status", "--address", address, "--json"]).ended_with(DONE).json()
}

#[test]
fn the_units_of_a_named_line_are_listed_by_their_addresses() {
    let line = line();
    let listed = on(&line, &["list", "--scan", "--json"]).ended_with(DONE).json();
    let units = listed["ports"][0]["units"].as_array().expect("one line").clone();
    let numbers: Vec<_> = units.iter().map(|unit| unit["address"].clone()).collect();
    assert_eq!(numbers, [0, 3, 15]);
    assert!(units.iter().all(|unit| unit["model"] == "SuprMotr V9" && unit["suprmotr"]["echo"] == true));
    on(&line, &["list", "--scan"]).ended_with(DONE).prints("unit f SuprMotr V9");
}

#[test]
fn a_unit_is_driven_by_a_distance_and_to_a_position_and_nothing_else() {
    let line = line();
    on(&line, &["drive", "--address", "f", "--by", "5000", "--for", "2"])
        .ended_with(DONE)
        .explains("no serial time-out");
    // Friction keeps a motor without an integral gain from the last counts.
    let stands_at = |told: &Value, counts: f64| {
        let position = told["readings"]["m1_position"].as_f64().expect("it is read");
        assert!((position - counts).abs() < 40.0, "{position}");
    };
    stands_at(&status(&line, "F"), 5000.0);
    on(&line, &["drive", "--address", "F", "--position", "-1000", "--for", "2"]).ended_with(DONE);
    stands_at(&status(&line, "F"), -1000.0);
    assert_eq!(status(&line, "0")["readings"]["m1_position"], 0.0, "the others stand where they were");
    on(&line, &["drive", "--address", "F", "--position", "1073741824"])
        .ended_with(REFUSED)
        .explains("the target would be 1073741824 counts from 0");
    on(&line, &["drive", "--address", "F", "--duty", "50"])
        .ended_with(REFUSED)
        .explains("a SuprMotr takes moves and nothing else");
    on(&line, &["stop"]).ended_with(DONE).prints("unit F: motor stopped");
}

#[test]
fn settings_are_the_numbers_of_the_wire_and_what_is_out_of_range_is_refused() {
    let line = line();
    let read = ["settings", "read", "--address", "3", "--json"];
    let value = |key: &str| {
        let json = on(&line, &read).ended_with(DONE).json();
        let rows = json["settings"].as_array().expect("rows").clone();
        rows.into_iter().find(|row| row["key"] == key).map(|row| row["value"].clone()).unwrap_or_default()
    };
    assert_eq!((value("loop.p"), value("motion.velocity")), (Value::from(75), Value::from(20_000)));
    let write = |change: &str| on(&line, &["settings", "write", "--address", "3", change, "--yes"]);
    write("loop.p=256").ended_with(NOT_TAKEN).explains("255");
    write("loop.p=80").ended_with(DONE);
    assert_eq!(value("loop.p"), 80);
    on(&line, &["settings", "save", "--address", "3", "--yes"]).ended_with(DONE);
    write("loop.p=90").ended_with(DONE);
    on(&line, &["settings", "reload", "--address", "3", "--yes"]).ended_with(DONE);
    assert_eq!(value("loop.p"), 80, "what UD stored");
    on(&line, &["settings", "defaults", "--address", "3", "--yes"]).ended_with(DONE);
    assert_eq!(value("loop.p"), 75);
}

#[test]
fn typed_commands_are_answered_in_words_and_a_restart_is_left_alone_beside_a_macro_0() {
    let line = line();
    let type_in = |words: &[&str]| on(&line, &[&["terminal", "--address", "3"], words].concat());
    type_in(&["tp,tt", "%"]).ended_with(DONE).prints("3P0:+0000000000").prints("Trajectory complete");
    type_in(&["mr500"]).ended_with(REFUSED).explains("not armed");
    type_in(&["md0,mr500"]).ended_with(DONE);
    on(&line, &["settings", "reload", "--address", "3", "--yes"]).explains("macro 0 is defined");
    assert_eq!(status(&line, "3")["readings"]["m1_position"], 0.0, "nothing has moved");
}

#[test]
fn traffic_and_protocol_are_told_in_words() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("traffic.txt");
    std::fs::write(&file, "01 35 54 50 0D\n0D\n").expect("it takes it");
    run(program().args(["monitor", "--family", "suprmotr", "--decode", name(&file)]))
        .ended_with(DONE)
        .prints("select unit 5")
        .prints("Tell Position")
        .prints("the last line once more");
    run(program().args(["protocol", "--family", "suprmotr", "MR"])).ended_with(DONE).prints("Move Relative");
    run(program().args(["status", "--connect", "sim:suprmotr-v9"]))
        .ended_with(DONE)
        .prints("Motor on, echo on");
}

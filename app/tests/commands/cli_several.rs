//! Several controllers at once: one line with five RoboClaws of a rover, two lines, and a chain of Motion Minds.

use crate::cli::{DIFFERENT, DONE, NO_LINK, NOT_TAKEN, REFUSED, Run, Simulated, USAGE, name, program, run};
use serde_json::Value;

fn rover(addresses: &str) -> Simulated {
    Simulated::start(&["--model", "roboclaw-2x7a", "--address", addresses])
}

fn brushwork(line: &Simulated, words: &[&str]) -> Run {
    run(program().args(words).args(["--connect", &line.port()]))
}

/// What each of the array's objects has under a pointer.
fn each(array: &Value, pointer: &str) -> Vec<Value> {
    let objects = array.as_array().expect("an array of controllers");
    objects.iter().map(|object| object.pointer(pointer).cloned().unwrap_or_default()).collect()
}

#[test]
fn five_boards_of_a_rover_answer_one_command_each_under_its_own_head() {
    let line = rover("0x80-0x84");
    let text = brushwork(&line, &["status", "--address", "0x80-0x84"]).ended_with(DONE);
    for address in 0x80..=0x84 {
        let text = &text.stdout;
        assert!(
            text.contains(&format!("0x{address:02X} on {}:\nRoboClaw 2x7A at 0x{address:02X}", line.port())),
            "{text}"
        );
    }
    let json = brushwork(&line, &["status", "--address", "all", "--json"]).ended_with(DONE).json();
    assert_eq!(each(&json, "/address"), [128, 129, 130, 131, 132]);
    assert_eq!(each(&json, "/result/identity/address"), [128, 129, 130, 131, 132]);
    let one = brushwork(&line, &["status", "--address", "0x82", "--json"]).ended_with(DONE).json();
    assert_eq!(one["identity"]["address"], 130, "one address gives what it always gave");
}

#[test]
fn a_silent_board_is_named_and_keeps_nobody_from_answering() {
    let line = rover("0x80,0x82");
    let run =
        brushwork(&line, &["settings", "read", "--address", "0x80-0x82", "--json", "motor1.velocity.p"]);
    let json = run.ended_with(NO_LINK).explains("Not done to the end on 0x81 on").json();
    assert_eq!(each(&json, "/exit_code"), [DONE, NO_LINK, DONE]);
    assert_eq!(each(&json, "/result/settings/0/value"), [Value::from(1.0), Value::Null, Value::from(1.0)]);
}

#[test]
fn one_profile_goes_to_all_with_the_differences_of_each_and_nobody_loses_its_address() {
    let line = rover("0x80-0x82");
    let file = line.folder.path().join("rover.json");
    brushwork(&line, &["settings", "write", "--address", "0x81", "motor1.velocity.p=2.5", "--yes"])
        .ended_with(DONE);
    brushwork(&line, &["settings", "export", "--address", "0x81-0x82", name(&file)]).ended_with(DONE);
    let (of_81, of_82) =
        (line.folder.path().join("rover-0x81.json"), line.folder.path().join("rover-0x82.json"));
    assert!(!file.exists() && of_82.exists());
    let import = ["settings", "import", name(&of_81), "--address", "0x80-0x82"];
    let shown =
        brushwork(&line, &import).ended_with(REFUSED).explains("each to its own of the 3 controllers");
    let lines: Vec<&str> = shown.stdout.lines().filter(|line| line.contains("velocity.p ")).collect();
    assert_eq!(lines.len(), 2, "0x81 has it already: {}", shown.stdout);
    brushwork(&line, &[&import[..], &["--yes"]].concat())
        .ended_with(DONE)
        .prints("each of several controllers keeps its own: Address or R/C switches.")
        .prints("There was nothing to write.");
    let read =
        ["settings", "read", "motor1.velocity.p", "roboclaw.config.address", "--address", "all", "--json"];
    let json = brushwork(&line, &read).ended_with(DONE).json();
    assert_eq!(each(&json, "/address"), [128, 129, 130], "all are where they were");
    let values = |key: &str| -> Vec<Value> {
        let rows =
            |object: &Value| object.pointer("/result/settings").and_then(Value::as_array).unwrap().clone();
        let all = json.as_array().unwrap().iter().flat_map(rows);
        all.filter(|row| row["key"] == key).map(|row| row["value"].clone()).collect()
    };
    assert_eq!(values("motor1.velocity.p"), [2.5, 2.5, 2.5]);
    brushwork(&line, &["settings", "diff", name(&of_81), "--address", "0x80-0x81"]).ended_with(DIFFERENT);
}

#[test]
fn nothing_is_written_to_anybody_where_one_cannot_take_it() {
    let line = rover("0x80-0x81");
    let write =
        |addresses, change| brushwork(&line, &["settings", "write", change, "--yes", "--address", addresses]);
    write("0x80-0x82", "motor1.velocity.p=3")
        .ended_with(NO_LINK)
        .explains("Nothing was written to any of them");
    write("0x80-0x81", "roboclaw.config.address=0x85")
        .ended_with(NOT_TAKEN)
        .explains("`brushwork address` does it");
    let read = ["settings", "read", "motor1.velocity.p", "--address", "0x80-0x81", "--json"];
    let json = brushwork(&line, &read).ended_with(DONE).json();
    assert_eq!(each(&json, "/result/settings/0/value"), [1.0, 1.0]);
}

#[test]
fn a_raw_number_goes_to_one_controller_and_is_refused_for_several() {
    let line = rover("0x80-0x81");
    let run = brushwork(&line, &["settings", "raw", "motor1.encoder.pin=1", "--address", "0x80-0x81"]);
    assert_eq!(run.code, USAGE, "{run:#?}");
}

#[test]
fn scripts_of_several_are_loaded_one_by_one_and_run_and_end_together() {
    let line = Simulated::start(&["--model", "mcp266", "--address", "0x80-0x81"]);
    let file = line.folder.path().join("drive.mcl");
    std::fs::write(&file, "main\npower2 9830,655359,9830,655359\npause 10\ngoto main\n").unwrap();
    let script = |words: &[&str], addresses: &str| {
        brushwork(&line, &[&["script"], words, &["--address", addresses]].concat())
    };
    let done = script(&["download", name(&file), "--simulated", "--json"], "0x80-0x81").ended_with(DONE);
    let json = done.json();
    assert_eq!(each(&json, "/address"), [128, 129]);
    assert_eq!(each(&json, "/result/verified"), ["status", "status"]);
    script(&["autorun", "500"], "0x81").ended_with(DONE);
    let json = script(&["status", "--json"], "all").ended_with(DONE).json();
    assert_eq!(each(&json, "/result/autorun_delay_ms"), [Value::Null, Value::from(500)]);
    let refused = script(&["start", "--for", "5"], "0x80-0x82").ended_with(NO_LINK);
    refused.explains("No unit answers at 0x82 on");
    let started = script(&["start", name(&file), "--simulated", "--for", "0.3"], "0x80-0x81");
    started.ended_with(DONE);
    let json = brushwork(&line, &["status", "--address", "all", "--json"]).ended_with(DONE).json();
    for position in each(&json, "/result/readings/m1_position") {
        assert!(position.as_f64().is_some_and(|counts| counts > 0.0), "each of them ran: {json}");
    }
    script(&["stop"], "0x80-0x81").ended_with(DONE);
}

#[test]
fn firmware_of_several_is_told_for_each_and_updated_until_one_fails() {
    let line = rover("0x80-0x81");
    let json = brushwork(&line, &["firmware", "info", "--address", "0x80-0x81", "--json"]).ended_with(DONE);
    assert_eq!(each(&json.json(), "/result/identity/address"), [128, 129]);
    let image = line.folder.path().join("new.bin");
    run(program().args(["firmware", "image", name(&image), "--model", "mcp266"])).ended_with(DONE);
    let update = ["firmware", "update", name(&image), "--simulated", "--accept-risk"];
    let refused = brushwork(&line, &[&update[..], &["--address", "0x80-0x81"]].concat());
    // An image for another model is taken by neither; the second one is not tried any more.
    refused.ended_with(REFUSED).explains("Not begun on 0x81 on").explains("Not done to the end on 0x80 on");
}

/// Boards as they are delivered have no serial time-out, so that none is armed: what matters here is that each is asked by itself.
#[test]
fn a_tuning_run_goes_to_one_board_after_the_other_and_each_says_what_became_of_it() {
    let line = rover("0x80-0x81");
    let report = line.folder.path().join("rover.json");
    let words = ["tune", "velocity", "--address", "0x80-0x82", "--report", name(&report), "--json"];
    let run = brushwork(&line, &words).ended_with(NO_LINK);
    let json = run.explains("Not done to the end on 0x80 on").explains("0x82 on").json();
    assert_eq!(each(&json, "/exit_code"), [REFUSED, REFUSED, NO_LINK]);
    assert_eq!(each(&json, "/address"), [128, 129, 130]);
    assert!(!report.exists(), "no board has the name of all");
}

#[test]
fn two_lines_are_asked_and_stopped_by_one_command() {
    let lines = [rover("0x80"), rover("0x80")];
    let both =
        |words: &[&str]| run(program().args(words).args(["-c", &lines[0].port(), "-c", &lines[1].port()]));
    let json = both(&["status", "--json"]).ended_with(DONE).json();
    assert_eq!(each(&json, "/connect"), [lines[0].port(), lines[1].port()]);
    let json = both(&["stop", "--json"]).ended_with(DONE).json();
    assert_eq!(each(&json, "/result/confirmed"), [true, true]);
    let gone = run(program().args(["stop", "--json", "-c", "/dev/no-such-port", "-c", &lines[1].port()]));
    let json = gone.ended_with(NO_LINK).explains("/dev/no-such-port was not found to be stopped").json();
    assert_eq!(each(&json, "/exit_code"), [NO_LINK, DONE]);
}

#[test]
fn a_chain_of_motion_minds_is_asked_the_same_way() {
    let line = Simulated::start(&["--model", "motion-mind-3", "--address", "3,5-6"]);
    let words = ["status", "--family", "motion-mind", "--address", "3,5-6", "--json"];
    let json = run(program().args(words).args(["-c", &line.port()])).ended_with(DONE).json();
    assert_eq!(each(&json, "/result/identity/address"), [3, 5, 6]);
}

#[test]
fn the_state_of_a_rover_stands_in_one_table_with_who_is_silent() {
    let line = rover("0x80-0x81,0x83");
    let run = brushwork(&line, &["status", "--together", "--address", "0x80-0x83"]).ended_with(NO_LINK);
    let rows: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(rows.len(), 5, "a head and four rows: {run:#?}");
    assert!(rows[0].contains("BATTERY V") && rows[0].contains("M2 A"), "{}", rows[0]);
    let first = rows[1];
    assert!(
        first.starts_with("0x80 on ") && first.contains("RoboClaw 2x7A") && first.contains(" 24.0 "),
        "{first}"
    );
    assert!(rows[3].starts_with("0x82 on ") && rows[3].ends_with("NO ANSWER"), "{}", rows[3]);
    assert!(rows[4].ends_with("nothing"), "{}", rows[4]);
}

#[test]
fn boards_of_a_rover_are_driven_together_on_one_line_and_on_two_or_not_at_all() {
    let rover = || {
        let boards = ["--model", "roboclaw-2x7a", "--generation", "4", "--address", "0x80-0x82"];
        Simulated::start(&boards)
    };
    let line = rover();
    let write = ["settings", "write", "unit.serial_timeout=1", "--address", "0x80-0x82", "--yes"];
    brushwork(&line, &write).ended_with(DONE);
    let drive = ["drive", "--motor", "both", "--duty", "25", "--for", "0.6", "--json"];
    let on = |addresses: &'static str| [&drive[..], &["--address", addresses]].concat();
    let last_of = |run: Run, count: usize| -> Vec<Value> {
        let lines = run.stdout.lines().rev().take(count);
        let mut last: Vec<Value> = lines.map(|line| serde_json::from_str(line).expect("JSON")).collect();
        last.reverse();
        last
    };
    let last = last_of(brushwork(&line, &on("0x80-0x82")).ended_with(DONE), 3);
    let addresses: Vec<_> = last.iter().map(|object| object["address"].clone()).collect();
    assert_eq!(addresses, [0x80, 0x81, 0x82]);
    for object in &last {
        let speed = object["readings"]["m2_velocity"].as_f64().expect("it is read");
        assert!(speed > 500.0, "{object}");
    }
    brushwork(&line, &on("0x80-0x83"))
        .ended_with(NO_LINK)
        .explains("Nothing was moved: no unit answers at 0x83 on");
    let other = rover();
    // One of the second line has no time-out.
    let write = ["settings", "write", "unit.serial_timeout=1", "--address", "0x80-0x81", "--yes"];
    brushwork(&other, &write).ended_with(DONE);
    let both = |addresses| brushwork(&line, &[&on(addresses)[..], &["-c", &other.port()]].concat());
    both("0x82").ended_with(REFUSED).explains("time-out");
    let last = last_of(both("0x81").ended_with(DONE), 2);
    let places: Vec<_> = last.iter().map(|object| object["connect"].clone()).collect();
    assert_eq!(places, [other.port(), line.port()], "in the order in which they were named");
    let at_rest = brushwork(&line, &["status", "--address", "all", "--json"]).ended_with(DONE).json();
    assert_eq!(each(&at_rest, "/result/readings/m1_pwm"), [0.0; 3]);
}

#[cfg(unix)]
#[test]
fn several_boards_are_watched_with_a_line_for_each_and_the_silent_one_is_named() {
    use crate::cli::LIMIT;
    use brushwork_child::Program;

    let line = rover("0x80-0x81");
    let mut command = program();
    command.args(["status", "--watch", "--interval", "0.2", "--json", "--address", "0x80-0x82"]);
    let mut running = Program::spawn({
        command.args(["--connect", &line.port()]);
        command
    });
    let mut seen = Vec::new();
    // A busy computer may show some rows before it has read anything.
    while seen.len() < 6 || !seen[seen.len() - 2..].iter().all(|(_, is_read)| *is_read) {
        assert!(seen.len() < 1000, "neither is read: {seen:?}");
        let text = running.next_line(LIMIT).expect("it goes on");
        let object: Value = serde_json::from_str(&text).expect("JSON");
        seen.push((object["address"].clone(), object["readings"]["m2_current"].is_number()));
    }
    running.signal("INT");
    let ending = running.finish(LIMIT);
    let addresses: Vec<_> = seen.iter().map(|(address, _)| address.clone()).collect();
    assert!(addresses.chunks(2).all(|pair| pair == [0x80, 0x81]), "they take turns: {seen:?}");
    assert!(ending.stderr.join(" ").contains("No unit answers at 0x82 on"), "{ending:?}");
}

#[test]
fn an_address_is_given_to_one_unit_read_back_and_saved() {
    let line = rover("0x80,0x82");
    let address = |words: &[&str]| brushwork(&line, &[&["address"], words].concat());
    address(&["0x84", "--yes"]).ended_with(REFUSED).explains("at 0x80, 0x82. Say which is meant");
    address(&["0x82", "--address", "0x80", "--yes"]).ended_with(REFUSED).explains("one answers there");
    address(&["0x84", "--address", "0x80"]).ended_with(REFUSED).explains("give --yes to do it");
    let given = address(&["0x84", "--address", "0x80", "--yes"]).ended_with(DONE);
    given.prints("RoboClaw 2x7A answers at 0x84 on");
    let reload = ["settings", "reload", "--yes", "--json", "--address", "0x84"];
    brushwork(&line, &reload).ended_with(DONE);
    let json = brushwork(&line, &["status", "--json", "--address", "all"]).ended_with(DONE).json();
    assert_eq!(each(&json, "/address"), [0x82, 0x84]);
    address(&["0x80-0x81"]).ended_with(REFUSED).explains("give one address at a time");
}

#[test]
fn two_units_at_one_address_are_known_by_their_garbled_replies_and_not_moved_together() {
    let line = rover("0x80-0x81");
    let moved = ["settings", "write", "roboclaw.config.address=0x80", "--address", "0x81", "--yes"];
    // They collide from now on, so that its own end is not looked at.
    brushwork(&line, &moved);
    let run = brushwork(&line, &["address", "0x84", "--yes"]);
    run.ended_with(REFUSED).explains("Nothing was written: the replies of 0x80").explains("are garbled");
    brushwork(&line, &["status", "--address", "0x84"]).ended_with(NO_LINK);
}

#[test]
fn a_motion_mind_of_a_chain_is_given_its_address_too() {
    let line = Simulated::start(&["--model", "motion-mind-3", "--address", "1"]);
    let target = format!("{},family=motion-mind", line.port());
    let run = run(program().args(["address", "5", "--yes", "-c", &target]));
    run.ended_with(DONE).prints("Motion Mind 3 answers at unit 5 on");
}

//! What the built program says: values equal to the simulator's truth, complete lists, help, and sentences about bad input.
#![cfg(unix)]

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::Command;

use brushwork_link::transport::{SerialTransport, Transport as _};
use brushwork_mcp_sim::controller::ControllerConfig;
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models::MODELS;
use brushwork_mcp_wire::packet_serial::{Address, COMMANDS, Generation, Request, number};
use brushwork_plant::machine::StreamIndex;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::simulated::{LATE_PTY, OnPty, is_driven};
use brushwork_tests::wait::{self, LIMIT};
use serde_json::Value;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// Exit codes, as `brushwork --help` lists them.
const DONE: i32 = 0;
const FAILED: i32 = 1;
const USAGE: i32 = 2;
const NO_LINK: i32 = 3;
/// How often a drive is begun for which this machine may be too crowded.
const TRIES: usize = 20;

fn start(arguments: &[&str]) -> Program {
    Program::start(BRUSHWORK, arguments)
}

fn run(arguments: &[&str]) -> Ending {
    start(arguments).finish(LIMIT)
}

fn code(ending: &Ending) -> Option<i32> {
    ending.status.code()
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn json(ending: &Ending) -> Value {
    assert_eq!(code(ending), Some(DONE), "{ending:?}");
    let text = ending.stdout.join("\n");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("no JSON: {error}: {text}"))
}

fn number_at(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer} in {value}"))
}

// ---------------------------------------------------------------------------------------------------------------------
// Values

/// Reads the truth file until it says what is wanted.
fn wait_for_truth(file: &Path, holds: impl Fn(&Value) -> bool) -> Value {
    let last = RefCell::new(Value::Null);
    let look = || {
        let text = std::fs::read_to_string(file).ok()?;
        let truth: Value = serde_json::from_str(&text).expect("the truth file is always whole");
        *last.borrow_mut() = truth.clone();
        holds(&truth).then_some(truth)
    };
    wait::until_some("another truth", look, || format!("{:#}", last.borrow()))
}

fn is_off_and_still(truth: &Value, axis: usize) -> bool {
    let speed = number_at(truth, &format!("/0/axes/{axis}/truth/motor_radians_per_second"));
    let output = &truth[0]["axes"][axis]["output"];
    let is_off = output["Duty"].as_f64().is_none_or(|duty| duty == 0.0);
    is_off && speed.abs() < 1e-3
}

/// The status once the speeds, which the controller averages over a while, have come down too.
fn status_at_rest(port: &str) -> Value {
    let last = RefCell::new(Value::Null);
    let look = || {
        let status = json(&run(&["status", "--connect", port, "--json"]));
        let is_still = |motor| number_at(&status, &format!("/readings/{motor}_velocity")) == 0.0;
        let at_rest = ["m1", "m2"].into_iter().all(is_still);
        *last.borrow_mut() = status.clone();
        at_rest.then_some(status)
    };
    wait::until_some("speeds that come down", look, || format!("{:#}", last.borrow()))
}

/// Drives, stops, and reads what has become of it.
fn what_status_says_is_true(generation: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (link, truth_file) = (text(&folder.path().join("mcp")), folder.path().join("truth.json"));
    let mut sim = start(&[
        "sim",
        "--generation",
        generation,
        "--pty",
        &link,
        "--truth",
        &text(&truth_file),
        "--fault",
        "plant:battery=22.4",
        "--fault",
        "plant:logic=11.6",
        "--fault",
        "plant:hot-board=41.5",
    ]);
    sim.wait_for("Connect with", LIMIT);
    let link = format!("{link}{LATE_PTY}");
    let words = ["drive", "--connect", &link, "--motor", "2", "--duty", "-40", "--for", "0.4", "--json"];
    // On a busy machine the program or its controller may not be heard in time.
    let is_heard = |drive: &Ending| !drive.was_starved() && !drive.found_silence();
    let drive = (0..TRIES).map(|_| run(&words)).find(is_heard).expect("a machine with some room");
    assert_eq!(code(&drive), Some(DONE), "{drive:?}");
    assert!(drive.stdout.iter().all(|line| serde_json::from_str::<Value>(line).is_ok()), "{drive:?}");

    let moved = |truth: &Value| number_at(truth, "/0/axes/1/encoder_counts") < -100.0;
    let at_rest = |truth: &Value| (0..2).all(|axis| is_off_and_still(truth, axis));
    let truth = wait_for_truth(&truth_file, |truth| moved(truth) && at_rest(truth));
    let status = status_at_rest(&link);
    let reading = |key: &str| number_at(&status, &format!("/readings/{key}"));
    let near = |key: &str, wanted: f64, tolerance: f64| {
        assert!((reading(key) - wanted).abs() <= tolerance, "{key} is {}, not {wanted}", reading(key));
    };
    near("main_battery", number_at(&truth, "/0/bus_volts"), 0.1);
    near("main_battery", 22.4, 0.1);
    near("logic_battery", 11.6, 0.1);
    near("temperature_1", number_at(&truth, "/0/board_celsius/0"), 0.1);
    near("temperature_1", 41.5, 0.1);
    for (motor, axis) in [("m1", 0), ("m2", 1)] {
        near(&format!("{motor}_position"), number_at(&truth, &format!("/0/axes/{axis}/encoder_counts")), 0.0);
        near(&format!("{motor}_pwm"), 0.0, 0.0);
        near(&format!("{motor}_current"), 0.0, 0.2);
    }
    assert_eq!(status["identity"]["generation"].to_string(), generation);
    assert_eq!(status["identity"]["model"], "MCP266");
    assert_eq!(status["lamps"].as_array().map(Vec::len), Some(13), "{status}");
    sim.signal("INT");
    assert_eq!(code(&sim.finish(LIMIT)), Some(DONE));
}

#[test]
fn in_generation_1_what_status_says_is_true() {
    what_status_says_is_true("1");
}

#[test]
fn in_generation_2_what_status_says_is_true() {
    what_status_says_is_true("2");
}

#[test]
fn in_generation_3_what_status_says_is_true() {
    what_status_says_is_true("3");
}

#[test]
fn in_generation_4_what_status_says_is_true() {
    what_status_says_is_true("4");
}

#[test]
fn a_bus_of_three_models_answers_each_at_its_address() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let link = text(&folder.path().join("bus"));
    let mut sim = start(&[
        "sim",
        "--pty",
        &link,
        "--port",
        "ttl1",
        "--address",
        "0x80,0x82,135",
        "--model",
        "mcp266,mcp233,roboclaw-2x7a",
    ]);
    sim.wait_for(&link, LIMIT);
    let link = format!("{link}{LATE_PTY}");
    for (address, model) in [("0x80", "MCP266"), ("0x82", "MCP233"), ("0x87", "RoboClaw 2x7A")] {
        let status = json(&run(&["status", "--connect", &link, "--address", address, "--json"]));
        assert_eq!(status["identity"]["model"], model);
        assert_eq!(format!("{:#04x}", number_at(&status, "/identity/address") as u8), address);
    }
}

/// Duty 30 % on both motors, sent by nobody who will renew it.
fn set_going(controller: &OnPty) {
    let packet = Request::new(Address::DEFAULT, number::DUTY_BOTH, &[9_830, -9_830])
        .encode(Generation::Gen1)
        .expect("the command has two duties");
    let mut port = SerialTransport::open(&text(&controller.port()), 115_200).expect("the port opens");
    port.write(&packet).expect("the port takes bytes");
    assert_eq!(port.read(&mut [0], LIMIT).expect("the port is there"), 1, "the controller acknowledges");
    controller.wait_until("driven motors", is_driven);
}

#[test]
fn stop_stops_what_another_program_has_left_running_and_says_so() {
    let mut config = ControllerConfig::default();
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.streams[0].timeout_ms = 0; // the controller itself stops nothing
    config.settings = Some(settings);
    let controller = OnPty::start_with(config, StreamIndex::Usb);
    for more in [&[][..], &["--json"]] {
        set_going(&controller);
        let ending = run(&[&["stop", "--connect", &controller.target()], more].concat());
        assert_eq!(code(&ending), Some(DONE), "{ending:?}");
        let _ = controller.wait_until_off();
        let reported = ending.stdout.join("\n");
        match more {
            [] => assert!(reported.contains("0x80: both motors stopped, buffers empty"), "{reported}"),
            _ => assert_eq!(json(&ending)["confirmed"], true),
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Lists

#[test]
fn list_names_every_simulated_model() {
    let list = json(&run(&["list", "--json"]));
    let named: Vec<&str> = list["simulated"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|row| row["connect"].as_str())
        .collect();
    let keys = MODELS.iter().map(|model| model.key).chain(["motion-mind-3", "suprmotr-v9", "motorvator-3"]);
    let wanted: Vec<String> = keys.map(|key| format!("sim:{key}")).collect();
    assert_eq!(named, wanted);
    assert!(list["ports"].is_array());
}

#[test]
fn the_protocol_page_has_every_command() {
    let numbers = |page: &Value| -> BTreeSet<u64> {
        page["commands"].as_array().into_iter().flatten().filter_map(|row| row["number"].as_u64()).collect()
    };
    let page = json(&run(&["protocol", "--json"]));
    assert_eq!(numbers(&page), COMMANDS.iter().map(|command| u64::from(command.number)).collect());
    let two = json(&run(&["protocol", "--json", "90", "read_version"]));
    assert_eq!(numbers(&two), BTreeSet::from([21, 90]));
    let text = run(&["protocol"]).stdout.join("\n");
    assert!(COMMANDS.iter().all(|command| text.contains(command.key)), "the text page lacks a command");
}

#[test]
fn every_command_has_help_with_an_example() {
    let commands = ["list", "status", "drive", "stop", "settings", "sim", "protocol", "monitor", "bench"];
    let top = run(&["--help"]);
    assert_eq!(code(&top), Some(DONE));
    let reported = top.stdout.join("\n");
    assert!(reported.contains("Exit codes:") && reported.contains("130"), "{reported}");
    for command in commands {
        assert!(reported.contains(&format!("\n  {command} ")), "{command} is not in: {reported}");
        for asked in [&[command, "--help"][..], &["help", command], &[command, "-h"]] {
            let ending = run(asked);
            assert_eq!(code(&ending), Some(DONE), "{ending:?}");
            let help = ending.stdout.join("\n");
            assert!(help.contains("Usage:") && help.contains(command), "{help}");
            assert!(help.contains("Example"), "{help}");
        }
    }
}

#[test]
fn the_faults_that_help_promises_are_all_taken() {
    let help = run(&["sim", "--help"]).stdout.join("\n");
    for fault in ["drop=SHARE", "unplug", "plant:locked-shaft", "plant:limit-switch"] {
        assert!(help.contains(fault), "{fault} is not in: {help}");
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// What goes wrong

/// One sentence, or several, and no trace of a panic.
fn assert_reported(ending: &Ending, wanted: i32, words: &[&str]) {
    let reported = ending.stderr.join("\n");
    assert_eq!(code(ending), Some(wanted), "{reported}");
    assert!(!reported.contains("panicked"), "{reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
}

#[test]
fn bad_arguments_of_sim_are_told_in_a_sentence_that_says_what_may_stand_there() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let taken = text(file.path());
    let cases: [(&[&str], i32, &[&str]); 11] = [
        (&["--fault", "nonsense"], USAGE, &["--fault nonsense", "drop=SHARE"]),
        (&["--fault", "drop=2"], USAGE, &["--fault drop=2"]),
        (&["--model", "mcp999"], USAGE, &["mcp999", "mcp266"]),
        (&["--preset", "lorry"], USAGE, &["lorry", "flywheel"]),
        (&["--address", "0x90"], USAGE, &["0x80 to 0x87"]),
        (&["--address", "0x80,0x80", "--port", "ttl1"], USAGE, &["0x80", "different"]),
        (&["--model", "mcp266,mcp233"], USAGE, &["2 models"]),
        (&["--address", "0x80,0x81", "--port", "usb"], USAGE, &["usb", "ttl1"]),
        (&["--tcp", "here"], USAGE, &["--tcp 127.0.0.1:7000"]),
        (&["--tcp", "192.0.2.1:7000"], FAILED, &["192.0.2.1", "127.0.0.1"]),
        (&["--pty", &taken], FAILED, &[&taken, "already there"]),
    ];
    for (arguments, wanted, words) in cases {
        assert_reported(&run(&[&["sim"], arguments].concat()), wanted, words);
    }
    assert!(file.path().exists(), "what was there is left alone");
}

#[test]
fn a_target_that_makes_no_sense_is_told_in_a_sentence() {
    for (target, wanted, word) in [
        ("tcp:nowhere", USAGE, "tcp:host:port"),
        ("/dev/x,baud=7", USAGE, "300 to 1000000"),
        ("sim:mcp999", NO_LINK, "mcp266"),
        ("tcp:127.0.0.1:1", NO_LINK, "127.0.0.1:1"),
        ("/etc/hostname", NO_LINK, "/etc/hostname"),
    ] {
        assert_reported(&run(&["status", "--connect", target]), wanted, &[word]);
    }
    assert_reported(&run(&["protocol", "no_such_command"]), USAGE, &["no_such_command"]);
}

/// Answers every request with bytes that mean nothing, by a generator with a fixed seed.
fn babble(listener: &TcpListener) {
    // The test waits for this to end, also when the program never comes or no longer reads.
    listener.set_nonblocking(true).expect("a listener can be asked without waiting");
    let (mut client, _) =
        wait::until_some("a client", || listener.accept().ok(), || "none has come".to_owned());
    client.set_nonblocking(false).expect("a client can be waited for");
    client.set_read_timeout(Some(LIMIT)).expect("a time-out can be set");
    client.set_write_timeout(Some(LIMIT)).expect("a time-out can be set");
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    let mut request = [0; 256];
    while client.read(&mut request).is_ok_and(|count| count > 0) {
        let mut bytes = [0_u8; 48];
        for byte in &mut bytes {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            *byte = (state >> 32) as u8;
        }
        let length = (state % 48) as usize;
        if client.write_all(&bytes[..length]).is_err() {
            return;
        }
    }
}

#[test]
fn a_port_that_talks_nonsense_is_no_controller() {
    // Each looks for some seconds, so that they do it at once.
    std::thread::scope(|scope| {
        for command in ["status", "stop", "drive"] {
            let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
            let target = format!("tcp:{}", listener.local_addr().expect("it has an address"));
            scope.spawn(move || babble(&listener));
            scope.spawn(move || {
                let more: &[&str] = if command == "drive" { &["--duty", "10"] } else { &[] };
                let ending = run(&[&[command, "--connect", &target], more].concat());
                assert_reported(&ending, NO_LINK, &[&target]);
                assert!(ending.stdout.is_empty(), "{ending:?}");
            });
        }
    });
}

#[test]
fn a_port_that_another_program_holds_is_told_with_its_name() {
    let controller = OnPty::start(Generation::Gen1);
    let port = text(&controller.port());
    let mut holder = start(&["status", "--connect", &port, "--watch"]);
    holder.next_line(LIMIT).expect("it has connected");
    assert_reported(&run(&["status", "--connect", &port]), NO_LINK, &[&port, "using it"]);
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_the_program_names_the_command_line() {
    for arguments in [&[][..], &["--open", "sim:mcp266"]] {
        let mut command = Command::new(BRUSHWORK);
        command.args(arguments);
        for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(name);
        }
        let ending = Program::spawn(command).finish(LIMIT);
        assert_reported(&ending, FAILED, &["no display", "command line", "brushwork --help"]);
        assert_eq!(ending.stderr.len(), 1, "{ending:?}");
    }
    assert_reported(&run(&["--open", "sim:mcp266", "status"]), USAGE, &["--open"]);
}

/// It is killed while everything is read back, which takes a line of this rate more than a second.
#[test]
fn a_raw_number_whose_program_is_killed_before_it_is_read_back_is_named_by_the_next_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut sim = start(&[
        "sim",
        "--tcp",
        "127.0.0.1:0",
        "--port",
        "ttl1",
        "--pace",
        "--baud",
        "19200",
        "--generation",
        "4",
    ]);
    let greeting = sim.wait_for("Connect with", LIMIT);
    let place = greeting.rsplit("tcp:").next().unwrap_or_default().trim();
    let port = format!("tcp:{},stream=ttl1", place.split(',').next().unwrap_or_default());
    let brushwork = |arguments: &[&str]| {
        let mut command = Command::new(BRUSHWORK);
        command.args(arguments).args(["-c", &port]).env("BRUSHWORK_DATA_DIR", folder.path());
        Program::spawn(command)
    };
    let noted = || {
        let files = std::fs::read_dir(folder.path().join("raw")).ok()?;
        // Until it has its name it is not noted, and nothing has gone out.
        let mut paths = files.flatten().map(|file| file.path());
        let noted = paths.find(|path| path.extension().is_some_and(|extension| extension == "json"))?;
        let text = std::fs::read_to_string(noted).ok()?;
        serde_json::from_str::<Value>(&text).ok()
    };
    let writing = brushwork(&["settings", "raw", "motor1.encoder.pin=2", "--own-risk"]);
    let begun = wait::until_some("the number is noted", noted, || "it is not".to_owned());
    writing.signal("KILL");
    writing.finish(LIMIT);
    assert_eq!((&begun[0]["wanted"], &begun[0]["is_open"]), (&2.into(), &true.into()), "{begun}");
    assert_eq!(noted().expect("it is kept")[0]["found"], Value::Null, "it was killed in time");

    let status = brushwork(&["status"]).finish(LIMIT).stderr.join("\n");
    assert!(
        status.contains("The raw number 2 was written to motor1.encoder.pin")
            && status.contains("not read back"),
        "{status}"
    );
    let key = ["settings", "read", "motor1.encoder.pin"];
    let read = brushwork(&key).finish(LIMIT).stderr.join("\n");
    assert!(read.contains("The raw number 2 w") && read.contains("command 92"), "{read}");
    assert_eq!(noted().expect("it is kept")[0].get("is_open"), None, "what became of it is known now");
    assert!(
        !brushwork(&key).finish(LIMIT).stderr.join("\n").contains("The raw number 2 w"),
        "once is enough"
    );
}

/// As a real controller over a port: what is only guessed is refused there.
#[test]
fn a_raw_number_is_written_at_the_owners_word_read_back_undone_and_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = folder.path().join("unit.json").display().to_string();
    // Of generation 4, whose examination takes the least time.
    let mut sim = start(&["sim", "--tcp", "127.0.0.1:0", "--generation", "4"]);
    let greeting = sim.wait_for("Connect with", LIMIT);
    let port = format!("tcp:{},stream=usb", greeting.rsplit("tcp:").next().unwrap_or_default().trim());
    let settings = |arguments: &[&str]| run(&[&["settings"], arguments, &["-c", &port]].concat());
    let pin = || json(&settings(&["read", "motor1.encoder.pin", "--json"]))["settings"][0]["value"].clone();
    let before = pin();
    assert_ne!(before, 2);

    let refused = settings(&["write", "motor1.encoder.pin=2", "--yes"]);
    assert_eq!(code(&refused), Some(5), "a guess is no normal write: {refused:?}");
    let unasked = settings(&["raw", "motor1.encoder.pin=2"]);
    assert_eq!(code(&unasked), Some(4), "nobody could be asked: {unasked:?}");
    let shown = settings(&["raw", "motor1.encoder.pin=0x02", "--dry-run"]);
    assert_eq!(code(&shown), Some(DONE), "{shown:?}");
    assert!(shown.stdout.join("\n").contains("80 5C 02"), "command 92 and the number: {shown:?}");
    assert_eq!(pin(), before);

    let written = settings(&["raw", "motor1.encoder.pin=2", "--own-risk"]);
    assert_eq!(code(&written), Some(DONE), "{written:?}");
    assert!(written.stderr.join("\n").contains("What this number means is not public"), "{written:?}");
    assert_eq!(pin(), 2);
    let undone = settings(&["raw", "--undo", "--own-risk"]);
    assert_eq!(code(&undone), Some(DONE), "{undone:?}");
    assert_eq!(pin(), before);

    for (key, words) in [
        ("can.rate=500000", "no known command carries it"),
        ("motor1.velocity.z=1", "has no setting motor1.velocity.z"),
        ("motor1.encoder.pin=256", "cannot be written"),
    ] {
        let refused = settings(&["raw", key, "--own-risk"]);
        assert_eq!(code(&refused), Some(5), "{refused:?}");
        assert!(refused.stderr.join("\n").contains(words), "{refused:?}");
    }

    let examined = run(&["examine", "-c", &port, "--json", &report]);
    assert_eq!(code(&examined), Some(DONE), "{examined:?}");
    assert!(examined.stdout.join("\n").contains("Written raw, at the owner's word"), "{examined:?}");
    let found: Value =
        serde_json::from_str(&std::fs::read_to_string(&report).expect("written")).expect("JSON");
    let [first, second] = [0, 1].map(|at| found["raw_writes"][at].clone());
    assert_eq!((&first["command"], &first["wanted"], &first["found"]), (&92.into(), &2.into(), &2.into()));
    assert_eq!((&second["wanted"], &second["before"]), (&before, &2.into()));
}

//! The built program from outside: what it prints, how it ends, and what the motors do when it is ended.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::guardian;
use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_mcp_sim::controller::ControllerConfig;
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::machine::StreamIndex;
use brushwork_tests::program::{Child, Ending, Program};
use brushwork_tests::served::guardians_of;
use brushwork_tests::simulated::{LATE_PTY, OnPty, OnTcp, PATIENT_TIME_OUT, is_at_rest, is_driven};
use brushwork_tests::wait::{self, LIMIT};
use brushwork_tests::{foreign, workspace};
use rustix::process::Signal;
use serde_json::Value;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// Exit codes, as `brushwork --help` lists them.
const DONE: i32 = 0;
const USAGE: i32 = 2;
const NO_LINK: i32 = 3;
const REFUSED: i32 = 4;
const INTERRUPTED: i32 = 130;

/// The controller's own time-out as it leaves the factory.
const FACTORY_TIME_OUT: Duration = Duration::from_secs(1);

/// How often a busy machine may keep a program from renewing its motion before the test gives up.
const TRIES: usize = 20;

fn start(arguments: &[&str]) -> Program {
    Program::start(BRUSHWORK, arguments)
}

fn run(arguments: &[&str]) -> Ending {
    start(arguments).finish(LIMIT)
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn json(ending: &Ending) -> Value {
    let text = ending.stdout.join("\n");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("no JSON: {error}: {text}"))
}

// ---------------------------------------------------------------------------------------------------------------------
// brushwork sim

fn sim_ends_cleanly_on(signal: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let link = folder.path().join("mcp");
    let mut sim = start(&["sim", "--pty", &text(&link), "--generation", "4"]);
    let greeting = sim.wait_for(&text(&link), LIMIT);
    wait::for_path(&link);
    let status = json(&run(&["status", "--connect", &format!("{}{LATE_PTY}", text(&link)), "--json"]));
    println!("{greeting}: {status}");
    sim.signal(signal);
    let ending = sim.finish(LIMIT);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    assert!(link.symlink_metadata().is_err(), "the link is left behind after SIG{signal}");
}

#[test]
fn a_served_controller_ends_cleanly_on_ctrl_c() {
    sim_ends_cleanly_on("INT");
}

#[test]
fn a_served_controller_ends_cleanly_on_sigterm() {
    sim_ends_cleanly_on("TERM");
}

#[test]
fn a_served_controller_ends_cleanly_when_the_terminal_closes() {
    sim_ends_cleanly_on("HUP");
}

#[test]
fn a_controller_on_tcp_says_how_to_connect_and_answers_there() {
    let mut sim = start(&["sim", "--tcp", "127.0.0.1:0"]);
    let line = sim.wait_for("Connect with", LIMIT);
    let target = line.rsplit(' ').next().unwrap_or_default().to_owned();
    assert!(target.starts_with("tcp:127.0.0.1:"), "{line}");
    let ending = run(&["status", "--connect", &target, "--json"]);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    assert!(json(&ending).to_string().contains("MCP266"), "{ending:?}");
}

#[test]
fn several_units_share_one_line() {
    let mut sim = start(&["sim", "--tcp", "127.0.0.1:0", "--port", "ttl1", "--address", "0x80,0x83"]);
    let line = sim.wait_for("Connect with", LIMIT);
    let target = line.rsplit(' ').next().unwrap_or_default();
    for (address, code) in [("0x80", DONE), ("0x83", DONE), ("0x81", NO_LINK)] {
        let ending = run(&["status", "--connect", target, "--address", address, "--json"]);
        assert_eq!(ending.status.code(), Some(code), "{address}: {ending:?}");
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// brushwork stop

#[test]
fn stop_without_an_address_stops_every_unit_of_the_line_and_says_which_and_who_did_not_answer() {
    let line = OnTcp::line(&[0x80, 0x81, 0x85]);
    line.set_all_going();
    let ending = run(&["stop", "--connect", &text(&line.port())]);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    wait::until("bridges at rest", || line.driven() == [false; 3], || format!("{:?}", line.driven()));
    for place in ["0x80", "0x81", "0x85"] {
        let reported = format!("{place}: both motors stopped");
        assert!(ending.stdout.iter().any(|sentence| sentence.starts_with(&reported)), "{ending:?}");
    }
    let said = ending.stderr.join(" ");
    assert!(said.contains("No unit answered at 0x82 to 0x84, 0x86, 0x87"), "{said}");
    line.set_all_going();
    let reported = json(&run(&["stop", "--connect", &text(&line.port()), "--json"]));
    assert_eq!(reported["confirmed"], true);
    let addresses: Vec<_> =
        reported["units"].as_array().into_iter().flatten().map(|unit| &unit["address"]).collect();
    assert_eq!(addresses, [0x80, 0x81, 0x85]);
    wait::until("bridges at rest", || line.driven() == [false; 3], || format!("{:?}", line.driven()));
}

#[test]
fn stop_with_addresses_stops_these_alone_and_names_the_one_that_does_not_answer() {
    let line = OnTcp::line(&[0x80, 0x81, 0x82]);
    line.set_all_going();
    let port = text(&line.port());
    let ending = run(&["stop", "--connect", &port, "--address", "0x81,0x82"]);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    wait::until("two at rest", || line.driven() == [true, false, false], || format!("{:?}", line.driven()));
    let ending = run(&["stop", "--connect", &port, "--address", "0x80,0x86"]);
    assert_eq!(ending.status.code(), Some(NO_LINK), "{ending:?}");
    wait::until("all at rest", || line.driven() == [false; 3], || format!("{:?}", line.driven()));
    let said = ending.stderr.join(" ");
    assert!(said.contains("No unit answered at 0x86: the stop was written there too"), "{said}");
    let ending = run(&["stop", "--connect", &port, "--address", "0x80,5"]);
    assert_eq!(ending.status.code(), Some(USAGE), "{ending:?}");
}

#[test]
fn stop_on_a_can_bus_stops_every_node_that_is_a_controller() {
    let nodes = [3, 5].map(|id| NodeId::new(id).expect("from 1 to 127"));
    let bus = OnTcp::nodes(&nodes, Form::Ascii);
    for id in [3, 5] {
        // SDO to the node, 2B: two bytes; objects 2020 and 2021 (commands 32 and 33), duty 0x3E80 of 0x7FFF.
        bus.receive(format!(":S60{id}N2B202000803E0000;:S60{id}N2B212000803E0000;").into_bytes());
    }
    wait::until("driven motors", || bus.driven() == [true; 2], || format!("{:?}", bus.driven()));
    let ending = run(&["stop", "--connect", &format!("can:{}", bus.port().display())]);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    wait::until("bridges at rest", || bus.driven() == [false; 2], || format!("{:?}", bus.driven()));
    for node in ["node 3", "node 5"] {
        let reported = format!("{node}: both motors stopped");
        assert!(ending.stdout.iter().any(|sentence| sentence.starts_with(&reported)), "{ending:?}");
    }
    assert!(ending.stderr.join(" ").contains("Nodes that do not answer"), "{ending:?}");
}

#[test]
fn ctrl_c_of_a_drive_without_an_address_stops_the_other_units_of_the_line_too() {
    let line = OnTcp::line(&[0x80, 0x81]);
    line.set_all_going();
    let target = format!("{},stream=ttl1", line.port().display());
    for (address, after) in [(Some("0x80"), [false, true]), (None, [false, false])] {
        let ending = (0..TRIES).find_map(|_| {
            line.set_all_going();
            let more = address.map_or(vec![], |address| vec!["--address", address]);
            let drive = ["drive", "--connect", &target, "--duty", "25", "--for", "600"];
            let mut program = start(&[&drive[..], &more].concat());
            program.wait_for(" s  ", LIMIT);
            program.signal("INT");
            let ending = program.finish(LIMIT);
            (!ending.was_starved()).then_some(ending)
        });
        let ending = ending.expect("the program has the processor now and then");
        assert_eq!(ending.status.code(), Some(INTERRUPTED), "{ending:?}");
        wait::until("the bridges", || line.driven() == after, || format!("{:?} {ending:?}", line.driven()));
        let said = ending.stderr.join(" ");
        assert_eq!(said.contains("0x81: both motors stopped"), address.is_none(), "{said}");
    }
}

#[test]
fn however_a_drive_of_several_units_ends_none_of_them_is_left_driven() {
    let line = OnTcp::line(&[0x80, 0x81, 0x84]);
    let target = format!("{},stream=ttl1", line.port().display());
    let words =
        ["drive", "--connect", &target, "--address", "0x80,0x81,0x84", "--motor", "both", "--duty", "30"];
    for signal in ["KILL", "INT"] {
        let ending = (0..TRIES).find_map(|_| {
            let mut program = start(&[&words[..], &["--for", "600"]].concat());
            program.wait_for("0x84 on ", LIMIT);
            let all = || line.driven() == [true; 3];
            // Whoever is starved is stopped by its own dead-man before.
            wait::until(
                "driven motors, or the end",
                || all() || !program.is_running(),
                || format!("{:?}", line.driven()),
            );
            if program.is_running() {
                program.signal(signal);
            }
            let number = program.id();
            let ending = program.finish(LIMIT);
            leaves_the_line(number);
            (!ending.was_starved()).then_some(ending)
        });
        let ending = ending.expect("the program has the processor now and then");
        // The units' own time-out is a minute.
        wait::until(
            "the bridges",
            || line.driven() == [false; 3],
            || format!("{:?} {ending:?}", line.driven()),
        );
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// brushwork drive

fn drive_arguments(port: &Path, seconds: &str) -> Vec<String> {
    let target = format!("{},stream=usb", port.display());
    let arguments = ["drive", "--connect", &target, "--motor", "both", "--duty", "50", "--for", seconds];
    arguments.map(str::to_owned).to_vec()
}

fn driving(controller: &OnTcp) -> Program {
    let start = || Program::start(BRUSHWORK, &drive_arguments(&controller.port(), "600"));
    guardian::started_driving(start, || controller.look(is_driven))
}

fn is_ended_by(signal: &str) {
    let controller = OnTcp::patient(Generation::Gen1);
    let ending = (0..TRIES).find_map(|_| {
        let program = driving(&controller);
        program.signal(signal);
        let off = controller.wait_until_off();
        println!("SIG{signal}: {off:?}");
        off.assert_by_command();
        let ending = program.finish(LIMIT);
        (!ending.was_starved()).then_some(ending)
    });
    let ending = ending.expect("the program has the processor now and then");
    assert_eq!(ending.status.code(), Some(INTERRUPTED), "{ending:?}");
    controller.wait_until("shafts at rest", is_at_rest);
}

#[test]
fn ctrl_c_stops_both_motors_before_the_program_ends() {
    is_ended_by("INT");
}

#[test]
fn sigterm_stops_both_motors_before_the_program_ends() {
    is_ended_by("TERM");
}

#[test]
fn a_closed_terminal_stops_both_motors_before_the_program_ends() {
    is_ended_by("HUP");
}

#[test]
fn a_closed_pipe_stops_both_motors_before_the_program_ends() {
    let controller = OnTcp::patient(Generation::Gen1);
    let mut command = Command::new(BRUSHWORK);
    command.args(drive_arguments(&controller.port(), "600"));
    let mut program = Child::spawn(&command, [Stdio::null(), Stdio::piped(), Stdio::null()]);
    controller.wait_until("driven motors", is_driven);
    program.close_stdout();
    let off = controller.wait_until_off();
    println!("closed pipe: {off:?}");
    off.assert_by_command();
    // Refused: a machine that was too busy kept it from renewing the motion before it could write.
    let code = program.finish(LIMIT).code();
    assert!(matches!(code, Some(INTERRUPTED | REFUSED)), "{code:?}");
}

/// Waits for the guardian of a program that has ended: until it has, it holds the connection.
fn leaves_the_line(program: u32) {
    wait::until("no guardian", || guardians_of(program).is_empty(), || "it is there".to_owned());
}

fn is_stopped_by_the_controller(signal: &str) {
    let controller = OnTcp::start(Generation::Gen1);
    let stopped = (0..TRIES).any(|_| {
        let mut program = driving(&controller);
        // Whatever is looked at below was alive until then, or had stopped the motors itself.
        let was_alive = program.is_running() && controller.look(is_driven);
        // Its guardian would be quicker. A lost machine takes both.
        guardian::signal(program.id(), Signal::KILL);
        program.signal(signal);
        let off = controller.wait_until_off();
        println!("SIG{signal}: {off:?}, time-out {FACTORY_TIME_OUT:?}");
        let by_time_out = was_alive && off.silent_for >= FACTORY_TIME_OUT;
        if by_time_out {
            off.assert_by_time_out(FACTORY_TIME_OUT);
        }
        leaves_the_line(program.id());
        by_time_out
    });
    assert!(stopped, "the time-out stops the motors");
}

#[test]
fn a_killed_program_leaves_motors_that_the_controller_stops() {
    is_stopped_by_the_controller("KILL");
}

#[test]
fn a_frozen_program_leaves_motors_that_the_controller_stops() {
    is_stopped_by_the_controller("STOP");
}

#[test]
fn a_drive_that_is_over_stops_both_motors() {
    let controller = OnTcp::patient(Generation::Gen2);
    let ending = (0..TRIES).find_map(|_| {
        let program = Program::start(BRUSHWORK, &drive_arguments(&controller.port(), "0.5"));
        let ending = program.finish(LIMIT);
        (!ending.was_starved()).then_some(ending)
    });
    let ending = ending.expect("the program has the processor now and then");
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    controller.wait_until_off().assert_by_command();
    assert!(controller.look(|unit| unit.view().axes.iter().all(|axis| axis.encoder_counts > 0)), "they ran");
}

#[test]
fn driving_is_refused_without_a_time_out_and_nothing_moves() {
    let mut config = ControllerConfig::default();
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.streams[0].timeout_ms = 0;
    config.settings = Some(settings);
    let controller = OnTcp::start_with(config, StreamIndex::Usb);
    let program = Program::start(BRUSHWORK, &drive_arguments(&controller.port(), "1"));
    let ending = program.finish(LIMIT);
    assert_eq!(ending.status.code(), Some(REFUSED), "{ending:?}");
    assert!(ending.stderr.join(" ").contains("time-out"), "{ending:?}");
    assert!(controller.look(|unit| unit.view().axes.iter().all(|axis| axis.encoder_counts == 0)));
}

// ---------------------------------------------------------------------------------------------------------------------
// brushwork settings

#[test]
fn settings_that_contradict_each_other_are_told_before_the_write_and_at_every_read() {
    let controller = OnPty::start(Generation::Gen2);
    let port = controller.target();
    let run = |arguments: &[&str]| {
        let words = [&["settings"], arguments, &["-c", &port]].concat();
        Program::start(BRUSHWORK, &words).finish(LIMIT)
    };
    let write = run(&["write", "pin.3.type=analog", "pin.3.max=5000", "pin.3.max_action=m1_off", "--yes"]);
    assert_eq!(write.status.code(), Some(DONE), "{write:?}");
    let conflict = "The maximum action of DIN3/AN3 never acts: the input never goes up to 5000.";
    assert!(write.stdout.join(" ").contains(&format!("Note: {conflict}")), "{write:?}");
    let read = run(&["read"]);
    assert!(read.stderr.join(" ").contains(&format!("Warning: {conflict}")), "{read:?}");
    let json = run(&["read", "--json"]);
    assert!(json.stdout.join(" ").contains("\"kind\": \"action_never_fires\""), "{json:?}");
}

// ---------------------------------------------------------------------------------------------------------------------
// brushwork monitor

#[test]
fn a_tap_decodes_a_foreign_program_and_stops_its_motors_when_it_ends() {
    if foreign::is_left_out("python") {
        return;
    }
    let controller = OnPty::start(Generation::Gen1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let tap = folder.path().join("tap");
    let mut monitor = start(&["monitor", "--connect", &controller.target(), "--pty", &text(&tap)]);
    wait::for_path(&tap);

    let script = workspace::root().join("tests/foreign/driving_client.py");
    let time_out_ms = PATIENT_TIME_OUT.as_millis().to_string();
    let mut client = Program::start(&text(&foreign::python()), &[&text(&script), &text(&tap), &time_out_ms]);
    client.wait_for("driving", LIMIT);
    controller.wait_until("a client that drives through the tap", is_driven);
    for decoded in ["duty M1 50.0 %, duty M2 -50.0 %", "read motor currents: current M1"] {
        println!("{}", monitor.wait_for(decoded, LIMIT));
    }

    monitor.signal("INT");
    let off = controller.wait_until_off();
    println!("tap ended: {off:?}");
    off.assert_by_command();
}

// ---------------------------------------------------------------------------------------------------------------------
// What goes wrong, and what is only read

#[test]
fn a_port_that_is_not_there_is_told_in_a_sentence() {
    let ending = run(&["status", "--connect", "/dev/no-such-port"]);
    assert_eq!(ending.status.code(), Some(NO_LINK), "{ending:?}");
    let reported = ending.stderr.join(" ");
    assert!(reported.contains("/dev/no-such-port") && reported.ends_with('.'), "{reported}");
}

#[test]
fn a_port_that_is_no_controller_is_told_in_a_sentence() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
    let target = format!("tcp:{}", listener.local_addr().expect("it has an address"));
    let ending = run(&["status", "--connect", &target]);
    assert_eq!(ending.status.code(), Some(NO_LINK), "{ending:?}");
    let reported = ending.stderr.join(" ");
    assert!(reported.contains(&target) && reported.ends_with('.'), "{reported}");
}

#[test]
fn a_command_line_that_makes_no_sense_has_its_own_exit_code() {
    for arguments in [&["fly"][..], &["drive"], &["drive", "--duty", "400"], &["sim", "--generation", "9"]] {
        assert_eq!(run(arguments).status.code(), Some(USAGE), "{arguments:?}");
    }
}

#[test]
fn what_is_data_can_be_had_as_json() {
    for arguments in [&["list", "--json"][..], &["protocol", "--json"], &["status", "--json"]] {
        let ending = run(arguments);
        assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
        assert!(!json(&ending).is_null(), "{arguments:?}");
    }
}

#[test]
fn reading_the_status_moves_nothing() {
    let controller = OnPty::start(Generation::Gen3);
    let ending = run(&["status", "--connect", &controller.target(), "--json"]);
    assert_eq!(ending.status.code(), Some(DONE), "{ending:?}");
    assert!(controller.look(|unit| unit.view().axes.iter().all(|axis| axis.encoder_counts == 0)));
}

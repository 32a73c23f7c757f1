//! `brushwork script` from outside, against a controller on a pseudo-terminal: what is downloaded, started, stopped and refused.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use brushwork_link::transport::{SerialTransport, Transport as _};
use brushwork_mcp_sim::controller::Controller;
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_plant::world::Content;
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::simulated::{OnPort, OnPty, OnTcp, is_at_rest, is_driven};
use brushwork_tests::wait::LIMIT;
use serde_json::Value;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// Exit codes, as `brushwork --help` lists them.
const DONE: i32 = 0;
const REFUSED: i32 = 4;
const INTERRUPTED: i32 = 130;

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn target<const IS_PTY: bool>(controller: &OnPort<IS_PTY>) -> String {
    format!("{},stream=usb", controller.target())
}

fn script(arguments: &[&str]) -> Program {
    Program::start(BRUSHWORK, &[&["script"], arguments].concat())
}

fn run(arguments: &[&str]) -> Ending {
    script(arguments).finish(LIMIT)
}

fn code(ending: &Ending) -> Option<i32> {
    ending.status.code()
}

/// A file with a script that drives both motors.
fn driving(folder: &tempfile::TempDir) -> PathBuf {
    let file = folder.path().join("drive.mcl");
    std::fs::write(&file, "main\npower2 9830,655359,9830,655359\npause 10\ngoto main\n")
        .expect("a folder of ours");
    file
}

fn holds(controller: &Controller) -> Content {
    controller.unit().map_or(Content::Nothing, |unit| unit.script_view().holds)
}

fn runs(controller: &Controller) -> bool {
    controller.unit().is_some_and(|unit| unit.script_is_running())
}

#[test]
fn what_is_compiled_here_is_not_sent_unless_the_controller_is_said_to_be_simulated() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = text(&driving(&folder));
    let controller = OnPty::start(Generation::Gen2);
    let target = target(&controller);
    let refused = run(&["download", &file, "--to", &target]);
    assert_eq!(code(&refused), Some(REFUSED), "{refused:?}");
    assert!(refused.stderr.join("\n").contains("byte code of real controllers is not public"), "{refused:?}");
    assert_eq!(controller.look(holds), Content::Nothing);
    let done = run(&["download", &file, "--to", &target, "--simulated", "--json"]);
    assert_eq!(code(&done), Some(DONE), "{done:?}");
    let reported: Value = serde_json::from_str(&done.stdout.join("\n")).expect("JSON");
    assert_eq!((&reported["verified"], &reported["status"]), (&"status".into(), &255.into()), "{reported}");
    assert_eq!(controller.look(holds), Content::Own);
    assert!(!controller.look(runs), "a download starts nothing");
}

#[test]
fn a_started_script_ends_with_its_motors_on_ctrl_c() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = text(&driving(&folder));
    let controller = OnTcp::start(Generation::Gen2);
    let mut program = script(&["start", &file, "--simulated", "--to", &target(&controller)]);
    controller.wait_until("a script that drives", is_driven);
    assert!(program.is_running() && controller.look(runs));
    program.signal("INT");
    let ending = program.finish(LIMIT);
    assert_eq!(code(&ending), Some(INTERRUPTED), "{ending:?}");
    controller.wait_until("motors at rest", is_at_rest);
    assert!(!controller.look(runs));
}

#[test]
fn autorun_is_told_and_set_and_a_foreign_image_is_not_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("maker.bin");
    std::fs::write(&file, [0x5A; 0x200]).expect("a folder of ours");
    let controller = OnPty::start(Generation::Gen2);
    let target = target(&controller);
    let set = run(&["autorun", "500", "--json", "--to", &target]);
    assert!(set.stdout.join("\n").contains("500"), "{set:?}");
    let reported = run(&["status", "--to", &target]);
    assert_eq!(reported.stdout[0], "Autorun is on: the script starts 500 ms after power-up.", "{reported:?}");
    assert!(reported.stdout[1].starts_with("No command of the protocol tells"), "{reported:?}");
    let done = run(&["download", &text(&file), "--to", &target]);
    assert_eq!(code(&done), Some(DONE), "{done:?}");
    assert!(done.stderr.join("\n").contains("Autorun is on"), "{done:?}");
    let refused = run(&["start", "--for", "5", "--to", &target]);
    assert_eq!(code(&refused), Some(REFUSED), "{refused:?}");
    assert!(refused.stderr.join("\n").contains("holds no script that it can run"), "{refused:?}");
}

/// Sends a command without arguments to address 0x80.
fn send(port: &mut SerialTransport, command: u8) {
    let mut packet = vec![0x80, command];
    packet.extend(crc16_xmodem(&packet).to_be_bytes());
    port.write(&packet).expect("the port takes bytes");
}

/// So many bytes without what is listened for are no answer.
const TALK: usize = 1024;

/// Reads on, asking again with `ask`, until what came holds `words`.
fn hear(port: &mut SerialTransport, words: &[u8], mut ask: impl FnMut(&mut SerialTransport)) {
    let deadline = Instant::now() + LIMIT;
    let mut heard = Vec::new();
    let has_come = |heard: &[u8]| heard.windows(words.len()).any(|window| window == words);
    while !has_come(&heard) {
        assert!(Instant::now() < deadline, "heard {:?}", String::from_utf8_lossy(&heard));
        ask(port);
        let asked = heard.len();
        let mut buffer = [0; 256];
        while let count @ 1.. = port.read(&mut buffer, Duration::from_millis(200)).expect("the port is there")
        {
            heard.extend(&buffer[..count]);
            // A script talks without an end.
            if has_come(&heard) || heard.len() - asked > TALK {
                break;
            }
        }
    }
}

#[test]
fn rts_by_the_controls_of_a_served_controller_brings_packet_serial_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("talk.mcl");
    // Takes the USB port, the stream type of MCL being 0, and talks.
    let talks = "main\nSTREAMTYPE(0) = 0\nputs 0,[\"tick \"]\npause 20\ngoto main\n";
    std::fs::write(&file, talks).expect("a folder of ours");
    let link = folder.path().join("mcp");
    let arguments = ["sim", "--pty", &text(&link), "--script", &text(&file), "--rts", "--control"];
    let mut sim = Program::start(BRUSHWORK, &arguments);
    sim.wait_for("Connect with", LIMIT);
    let mut port = SerialTransport::open(&text(&link), 115_200).expect("the port opens");
    let ask_version = |port: &mut SerialTransport| send(port, number::READ_VERSION);
    send(&mut port, number::START_SCRIPT);
    hear(&mut port, b"MCP266", ask_version);
    sim.say("rts off");
    sim.wait_for_error("RTS is released", LIMIT);
    hear(&mut port, b"tick tick", |_| {});
    sim.say("rts on");
    sim.wait_for_error("RTS is held: the USB port speaks packet serial", LIMIT);
    hear(&mut port, b"MCP266", ask_version);
    sim.signal("INT");
    let ending = sim.finish(LIMIT);
    assert_eq!(code(&ending), Some(DONE), "{ending:?}");
}

#[test]
fn the_power_of_a_served_controller_is_switched_and_cycled_by_its_controls() {
    let folder = tempfile::tempdir().expect("a folder");
    let link = folder.path().join("mcp");
    let mut sim = Program::start(BRUSHWORK, &["sim", "--pty", &text(&link), "--control"]);
    sim.wait_for("Connect with", LIMIT);
    let mut port = SerialTransport::open(&text(&link), 115_200).expect("the port opens");
    let ask_version = |port: &mut SerialTransport| send(port, number::READ_VERSION);
    hear(&mut port, b"MCP266", ask_version);
    sim.say("power off");
    sim.wait_for_error("The power is off.", LIMIT);
    let deadline = Instant::now() + LIMIT;
    let is_silent = |port: &mut SerialTransport| {
        while port.read(&mut [0; 256], Duration::from_millis(200)).expect("the port is there") > 0 {}
        ask_version(port);
        port.read(&mut [0; 256], Duration::from_millis(300)).expect("the port is there") == 0
    };
    while !is_silent(&mut port) {
        assert!(Instant::now() < deadline, "it still answers");
    }
    sim.say("power on");
    sim.wait_for_error("The power is on.", LIMIT);
    hear(&mut port, b"MCP266", ask_version);
    for (said, sentence) in [
        ("power cycle 1", "The power was off for half a second."),
        ("power cycle 2", "\"power cycle 2\" is no command"),
        ("reboot", "\"reboot\" is no command"),
    ] {
        sim.say(said);
        sim.wait_for_error(sentence, LIMIT);
    }
    hear(&mut port, b"MCP266", ask_version);
    sim.signal("INT");
    let ending = sim.finish(LIMIT);
    assert_eq!(code(&ending), Some(DONE), "{ending:?}");
}

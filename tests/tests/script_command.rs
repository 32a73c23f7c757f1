//! `brushwork script` from outside, against a controller on a pseudo-terminal: what is downloaded, started, stopped and refused.
#![cfg(unix)]

use std::path::{Path, PathBuf};

use brushwork_protocol::packet_serial::Generation;
use brushwork_sim::controller::{Content, Controller};
use brushwork_tests::program::{Ending, Program};
use brushwork_tests::simulated::{OnPty, is_at_rest, is_driven};
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

fn target(controller: &OnPty) -> String {
    format!("{},stream=usb", text(&controller.port()))
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
    let told: Value = serde_json::from_str(&done.stdout.join("\n")).expect("JSON");
    assert_eq!((&told["verified"], &told["status"]), (&"status".into(), &255.into()), "{told}");
    assert_eq!(controller.look(holds), Content::Own);
    assert!(!controller.look(runs), "a download starts nothing");
}

#[test]
fn a_started_script_ends_with_its_motors_on_ctrl_c() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = text(&driving(&folder));
    let controller = OnPty::start(Generation::Gen2);
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
    let told = run(&["status", "--to", &target]);
    assert_eq!(told.stdout[0], "Autorun is on: the script starts 500 ms after power-up.", "{told:?}");
    assert!(told.stdout[1].starts_with("No command of the protocol tells"), "{told:?}");
    let done = run(&["download", &text(&file), "--to", &target]);
    assert_eq!(code(&done), Some(DONE), "{done:?}");
    assert!(done.stderr.join("\n").contains("Autorun is on"), "{done:?}");
    let refused = run(&["start", "--for", "5", "--to", &target]);
    assert_eq!(code(&refused), Some(REFUSED), "{refused:?}");
    assert!(refused.stderr.join("\n").contains("holds no script that it can run"), "{refused:?}");
}

//! `brushwork macro`: macro files, checked, formatted and tried.

use std::fs;

use crate::cli::{DIFFERENT, DONE, REFUSED, Run, Simulated, USAGE, name, program, run};

/// The file has errors.
const WRONG: i32 = 9;
/// What was tried was refused, or the motor was let go.
const FAULTED: i32 = 10;

const SHUTTLE: &str = "\
# To and fro, with a lamp.
const FAR = 500

macro shuttle = 3
    MA 0, WS 10
    CN 1
    MA FAR, WS 10
    CF 1, TT
";

fn with(text: &str, act: impl Fn(&str) -> Run) -> (Run, String) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("slide.macros");
    fs::write(&file, text).expect("it takes it");
    let ended = act(name(&file));
    (ended, fs::read_to_string(&file).expect("it is still there"))
}

fn macros(words: &[&str]) -> Run {
    run(program().arg("macro").args(words))
}

#[test]
fn a_file_is_checked_with_line_and_column() {
    let (checked, _) = with(SHUTTLE, |file| macros(&["check", file]));
    checked.ended_with(DONE).prints("0 errors, 0 warnings");
    let (checked, _) = with("macro go\n    MA 5,\n    DP 300\n", |file| macros(&["check", file]));
    checked
        .ended_with(WRONG)
        .prints("slide.macros:3:5: error E204: DP takes 0 to 255, not 300.")
        .prints("1 error");
    let (checked, _) = with(SHUTTLE, |file| macros(&["check", "--json", file]));
    let json = checked.ended_with(DONE).json();
    let file = &json["files"][0];
    assert_eq!((&file["ok"], &file["errors"]), (&true.into(), &0.into()));
    let defined = &file["macros"][0];
    assert_eq!((&defined["number"], &defined["name"]), (&3.into(), &"shuttle".into()));
    assert_eq!(defined["line"], "MD3,MA0,WS10,CN1,MA500,WS10,CF1,TT");
    let warned = "macro start = 0\n    MA 5\n";
    let (checked, _) = with(warned, |file| macros(&["check", file]));
    checked.ended_with(DONE).prints("W401");
    let (checked, _) = with(warned, |file| macros(&["check", "--deny-warnings", file]));
    checked.ended_with(WRONG);
    macros(&["check", "nowhere.macros"]).ended_with(1).explains("Could not read nowhere.macros");
}

#[test]
fn a_file_is_formatted_in_its_place_and_one_with_errors_is_left_alone() {
    let untidy = "#To and fro, with a lamp.\nconst FAR=500\n\n\nmacro shuttle=3\nma0,ws10\nCN1\nMA FAR,ws 10\ncf1,tt\n";
    let (_, text) = with(untidy, |file| macros(&["fmt", "--check", file]).ended_with(DIFFERENT).prints(file));
    assert_eq!(text, untidy);
    let (_, text) = with(untidy, |file| macros(&["fmt", file]).ended_with(DONE));
    assert_eq!(text, SHUTTLE);
    let (_, text) = with(SHUTTLE, |file| macros(&["fmt", "--check", file]).ended_with(DONE));
    assert_eq!(text, SHUTTLE);
    let wrong = "macro go\nqq 5\n";
    let (_, text) =
        with(wrong, |file| macros(&["fmt", file]).ended_with(WRONG).explains("slide.macros:2:1: error E201"));
    assert_eq!(text, wrong);
}

#[test]
fn a_macro_is_tried_command_by_command_in_the_controllers_own_time() {
    let (ran, _) = with(SHUTTLE, |file| macros(&["run", file]));
    // 2 sqrt(500 / 200,000) = 0.1 s there, two waits of 10 ms.
    ran.ended_with(DONE)
        .prints("slide.macros:5:5  shuttle: MA0 at 0")
        .prints("outputs 0000000000000001")
        .prints("says 0T0:+0000000500")
        .explains("Ended after 0.121 s");
    let (ran, _) = with(SHUTTLE, |file| macros(&["run", file, "--macro", "home"]));
    ran.ended_with(USAGE).explains("has no macro home. It has shuttle.");
    let forever = "macro go\n    MA 500, WS 0, MA 0, WS 0\n    MC go\n";
    let (ran, _) = with(forever, |file| macros(&["run", file, "--for", "2"]));
    ran.ended_with(DONE).explains("Still running after 2.000 s");
    let (ran, _) = with("macro go\n    DV 1000000, SM 10\n    MA 50000, WS\n", |file| macros(&["run", file]));
    ran.ended_with(FAULTED).explains("let the motor go");
    let (ran, _) = with("macro go\n    MC nobody\n", |file| macros(&["run", file]));
    ran.ended_with(WRONG).explains("slide.macros:2:8: error E205");
}

#[test]
fn macros_go_to_a_controller_and_come_back_with_their_names() {
    let line = Simulated::start(&["--model", "suprmotr-v9", "--address", "3"]);
    let connect = format!("{},family=suprmotr", line.port());
    let target = ["--connect", &connect, "--address", "3"];
    let on = |words: &[&str]| run(program().arg("macro").args(words).args(target));
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("slide.macros");
    fs::write(&file, format!("{SHUTTLE}\nmacro home = 1\n    GH, WS\n")).expect("it takes it");
    on(&["upload", name(&file)])
        .ended_with(DONE)
        .prints("macro 3 shuttle: stored and read back")
        .prints("macro 1 home: stored and read back");
    on(&["read", "-"]).ended_with(DONE).prints("macro macro_1 = 1 GH WS macro macro_3 = 3 MA 0 WS 10 CN 1");
    on(&["read", name(&file)]).ended_with(1).explains("exists already");
    on(&["read", name(&file), "--force"]).ended_with(DONE).prints("2 macros");
    let text = fs::read_to_string(&file).expect("it was written");
    assert!(text.starts_with("macro home = 1\n    GH\n    WS\n\nmacro shuttle = 3\n    MA 0\n"), "{text}");
    // What was read goes back as it is.
    on(&["upload", name(&file)]).ended_with(DONE);
    fs::write(&file, "macro go\n    QQ\n").expect("it takes it");
    on(&["upload", name(&file)]).ended_with(WRONG).explains("E201");
    run(program().args(["macro", "read", "-", "--connect", "sim:mcp266"]))
        .ended_with(REFUSED)
        .explains("keeps no macros");
}

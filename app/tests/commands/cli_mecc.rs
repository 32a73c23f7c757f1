//! `brushwork mecc`: programs checked, run and formatted, as a person or a script does it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::{DIFFERENT, DONE, Run, USAGE, name, program, run};
use serde_json::Value;
use tempfile::TempDir;

const FAILED: i32 = 1;
const WRONG: i32 = 9;
const FAULTED: i32 = 10;

/// Sends back what comes, and shows it.
const ECHO: &str = "\
Declare DataTable t
    Reserve 8
End DataTable
Declare DataPointer p
Declare Byte first
Declare EventHandler back()
    p = SetPointer(t)
    Receive p
    p = SetPointer(t)
    first = ReadData(p)
    DisplayHex first
    p = SetPointer(t)
    Transmit p
End EventHandler
Begin Program
    SetEvent ReceiveEvent, back
    Enable Events
    Loop
    End Loop
End Program
";

fn mecc(arguments: &[&str]) -> Run {
    run(program().arg("mecc").args(arguments))
}

fn file(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("a.mecc");
    fs::write(&path, text).expect("the folder is the test's");
    (folder, path)
}

fn lines(path: &Path) -> Vec<Value> {
    let text = fs::read_to_string(path).expect("the trace is written");
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

#[test]
fn frames_stand_on_standard_output_and_the_rest_in_the_trace() {
    let (folder, path) = file(ECHO);
    let trace = folder.path().join("trace");
    let sent = ["--send", "0.5:I001002003", "--send", "0.1:I171", "--limit", "1", "--trace", name(&trace)];
    let run = mecc(&[&["run", name(&path)], &sent[..]].concat()).ended_with(DONE);
    assert_eq!(run.stdout, "073171000000000000000000000\n073001002003000000000000000\n");
    assert_eq!(run.stderr, "");
    let seen = lines(&trace);
    let events: Vec<&str> = seen.iter().map(|line| line["event"].as_str().unwrap()).collect();
    assert_eq!(events, ["receive", "display", "transmit", "receive", "display", "transmit"]);
    assert_eq!((&seen[1]["text"], &seen[4]["text"]), (&"AB".into(), &"01".into()));
    // Five characters of 1.04 ms.
    assert!((0.1052..0.107).contains(&seen[0]["t"].as_f64().unwrap()), "{}", seen[0]);
    // The next trace takes its place; anything else stays.
    mecc(&[&["run", name(&path)], &sent[..]].concat()).ended_with(DONE);
    fs::write(&trace, "precious").unwrap();
    mecc(&[&["run", name(&path)], &sent[..]].concat()).ended_with(FAILED).explains("Give --force");
    assert_eq!(fs::read_to_string(&trace).unwrap(), "precious");
}

#[test]
fn a_program_ends_by_itself_at_the_limit_or_by_a_fault() {
    let (_folder, path) = file("Begin Program\nWait 128\nEnd Program\n");
    mecc(&["run", name(&path)]).ended_with(DONE);
    let (_folder, path) = file("Begin Program\nLoop\nEnd Loop\nEnd Program\n");
    mecc(&["run", name(&path), "--limit", "3600"]).ended_with(DONE);
    let (_folder, path) = file("Declare Byte a\nBegin Program\na = 1 / a\nDisplayHex a\nEnd Program\n");
    let words = format!(
        "{}:3: the script was stopped by a fault: Unknown Instruction: a division by zero",
        name(&path)
    );
    mecc(&["run", name(&path)]).ended_with(FAULTED).explains(&words);
}

#[test]
fn errors_have_file_line_and_column_and_end_with_9() {
    let (_folder, path) = file("Begin Program\n    Wiat 5\nEnd Program\n");
    let place = format!("{}:2:5: error E210: `Wiat` is no command.", name(&path));
    let run = mecc(&["run", name(&path)]).ended_with(WRONG).explains(&place).explains("Did you mean Wait?");
    assert_eq!(run.stdout, "");
    mecc(&["check", name(&path)]).ended_with(WRONG).prints(&place).prints("1 error, 0 warnings");
    let checked = mecc(&["check", "--json", name(&path)]).ended_with(WRONG).json();
    let said = &checked["files"][0]["diagnostics"][0];
    assert_eq!((&said["code"], &said["line"], &said["column"]), (&"E210".into(), &2.into(), &5.into()));
    let (_folder, path) = file("Begin Program\nSetTimer 1, 111\nEnd Program\n");
    mecc(&["check", name(&path)]).ended_with(DONE).prints("0 errors, 2 warnings");
    mecc(&["check", "--deny-warnings", name(&path)]).ended_with(WRONG);
    mecc(&["check", "/nowhere/a.mecc"]).ended_with(FAILED).explains("Could not read /nowhere/a.mecc");
}

#[test]
fn an_input_changes_and_a_lost_frame_is_told() {
    let text = ECHO
        .replace("ReceiveEvent", "OnOff3Event")
        .replace("    Transmit p\n", "    Transmit p\n    p = SetPointer(t)\n    Transmit p\n");
    let (_folder, path) = file(&text);
    let run = mecc(&["run", "-q", name(&path), "--limit", "1", "--input", "0.5:3=on"]).ended_with(DONE);
    assert_eq!(run.stdout, "073000000000000000000000000\n");
    assert!(run.stderr.starts_with("1 transmissions were lost"), "{}", run.stderr);
}

#[test]
fn arguments_that_make_no_sense_are_refused() {
    let (_folder, path) = file(ECHO);
    for wrong in [
        ["--send", "I001"],
        ["--send", "x:I001"],
        ["--send", "-1:I001"],
        ["--input", "1:5=on"],
        ["--limit", "soon"],
    ] {
        mecc(&["run", name(&path), wrong[0], wrong[1]]).ended_with(USAGE);
    }
}

#[test]
fn programs_are_formatted_and_the_reference_is_printed() {
    let (_folder, path) = file("Begin Program\nLoop\nBeep  1,2\nEnd Loop\nEnd Program\n");
    mecc(&["fmt", "--check", name(&path)]).ended_with(DIFFERENT).prints(name(&path));
    mecc(&["fmt", name(&path)]).ended_with(DONE);
    let expected = "Begin Program\n    Loop\n        Beep 1, 2\n    End Loop\nEnd Program\n";
    assert_eq!(fs::read_to_string(&path).unwrap(), expected);
    let page = mecc(&["reference"]).ended_with(DONE).stdout;
    assert!(page.contains("SetServo servo, direction, angle (from the maker's other pages)"), "{page}");
    let data = mecc(&["reference", "--json"]).ended_with(DONE).json();
    assert_eq!(data["events"][14]["name"], "ReceiveEvent");
}

//! No child outlives its owner, and no wait for one is without an end.
#![cfg(unix)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use brushwork_child::{Child, Program};
use rustix::process::{Pid, test_kill_process};

/// More than a healthy machine needs for anything here, and far less than the children would go on.
const LIMIT: Duration = Duration::from_secs(120);

/// How long a child is waited for that does not end.
const SHORT: Duration = Duration::from_millis(100);

/// Set for a copy of this file's process that is to be killed.
const TO_BE_KILLED: &str = "BRUSHWORK_CHILD_TO_BE_KILLED";

fn sleeps() -> Command {
    let mut command = Command::new("sleep");
    command.arg("600");
    command
}

fn nothing() -> [Stdio; 3] {
    [Stdio::null(), Stdio::null(), Stdio::null()]
}

fn shell(script: &str) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", script]);
    command
}

/// Whether there is a process of that number, be it one that has ended and was not waited for.
fn exists(id: u32) -> bool {
    let id = Pid::from_raw(i32::try_from(id).expect("a process number")).expect("it is not 0");
    test_kill_process(id).is_ok()
}

/// What a panic said.
fn panic_of<T>(act: impl FnOnce() -> T) -> String {
    let Err(panic) = catch_unwind(AssertUnwindSafe(act)) else { panic!("it does not panic") };
    *panic.downcast::<String>().expect("a panic with a sentence")
}

#[test]
fn a_child_ends_with_its_owner() {
    let child = Child::spawn(&sleeps(), nothing());
    let id = child.id();
    assert!(exists(id));
    drop(child);
    assert!(!exists(id));
}

#[test]
fn a_child_ends_when_its_test_panics() {
    let mut id = 0;
    let said = panic_of(|| {
        let program = Program::spawn(sleeps());
        id = program.id();
        assert!(!exists(id), "process {id} is there");
    });
    assert_eq!(said, format!("process {id} is there"));
    assert!(!exists(id));
}

#[test]
fn a_child_that_is_waited_for_too_long_is_ended_and_told() {
    let child = Child::spawn(&sleeps(), nothing());
    let id = child.id();
    assert_eq!(panic_of(|| child.finish(SHORT)), format!("process {id} was still running after 100ms"));
    assert!(!exists(id));
    let program = Program::spawn(shell("echo here; exec sleep 600"));
    let id = program.id();
    assert!(panic_of(|| program.finish(SHORT)).starts_with("still running after 100ms"));
    assert!(!exists(id));
}

#[test]
fn output_that_does_not_come_to_its_end_is_given_up() {
    let begin = Instant::now();
    let said = panic_of(|| Child::output(&shell("echo so far; exec sleep 600"), b"", Duration::from_secs(2)));
    assert!(said.contains("was still running after 2s and printed \"so far\\n\" and \"\""), "{said}");
    assert!(begin.elapsed() < LIMIT);
}

#[test]
fn a_child_gets_its_input_and_gives_both_outputs_to_the_last_byte() {
    // More than a pipe holds, in each direction.
    let input: Vec<u8> = (0..300_000_u32).map(|index| (index % 251) as u8).collect();
    let output = Child::output(&shell("cat; echo told >&2; exit 3"), &input, LIMIT);
    assert_eq!(output.status.code(), Some(3));
    assert!(output.stdout == input, "{} bytes", output.stdout.len());
    assert_eq!(output.stderr, b"told\n");
    // A child that reads nothing is no hindrance.
    assert!(Child::output(&Command::new("true"), &input, LIMIT).status.success());
}

#[test]
fn arguments_folder_and_environment_reach_the_child() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = shell("echo \"$0:$FIRST:${HOME-none}\"; pwd -P");
    command.arg("an argument").env("FIRST", "1").env_remove("HOME").current_dir(folder.path());
    let said = String::from_utf8(Child::output(&command, b"", LIMIT).stdout).unwrap();
    let there = folder.path().canonicalize().unwrap();
    assert_eq!(said, format!("an argument:1:none\n{}\n", there.display()));
}

#[test]
fn each_signal_arrives() {
    use std::os::unix::process::ExitStatusExt as _;
    for (name, number) in [("HUP", 1), ("INT", 2), ("KILL", 9), ("TERM", 15)] {
        let mut command = shell("echo here; exec sleep 600");
        if cfg!(target_os = "linux") {
            // Under nohup or in the background these tests inherit that SIGHUP or SIGINT is ignored, which `env` of Linux alone takes back.
            let shell = std::mem::replace(&mut command, Command::new("env"));
            command.arg("--default-signal=HUP,INT").arg(shell.get_program()).args(shell.get_args());
        }
        let mut program = Program::spawn(command);
        program.wait_for("here", LIMIT);
        program.signal(name);
        assert_eq!(program.finish(LIMIT).status.signal(), Some(number), "{name}");
    }
    let mut child = Child::spawn(&sleeps(), nothing());
    child.signal("STOP");
    assert!(child.is_running(), "it stands and is there");
    drop(child);
}

/// The copy of this test's process starts a child and is killed; nobody there could have ended the child.
#[test]
fn a_child_ends_when_its_tests_process_is_killed() {
    if std::env::var_os(TO_BE_KILLED).is_some() {
        let child = Child::spawn(&sleeps(), nothing());
        println!("\nchild {}", child.id());
        child.finish(LIMIT);
        return;
    }
    if !Child::is_tied() {
        println!("left out: here is no setpriv of util-linux");
        return;
    }
    let mut copy = Command::new(std::env::current_exe().unwrap());
    copy.args(["--exact", "children::a_child_ends_when_its_tests_process_is_killed", "--nocapture"]);
    copy.env(TO_BE_KILLED, "yes");
    let mut copy = Program::spawn(copy);
    let line = copy.wait_for("child ", LIMIT);
    let id: u32 = line.trim_start_matches("child ").parse().unwrap();
    // Until then it is `setpriv`, which may not have asked the kernel yet.
    until("it runs", || {
        std::fs::read_to_string(format!("/proc/{id}/comm")).is_ok_and(|name| name == "sleep\n")
    });
    drop(copy);
    until("it has ended", || !is_alive(id));
}

fn until(what: &str, holds: impl Fn() -> bool) {
    let end = Instant::now() + LIMIT;
    while !holds() {
        assert!(Instant::now() < end, "waited {LIMIT:?}, but not so: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Whether a process of somebody else's is there and has not ended; nobody may have waited for it.
fn is_alive(id: u32) -> bool {
    let state = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    state
        .rsplit(')')
        .next()
        .is_some_and(|rest| !rest.is_empty() && !rest.trim_start().starts_with(['Z', 'X']))
}

//! `tests/limited`, by which no step of the test command goes on for ever: whatever a command does, it ends with all that it started.
#![cfg(target_os = "linux")]

use std::process::{Command, Output};

use brushwork_tests::program::{Child, Program};
use brushwork_tests::wait::LIMIT;
use brushwork_tests::workspace;

/// A shell script under a limit. Under nohup or in the background these tests inherit that a signal is ignored, which no shell can undo.
fn limited(seconds: &str, script: &str) -> Command {
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP,INT,TERM").arg(workspace::root().join("tests/limited"));
    command.args([seconds, "sh", "-c", script]);
    command
}

/// How a script ended. Its output comes to its end only when everything that the script started has ended too.
fn run(seconds: &str, script: &str) -> Output {
    Child::output(&limited(seconds, script), b"", LIMIT)
}

#[test]
fn a_command_that_hangs_is_ended_with_all_that_it_started_and_named() {
    let output = run("0.5", "trap '' HUP INT TERM; sleep 600 & sleep 601");
    assert_eq!(output.status.code(), Some(124), "{output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("sleep 600 & sleep 601` was not done after 0.5 s"), "{said}");
}

#[test]
fn what_a_command_leaves_running_is_ended_and_its_exit_code_is_kept() {
    let output = run("600", "cat; echo done; sleep 600 & exit 3");
    assert_eq!((output.status.code(), &output.stdout[..]), (Some(3), &b"done\n"[..]), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
}

#[test]
fn an_interrupt_ends_the_command_with_all_that_it_started() {
    for (signal, code) in [("HUP", 129), ("INT", 130), ("TERM", 143)] {
        let mut program = Program::spawn(limited("600", "sleep 600 & echo begun; wait"));
        program.wait_for("begun", LIMIT);
        program.signal(signal);
        assert_eq!(program.next_line(LIMIT), None, "the end of everything that could print");
        let ending = program.finish(LIMIT);
        assert_eq!(ending.status.code(), Some(code), "SIG{signal}: {ending:?}");
    }
}

#[test]
fn a_command_under_a_limit_can_still_be_interrupted_by_itself() {
    // Shells start what is in the background with SIGINT ignored, which all below would inherit.
    let output = run("600", "sleep 600 & kill -INT $$; echo lives on");
    assert_eq!((output.status.code(), &output.stdout[..]), (Some(130), &b""[..]), "{output:?}");
}

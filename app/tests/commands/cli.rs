//! The built program as a person or a script runs it: its output, its exit codes, and controllers in the background.

#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use brushwork_child::{Child, Program};
use serde_json::Value;
use tempfile::TempDir;

pub const DONE: i32 = 0;
pub const USAGE: i32 = 2;
pub const NO_LINK: i32 = 3;
pub const REFUSED: i32 = 4;
pub const NOT_TAKEN: i32 = 5;
pub const DIFFERENT: i32 = 6;

/// How long a command may take on a machine that is busy with everything else: none takes more than some seconds of its own.
pub const LIMIT: Duration = Duration::from_secs(300);

/// What a run of the program gave.
#[derive(Debug)]
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    #[track_caller]
    pub fn ended_with(self, code: i32) -> Self {
        assert_eq!(self.code, code, "{self:#?}");
        self
    }

    #[track_caller]
    pub fn explains(self, words: &str) -> Self {
        assert!(self.stderr.contains(words), "no {words:?} in {self:#?}");
        self
    }

    /// Standard output has these words, however wide its columns are.
    #[track_caller]
    pub fn prints(self, words: &str) -> Self {
        let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(in_one_line(&self.stdout).contains(&in_one_line(words)), "no {words:?} in {self:#?}");
        self
    }

    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:#?}"))
    }
}

thread_local! {
    /// What the programs of one test keep for their user: each test has a thread and so a folder of its own.
    static DATA: TempDir = tempfile::tempdir().expect("a temporary folder can be made");
}

/// The program, keeping its files in a folder of this test.
pub fn program() -> Command {
    DATA.with(|folder| program_keeping_in(folder.path()))
}

/// The program, keeping its files in a folder.
pub fn program_keeping_in(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork"));
    command.env("BRUSHWORK_DATA_DIR", folder);
    command
}

/// `brushwork settings` with nobody at the terminal.
pub fn settings(arguments: &[&str]) -> Run {
    run(program().arg("settings").args(arguments))
}

/// Runs to the end, with nothing on standard input.
pub fn run(command: &Command) -> Run {
    let output = Child::output(command, b"", LIMIT);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program prints UTF-8");
    Run { code: output.status.code().unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// A profile of a fresh simulated controller, and the folder it is in.
pub fn exported(target: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let file = folder.path().join("profile.json");
    settings(&["export", "-c", target, name(&file)]).ended_with(DONE);
    (folder, file)
}

pub fn name(path: &Path) -> &str {
    path.to_str().expect("temporary names are UTF-8")
}

/// Replaces the first `from` of a profile.
pub fn edit(file: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(file).expect("the profile is there");
    assert!(text.contains(from), "no {from:?} in {text}");
    std::fs::write(file, text.replacen(from, to, 1)).expect("the profile can be written");
}

/// Starts a program and waits for the first line that it prints.
fn told(command: Command) -> (Program, String) {
    let mut program = Program::spawn(command);
    let first = program.next_line(LIMIT).expect("it says where it is");
    (program, first)
}

/// `brushwork sim` in the background: a controller that outlives one command, and ends with this.
///
/// It is served on a TCP port. On pseudo-terminals, beside six busy processes, commands found no answer in the time that a serial port is given;
/// on TCP ports, which are given the same time here, they found one.
pub struct Simulated {
    _program: Program,
    target: String,
    pub folder: TempDir,
}

impl Simulated {
    pub fn start(arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let mut command = program();
        command.args(["sim", "--tcp", "127.0.0.1:0"]).args(arguments);
        let (program, first) = told(command);
        let (_, place) = first.rsplit_once("tcp:").unwrap_or_else(|| panic!("no place in {first}"));
        Self { _program: program, target: format!("tcp:{place},latency=60"), folder }
    }

    /// On a pseudo-terminal, for those who open it as a file, and for a command of each kind.
    pub fn start_on_pty(arguments: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let link = folder.path().join("port");
        let mut command = program();
        command.args(["sim", "--pty"]).arg(&link).args(arguments);
        let (program, first) = told(command);
        assert!(first.contains("port"), "{first}");
        Self { _program: program, target: name(&link).to_owned(), folder }
    }

    /// What a command connects to.
    pub fn port(&self) -> String {
        self.target.clone()
    }

    pub fn settings(&self, action: &str, arguments: &[&str]) -> Run {
        // A pseudo-terminal may be late on a busy machine.
        let late = if self.target.starts_with("tcp:") { "" } else { ",latency=4000" };
        settings(&[&[action, "--connect", &format!("{}{late}", self.target)], arguments].concat())
    }
}

//! Runs the Python clients of `tests/foreign` and answers their questions about the simulator's truth.
//!
//! The other end of `tests/foreign/harness.py`: one JSON object per line in both directions, past the wire under test.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use brushwork_child::{Child, Program};
use serde_json::Value;

use crate::{wait, workspace};

/// Names a tool whose tests are left out because it cannot be had here; set by `tests/run`, comma-separated.
const LEAVE_OUT: &str = "BRUSHWORK_LEAVE_OUT";

/// Whether tests that need `tool` are to be left out; says so in the test's output.
#[must_use]
#[expect(clippy::print_stdout, reason = "a test that is left out has to say so in its output")]
pub fn is_left_out(tool: &str) -> bool {
    let left_out = std::env::var(LEAVE_OUT).unwrap_or_default().split(',').any(|name| name == tool);
    if left_out {
        println!("left out: {LEAVE_OUT} names {tool}");
    }
    left_out
}

/// How long pip may take to fetch the pinned packages over a slow line, for the first test and all that wait for it.
const INSTALLATION_LIMIT: Duration = Duration::from_secs(20 * 60);

/// How long a script may take as a whole; each of its lines has a limit of its own.
const SCRIPT_LIMIT: Duration = Duration::from_secs(15 * 60);

/// The Python that has the pinned packages; made on first use.
///
/// # Panics
/// When it cannot be made. `BRUSHWORK_LEAVE_OUT=python` leaves the tests that need it out.
#[must_use]
pub fn python() -> PathBuf {
    let script = workspace::root().join("tests/foreign/python");
    let output = Child::output(&Command::new(script), b"", INSTALLATION_LIMIT);
    assert!(
        output.status.success(),
        "no Python environment ({LEAVE_OUT}=python leaves it out): {}",
        String::from_utf8_lossy(&output.stderr)
    );
    PathBuf::from(String::from_utf8_lossy(&output.stdout).trim())
}

/// One finding of a script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The method or command it is about.
    pub name: String,
    /// Whether it did what it should.
    pub passed: bool,
    /// Why not.
    pub detail: String,
}

/// One measured figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What was measured.
    pub name: String,
    /// How much.
    pub value: f64,
    /// In what.
    pub unit: String,
}

/// All that a script reported.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// In the order of the reports.
    pub findings: Vec<Finding>,
    /// In the order of the reports.
    pub figures: Vec<Figure>,
}

impl Findings {
    /// Whether the finding of that name is there and passed.
    #[must_use]
    pub fn passed(&self, name: &str) -> bool {
        self.findings.iter().any(|finding| finding.name == name && finding.passed)
    }

    /// The findings that did not pass, one line each.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let failed = self.findings.iter().filter(|finding| !finding.passed);
        failed.map(|finding| format!("{}: {}", finding.name, finding.detail)).collect()
    }
}

/// What a script may ask of the test.
pub trait Simulated {
    /// The simulator's truth at this moment.
    fn truth(&mut self) -> Value;

    /// Does something to the machine that no wire can do.
    ///
    /// # Errors
    /// A sentence, when there is no such action.
    fn act(&mut self, action: &str) -> Result<(), String>;
}

/// Runs a script of `tests/foreign` against the controller at `port` until it has finished.
///
/// # Panics
/// When the script breaks off, says something unreadable or hangs.
pub fn run(script: &str, port: &Path, arguments: &[&str], simulated: &mut dyn Simulated) -> Findings {
    let mut command = Command::new(python());
    command.arg(workspace::root().join("tests/foreign").join(script)).arg(port).args(arguments);
    let mut program = Program::spawn(command);
    let mut findings = Findings::default();
    let end = Instant::now() + SCRIPT_LIMIT;
    while let Some(line) = program.next_line(wait::LIMIT) {
        let message: Value =
            serde_json::from_str(&line).unwrap_or_else(|error| panic!("{script} said `{line}`: {error}"));
        assert!(Instant::now() < end, "{script} has not finished after {SCRIPT_LIMIT:?}, but says `{line}`");
        if let Some(answer) = answer_to(&message, simulated) {
            program.say(&answer.to_string());
        } else if message.get("finished").is_some() {
            program.finish(wait::LIMIT);
            return findings;
        } else {
            note(&message, &mut findings);
        }
    }
    let ending = program.finish(wait::LIMIT);
    panic!("{script} broke off: {:#?}", ending.stderr);
}

fn answer_to(message: &Value, simulated: &mut dyn Simulated) -> Option<Value> {
    match message.get("ask")?.as_str()? {
        "truth" => Some(simulated.truth()),
        "act" => {
            let action = message["action"].as_str().unwrap_or_default();
            Some(Value::from(simulated.act(action).err().unwrap_or_else(|| "done".to_owned())))
        }
        other => Some(Value::from(format!("the test does not know `{other}`"))),
    }
}

fn note(message: &Value, findings: &mut Findings) {
    let text = |key: &str| message[key].as_str().unwrap_or_default().to_owned();
    if message.get("report").is_some() {
        findings.findings.push(Finding {
            name: text("report"),
            passed: message["passed"].as_bool().unwrap_or(false),
            detail: text("detail"),
        });
    } else if message.get("figure").is_some() {
        let value = message["value"].as_f64().unwrap_or(f64::NAN);
        findings.figures.push(Figure { name: text("figure"), value, unit: text("unit") });
    }
}

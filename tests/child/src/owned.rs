//! The owner of a child process.

use std::ffi::OsStr;
use std::io::{Read, Write};
use std::process::{self, Command, ExitStatus, Output, Stdio};
use std::sync::LazyLock;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Between two looks whether a child has ended.
const INTERVAL: Duration = Duration::from_millis(5);

/// How long the output of a child that has ended may take to come: a grandchild can hold the pipe open.
const LATE_OUTPUT: Duration = Duration::from_secs(10);

/// Lets the kernel end the program that it becomes when whoever started it is gone. Part of util-linux.
const SETPRIV: &str = "setpriv";

/// Its arguments before the program.
const AT_PARENTS_DEATH: [&str; 2] = ["--pdeathsig", "KILL"];

/// Whether this system has a [`SETPRIV`] that can do that; there are smaller ones.
static HAS_SETPRIV: LazyLock<bool> = LazyLock::new(|| {
    let mut command = Command::new(SETPRIV);
    command
        .args(AT_PARENTS_DEATH)
        .arg("true")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    #[expect(
        clippy::disallowed_methods,
        reason = "this is the owner; the command prints nothing and ends at once"
    )]
    command.status().is_ok_and(|status| status.success())
});

/// A running child process, killed and waited for when dropped, so also when its test panics.
///
/// Where there is `setpriv` of util-linux the kernel kills it too when the thread that started it ends, for example because the test's
/// process was killed; the child's first millisecond, before `setpriv` has asked for that, is not covered. Programs that it starts
/// itself are its own affair.
#[derive(Debug)]
pub struct Child(pub(crate) process::Child);

impl Child {
    /// Starts a command with these standard input, output and error. Of `command` count the program, the arguments, the working folder
    /// and single variables of the environment.
    ///
    /// # Panics
    /// When it cannot be started.
    #[must_use]
    pub fn spawn(command: &Command, [stdin, stdout, stderr]: [Stdio; 3]) -> Self {
        let mut command = tied(command);
        command.stdin(stdin).stdout(stdout).stderr(stderr);
        #[expect(clippy::disallowed_methods, reason = "this is the owner")]
        let spawned = command.spawn();
        Self(spawned.unwrap_or_else(|error| panic!("{command:?}: {error}")))
    }

    /// Runs a command to its end with `input` on its standard input, and returns all that it printed.
    ///
    /// # Panics
    /// When it cannot be started, or is still running after `limit`; it is killed then.
    #[must_use]
    pub fn output(command: &Command, input: &[u8], limit: Duration) -> Output {
        let mut child = Self::spawn(command, [Stdio::piped(), Stdio::piped(), Stdio::piped()]);
        let stdout = collect(child.0.stdout.take());
        let stderr = collect(child.0.stderr.take());
        let feeder = feed(child.0.stdin.take(), input.to_vec());
        let status = child.ended_within(limit);
        let there = || format!("{command:?} has ended, but its output does not");
        let (stdout, stderr) = (joined(stdout, there), joined(stderr, there));
        joined(feeder, || format!("{command:?} has ended, but its input is still open"));
        let status = status.unwrap_or_else(|| {
            panic!(
                "{command:?} was still running after {limit:?} and printed {:?} and {:?}",
                String::from_utf8_lossy(&stdout),
                String::from_utf8_lossy(&stderr)
            )
        });
        Output { status, stdout, stderr }
    }

    /// Whether the kernel ends each child with the thread that started it.
    #[must_use]
    pub fn is_tied() -> bool {
        *HAS_SETPRIV
    }

    /// The process number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.0.id()
    }

    /// Whether it is still running.
    pub fn is_running(&mut self) -> bool {
        matches!(self.0.try_wait(), Ok(None))
    }

    /// Closes the pipe that its standard output goes to.
    pub fn close_stdout(&mut self) {
        self.0.stdout = None;
    }

    /// Sends a signal by its short name: `INT`, `TERM`, `HUP`, `KILL`, `STOP`, `CONT`.
    ///
    /// # Panics
    /// When there is no such signal, or the child was already seen to have ended.
    #[cfg(unix)]
    pub fn signal(&self, name: &str) {
        use rustix::process::{Pid, Signal, kill_process};
        let signal = match name {
            "INT" => Signal::INT,
            "TERM" => Signal::TERM,
            "HUP" => Signal::HUP,
            "KILL" => Signal::KILL,
            "STOP" => Signal::STOP,
            "CONT" => Signal::CONT,
            _ => panic!("no test has needed the signal {name} yet"),
        };
        kill_process(Pid::from_child(&self.0), signal)
            .unwrap_or_else(|error| panic!("SIG{name} to process {}: {error}", self.id()));
    }

    /// Waits for its end.
    ///
    /// # Panics
    /// When it is still running after `limit`; it is killed then.
    pub fn finish(mut self, limit: Duration) -> ExitStatus {
        let id = self.id();
        self.ended_within(limit).unwrap_or_else(|| panic!("process {id} was still running after {limit:?}"))
    }

    /// Waits for its end; kills it after `limit` and returns none.
    fn ended_within(&mut self, limit: Duration) -> Option<ExitStatus> {
        let end = Instant::now() + limit;
        loop {
            if let Ok(Some(status)) = self.0.try_wait() {
                return Some(status);
            }
            if Instant::now() >= end {
                self.kill();
                return None;
            }
            thread::sleep(INTERVAL);
        }
    }

    fn kill(&mut self) {
        // Both fail when it has ended already, which is what they are for.
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.kill();
    }
}

/// The same command, ended by the kernel with the thread that starts it, where that can be had.
fn tied(command: &Command) -> Command {
    let mut arguments: Vec<&OsStr> = Vec::new();
    let mut program = command.get_program();
    if *HAS_SETPRIV {
        arguments.extend(AT_PARENTS_DEATH.map(OsStr::new));
        arguments.push(program);
        program = OsStr::new(SETPRIV);
    }
    let mut tied = Command::new(program);
    tied.args(arguments).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => tied.env(name, value),
            None => tied.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        tied.current_dir(folder);
    }
    tied
}

/// Reads a stream to its end on a thread.
fn collect(stream: Option<impl Read + Send + 'static>) -> JoinHandle<Vec<u8>> {
    let read = move || {
        let mut bytes = Vec::new();
        // What came before a failure counts.
        let _ = stream.map(|mut stream| stream.read_to_end(&mut bytes));
        bytes
    };
    thread::Builder::new().name("collect output".to_owned()).spawn(read).expect("a test may start a thread")
}

/// Writes to a stream on a thread, and closes it.
fn feed(stream: Option<impl Write + Send + 'static>, input: Vec<u8>) -> JoinHandle<()> {
    let write = move || {
        // A program that does not read its input to the end closes it.
        let _ = stream.map(|mut stream| stream.write_all(&input));
    };
    thread::Builder::new().name("feed input".to_owned()).spawn(write).expect("a test may start a thread")
}

/// The result of a thread that has nothing more to do but come to its end; `there` tells why it may not.
fn joined<T>(thread: JoinHandle<T>, there: impl FnOnce() -> String) -> T {
    let end = Instant::now() + LATE_OUTPUT;
    while !thread.is_finished() {
        assert!(Instant::now() < end, "waited {LATE_OUTPUT:?}: {}", there());
        thread::sleep(INTERVAL);
    }
    thread.join().expect("reading and writing do not panic")
}

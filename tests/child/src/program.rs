//! A program under test: started, watched line by line, signalled.
//!
//! Used for the built `brushwork` and for the foreign clients.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::{Child, ahead};

/// Lines that may wait unread before the child has to.
const QUEUE_LINES: usize = 10_000;

/// A running child whose output is read by two threads; killed when dropped.
#[derive(Debug)]
pub struct Program {
    child: Child,
    stdin: Option<ChildStdin>,
    stdout: Receiver<String>,
    stderr: Receiver<String>,
    seen: Vec<String>,
}

thread_local! {
    /// What the programs of one test keep for their user: each test has a thread and so a folder of its own.
    static DATA: TempDir = tempfile::tempdir().expect("a temporary folder can be made");
}

/// How a program ended and what it had printed.
#[derive(Debug)]
pub struct Ending {
    /// Exit code or signal.
    pub status: ExitStatus,
    /// Every line of standard output.
    pub stdout: Vec<String>,
    /// Every line of standard error.
    pub stderr: Vec<String>,
}

impl Ending {
    /// Whether the machine was too busy to let the program renew its motion, which then stops for safety's sake: no
    /// fault of anybody, but the test has to be tried again.
    #[must_use]
    pub fn was_starved(&self) -> bool {
        self.stderr.iter().any(|line| line.contains("did not renew the motion within"))
    }

    /// Whether a controller was silent that a test simulates beside the program, or so late that a motion had waited behind an answer for too
    /// long: on a crowded machine what carries its answers has no processor, for longer than a line that was quick until then is waited for.
    #[must_use]
    pub fn found_silence(&self) -> bool {
        let said = ["no answer within", "no answer came in time", "waited for longer than a motion may live"];
        self.stderr.iter().any(|line| said.iter().any(|said| line.contains(said)))
    }
}

impl Program {
    /// Starts `executable` with its three streams connected to the test.
    #[must_use]
    pub fn start<S: AsRef<str>>(executable: &str, arguments: &[S]) -> Self {
        let mut command = Command::new(executable);
        command.args(arguments.iter().map(AsRef::as_ref));
        Self::spawn(command)
    }

    /// Starts a prepared command with its three streams connected to the test.
    #[must_use]
    pub fn spawn(mut command: Command) -> Self {
        let has_its_own = command.get_envs().any(|(name, _)| name == "BRUSHWORK_DATA_DIR");
        if !has_its_own {
            DATA.with(|folder| command.env("BRUSHWORK_DATA_DIR", folder.path()));
        }
        let start = || Child::spawn(&command, [Stdio::piped(), Stdio::piped(), Stdio::piped()]);
        let mut child = if is_controller(&command) { ahead(start) } else { start() };
        let stdin = child.0.stdin.take();
        let stdout = read_lines("stdout", child.0.stdout.take().expect("stdout is piped"));
        let stderr = read_lines("stderr", child.0.stderr.take().expect("stderr is piped"));
        Self { child, stdin, stdout, stderr, seen: Vec::new() }
    }

    /// The next line of standard output, or none when the program closed it.
    ///
    /// # Panics
    /// When nothing comes within `limit`.
    pub fn next_line(&mut self, limit: Duration) -> Option<String> {
        match self.stdout.recv_timeout(limit) {
            Ok(line) => {
                self.seen.push(line.clone());
                Some(line)
            }
            Err(RecvTimeoutError::Disconnected) => None,
            Err(RecvTimeoutError::Timeout) => {
                panic!(
                    "no line within {limit:?}; before: {:#?}; stderr: {:#?}",
                    self.seen,
                    drain(&self.stderr)
                )
            }
        }
    }

    /// Reads on until a line of standard output contains `words`, and returns it.
    ///
    /// # Panics
    /// When the program closes its output or `limit` passes first.
    pub fn wait_for(&mut self, words: &str, limit: Duration) -> String {
        let deadline = Instant::now() + limit;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.next_line(left) {
                Some(line) if line.contains(words) => return line,
                Some(_) => {}
                None => panic!(
                    "ended without `{words}`; printed {:#?}; stderr: {:#?}",
                    self.seen,
                    drain(&self.stderr)
                ),
            }
        }
    }

    /// Reads on until a line of standard error contains `words`, and returns it.
    ///
    /// # Panics
    /// When the program closes it or `limit` passes first.
    pub fn wait_for_error(&mut self, words: &str, limit: Duration) -> String {
        self.reach_error(words, limit)
            .unwrap_or_else(|others| panic!("ended without `{words}` on standard error: {others:#?}"))
    }

    /// Reads on until a line of standard error contains `words`, and returns it.
    ///
    /// # Errors
    /// All lines read, when the program closes its standard error first.
    ///
    /// # Panics
    /// When `limit` passes first.
    pub fn reach_error(&mut self, words: &str, limit: Duration) -> Result<String, Vec<String>> {
        let deadline = Instant::now() + limit;
        let mut others = Vec::new();
        loop {
            match self.stderr.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(line) if line.contains(words) => return Ok(line),
                Ok(line) => others.push(line),
                Err(RecvTimeoutError::Disconnected) => return Err(others),
                Err(RecvTimeoutError::Timeout) => {
                    panic!("no `{words}` on standard error within {limit:?}, but {others:#?}")
                }
            }
        }
    }

    /// Writes one line to standard input.
    ///
    /// # Panics
    /// When the program no longer reads.
    pub fn say(&mut self, line: &str) {
        let stdin = self.stdin.as_mut().expect("stdin is open until the program is waited for");
        writeln!(stdin, "{line}").and_then(|()| stdin.flush()).expect("the program reads its input");
    }

    /// Sends a signal by its short name; see [`Child::signal`].
    #[cfg(unix)]
    pub fn signal(&self, name: &str) {
        self.child.signal(name);
    }

    /// The process number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Whether the program is still running.
    pub fn is_running(&mut self) -> bool {
        self.child.is_running()
    }

    /// Waits for the end.
    ///
    /// # Panics
    /// When the program is still running after `limit`; it is killed then.
    pub fn finish(mut self, limit: Duration) -> Ending {
        self.stdin = None;
        let deadline = Instant::now() + limit;
        let mut stderr = Vec::new();
        loop {
            // A program that prints more than the queues hold would otherwise wait for ever.
            self.seen.extend(self.stdout.try_iter());
            stderr.extend(self.stderr.try_iter());
            if let Ok(Some(status)) = self.child.0.try_wait() {
                let mut stdout = std::mem::take(&mut self.seen);
                stdout.extend(drain_to_end(&self.stdout));
                stderr.extend(drain_to_end(&self.stderr));
                return Ending { status, stdout, stderr };
            }
            assert!(
                Instant::now() < deadline,
                "still running after {limit:?}; printed {:#?}; stderr {stderr:#?}",
                self.seen
            );
            thread::sleep(Duration::from_millis(5));
        }
    }
}

/// Whether it is `brushwork sim`.
fn is_controller(command: &Command) -> bool {
    command.get_args().next().is_some_and(|first| first == "sim")
}

fn read_lines(name: &str, stream: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = sync_channel(QUEUE_LINES);
    thread::Builder::new()
        .name(format!("read {name}"))
        .spawn(move || forward_lines(stream, &sender))
        .expect("a test may start a thread");
    receiver
}

fn forward_lines(stream: impl Read, sender: &SyncSender<String>) {
    for line in BufReader::new(stream).lines() {
        let Ok(line) = line else { return };
        if sender.send(line).is_err() {
            return;
        }
    }
}

fn drain(lines: &Receiver<String>) -> Vec<String> {
    lines.try_iter().collect()
}

/// What is left when the program has ended; a grandchild that holds the pipe open must not hang the test.
fn drain_to_end(lines: &Receiver<String>) -> Vec<String> {
    let mut left = Vec::new();
    while let Ok(line) = lines.recv_timeout(Duration::from_secs(1)) {
        left.push(line);
    }
    left
}

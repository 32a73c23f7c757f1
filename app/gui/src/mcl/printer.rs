//! Pages to the system's printer, by its print command: `lp` or `lpr`. Where there is neither, pages go to a PDF file alone.

use crate::messages::{EditorMessage, WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::messages::RemedyMessage;
use std::env;
use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use brushwork_link::{Failure, work};
use crossbeam_channel::{Receiver, Sender, bounded};

/// Answers that wait to be told; a person does not print more at once.
const QUEUE: usize = 16;

/// A print command of the system, which takes PDF on its standard input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spooler {
    program: PathBuf,
    /// Whether it takes the arguments of `lp`; else those of `lpr`.
    is_lp: bool,
}

impl Spooler {
    /// The one that is installed.
    pub fn find() -> Option<Self> {
        Self::find_in(&env::var_os("PATH")?)
    }

    /// The one in these folders, which stand as in PATH.
    pub fn find_in(folders: &OsStr) -> Option<Self> {
        let in_folders = |name: &str| {
            let mut paths = env::split_paths(folders).map(|folder| folder.join(name));
            paths.find(|path| is_program(path))
        };
        let lp = in_folders("lp").map(|program| Self { program, is_lp: true });
        lp.or_else(|| in_folders("lpr").map(|program| Self { program, is_lp: false }))
    }

    /// Hands pages over and waits until they are taken.
    fn print(&self, job: &Job) -> Result<(), Failure> {
        let on = if job.printer.is_empty() { "the system's printer" } else { &job.printer };
        let failed = |why: String| {
            let tried = WindowActMessage::Print { title: job.title.clone() };
            let why = WindowCauseMessage::Said { text: why };
            Err(Failure::new(tried, on, why, WindowRemedyMessage::SetUpPrinter))
        };
        let mut command = Command::new(&self.program);
        command.args([if self.is_lp { "-t" } else { "-J" }, &job.title]);
        if !job.printer.is_empty() {
            command.args([if self.is_lp { "-d" } else { "-P" }, &job.printer]);
        }
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        #[expect(clippy::disallowed_methods, reason = "a person may wait for a printer as long as they like")]
        let spawned = piped.spawn();
        let mut child = match spawned {
            Ok(child) => child,
            Err(error) => return failed(error.to_string()),
        };
        // One that refuses the job closes its end: what it says counts, not the broken pipe.
        let written = child.stdin.take().map(|mut stdin| stdin.write_all(&job.pages));
        let output = match child.wait_with_output() {
            Ok(output) => output,
            Err(error) => return failed(error.to_string()),
        };
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr).trim().trim_end_matches('.').to_owned();
            return failed(if said.is_empty() { output.status.to_string() } else { said });
        }
        match written {
            Some(Err(error)) => failed(error.to_string()),
            _ => Ok(()),
        }
    }
}

#[cfg(unix)]
fn is_program(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    path.metadata().is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_program(path: &Path) -> bool {
    path.is_file()
}

/// What is to be printed.
#[derive(Clone, Debug)]
pub struct Job {
    pub title: String,
    /// Its name in the system; empty for the one that the system takes by itself.
    pub printer: String,
    /// PDF.
    pub pages: Vec<u8>,
}

/// Prints on threads of their own, since a printer may let one wait.
#[derive(Debug)]
pub struct Printing {
    sender: Sender<Result<EditorMessage, Failure>>,
    news: Receiver<Result<EditorMessage, Failure>>,
}

impl Default for Printing {
    fn default() -> Self {
        let (sender, news) = bounded(QUEUE);
        Self { sender, news }
    }
}

impl Printing {
    /// Begins a job; `tell` is called when there is news of it.
    pub fn begin(&self, spooler: Spooler, job: Job, tell: impl Fn() + Send + 'static) {
        let sender = self.sender.clone();
        let refused = Failure::new(
            WindowActMessage::Print { title: job.title.clone() },
            "this computer",
            WindowCauseMessage::NoThread,
            RemedyMessage::TryAgain,
        );
        let work = move || {
            let done = spooler.print(&job).map(|()| EditorMessage::Printed { title: job.title.clone() });
            // A window that is gone wants no answer.
            let _ = sender.try_send(done);
            tell();
        };
        if work::spawn("mcl print", work).is_err() {
            let _ = self.sender.try_send(Err(refused));
        }
    }

    /// What became of a job.
    pub fn news(&self) -> Option<Result<EditorMessage, Failure>> {
        self.news.try_recv().ok()
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::PermissionsExt as _;
    use std::time::Duration;

    fn install(folder: &Path, name: &str, script: &str) {
        let path = folder.join(name);
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a folder of ours");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("a file of ours");
    }

    fn reported(spooler: Spooler, printer: &str) -> Result<EditorMessage, Failure> {
        let printing = Printing::default();
        let job =
            Job { title: "a.mcl".to_owned(), printer: printer.to_owned(), pages: b"%PDF-1.7 x".to_vec() };
        let (reported, news) = bounded(1);
        printing.begin(spooler, job, move || {
            let _ = reported.try_send(());
        });
        news.recv_timeout(Duration::from_secs(60)).expect("the print command answers");
        printing.news().expect("there is news")
    }

    #[test]
    fn lp_is_given_title_printer_and_pages() {
        let folder = tempfile::tempdir().unwrap();
        let seen = folder.path().join("seen");
        install(folder.path(), "lpr", "exit 1");
        install(folder.path(), "lp", &format!("echo \"$@\" >{0}; cat >>{0}", seen.display()));
        let spooler = Spooler::find_in(folder.path().as_os_str()).unwrap();
        assert_eq!(reported(spooler, "laser").unwrap().to_string(), "a.mcl is with the printer.");
        assert_eq!(fs::read_to_string(seen).unwrap(), "-t a.mcl -d laser\n%PDF-1.7 x");
    }

    #[test]
    fn lpr_stands_in_for_lp_and_its_refusal_is_told() {
        let folder = tempfile::tempdir().unwrap();
        install(folder.path(), "lpr", "echo 'lpr: no default destination.' >&2; exit 1");
        let spooler = Spooler::find_in(folder.path().as_os_str()).unwrap();
        let failure = reported(spooler, "").unwrap_err().to_string();
        for part in ["print a.mcl", "the system's printer", "lpr: no default destination", "PDF file"] {
            assert!(failure.contains(part), "{failure}");
        }
    }

    #[test]
    fn without_either_there_is_none() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("lp"), "not a program").unwrap();
        assert_eq!(Spooler::find_in(folder.path().as_os_str()), None);
    }
}

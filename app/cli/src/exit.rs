//! Exit codes: one place for the numbers, the help text and the type.

use std::fmt::Display;
use std::process::ExitCode;

use super::output::{OutputError, say};

/// Shown under `brushwork --help`.
pub const HELP: &str = "Exit codes:\n  \
    0  done\n  \
    1  something else failed (a file, a benchmark, an internal error)\n  \
    2  the command line could not be understood\n  \
    3  no controller could be reached, or the link was lost\n  \
    4  the controller or a safety rule refused or ended it; drive: a motor did not do what it was told,\n     \
    the stop was not confirmed, or the motor is not held, since its loop was left off\n  \
    5  settings: a value or a profile was refused, or something did not take; firmware: the new version does not run\n  \
    6  settings diff, firmware update: there are differences\n  \
    8  tune: gains were found, with warnings to read\n  \
    9  mcl: a script has errors\n  \
    10  mcl run: the script was stopped by a fault\n  \
    130  ended by Ctrl-C, SIGTERM, SIGHUP or a closed pipe, after both motors were stopped\n\n\
    `brushwork sim` ends with 0 then: that is how it is ended.";

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// All was done.
    Done = 0,
    /// A failure of no other kind.
    Failed = 1,
    /// An argument makes no sense; clap finds most of them itself, with the same code.
    Usage = 2,
    /// No controller was reached, or the link was lost.
    NoLink = 3,
    /// The controller or a safety rule refused.
    Refused = 4,
    /// A setting's value, a profile or firmware was refused, or did not take.
    NotTaken = 5,
    /// `settings diff`, or a comparison after an update, found differences.
    Different = 6,
    /// The tuner found gains, with something to know about them.
    TunedWithWarnings = 8,
    /// A script has errors.
    ScriptWrong = 9,
    /// A script was stopped by a fault.
    ScriptFaulted = 10,
    /// A signal or a closed pipe ended the command, with the motors stopped.
    Interrupted = 130,
}

impl Exit {
    /// Ends so, with a sentence for the person at the terminal.
    #[must_use]
    pub fn saying(self, sentence: impl Display) -> Self {
        say(sentence.to_string());
        self
    }
}

impl From<OutputError> for Exit {
    fn from(error: OutputError) -> Self {
        match error {
            OutputError::Closed => Self::Interrupted,
            OutputError::Io(_) => Self::Failed,
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

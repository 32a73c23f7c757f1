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
    9  mcl, mecc, macro: a script or macro file has errors\n  \
    10  mcl run, mecc run: the script was stopped by a fault; macro run: a command was refused, or the motor was let go\n  \
    11  tune: this computer or the line answered late\n  \
    130  ended by Ctrl-C, SIGTERM, SIGHUP or a closed pipe, after both motors were stopped\n\n\
    `brushwork sim` ends with 0 then: that is how it is ended. A command that goes to several controllers ends with the code of the\n  \
    one that came off worst, which is the first of these that there is: 130, 3, 4, 5, 1, 2, 6, 0.";

/// The worst first.
const WORST_FIRST: [Exit; 12] = [
    Exit::Interrupted,
    Exit::NoLink,
    Exit::Refused,
    Exit::TooLate,
    Exit::NotTaken,
    Exit::Failed,
    Exit::Usage,
    Exit::ScriptFaulted,
    Exit::ScriptWrong,
    Exit::TunedWithWarnings,
    Exit::Different,
    Exit::Done,
];

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
    /// This computer, or the line, was too late for a tuning run.
    TooLate = 11,
    /// A signal or a closed pipe ended the command, with the motors stopped.
    Interrupted = 130,
}

impl Exit {
    /// The worse of two, for a command that goes to several controllers.
    #[must_use]
    pub fn or_worse(self, other: Self) -> Self {
        WORST_FIRST.into_iter().find(|exit| *exit == self || *exit == other).unwrap_or(self)
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_controllers_the_one_that_came_off_worst_gives_the_code() {
        assert_eq!(Exit::Done.or_worse(Exit::Different), Exit::Different);
        assert_eq!(Exit::NoLink.or_worse(Exit::NotTaken), Exit::NoLink);
        assert_eq!(Exit::NotTaken.or_worse(Exit::NoLink), Exit::NoLink);
        assert_eq!(Exit::NoLink.or_worse(Exit::Interrupted), Exit::Interrupted);
        let codes = WORST_FIRST.map(|exit| (exit as u8).to_string());
        let told: Vec<&str> =
            HELP.rsplit_once("there is: ").unwrap().1.trim_end_matches('.').split(", ").collect();
        let kept: Vec<&str> = codes.iter().map(String::as_str).filter(|code| told.contains(code)).collect();
        assert_eq!(kept, told, "the page tells the same order");
    }
}

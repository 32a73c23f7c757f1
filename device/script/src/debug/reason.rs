//! Why a script stands, waits or runs, in a sentence.

use crate::vm::Fault;
use std::time::Duration;

/// What else than the program itself ended a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopCause {
    /// Command 249: Stop Script, Stop All, or a screen that was disarmed.
    Command,
    /// The action of an input pin, counted from 0 where it is known.
    PinAction(Option<usize>),
    /// The script was reset, to begin again.
    Reset,
    /// Another image was downloaded, or the memory erased.
    NewImage,
    /// The controller lost its power.
    PowerLost,
}

/// What a running program waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// PAUSE.
    Pause {
        /// Until then, in time since power-up.
        until: Duration,
    },
    /// Wait: nothing else runs then, no handler of an event either.
    Ticks {
        /// Until then, in time since power-up.
        until: Duration,
    },
    /// Something that is still being sent, read or written: I2C, the EEPROM, a slow port.
    Busy {
        /// Until then, in time since power-up.
        until: Duration,
    },
    /// GETS.
    Gets {
        /// The stream.
        stream: u32,
    },
}

/// Which step is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepKind {
    /// Into subroutines.
    Into,
    /// Over subroutines.
    Over,
    /// Out of a subroutine.
    Out,
}

/// Why a script is where it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Reason {
    /// There is no script, or none was started yet.
    #[default]
    NotStarted,
    /// It runs.
    Running,
    /// It runs, but waits.
    Waiting(Wait),
    /// A breakpoint.
    Breakpoint {
        /// Its line.
        line: u32,
        /// How often it was reached since the start, this time included.
        hits: u64,
        /// Its condition, if it has one.
        condition: Option<String>,
    },
    /// A breakpoint whose condition could not be worked out.
    BadCondition {
        /// Its line.
        line: u32,
        /// What is wrong.
        why: String,
    },
    /// The statement Debug of this line.
    Statement(u32),
    /// A step is finished.
    Step(StepKind),
    /// The line that was to be run to.
    Cursor,
    /// It was asked to stop at its first line.
    Entry,
    /// Pause was asked for.
    Asked(Option<Wait>),
    /// END or STOP.
    Ended,
    /// Something went wrong in it.
    Faulted(Fault),
    /// It was stopped from outside.
    Stopped(StopCause),
}

impl Reason {
    /// The sentence, for a script at `line` when it is `now` since power-up.
    #[must_use]
    pub fn sentence(&self, line: u32, now: Duration) -> String {
        match self {
            Self::NotStarted => "No script runs: start it.".to_owned(),
            Self::Running => "The script runs.".to_owned(),
            Self::Waiting(wait) => format!("The script runs: {}.", wait.reported(line, now)),
            Self::Breakpoint { line, hits, condition } => {
                let condition = condition.as_ref().map(|text| format!(" ({text})")).unwrap_or_default();
                format!("Paused at the breakpoint on line {line}{condition}, reached {}.", times(*hits))
            }
            Self::BadCondition { line, why } => {
                format!("Paused at the breakpoint on line {line}: its condition cannot be worked out. {why}")
            }
            Self::Statement(line) => format!("Paused at the Debug statement on line {line}."),
            Self::Step(kind) => format!("Paused at line {line}: {}.", kind.reported()),
            Self::Cursor => format!("Paused at line {line}, which was to be run to."),
            Self::Entry => format!("Paused before the first line that does something, line {line}."),
            Self::Asked(None) => format!("Paused at line {line}, because Pause was asked for."),
            Self::Asked(Some(wait)) => {
                format!("Paused because Pause was asked for: {}.", wait.reported(line, now))
            }
            Self::Ended => format!("The script has ended: END was reached at line {line}."),
            Self::Faulted(fault) => format!("The script has failed at line {}: {}.", fault.line, fault.kind),
            Self::Stopped(cause) => format!("The script was stopped at line {line}: {}.", cause.reported()),
        }
    }
}

impl Wait {
    fn reported(self, line: u32, now: Duration) -> String {
        match self {
            Self::Pause { until } => {
                let left = until.saturating_sub(now).as_secs_f64();
                format!("PAUSE at line {line} waits until {:.3} s, {left:.3} s more", until.as_secs_f64())
            }
            Self::Ticks { until } => {
                let left = until.saturating_sub(now).as_secs_f64();
                let until = until.as_secs_f64();
                format!(
                    "Wait at line {line} goes on until {until:.3} s, {left:.3} s more, and no event is served"
                )
            }
            Self::Busy { until } => {
                let left = until.saturating_sub(now).as_secs_f64();
                format!("line {line} waits until what it began is done, {left:.3} s more")
            }
            Self::Gets { stream } => format!("GETS at line {line} waits for a byte on stream {stream}"),
        }
    }
}

impl StepKind {
    fn reported(self) -> &'static str {
        match self {
            Self::Into => "one line was run",
            Self::Over => "one line was run, with the subroutines it calls",
            Self::Out => "the subroutine has returned",
        }
    }
}

impl StopCause {
    fn reported(self) -> String {
        match self {
            Self::Command => {
                "the controller was told to (command 249: Stop Script, Stop All or disarming)".into()
            }
            Self::PinAction(Some(pin)) => format!("the action of input pin {} did it", pin + 1),
            Self::PinAction(None) => "the action of an input pin did it".into(),
            Self::Reset => "it was reset, to begin again".into(),
            Self::NewImage => "another program was downloaded".into(),
            Self::PowerLost => "the controller lost its power".into(),
        }
    }
}

fn times(count: u64) -> String {
    match count {
        1 => "for the first time".to_owned(),
        2 => "for the second time".to_owned(),
        count => format!("{count} times"),
    }
}

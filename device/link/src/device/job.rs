//! Long work on the device thread: a settings write, a tuning run, a script download.

use crate::failure::Failure;
use std::any::Any;
use std::fmt;
use std::time::Duration;

pub use super::job_context::JobContext;

/// What a job hands back; whoever started it knows its type.
pub type JobOutput = Box<dyn Any + Send>;

/// Long work. It runs on the device thread, so it must do nothing slow but through its context.
pub trait Job: Send {
    /// What it does, as a verb phrase for sentences and progress bars: "write 12 settings".
    fn name(&self) -> String;

    /// When it is ended by force, counted from its start.
    fn time_limit(&self) -> Duration;

    /// Whether it sets motors in motion. Such a job is refused unless something is armed, and it ends with the motors
    /// stopped and disarmed, whatever its way out.
    fn moves_motors(&self) -> bool {
        false
    }

    /// Does the work. Errors of the context should be passed on at once: after an interruption each further call of the
    /// context fails too.
    fn run(&mut self, context: &mut JobContext<'_>) -> Result<JobOutput, Failure>;
}

impl fmt::Debug for dyn Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Job").field("name", &self.name()).finish_non_exhaustive()
    }
}

/// A job made of a closure.
pub struct FnJob<F> {
    name: String,
    time_limit: Duration,
    moves_motors: bool,
    run: F,
}

impl<F> FnJob<F>
where
    F: FnMut(&mut JobContext<'_>) -> Result<JobOutput, Failure> + Send + 'static,
{
    /// A job that moves no motor.
    pub fn boxed(name: impl Into<String>, time_limit: Duration, run: F) -> Box<dyn Job> {
        Box::new(Self { name: name.into(), time_limit, moves_motors: false, run })
    }

    /// A job that moves motors.
    pub fn moving(name: impl Into<String>, time_limit: Duration, run: F) -> Box<dyn Job> {
        Box::new(Self { name: name.into(), time_limit, moves_motors: true, run })
    }
}

impl<F> Job for FnJob<F>
where
    F: FnMut(&mut JobContext<'_>) -> Result<JobOutput, Failure> + Send,
{
    fn name(&self) -> String {
        self.name.clone()
    }

    fn time_limit(&self) -> Duration {
        self.time_limit
    }

    fn moves_motors(&self) -> bool {
        self.moves_motors
    }

    fn run(&mut self, context: &mut JobContext<'_>) -> Result<JobOutput, Failure> {
        (self.run)(context)
    }
}

/// How a job ended.
pub enum JobEnding {
    /// It did its work; what it hands back.
    Done(JobOutput),
    /// Something more urgent ended it: Stop, Cancel, the time limit, the dead-man, closing.
    Interrupted(crate::exchange::Interruption),
    /// It gave up.
    Failed(Failure),
    /// It had a bug. The text is its last word.
    Panicked(String),
}

impl fmt::Debug for JobEnding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done(_) => f.write_str("Done"),
            Self::Interrupted(cause) => write!(f, "Interrupted({cause:?})"),
            Self::Failed(failure) => write!(f, "Failed({failure})"),
            Self::Panicked(word) => write!(f, "Panicked({word})"),
        }
    }
}

/// The end of a job.
#[derive(Debug)]
pub struct JobReport {
    /// Its name.
    pub name: String,
    /// How long it ran.
    pub ran_for: Duration,
    /// How it ended.
    pub ending: JobEnding,
    /// Whether motors were stopped as its last act; `None` when it had nothing to do with motors.
    pub motors_stopped: Option<bool>,
}

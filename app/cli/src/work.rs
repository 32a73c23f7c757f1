//! Work on the device thread as a command waits for it: progress on a terminal, Ctrl-C, and what it means that it did not end well.

use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use brushwork_link::device::{JobContext, JobReport};
use brushwork_link::{Event, Job, JobEnding, JobTicket, Message};

use super::interrupt::exit_of_interruption;
use super::messages::CliJobMessage;
use super::{Client, Exit, Interrupt, say};

/// How long a job may take to end beyond its own limit, or after Ctrl-C.
const END_LIMIT: Duration = Duration::from_secs(60);

/// Whether a job may move motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moves {
    /// Its dead-man is renewed, and Ctrl-C stops all motors.
    Yes,
    /// Ctrl-C cancels it and no more.
    No,
}

/// Waits for the end of a job. Ctrl-C does not end the waiting, but the job, whose report comes all the same.
///
/// # Errors
/// The link was lost, or the job did not end in its time; said on standard error.
pub fn wait<T>(
    client: &Client,
    ticket: &JobTicket<T>,
    limit: Duration,
    moves: Moves,
    interrupt: &Interrupt,
) -> Result<JobReport, Exit> {
    let deaf = Interrupt::default();
    let mut progress = Progress::new();
    let mut deadline = Instant::now() + limit + END_LIMIT;
    let mut is_cancelled = false;
    while Instant::now() < deadline {
        if interrupt.is_raised() && !is_cancelled {
            is_cancelled = true;
            deadline = Instant::now() + END_LIMIT;
            if moves == Moves::Yes {
                client.device().stop_all();
            }
            ticket.cancel();
        }
        if moves == Moves::Yes {
            client.device().renew();
        }
        match client.next_event(&deaf)? {
            Some(Event::JobProgress { id, fraction, text }) if id == ticket.id() => {
                progress.show(fraction, &text);
            }
            Some(Event::Failure(failure)) => say(failure.to_string()),
            Some(Event::JobEnded(report)) if report.id == ticket.id() => return Ok(report),
            _ => {}
        }
    }
    let exit = if is_cancelled { Exit::Interrupted } else { Exit::Failed };
    Err(exit.saying(CliJobMessage::NotInTime { act: ticket.name().clone() }))
}

/// What a job handed back.
pub struct Finished<T> {
    /// Its result, which tells how far it came when something broke in.
    pub value: T,
    /// The exit code, when something broke in.
    pub broken: Option<Exit>,
}

/// Runs work that moves nothing on the device thread, with the selected controller, and waits for its end. Ctrl-C cancels it; what it had
/// to say by then comes back all the same.
///
/// # Errors
/// It was not begun, or nothing came of it; said on standard error.
pub fn run<T: Send + 'static>(
    client: &Client,
    name: impl Into<Message>,
    limit: Duration,
    interrupt: &Interrupt,
    mut work: impl FnMut(&mut JobContext<'_>) -> T + Send + 'static,
) -> Result<Finished<T>, Exit> {
    // What came of an act that failed is a result too, so that it comes back after an interruption.
    let name = name.into();
    let job = Job::new(name.clone(), limit, move |wire| Ok(work(wire)));
    let ticket = client.device().start(job).map_err(|refused| {
        Exit::Refused.saying(CliJobMessage::NotBegun { act: name.clone(), refused: refused.to_string() })
    })?;
    let JobReport { name, ending, .. } = wait(client, &ticket, limit, Moves::No, interrupt)?;
    let broken = value(ending, &name, Exit::Failed, interrupt).err();
    match (ticket.take(), broken) {
        (Some(value), broken) => Ok(Finished { value, broken }),
        (None, broken) => Err(broken.unwrap_or(Exit::Failed)),
    }
}

/// What a job gave; why it did not run to its end is said.
///
/// # Errors
/// The exit code for that; `failed` where the controller did not do something.
pub fn value<T>(ending: JobEnding<T>, act: &Message, failed: Exit, interrupt: &Interrupt) -> Result<T, Exit> {
    match ending {
        JobEnding::Done(value) => Ok(value),
        JobEnding::Interrupted(cause) => {
            let exit = exit_of_interruption(cause, interrupt.is_raised());
            Err(exit.saying(CliJobMessage::NotToTheEnd { act: act.clone(), cause: cause.to_string() }))
        }
        JobEnding::Failed(failure) => Err(failed.saying(failure)),
        JobEnding::Panicked(word) => {
            Err(Exit::Failed.saying(CliJobMessage::Internal { act: act.clone(), word }))
        }
    }
}

/// One line on a terminal that is overwritten as work goes on; nothing where standard error is no terminal.
pub struct Progress {
    on_terminal: bool,
    is_shown: bool,
}

impl Progress {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self { on_terminal: io::stderr().is_terminal(), is_shown: false }
    }

    /// Shows how far it is.
    pub fn show(&mut self, fraction: Option<f32>, text: &str) {
        if !self.on_terminal {
            return;
        }
        self.is_shown = true;
        let percent = fraction.map_or_else(String::new, |fraction| format!("{:3.0} % ", fraction * 100.0));
        let _ = write!(io::stderr(), "\r\x1b[K{percent}{text}");
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.is_shown {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

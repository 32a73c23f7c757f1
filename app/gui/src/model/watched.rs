//! A job that was asked for, followed by the device thread's events until it ends.

use brushwork_link::device::{Event, JobEnding};
use brushwork_link::exchange::Interruption;
use crossbeam_channel::{Receiver, Sender, bounded};

/// One kind of job, at most one of which runs.
#[derive(Debug)]
pub struct Watched<T> {
    running: Option<Running<T>>,
}

#[derive(Debug)]
struct Running<T> {
    name: &'static str,
    has_started: bool,
    outcome: Receiver<T>,
    fraction: f32,
    text: String,
}

impl<T> Default for Watched<T> {
    fn default() -> Self {
        Self { running: None }
    }
}

impl<T> Watched<T> {
    /// A job of this name is about to be asked for; what it finds goes into the sender. None while one runs.
    pub fn begin(&mut self, name: &'static str) -> Option<Sender<T>> {
        if self.running.is_some() {
            return None;
        }
        let (sender, outcome) = bounded(1);
        let text = "Waiting for its turn".to_owned();
        self.running = Some(Running { name, has_started: false, outcome, fraction: 0.0, text });
        Some(sender)
    }

    /// The request was not taken, or the link ended.
    pub fn forget(&mut self) {
        self.running = None;
    }

    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// How far it is, 0 to 1, and what it does.
    pub fn progress(&self) -> Option<(f32, &str)> {
        self.running.as_ref().map(|running| (running.fraction, running.text.as_str()))
    }

    /// Whether the event is about it.
    pub fn awaits(&self, event: &Event) -> bool {
        let Some(running) = &self.running else { return false };
        match event {
            Event::JobStarted { name } => name == running.name,
            Event::JobProgress { .. } => running.has_started,
            Event::JobEnded(report) => report.name == running.name,
            _ => false,
        }
    }

    /// Takes in an event that it awaits. At the end tells what was found, or a sentence that says why nothing was.
    pub fn take(&mut self, event: Event) -> Option<Result<T, String>> {
        let running = self.running.as_mut()?;
        match event {
            Event::JobStarted { .. } => running.has_started = true,
            Event::JobProgress { fraction, text } => {
                running.fraction = fraction.unwrap_or(running.fraction);
                running.text = text;
            }
            Event::JobEnded(report) => {
                let running = self.running.take()?;
                return Some(match report.ending {
                    JobEnding::Done(_) => running.outcome.try_recv().map_err(|_| no_outcome(running.name)),
                    ending => Err(ending_text(running.name, &ending)),
                });
            }
            _ => {}
        }
        None
    }
}

fn no_outcome(name: &str) -> String {
    format!("Could not {name}: it ended without a result. Try again.")
}

fn ending_text(name: &str, ending: &JobEnding) -> String {
    match ending {
        JobEnding::Done(_) => no_outcome(name),
        JobEnding::Failed(failure) => failure.to_string(),
        JobEnding::Panicked(word) => format!("Could not {name}: Brushwork had a bug. Its last word: {word}"),
        JobEnding::Interrupted(cause) => {
            format!("Did not {name} to the end: {}. The motors were stopped.", interruption(*cause))
        }
    }
}

/// What broke into a job, as a clause.
pub fn interruption(cause: Interruption) -> &'static str {
    match cause {
        Interruption::Stop => "Stop was pressed",
        Interruption::DeadMan => {
            "this computer answered late: the window did not renew the motion within 250 ms"
        }
        Interruption::Disarm => "it was disarmed",
        Interruption::Closing => "the link was closed",
        Interruption::Cancelled => "it was cancelled",
        Interruption::TimeLimit => "it took too long",
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_link::device::JobReport;

    use super::*;

    const JOB: &str = "try the motor";

    fn ended(name: &str, ending: JobEnding) -> Event {
        let ran_for = Duration::from_secs(1);
        Event::JobEnded(JobReport { name: name.to_owned(), ran_for, ending, motors_stopped: Some(true) })
    }

    #[test]
    fn a_job_is_followed_to_its_result() {
        let mut watched = Watched::default();
        let sender = watched.begin(JOB).unwrap();
        assert!(watched.begin(JOB).is_none(), "one at a time");
        let progress = Event::JobProgress { fraction: Some(0.5), text: "half way".to_owned() };
        assert!(!watched.awaits(&progress), "another job's, before this one began");
        assert!(watched.take(Event::JobStarted { name: JOB.to_owned() }).is_none());
        assert!(watched.awaits(&progress) && watched.take(progress).is_none());
        assert_eq!(watched.progress(), Some((0.5, "half way")));
        sender.send(42).unwrap();
        let end = ended(JOB, JobEnding::Done(Box::new(())));
        assert!(watched.awaits(&end) && !watched.awaits(&ended("save", JobEnding::Done(Box::new(())))));
        assert_eq!(watched.take(end), Some(Ok(42)));
        assert!(!watched.is_running());
    }

    #[test]
    fn an_interrupted_job_says_why_and_that_the_motors_were_stopped() {
        let mut watched = Watched::<()>::default();
        drop(watched.begin(JOB));
        let told = watched.take(ended(JOB, JobEnding::Interrupted(Interruption::Stop)));
        let sentence = told.unwrap().unwrap_err();
        assert_eq!(sentence, "Did not try the motor to the end: Stop was pressed. The motors were stopped.");
    }
}

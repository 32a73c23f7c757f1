//! A job that was asked for, followed by the device thread's events until it ends.

use brushwork_link::Message;
use brushwork_link::{Event, Interruption, Job, JobEnding, JobTicket, QueuedJob};

use super::{Effect, Gravity};
use crate::messages::JobMessage;
use brushwork_core::messages::EndedMessage;

/// One kind of job, at most one of which runs.
#[derive(Debug)]
pub struct Watched<T> {
    running: Option<Running<T>>,
}

#[derive(Debug)]
struct Running<T> {
    ticket: JobTicket<T>,
    fraction: f32,
    text: String,
}

/// Why a job has no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unfinished {
    pub gravity: Gravity,
    pub sentence: Message,
}

impl<T> Default for Watched<T> {
    fn default() -> Self {
        Self { running: None }
    }
}

impl<T: Send + 'static> Watched<T> {
    /// What to ask of the device thread. None while one runs.
    pub fn begin(&mut self, job: Job<T>) -> Option<QueuedJob> {
        if self.running.is_some() {
            return None;
        }
        let (job, ticket) = job.queued();
        self.running = Some(Running { ticket, fraction: 0.0, text: "Waiting for its turn".to_owned() });
        Some(job)
    }
}

impl<T> Watched<T> {
    /// The job was not taken, or the link ended.
    pub fn forget(&mut self) {
        self.running = None;
    }

    /// Ends it at its next exchange.
    pub fn cancel(&self) {
        if let Some(running) = &self.running {
            running.ticket.cancel();
        }
    }

    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// How far it is, 0 to 1, and what it does.
    pub fn progress(&self) -> Option<(f32, &str)> {
        self.running.as_ref().map(|running| (running.fraction, running.text.as_str()))
    }

    /// Takes in an event; at its end gives the ticket back, with how it ended. Events of other jobs are not for it: it may
    /// have been forgotten, and another one begun.
    pub fn take(&mut self, event: Event) -> Option<(JobTicket<T>, JobEnding)> {
        let running = self.running.as_mut().filter(|running| event.job() == Some(running.ticket.id()))?;
        if let Event::JobEnded(report) = event {
            return self.running.take().map(|running| (running.ticket, report.ending));
        }
        if let Event::JobProgress { fraction, text, .. } = event {
            running.fraction = fraction.unwrap_or(running.fraction);
            running.text = text;
        }
        None
    }

    /// As [`Watched::take`]: at the end what the job gave, or why it gave nothing.
    pub fn take_result(&mut self, event: Event) -> Option<Result<T, Unfinished>> {
        let (ticket, ending) = self.take(event)?;
        Some(match ticket.ending(ending) {
            JobEnding::Done(value) => Ok(value),
            ending @ (JobEnding::Interrupted(_) | JobEnding::Failed(_) | JobEnding::Panicked(_)) => {
                Err(unfinished(ticket.name(), &ending))
            }
        })
    }
}

fn unfinished<T>(name: &Message, ending: &JobEnding<T>) -> Unfinished {
    let (gravity, sentence) = match ending {
        JobEnding::Done(_) => (Gravity::Note, Message::default()),
        JobEnding::Failed(failure) => (Gravity::Error, failure.message()),
        JobEnding::Panicked(word) => {
            (Gravity::Error, JobMessage::Panicked { act: name.clone(), word: word.clone() }.into())
        }
        JobEnding::Interrupted(cause) => {
            (Gravity::Warning, JobMessage::CutShort { act: name.clone(), cause: interruption(*cause) }.into())
        }
    };
    Unfinished { gravity, sentence }
}

/// What broke into a job, as a clause.
pub fn interruption(cause: Interruption) -> EndedMessage {
    match cause {
        Interruption::Stop => EndedMessage::StopPressed,
        Interruption::DeadMan => EndedMessage::DeadMan,
        Interruption::Disarm => EndedMessage::Disarmed,
        Interruption::Closing => EndedMessage::LinkClosed,
        Interruption::Cancelled => EndedMessage::Cancelled,
        Interruption::TimeLimit => EndedMessage::TookLong,
    }
}

/// What is said at the end of such a job; nothing before.
pub fn said(ended: Option<Result<(), Unfinished>>, done: JobMessage) -> Vec<Effect> {
    let said = ended.map(|result| match result {
        Ok(()) => Effect::say(Gravity::Note, done),
        Err(Unfinished { gravity, sentence }) => Effect::say(gravity, sentence),
    });
    said.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_link::device::{JobId, JobReport};
    use brushwork_link::messages::ActMessage;

    use super::*;

    fn job() -> Job<u8> {
        Job::new(ActMessage::Move, Duration::from_secs(1), |_| Ok(42))
    }

    fn ended(id: JobId, ending: JobEnding) -> Event {
        let ran_for = Duration::from_secs(1);
        Event::JobEnded(JobReport {
            id,
            name: Message::default(),
            ran_for,
            ending,
            motors_stopped: Some(true),
        })
    }

    #[test]
    fn a_job_is_followed_to_its_end_and_no_other() {
        let mut watched = Watched::default();
        let id = watched.begin(job()).unwrap().id();
        let other = job().queued().0.id();
        assert!(watched.begin(job()).is_none(), "one at a time");
        let progress = |id| Event::JobProgress { id, fraction: Some(0.5), text: "half way".to_owned() };
        assert!(watched.take(progress(other)).is_none());
        assert_eq!(watched.progress(), Some((0.0, "Waiting for its turn")));
        assert!(watched.take(progress(id)).is_none());
        assert_eq!(watched.progress(), Some((0.5, "half way")));
        assert!(watched.take(ended(other, JobEnding::Done(()))).is_none());
        assert!(watched.is_running());
        let reported = watched.take_result(ended(id, JobEnding::Done(()))).unwrap();
        assert!(reported.is_err(), "nothing has run it");
        assert!(!watched.is_running());
    }

    #[test]
    fn an_interrupted_job_says_why_and_that_the_motors_were_stopped() {
        let mut watched = Watched::default();
        let id = watched.begin(job()).unwrap().id();
        let reported = watched.take_result(ended(id, JobEnding::Interrupted(Interruption::Stop)));
        let sentence = "Did not move the motors to the end: Stop was pressed. The motors were stopped.";
        let unfinished = reported.expect("it has ended").expect_err("it was interrupted");
        assert_eq!(
            (unfinished.gravity, unfinished.sentence.to_string().as_str()),
            (Gravity::Warning, sentence)
        );
    }
}

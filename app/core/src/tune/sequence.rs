//! A run from the press of its button to the gains put back: three jobs of the device thread, one after the other.
//!
//! The first moves nothing: it reads what the controller holds and shortens the stream's time-out, which disarms. Whoever asked for the
//! run has agreed to motion, so it is armed again for the second, which moves the motor. The third puts back what must be put
//! back, on every way out, and is asked for again until it has been done. Window and command line carry out what [`Sequence::next`]
//! asks for and hand it the events.

use std::fmt;
use std::sync::PoisonError;

use brushwork_link::device::JobId;
use brushwork_link::{
    ArmScope, Event, Failure, Interruption, Job, JobEnding, JobTicket, Message, QueuedJob, Subject,
};

use super::law::{Report, Request as TuneRequest, Setup, Trace, Trial, TrialRequest};
use super::live::Live;
use super::{self as jobs, Restored, Slot, Target, take};
use crate::keep::TrialKeeper;
use crate::messages::EndedMessage;

/// How often putting the gains back is asked for again when something breaks into it.
const MOST_RESTORES: u8 = 4;

/// How often a run that this computer was too late for is begun again: beside six busy programs on two processors one in twenty is.
const LATE_RUNS: u8 = 3;

/// What a run does.
#[derive(Clone, Debug)]
pub enum Work {
    /// Identifies the motor and designs gains.
    Tune(Box<TuneRequest>),
    /// Tries gains.
    Try(Box<TrialRequest>),
    /// Puts back what a run left when its link was lost.
    PutBack,
}

/// Where a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Preparing,
    Arming,
    Running,
    Restoring,
}

/// What came of a run.
#[derive(Debug)]
pub struct Ended {
    /// What it was to do.
    pub work: Work,
    /// What a tuning run found, an interrupted one too.
    pub report: Option<Report>,
    /// What a trial of gains found.
    pub trial: Option<Trial>,
    /// Why there is less than was asked for.
    pub why: Option<Why>,
    /// What broke into the run itself, or into the job before it.
    pub interrupted: Option<Interruption>,
    /// What the controller held before and does not hold again.
    pub owed: Option<(Setup, Origin)>,
    /// What putting everything back came to, where that was done.
    pub restored: Option<Restored>,
}

/// Why a run came to less than was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// Something broke in.
    Interrupted(Interruption),
    /// The controller did not do something.
    Failed(Box<Failure>),
    /// A bug, with its last word.
    Panicked(String),
    /// It was ended from outside: why, as a clause.
    Ended(Message),
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interrupted(cause) => cause.fmt(f),
            Self::Failed(failure) => failure.fmt(f),
            Self::Panicked(word) => write!(f, "Brushwork had a bug. Its last word: {word}"),
            Self::Ended(why) => why.fmt(f),
        }
    }
}

/// How the arming stands that a run asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Armed {
    /// It may move the motor.
    Yes,
    /// It is not known yet.
    Open,
    /// It was refused.
    Refused,
}

/// What a run's backup and journal need.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The model and its firmware.
    pub subject: Subject,
    /// What writes them.
    pub keeper: TrialKeeper,
}

/// What is to be asked of the device thread next.
#[derive(Debug)]
pub enum Next {
    /// To arm.
    Arm(ArmScope),
    /// To do this job.
    Job(QueuedJob),
}

/// What was asked for in a stage.
#[derive(Debug)]
enum Asked {
    Nothing,
    Arming,
    Work(JobTicket<()>),
    Restore(JobTicket<Restored>),
}

/// One run.
#[derive(Debug)]
pub struct Sequence {
    /// What it does.
    pub work: Work,
    /// With which motor.
    pub target: Target,
    scope: ArmScope,
    stage: Stage,
    asked: Asked,
    restores: u8,
    /// From the job that prepares on.
    origin: Option<Origin>,
    setup: Slot<Setup>,
    before: Option<Setup>,
    found: Slot<Report>,
    tried: Slot<Trial>,
    /// The run as it goes on.
    pub live: Live,
    /// What it does at the moment, and since when on the trace.
    texts: Vec<(String, f64)>,
    why: Option<Why>,
    interrupted: Option<Interruption>,
    /// The run itself has come to its end.
    is_complete: bool,
    restored: Option<Restored>,
    /// How often it may still begin again by itself where the motion was not renewed in time.
    late_runs: u8,
    /// How often it has.
    begun_again: u8,
}

impl Sequence {
    /// A run of which nothing is begun yet.
    pub fn new(work: Work, target: Target, scope: ArmScope) -> Self {
        let live = Live::new(Trace::new(target.motor.index(), target.encoder.unwrap_or_default()));
        Self {
            work,
            target,
            scope,
            stage: Stage::Preparing,
            asked: Asked::Nothing,
            restores: 0,
            origin: None,
            setup: Slot::default(),
            before: None,
            found: Slot::default(),
            tried: Slot::default(),
            live,
            texts: Vec::new(),
            why: None,
            interrupted: None,
            is_complete: false,
            restored: None,
            late_runs: 0,
            begun_again: 0,
        }
    }

    /// The same, begun again by itself where this computer was too late to renew the motion. It arms again for that, so that it is for whoever
    /// has no screen on which something else could have been done meanwhile.
    #[must_use]
    pub fn begun_again_when_late(self) -> Self {
        Self { late_runs: LATE_RUNS, ..self }
    }

    /// How often it was begun again by itself.
    pub fn begun_again(&self) -> u8 {
        self.begun_again
    }

    /// What a lost link has left to do: nothing but putting back.
    pub fn put_back(target: Target, scope: ArmScope, (before, origin): (Setup, Origin)) -> Self {
        let stage = Stage::Restoring;
        Self { stage, before: Some(before), origin: Some(origin), ..Self::new(Work::PutBack, target, scope) }
    }

    /// What it does, as a person reads it.
    pub fn text(&self) -> &str {
        match self.stage {
            Stage::Preparing => "Reading what the controller holds",
            Stage::Arming => "Arming",
            Stage::Running => self.texts.last().map_or("Waiting for its turn", |(text, _)| text),
            Stage::Restoring => "Putting the previous gains back",
        }
    }

    /// Which of the stages of the run itself it is in, counted from 0, and for how long, s.
    pub fn step(&self) -> Option<(usize, f64)> {
        if self.stage != Stage::Running {
            return None;
        }
        let (_, since_s) = self.texts.last()?;
        Some((self.texts.len() - 1, (self.live.look().end_s() - since_s).max(0.0)))
    }

    /// How long the steps took that are over, s.
    pub fn durations(&self) -> Vec<f64> {
        self.texts.windows(2).map(|pair| pair[1].1 - pair[0].1).collect()
    }

    /// Whether everything is being put back.
    pub fn is_restoring(&self) -> bool {
        self.stage == Stage::Restoring
    }

    /// Ends it before its end. What runs is interrupted by the device thread; what has not begun does not begin.
    pub fn abort(&mut self, why: EndedMessage) {
        self.late_runs = 0;
        if self.stage == Stage::Restoring {
            return;
        }
        self.why.get_or_insert(Why::Ended(why.into()));
        if self.stage == Stage::Arming {
            self.go_to(Stage::Restoring);
        }
    }

    /// As [`Sequence::abort`]; the job that runs ends at its next exchange, unless it puts something back.
    pub fn cancel(&mut self, why: EndedMessage) {
        if let Asked::Work(ticket) = &self.asked {
            ticket.cancel();
        }
        self.abort(why);
    }

    fn go_to(&mut self, stage: Stage) {
        (self.stage, self.asked) = (stage, Asked::Nothing);
    }

    /// What to ask for now, if anything; asked in every frame. `origin` is asked once, before anything else.
    pub fn next(&mut self, armed: Armed, origin: impl FnOnce() -> Option<Origin>) -> Option<Next> {
        if self.origin.is_none() {
            self.origin = origin();
        }
        let Origin { subject, keeper } = self.origin.clone()?;
        if self.stage == Stage::Arming {
            match armed {
                Armed::Yes => self.go_to(Stage::Running),
                Armed::Refused if matches!(self.asked, Asked::Arming) => {
                    self.abort(EndedMessage::NotArmed);
                }
                Armed::Open | Armed::Refused => {}
            }
        }
        if !matches!(self.asked, Asked::Nothing) {
            return None;
        }
        let work = match self.stage {
            Stage::Arming => {
                self.asked = Asked::Arming;
                return Some(Next::Arm(self.scope));
            }
            Stage::Preparing => jobs::prepare(self.target, subject, &self.setup, &keeper),
            Stage::Running => match &self.work {
                Work::Tune(request) => jobs::run(self.target, **request, &self.found, &self.live),
                Work::Try(wanted) => jobs::trial(self.target, **wanted, &self.tried, &self.live),
                Work::PutBack => return None,
            },
            Stage::Restoring => {
                let (job, ticket) = self.restore(self.before?, &keeper).queued();
                self.asked = Asked::Restore(ticket);
                return Some(Next::Job(job));
            }
        };
        let (job, ticket) = work.queued();
        self.asked = Asked::Work(ticket);
        Some(Next::Job(job))
    }

    /// What puts everything back but the gains of a run that has ended as it should, where they are to be kept, and a loop that was
    /// left off for a reason that the result tells.
    fn restore(&self, before: Setup, keeper: &TrialKeeper) -> Job<Restored> {
        let report = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let trial = self.tried.lock().unwrap_or_else(PoisonError::into_inner);
        let leaves_off = jobs::leaves_off(report.as_ref(), trial.as_ref());
        let kept = report.as_ref().filter(|_| self.is_complete);
        jobs::restore(self.target, before, kept, leaves_off, keeper)
    }

    /// The device thread did not take what was asked for: it is asked again.
    pub fn not_begun(&mut self) {
        self.asked = Asked::Nothing;
    }

    /// The job that was asked for.
    fn job(&self) -> Option<JobId> {
        match &self.asked {
            Asked::Nothing | Asked::Arming => None,
            Asked::Work(ticket) => Some(ticket.id()),
            Asked::Restore(ticket) => Some(ticket.id()),
        }
    }

    /// Takes in an event of a job; the end of the run, if it is that.
    pub fn take(&mut self, event: Event) -> Option<Ended> {
        if event.job() != self.job() {
            return None;
        }
        if let Event::JobEnded(report) = event {
            return self.job_ended(report.ending);
        }
        // What the jobs around it say has no place among the steps of the run.
        if let Event::JobProgress { text, .. } = event
            && self.stage == Stage::Running
        {
            let since_s = self.live.look().end_s();
            if self.texts.last().is_none_or(|(last, _)| *last != text) {
                self.texts.push((text, since_s));
            }
        }
        None
    }

    fn job_ended(&mut self, ending: JobEnding) -> Option<Ended> {
        match std::mem::replace(&mut self.asked, Asked::Nothing) {
            Asked::Work(_) => self.work_ended(ending),
            Asked::Restore(ticket) => match ticket.ending(ending) {
                JobEnding::Done(_) if self.was_late() => {
                    self.begin_again();
                    None
                }
                JobEnding::Done(restored) => {
                    self.restored = Some(restored);
                    Some(self.end(None))
                }
                ending if self.restores >= MOST_RESTORES => {
                    self.note(ending);
                    let owed = self.before;
                    Some(self.end(owed))
                }
                JobEnding::Interrupted(_) | JobEnding::Failed(_) | JobEnding::Panicked(_) => {
                    self.restores += 1;
                    None
                }
            },
            Asked::Nothing | Asked::Arming => None,
        }
    }

    /// Whether the run was ended since its motion was not renewed in time, and may begin again.
    fn was_late(&self) -> bool {
        let is_late = self.interrupted == Some(Interruption::DeadMan);
        is_late && matches!(self.work, Work::Tune(_)) && self.late_runs > 0
    }

    fn begin_again(&mut self) {
        self.late_runs -= 1;
        self.begun_again += 1;
        (self.why, self.interrupted, self.restores) = (None, None, 0);
        (self.setup, self.found) = (Slot::default(), Slot::default());
        self.texts.clear();
        self.go_to(Stage::Preparing);
    }

    /// The job before the run has ended, or the run itself.
    fn work_ended(&mut self, ending: JobEnding) -> Option<Ended> {
        let is_done = matches!(ending, JobEnding::Done(()));
        if let JobEnding::Interrupted(cause) = ending {
            self.interrupted = Some(cause);
        }
        if self.stage == Stage::Running {
            self.is_complete = is_done;
            self.note(ending);
            self.go_to(Stage::Restoring);
            return None;
        }
        self.before = take(&self.setup);
        self.note(ending);
        let Some(before) = self.before else { return Some(self.end(None)) };
        self.target.encoder = Some(before.encoder);
        self.live.begin(Trace::new(self.target.motor.index(), before.encoder));
        let goes_on = is_done && self.why.is_none();
        self.go_to(if goes_on { Stage::Arming } else { Stage::Restoring });
        None
    }

    /// Why a job ended early, if it did.
    fn note<T>(&mut self, ending: JobEnding<T>) {
        let why = match ending {
            JobEnding::Done(_) => return,
            JobEnding::Failed(failure) => Why::Failed(Box::new(failure)),
            JobEnding::Panicked(word) => Why::Panicked(word),
            JobEnding::Interrupted(cause) => Why::Interrupted(cause),
        };
        self.why.get_or_insert(why);
    }

    fn end(&mut self, owed: Option<Setup>) -> Ended {
        Ended {
            work: self.work.clone(),
            report: take(&self.found),
            trial: take(&self.tried),
            why: self.why.take(),
            interrupted: self.interrupted,
            owed: owed.zip(self.origin.clone()),
            restored: self.restored,
        }
    }

    /// The link is gone: what was not put back is owed.
    pub fn link_ended(mut self) -> Ended {
        self.why.get_or_insert(Why::Ended(EndedMessage::LinkLost.into()));
        self.before = self.before.or_else(|| take(&self.setup));
        let owed = self.before;
        self.end(owed)
    }
}

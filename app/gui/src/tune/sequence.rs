//! A run from the press of its button to the gains put back: three jobs of the device thread, one after the other.
//!
//! The first moves nothing: it reads what the controller holds and shortens the stream's time-out, which disarms. The screen was armed
//! by hand when the run was asked for, so it is armed again for the second, which moves the motor. The third puts back what must be put
//! back, on every way out, and is asked for again until it has been done.

use std::sync::PoisonError;

use brushwork_core::tune::law::{Report, Request as TuneRequest, Setup, Trace, Trial, TrialRequest};
use brushwork_link::device::{ArmScope, Event, Job, JobEnding, Request};
use brushwork_link::settings::Subject;

use crate::model::link::Arming;
use crate::model::watched::interruption;
use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::tap::Live;
use brushwork_core::tune::{self as jobs, Restored, Slot, Target, take};

/// How often putting the gains back is asked for again when something breaks into it.
const MOST_RESTORES: u8 = 4;

/// What a run does.
#[derive(Clone, Debug)]
pub enum Work {
    /// Identifies the motor and designs gains.
    Tune(TuneRequest),
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
    pub work: Work,
    pub report: Option<Report>,
    pub trial: Option<Trial>,
    /// Why there is less than was asked for.
    pub why: Option<String>,
    /// What the controller held before and does not hold again.
    pub owed: Option<(Setup, Origin)>,
    /// A loop did not hold its motor still with what was put back, and was left off.
    pub loop_left_off: bool,
}

/// What a run's backup and journal need.
#[derive(Clone, Debug)]
pub struct Origin {
    pub subject: Subject,
    pub keeper: TrialKeeper,
}

/// What is to be asked of the device thread next.
#[derive(Debug)]
pub enum Next {
    Arm(ArmScope),
    Job(Request),
}

/// One run.
#[derive(Debug)]
pub struct Sequence {
    pub work: Work,
    pub target: Target,
    scope: ArmScope,
    stage: Stage,
    /// The job or the arming of the stage was asked for.
    is_asked: bool,
    has_started: bool,
    restores: u8,
    /// From the job that prepares on.
    origin: Option<Origin>,
    setup: Slot<Setup>,
    before: Option<Setup>,
    found: Slot<Report>,
    tried: Slot<Trial>,
    pub live: Live,
    /// What it does at the moment, and since when on the trace.
    texts: Vec<(String, f64)>,
    why: Option<String>,
    loop_left_off: bool,
}

impl Sequence {
    pub fn new(work: Work, target: Target, scope: ArmScope) -> Self {
        let live = Live::new(Trace::new(target.motor.index(), target.encoder.unwrap_or_default()));
        Self {
            work,
            target,
            scope,
            stage: Stage::Preparing,
            is_asked: false,
            has_started: false,
            restores: 0,
            origin: None,
            setup: Slot::default(),
            before: None,
            found: Slot::default(),
            tried: Slot::default(),
            live,
            texts: Vec::new(),
            why: None,
            loop_left_off: false,
        }
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
            Stage::Restoring => "Putting the gains from before back",
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

    pub fn is_restoring(&self) -> bool {
        self.stage == Stage::Restoring
    }

    /// Ends it before its end. What runs is interrupted by the device thread; what has not begun does not begin.
    pub fn abort(&mut self, why: &str) {
        if self.stage == Stage::Restoring {
            return;
        }
        self.why.get_or_insert_with(|| why.to_owned());
        if self.stage == Stage::Arming {
            self.go_to(Stage::Restoring);
        }
    }

    fn go_to(&mut self, stage: Stage) {
        (self.stage, self.is_asked, self.has_started) = (stage, false, false);
    }

    /// What to ask for now, if anything; asked in every frame. `origin` is asked once, before anything else.
    pub fn next(
        &mut self,
        arming: Arming,
        refused: bool,
        origin: impl FnOnce() -> Option<Origin>,
    ) -> Option<Next> {
        if self.origin.is_none() {
            self.origin = origin();
        }
        let Origin { subject, keeper } = self.origin.clone()?;
        if self.stage == Stage::Arming {
            if arming.is_armed_for(self.scope) {
                self.go_to(Stage::Running);
            } else if self.is_asked && refused && arming == Arming::Disarmed {
                self.abort("the screen could not be armed again");
            }
        }
        if std::mem::replace(&mut self.is_asked, true) {
            return None;
        }
        let job: Box<dyn Job> = match self.stage {
            Stage::Arming => return Some(Next::Arm(self.scope)),
            Stage::Preparing => jobs::prepare(self.target, subject, &self.setup, &keeper),
            Stage::Running => match &self.work {
                Work::Tune(request) => jobs::run_watched(self.target, *request, &self.found, &self.live),
                Work::Try(wanted) => jobs::trial(self.target, **wanted, &self.tried, &self.live),
                Work::PutBack => return None,
            },
            Stage::Restoring => {
                jobs::restore(self.target, self.before?, None, self.leaves_loop_off(), &keeper)
            }
        };
        Some(Next::Job(Request::Job(job)))
    }

    /// Whether the run has left a loop off, for a reason that its result tells.
    fn leaves_loop_off(&self) -> bool {
        let report = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let trial = self.tried.lock().unwrap_or_else(PoisonError::into_inner);
        jobs::leaves_off(report.as_ref(), trial.as_ref())
    }

    /// The device thread did not take what was asked for: it is asked again.
    pub fn not_begun(&mut self) {
        self.is_asked = false;
    }

    fn job_name(&self) -> Option<&'static str> {
        match (self.stage, &self.work) {
            (Stage::Preparing, _) => Some(jobs::PREPARE),
            (Stage::Running, Work::Tune(_)) => Some(jobs::RUN),
            (Stage::Running, _) => Some(jobs::TRIAL),
            (Stage::Restoring, _) => Some(jobs::RESTORE),
            (Stage::Arming, _) => None,
        }
    }

    /// Whether the event is about the job that runs.
    pub fn awaits(&self, event: &Event) -> bool {
        let Some(running) = self.job_name().filter(|_| self.is_asked) else { return false };
        match event {
            Event::JobStarted { name } => name == running,
            Event::JobProgress { .. } => self.has_started,
            Event::JobEnded(report) => report.name == running,
            _ => false,
        }
    }

    /// Takes in an event that it awaits; the end of the run, if it is that.
    pub fn take(&mut self, event: Event) -> Option<Ended> {
        match event {
            Event::JobStarted { .. } => self.has_started = true,
            // What the jobs around it say has no place among the steps of the run.
            Event::JobProgress { text, .. } if self.stage == Stage::Running => {
                let since_s = self.live.look().end_s();
                if self.texts.last().is_none_or(|(last, _)| *last != text) {
                    self.texts.push((text, since_s));
                }
            }
            Event::JobEnded(report) => return self.job_ended(report.ending),
            _ => {}
        }
        None
    }

    fn job_ended(&mut self, ending: JobEnding) -> Option<Ended> {
        let is_done = matches!(ending, JobEnding::Done(_));
        match self.stage {
            Stage::Preparing => {
                self.before = take(&self.setup);
                self.note(ending);
                let Some(before) = self.before else { return Some(self.end(None)) };
                self.target.encoder = Some(before.encoder);
                self.live.begin(Trace::new(self.target.motor.index(), before.encoder));
                let goes_on = is_done && self.why.is_none();
                self.go_to(if goes_on { Stage::Arming } else { Stage::Restoring });
            }
            Stage::Running => {
                self.note(ending);
                self.go_to(Stage::Restoring);
            }
            Stage::Restoring if is_done => {
                if let JobEnding::Done(output) = ending {
                    let told = output.downcast_ref::<Restored>();
                    self.loop_left_off = told.is_some_and(|told| told.loop_left_off);
                }
                return Some(self.end(None));
            }
            Stage::Restoring if self.restores >= MOST_RESTORES => {
                self.note(ending);
                let owed = self.before;
                return Some(self.end(owed));
            }
            Stage::Restoring => {
                self.restores += 1;
                self.is_asked = false;
            }
            Stage::Arming => {}
        }
        None
    }

    /// Why a job ended early, if it did.
    fn note(&mut self, ending: JobEnding) {
        let why = match ending {
            JobEnding::Done(_) => return,
            JobEnding::Failed(failure) => failure.to_string(),
            JobEnding::Panicked(word) => format!("Brushwork had a bug. Its last word: {word}"),
            JobEnding::Interrupted(cause) => interruption(cause).to_owned(),
        };
        self.why.get_or_insert(why);
    }

    fn end(&mut self, owed: Option<Setup>) -> Ended {
        Ended {
            work: self.work.clone(),
            report: take(&self.found),
            trial: take(&self.tried),
            why: self.why.take(),
            owed: owed.zip(self.origin.clone()),
            loop_left_off: self.loop_left_off,
        }
    }

    /// The link is gone: what was not put back is owed.
    pub fn link_ended(mut self) -> Ended {
        self.why.get_or_insert_with(|| "the link was lost".to_owned());
        self.before = self.before.or_else(|| take(&self.setup));
        let owed = self.before;
        self.end(owed)
    }
}

//! The window that examines a controller: what its owner has agreed to, how far it is, and what was found.
//!
//! The steps are those of `brushwork examine`; each is up to three jobs, one after the other, of which the last puts back what the second has changed.
//! It goes out whatever became of the second, as long as there is a link.

use std::collections::{BTreeSet, VecDeque};

use brushwork_core::examine::{Examination, Examining, Need, RawWrite, Step, Taking, Way};
use brushwork_core::keep::TrialKeeper;
use brushwork_core::messages::EndedMessage;
use brushwork_core::tune::Restored;
use brushwork_core::tune::sequence::Next;
use brushwork_link::device::{ArmScope, Event, Identity, JobEnding};
use brushwork_link::{Message, WriteOptions};
use brushwork_values::Motor;

use super::{Arming, Effect, Gravity, Watched};
use crate::messages::ExaminationMessage;
use crate::model::watched::{Unfinished, interruption};

/// The scope in which the step that moves a motor is armed.
const SCOPE: ArmScope = ArmScope::Tuning;

const REFUSED: &str = "Not asked: the owner did not agree.";
const ENDED: &str = "Not asked: the examination was ended before.";
const FAILED: &str = "Not asked: its step could not be taken to the end.";

/// How often putting back is asked for again when something breaks into it.
const MOST_RESTORES: u8 = 4;

/// What is asked of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExaminationAction {
    Begin,
    Cancel,
    /// Writes the report to the path that is typed.
    Save,
}

/// The window, and the examination that runs.
#[derive(Debug)]
pub struct ExaminationPanel {
    pub open: bool,
    /// Whose loops the moving step looks at.
    pub motor: Motor,
    /// The steps that their owner agreed to, by key.
    pub agreed: BTreeSet<&'static str>,
    /// Where the report goes, as typed.
    pub path: String,
    run: Option<Run>,
    /// What was found, of the run that goes on or of the last one.
    found: Option<Examination>,
    /// How the last run ended.
    pub ended: Option<(Gravity, Message)>,
    /// The last run has just ended, so that its headline is to be brought into view.
    pub is_new: bool,
}

/// Where the step that is being taken stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Preparing,
    Arming,
    Asking,
    PuttingBack,
}

#[derive(Debug)]
struct Now {
    taking: Taking,
    step: &'static Step,
    stage: Stage,
    is_asked_to_arm: bool,
    /// How often putting back was broken into.
    restores: u8,
}

#[derive(Debug)]
struct Run {
    examining: Examining,
    left: VecDeque<&'static Step>,
    steps: usize,
    options: WriteOptions,
    now: Option<Now>,
    work: Watched<()>,
    back: Watched<Restored>,
    /// Why no further step is taken.
    why: Option<(Gravity, Message)>,
}

impl Default for ExaminationPanel {
    fn default() -> Self {
        Self {
            open: false,
            motor: Motor::M1,
            agreed: BTreeSet::new(),
            path: String::new(),
            run: None,
            found: None,
            ended: None,
            is_new: false,
        }
    }
}

impl ExaminationPanel {
    /// The steps that a unit has, with whether each can be taken; none where there are no questions for its family.
    pub fn steps(identity: &Identity) -> Vec<(&'static Step, bool)> {
        let examining = Examining::begin(identity);
        let steps = |examining: &Examining| {
            examining.steps().iter().map(|step| (step, !examining.is_shut(step))).collect()
        };
        examining.as_ref().map_or_else(|_| Vec::new(), steps)
    }

    pub fn is_running(&self) -> bool {
        self.run.is_some()
    }

    /// The scope that has to be armed, or is, for the step that is being taken.
    pub fn arm_scope(&self) -> Option<ArmScope> {
        let now = self.run.as_ref()?.now.as_ref()?;
        matches!(now.stage, Stage::Arming | Stage::Asking).then_some(SCOPE).filter(|_| now.taking.moves())
    }

    /// What was found, as far as it goes.
    pub fn found(&self) -> Option<&Examination> {
        self.found.as_ref()
    }

    /// The step that is being taken: its number from 1, of how many, what it does, what its job does, and how much of that is done.
    pub fn progress(&self) -> Option<(usize, usize, &'static str, String, f32)> {
        let run = self.run.as_ref()?;
        let now = run.now.as_ref()?;
        let (share, text) = run.work.progress().or(run.back.progress()).unwrap_or((0.0, ""));
        let text = match now.stage {
            Stage::Preparing => "Keeping what the controller holds".to_owned(),
            Stage::Arming => "Arming".to_owned(),
            Stage::Asking => text.to_owned(),
            Stage::PuttingBack => "Putting everything back".to_owned(),
        };
        Some((run.steps - run.left.len(), run.steps, now.step.title, text, share))
    }

    /// Begins to examine a unit, with the steps that were agreed to.
    pub fn begin(
        &mut self,
        identity: &Identity,
        options: WriteOptions,
        raw_writes: Vec<RawWrite>,
    ) -> Result<(), Message> {
        let examining = Examining::begin(identity)?;
        examining.note_raw_writes(raw_writes);
        let is_agreed = |step: &&Step| step.need == Need::Read || self.agreed.contains(step.key);
        let (taken, refused): (VecDeque<_>, VecDeque<_>) =
            examining.steps().iter().filter(|step| !examining.is_shut(step)).partition(is_agreed);
        refused.iter().for_each(|step| examining.not_asked(step, REFUSED));
        self.ended = None;
        self.found = Some(examining.found());
        self.run = Some(Run {
            examining,
            steps: taken.len(),
            left: taken,
            options,
            now: None,
            work: Watched::default(),
            back: Watched::default(),
            why: None,
        });
        Ok(())
    }

    /// Ends it: what runs is interrupted, what was changed is put back, what is left is not begun.
    pub fn cancel(&mut self, gravity: Gravity, cause: EndedMessage) {
        let Some(run) = &mut self.run else { return };
        run.why.get_or_insert((gravity, ExaminationMessage::CutShort { cause }.into()));
        run.work.cancel();
        if let Some(now) = run.now.as_mut().filter(|now| now.stage == Stage::Arming) {
            now.stage = Stage::PuttingBack;
        }
    }

    /// What to ask of the device thread now; asked in every frame.
    pub fn next(
        &mut self,
        arming: Arming,
        refused: bool,
        keeper: impl FnOnce() -> Option<TrialKeeper>,
    ) -> Option<Next> {
        let run = self.run.as_mut()?;
        if run.work.is_running() || run.back.is_running() {
            return None;
        }
        if run.now.is_none() && run.why.is_none() {
            let step = run.left.pop_front()?;
            let way = Way { motor: self.motor, options: run.options };
            let taking = run.examining.take(step, way, keeper()?);
            run.now =
                Some(Now { taking, step, stage: Stage::Preparing, is_asked_to_arm: false, restores: 0 });
        }
        let now = run.now.as_mut()?;
        match now.stage {
            Stage::Preparing => match now.taking.prepare() {
                Some(job) => run.work.begin(job).map(Next::Job),
                None => {
                    now.stage = Stage::Asking;
                    run.work.begin(now.taking.work()).map(Next::Job)
                }
            },
            Stage::Arming if arming.is_armed_for(SCOPE) => {
                now.stage = Stage::Asking;
                run.work.begin(now.taking.work()).map(Next::Job)
            }
            Stage::Arming if !now.is_asked_to_arm => {
                now.is_asked_to_arm = true;
                Some(Next::Arm(SCOPE))
            }
            Stage::Arming if arming == Arming::Disarmed && refused => {
                self.cancel(Gravity::Error, EndedMessage::NotArmed);
                None
            }
            Stage::Arming => None,
            Stage::Asking => run.work.begin(now.taking.work()).map(Next::Job),
            Stage::PuttingBack => match now.taking.put_back() {
                Some(job) => run.back.begin(job).map(Next::Job),
                None => {
                    self.step_ended();
                    None
                }
            },
        }
    }

    /// The device thread did not take what was asked for: it is asked again.
    pub fn not_begun(&mut self) {
        let Some(run) = &mut self.run else { return };
        run.work.forget();
        run.back.forget();
        if let Some(now) = &mut run.now {
            now.is_asked_to_arm = false;
        }
    }

    /// Takes in an event of a job of the examination.
    pub fn take(&mut self, event: Event) {
        let Some(run) = &mut self.run else { return };
        if run.back.is_running() {
            if let Some(ended) = run.back.take_result(event) {
                self.put_back(ended);
            }
            return;
        }
        let Some((_, ending)) = run.work.take(event) else { return };
        let Some(now) = &mut run.now else { return };
        let is_done = matches!(ending, JobEnding::Done(()));
        now.stage = match now.stage {
            Stage::Preparing if is_done && now.taking.moves() => Stage::Arming,
            Stage::Preparing if is_done => Stage::Asking,
            Stage::Preparing | Stage::Arming | Stage::Asking | Stage::PuttingBack => Stage::PuttingBack,
        };
        match ending {
            JobEnding::Done(()) => {}
            // What a step could not do ends that step; what breaks in ends the examination.
            JobEnding::Failed(_) => run.examining.not_asked(now.step, FAILED),
            JobEnding::Interrupted(cause) => {
                let why = ExaminationMessage::CutShort { cause: interruption(cause) };
                run.why.get_or_insert((Gravity::Warning, why.into()));
            }
            JobEnding::Panicked(word) => {
                let why = ExaminationMessage::Panicked { word };
                run.why.get_or_insert((Gravity::Error, why.into()));
            }
        }
        self.found = Some(run.examining.found());
    }

    fn put_back(&mut self, ended: Result<Restored, Unfinished>) {
        let Some(run) = &mut self.run else { return };
        if let (Err(unfinished), Some(now)) = (ended, &mut run.now) {
            now.restores += 1;
            if unfinished.gravity == Gravity::Warning && now.restores < MOST_RESTORES {
                return;
            }
            run.why = Some((unfinished.gravity, unfinished.sentence));
        }
        self.step_ended();
    }

    /// The link is gone: what was changed and not put back is offered when the unit is met again.
    pub fn link_ended(&mut self) -> Vec<Effect> {
        let Some(run) = &mut self.run else { return Vec::new() };
        run.why.get_or_insert((Gravity::Error, ExaminationMessage::LinkLost.into()));
        run.now = None;
        self.end()
    }

    fn step_ended(&mut self) {
        let Some(run) = &mut self.run else { return };
        if let Some(now) = run.now.take() {
            run.examining.not_asked(now.step, FAILED);
        }
        self.found = Some(run.examining.found());
    }

    /// Ends the run where nothing is left of it, and says so.
    pub fn end(&mut self) -> Vec<Effect> {
        let is_over = |run: &mut Run| run.now.is_none() && (run.left.is_empty() || run.why.is_some());
        let Some(run) = self.run.take_if(is_over) else { return Vec::new() };
        run.left.iter().for_each(|step| run.examining.not_asked(step, ENDED));
        self.found = Some(run.examining.found());
        let (gravity, text) = run.why.unwrap_or((Gravity::Note, ExaminationMessage::Done.into()));
        self.ended = Some((gravity, text.clone()));
        self.is_new = true;
        vec![Effect::say(gravity, text)]
    }
}

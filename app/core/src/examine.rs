//! Examining a unit: its questions as jobs on the device thread, each step with what is kept before it and put back after it, and a simulated
//! unit made from what an examination found.
//!
//! A step is up to three jobs, as a tuning run is: the first keeps a backup and a journal, the second asks, the third puts back what the second
//! has changed, on every way out on which there is still a link. Nothing is asked here: whoever uses this asks the owner before each step that
//! does more than read.

use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_family::examine::{self, Examiner};
pub use brushwork_family::examine::{Answer, Examination, Need, RawWrite, State, Step};
use brushwork_family::messages::{
    ExamineActMessage, ExamineCauseMessage, ExamineRemedyMessage, LoopActMessage,
};
use brushwork_family::tuned::Registers;
use brushwork_family::{Restored, Simulator, Started, Tuned, simulator};
use brushwork_link::settings::{Ending, WriteReport, begin_command, begin_trial, end_act, write_watched};
use brushwork_link::{Failure, Identity, Job, Message, ReadReport, Subject, WriteOptions, families};
use brushwork_values::Motor;

use crate::keep::TrialKeeper;
use crate::messages::ExamineMessage;
use crate::tune::law::{Families, Setup};
use crate::tune::{self, Slot, Target};
use brushwork_link::bounded;

/// How long a step may take: on a line of 2400 bit/s each of a hundred reads takes half a second, and silence longer.
const ASKING_LIMIT: Duration = Duration::from_secs(600);
/// How long a step that moves a motor may take.
const MOVING_LIMIT: Duration = Duration::from_secs(60);
/// How long keeping and putting back may take.
const KEEPING_LIMIT: Duration = Duration::from_secs(400);

/// What is said of questions that need settings which this program does not know.
const UNKNOWN_MODEL: &str = "Not asked: this model's settings are not known to this program, so that nothing could be kept before and put back afterwards.";

/// An examination under way.
#[derive(Clone)]
pub struct Examining {
    examiner: &'static dyn Examiner,
    subject: Option<Subject>,
    found: Arc<Mutex<Examination>>,
}

impl fmt::Debug for Examining {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Examining").field("subject", &self.subject).finish_non_exhaustive()
    }
}

/// Whose motor is looked at, and what writing has to know of the way to the controller.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// The motor.
    pub motor: Motor,
    /// For the jobs that write.
    pub options: WriteOptions,
}

/// One step being taken.
pub struct Taking {
    examining: Examining,
    step: &'static Step,
    way: Way,
    keeper: TrialKeeper,
    /// What the unit held before; filled by the job before.
    settings: Slot<ReadReport>,
    loops: Slot<Setup>,
    is_saving: Slot<()>,
}

impl Examining {
    /// An examination of a unit, of which nothing was asked yet.
    ///
    /// # Errors
    /// A sentence: its family has no questions.
    pub fn begin(identity: &Identity) -> Result<Self, Message> {
        let Some(examiner) = examine::examiner(identity.family) else {
            return Err(ExamineMessage::NoQuestions { unit: identity.title().to_owned() }.into());
        };
        let found = Arc::new(Mutex::new(examine::begun(examiner, identity)));
        let begun = Self { examiner, subject: identity.subject(), found };
        if begun.subject.is_none() {
            let unknown = examiner.steps().iter().filter(|step| begun.is_shut(step));
            unknown.for_each(|step| begun.not_asked(step, UNKNOWN_MODEL));
        }
        Ok(begun)
    }

    /// The steps, the reading first.
    #[must_use]
    pub fn steps(&self) -> &'static [Step] {
        self.examiner.steps()
    }

    /// Whether a step cannot be taken, since nothing could be put back after it.
    #[must_use]
    pub fn is_shut(&self, step: &Step) -> bool {
        self.subject.is_none() && step.need > Need::Guess
    }

    /// Notes what the unit's owner had written raw.
    pub fn note_raw_writes(&self, writes: Vec<RawWrite>) {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).raw_writes = writes;
    }

    /// What was found so far.
    #[must_use]
    pub fn found(&self) -> Examination {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Says why those questions of a step that are still open were not asked, if nobody has said so yet.
    pub fn not_asked(&self, step: &Step, why: &str) {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).not_asked(step.key, why);
    }

    /// Takes a step. Its three jobs go out one after the other, the third whatever became of the second.
    #[must_use]
    pub fn take(&self, step: &'static Step, way: Way, keeper: TrialKeeper) -> Taking {
        let (settings, loops, is_saving) = (Slot::default(), Slot::default(), Slot::default());
        Taking { examining: self.clone(), step, way, keeper, settings, loops, is_saving }
    }
}

impl Taking {
    /// Whether the motors have to be armed before the job that asks.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.step.need == Need::Move
    }

    /// The job before: keeps backup and journal. None where nothing is changed.
    #[must_use]
    pub fn prepare(&self) -> Option<Job<()>> {
        let subject = self.examining.subject?;
        let keeper = self.keeper.clone();
        match self.step.need {
            Need::Read | Need::Guess => None,
            Need::Write => {
                let (step, held) = (self.step, Arc::clone(&self.settings));
                Some(Job::new(ExamineActMessage::Keep, KEEPING_LIMIT, move |context| {
                    let is_touched = |key: &str| touches(step, key);
                    let before = begin_trial(context, subject, &is_touched, &mut **keeper.lock())?;
                    tune::put(&held, before);
                    Ok(())
                }))
            }
            Need::Save => {
                let is_saving = Arc::clone(&self.is_saving);
                Some(Job::new(ExamineActMessage::Keep, KEEPING_LIMIT, move |context| {
                    begin_command(context, subject, true, &mut **keeper.lock())?;
                    tune::put(&is_saving, ());
                    Ok(())
                }))
            }
            Need::Move => Some(tune::prepare(self.target(), subject, &self.loops, &self.keeper)),
        }
    }

    /// The job that asks.
    #[must_use]
    pub fn work(&self) -> Job<()> {
        let (examiner, step, motor) = (self.examining.examiner, self.step, self.way.motor);
        let found = Arc::clone(&self.examining.found);
        let moves = self.moves();
        let work = move |context: &mut brushwork_link::device::JobContext<'_>| {
            if moves {
                context.set_polling(false);
            }
            let mut asked = found.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let result = examiner.ask(step, motor, context, &mut asked);
            // What was found before something broke in is kept too.
            *found.lock().unwrap_or_else(PoisonError::into_inner) = asked;
            result
        };
        let title = ExamineActMessage::TakeStep { title: step.title.to_owned() };
        if moves { Job::moving(title, MOVING_LIMIT, work) } else { Job::new(title, ASKING_LIMIT, work) }
    }

    /// The job after: puts back what was changed, proven by reading, and closes the journal. None where nothing was begun. Where something breaks
    /// into it, it can be asked for again.
    #[must_use]
    pub fn put_back(&self) -> Option<Job<Restored>> {
        let keeper = self.keeper.clone();
        if let Some(before) = held(&self.loops) {
            let target = Target { encoder: Some(before.encoder), ..self.target() };
            return Some(Job::new(LoopActMessage::PutBack, KEEPING_LIMIT, move |context| {
                let kept = Registers::<<Families as Tuned>::Law>::default();
                let restored = Families::restore(context, target, &before, &kept, false)?;
                end_act(context, &mut **keeper.lock(), Ending::Known);
                Ok(restored)
            }));
        }
        if let Some(before) = held(&self.settings) {
            let (step, options) = (self.step, WriteOptions { as_read: true, ..self.way.options });
            return Some(Job::new(ExamineActMessage::PutSettingsBack, KEEPING_LIMIT, move |context| {
                let held = before.image.iter().filter(|(key, _)| touches(step, key));
                let held = held.map(|(key, value)| (key.to_owned(), value)).collect();
                let on = context.describe();
                let written = write_watched(context, &before.table, &held, options, &before.image);
                let is_back = written.as_ref().is_ok_and(WriteReport::is_complete);
                end_act(context, &mut **keeper.lock(), if is_back { Ending::Known } else { Ending::Open });
                match written {
                    Ok(_) if is_back => Ok(Restored::default()),
                    Ok(_) => Err(not_back(on, ExamineCauseMessage::ReadOtherwise)),
                    Err(error) => {
                        Err(not_back(on, ExamineCauseMessage::NotWritten { why: error.to_string() }))
                    }
                }
            }));
        }
        held(&self.is_saving).map(|()| {
            Job::new(ExamineActMessage::CloseJournal, KEEPING_LIMIT, move |context| {
                end_act(context, &mut **keeper.lock(), Ending::Known);
                Ok(Restored::default())
            })
        })
    }

    fn target(&self) -> Target {
        Target { motor: self.way.motor, encoder: None, stream: self.way.options.own_stream }
    }
}

impl fmt::Debug for Taking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Taking").field("step", &self.step.key).finish_non_exhaustive()
    }
}

fn held<T: Clone>(slot: &Slot<T>) -> Option<T> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn touches(step: &Step, key: &str) -> bool {
    step.touches.iter().any(|touched| key.starts_with(touched))
}

fn not_back(on: String, came_back: ExamineCauseMessage) -> Failure {
    Failure::new(ExamineActMessage::PutSettingsBack, on, came_back, ExamineRemedyMessage::SeeUnfinished)
}

/// Makes a simulated unit that behaves as the examination in a file says, and says what of that it cannot imitate, a sentence each.
///
/// # Errors
/// A clause: the file cannot be read or is no examination, or no family has a simulator for it.
pub fn like(path: &Path) -> Result<(&'static dyn Simulator, Started, Vec<String>), String> {
    let text =
        bounded::read_text(path).map_err(|error| format!("{} cannot be read ({error})", path.display()))?;
    let examination = Examination::parse(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    let family = families().iter().find(|family| family.key() == examination.family);
    let simulator = family.and_then(|family| simulator::of(*family));
    let Some(simulator) = simulator else {
        return Err(format!(
            "this program has no simulated controllers of the family \"{}\"",
            examination.family
        ));
    };
    let (started, unlike) = simulator.like(&examination).map_err(|error| error.to_string())?;
    Ok((simulator, started, unlike))
}

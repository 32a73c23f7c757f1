//! The voltage clamp test on the settings screen: what is set, what runs, what was found.

use brushwork_link::{Event, JobEnding, Message};
use brushwork_values::Motor;
use crossbeam_channel::Receiver;

use crate::messages::ClampMessage;
use crate::model::{Effect, Gravity, UnitSettings, Watched};
use brushwork_core::motion::clamp::{STEPS, Step, Task};

mod acts;

/// How far above the controller's own limit the test's is set at first: a clamp acts at the controller's limit.
const ABOVE_MAXIMUM_VOLTS: f64 = 2.0;

/// The test of one link.
#[derive(Debug)]
pub struct ClampTest {
    pub motor: Motor,
    /// Set by hand; else what follows from the unit's settings.
    pub limit_volts: Option<f64>,
    pub down_percent_per_s: f64,
    pub hold_s: f64,
    pub job: Watched<()>,
    running: Option<Running>,
    /// What was found in the last run.
    pub steps: Vec<Step>,
    /// How the last run ended.
    pub verdict: Option<Verdict>,
}

/// How a run ended, as a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    pub gravity: Gravity,
    pub sentence: Message,
}

#[derive(Debug)]
struct Running {
    task: Task,
    found: Receiver<Step>,
}

impl Default for ClampTest {
    fn default() -> Self {
        Self {
            motor: Motor::M1,
            limit_volts: None,
            down_percent_per_s: 300.0,
            hold_s: 1.5,
            job: Watched::default(),
            running: None,
            steps: Vec::new(),
            verdict: None,
        }
    }
}

impl ClampTest {
    /// The limit of the test: as set, or from the unit's own maximum.
    pub fn limit(&self, unit: Option<&UnitSettings>) -> f64 {
        self.limit_volts.or_else(|| unit.and_then(first_limit)).unwrap_or(30.0)
    }

    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let Some(running) = &self.running else { return Vec::new() };
        self.steps.extend(running.found.try_iter());
        let task = running.task;
        let Some((_, ending)) = self.job.take(event) else { return Vec::new() };
        let verdict = verdict(&task, &self.steps, &ending);
        self.verdict = Some(verdict.clone());
        self.running = None;
        vec![Effect::say(verdict.gravity, verdict.sentence)]
    }

    pub fn forget_job(&mut self) {
        self.job.forget();
        self.running = None;
    }
}

/// A little above the unit's own maximum, and not above what its model stands.
fn first_limit(unit: &UnitSettings) -> Option<f64> {
    let row = unit.table().row("limits.main_battery.max_volts")?;
    let volts = unit.on_controller(&row.key)?.number()?;
    Some((volts + ABOVE_MAXIMUM_VOLTS).min(row.range.max))
}

fn verdict(task: &Task, steps: &[Step], ending: &JobEnding) -> Verdict {
    let highest = steps.iter().map(|step| step.peak_volts).fold(f64::NEG_INFINITY, f64::max);
    let over = steps.last().filter(|step| step.is_over);
    let braked = steps.last().filter(|step| step.is_braked());
    let (gravity, sentence) = match (ending, over) {
        (JobEnding::Done(()), Some(step)) => (
            Gravity::Error,
            ClampMessage::Over {
                percent: step.duty * 100.0,
                volts: step.peak_volts,
                limit: task.limit_volts,
            }
            .into(),
        ),
        (JobEnding::Done(()), None) if braked.is_some() => {
            (Gravity::Error, braked.map(braked_message).unwrap_or_default())
        }
        (JobEnding::Done(()), None) if steps.len() == STEPS => {
            (Gravity::Note, ClampMessage::Stayed { limit: task.limit_volts, highest }.into())
        }
        (JobEnding::Done(()), None) => (Gravity::Error, ClampMessage::NoResult.into()),
        (JobEnding::Failed(failure), _) => (Gravity::Error, failure.message()),
        (JobEnding::Interrupted(cause), _) => {
            (Gravity::Warning, ClampMessage::CutShort { cause: *cause }.into())
        }
        (JobEnding::Panicked(word), _) => {
            (Gravity::Error, ClampMessage::Panicked { word: word.clone() }.into())
        }
    };
    Verdict { gravity, sentence }
}

fn braked_message(step: &Step) -> Message {
    let (percent, milliseconds) = (step.duty * 100.0, step.high_s * 1000.0);
    ClampMessage::Braked { percent, milliseconds, volts: step.peak_volts }.into()
}

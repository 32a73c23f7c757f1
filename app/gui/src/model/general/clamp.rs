//! The voltage clamp test on the settings screen: what is set, what runs, what was found.

use brushwork_link::{Event, JobEnding};
use brushwork_values::Motor;
use crossbeam_channel::Receiver;

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
    pub sentence: String,
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
        vec![Effect::Say(verdict.gravity, verdict.sentence)]
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
            format!(
                "Stopped at {:.0} %: the main battery reached {:.1} V, the limit is {:.1} V. Use a resistor of fewer \
                 ohms, or add capacitance across B+ and B-. MCP manual 1.7.5.",
                step.duty * 100.0,
                step.peak_volts,
                task.limit_volts
            ),
        ),
        (JobEnding::Done(()), None) if braked.is_some() => {
            (Gravity::Error, format!("{} MCP manual 1.7.5.", braked.map(braked_text).unwrap_or_default()))
        }
        (JobEnding::Done(()), None) if steps.len() == STEPS => (
            Gravity::Note,
            format!(
                "The main battery stayed below {:.1} V from every speed: {highest:.1} V at most.",
                task.limit_volts
            ),
        ),
        (JobEnding::Done(()), None) => {
            (Gravity::Error, "The test ended without a result. Try again.".to_owned())
        }
        (JobEnding::Failed(failure), _) => (Gravity::Error, failure.to_string()),
        (JobEnding::Interrupted(cause), _) => {
            (Gravity::Warning, format!("The test did not run to its end: {cause}. The motors were stopped."))
        }
        (JobEnding::Panicked(word), _) => {
            (Gravity::Error, format!("The test did not run: the program has a fault ({word})."))
        }
    };
    Verdict { gravity, sentence }
}

fn braked_text(step: &Step) -> String {
    format!(
        "Stopped at {:.0} %: the main battery was above the controller's maximum for {:.0} ms, {:.1} V at most, so that \
         the controller braked the motor by itself. The clamp does not take the energy: check its wiring and its output, \
         or use a resistor of fewer ohms.",
        step.duty * 100.0,
        step.high_s * 1000.0,
        step.peak_volts
    )
}

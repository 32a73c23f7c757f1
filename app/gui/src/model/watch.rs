//! What the one sentence on Device Status is made of besides the status word: the settings that decide whether a motor runs,
//! the input pins, and what is known of the script.
//!
//! The settings are read by a short job when a unit is met, when Device Status opens and after other work on the unit has
//! ended. Nothing here edits.

use std::time::Duration;

use brushwork_link::device::{Event, Identity, Job, PinSignal, QueuedJob, Sample};
use brushwork_link::settings::{SettingsImage, SettingsTable, read_some};
use brushwork_mcp_client::diagnosis;
use brushwork_mcp_client::diagnosis::{PinEnd, Script};

use super::watched::Watched;

/// What the job is called while it runs.
const JOB: &str = "look what keeps the motors from running";
/// A serial line of 2400 bit/s takes most of it.
const LIMIT: Duration = Duration::from_secs(30);

/// What is known of one unit beyond its status word.
#[derive(Debug, Default)]
pub struct Watch {
    settings: Option<SettingsImage>,
    pins: Option<Vec<PinEnd>>,
    script: Script,
    wants_reading: bool,
    job: Watched<SettingsImage>,
}

impl Watch {
    pub fn settings(&self) -> Option<&SettingsImage> {
        self.settings.as_ref()
    }

    /// Where the input pins stand, while they are read.
    pub fn pins(&self) -> Option<&[PinEnd]> {
        self.pins.as_deref()
    }

    pub fn script(&self) -> Script {
        self.script
    }

    /// A script was started over this link, or was stopped.
    pub fn note_script(&mut self, script: Script) {
        self.script = script;
    }

    /// Another unit, or another link: nothing is known.
    pub fn forget(&mut self) {
        *self = Self { wants_reading: true, ..Self::default() };
    }

    /// What was read may have changed.
    pub fn want_reading(&mut self) {
        self.wants_reading = true;
    }

    /// Nothing of this unit is read for a diagnosis.
    pub fn want_nothing(&mut self) {
        self.wants_reading = false;
    }

    /// The job that reads what is wanted, if anything is.
    pub fn read(&mut self, identity: &Identity) -> Option<QueuedJob> {
        if !self.wants_reading || self.job.is_running() {
            return None;
        }
        self.wants_reading = false;
        let table = SettingsTable::new(identity.subject()?);
        let keys = diagnosis::keys(&table);
        self.job.begin(Job::new(JOB, LIMIT, move |context| Ok(read_some(context, &table, &keys)?.image)))
    }

    /// Whether it reads, or is about to.
    pub fn is_busy(&self) -> bool {
        self.wants_reading || self.job.is_running()
    }

    /// The job was not taken; it is made again later.
    pub fn not_begun(&mut self) {
        self.job.forget();
        self.wants_reading = true;
    }

    /// Takes in an event of its job.
    pub fn take(&mut self, event: Event) {
        if let Some((ticket, _)) = self.job.take(event) {
            self.settings = ticket.take().or(self.settings.take());
        }
    }

    /// Takes note of an event of the link.
    pub fn note(&mut self, event: &Event) {
        if let Event::Stopped(report) = event
            && report.confirmed()
        {
            self.script = Script::Stopped;
        }
    }

    /// Takes over where the input pins stand.
    pub fn note_sample(&mut self, sample: &Sample) {
        if !sample.signals.is_empty() {
            let end = |signal: &PinSignal| PinEnd::of_percent(signal.percent.into());
            self.pins = Some(sample.signals.iter().map(end).collect());
        }
    }

    /// Whether the pins have to be read: one of them can stop a motor.
    pub fn wants_signals(&self) -> bool {
        self.settings.as_ref().is_some_and(diagnosis::has_actions)
    }

    /// Whether each motor is homed or at a limit by an action of its pins; `None` where the pins are not known.
    pub fn homed(&self) -> Option<[bool; 2]> {
        let settings = self.settings.as_ref()?;
        if !diagnosis::has_actions(settings) {
            return Some([false; 2]);
        }
        Some(diagnosis::homed(settings, self.pins.as_deref()?))
    }
}

//! What the one sentence on Device Status is made of besides the status word: the settings that decide whether a motor runs,
//! the input pins, and what is known of the script.
//!
//! The settings are read by a short job when a unit is met, when Device Status opens and after other work on the unit has
//! ended. Nothing here edits.

use std::time::Duration;

use brushwork_link::device::{Event, FnJob, Identity, PinSignal, Request, Sample};
use brushwork_link::settings::{SettingsImage, SettingsTable, read_some};
use brushwork_mcp_client::diagnosis;
use brushwork_mcp_client::diagnosis::{PinEnd, Script};
use crossbeam_channel::{Receiver, bounded};

/// What the job is called while it runs.
pub const JOB: &str = "look what keeps the motors from running";
/// A serial line of 2400 bit/s takes most of it.
const LIMIT: Duration = Duration::from_secs(30);

/// What is known of one unit beyond its status word.
#[derive(Debug, Default)]
pub struct Watch {
    settings: Option<SettingsImage>,
    pins: Option<Vec<PinEnd>>,
    script: Script,
    wants_reading: bool,
    running: Option<Receiver<SettingsImage>>,
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
    pub fn read(&mut self, identity: &Identity) -> Option<Request> {
        if !self.wants_reading || self.running.is_some() {
            return None;
        }
        self.wants_reading = false;
        let table = SettingsTable::new(identity.subject()?);
        let keys = diagnosis::keys(&table);
        let (sender, result) = bounded(1);
        self.running = Some(result);
        Some(Request::Job(FnJob::boxed(JOB, LIMIT, move |context| {
            let report = read_some(context, &table, &keys)?;
            // Nobody waits for it when the link was closed meanwhile.
            let _ = sender.try_send(report.image);
            Ok(Box::new(()))
        })))
    }

    /// Whether it reads, or is about to.
    pub fn is_busy(&self) -> bool {
        self.wants_reading || self.running.is_some()
    }

    /// The request was not taken; it is made again later.
    pub fn not_begun(&mut self) {
        self.running = None;
        self.wants_reading = true;
    }

    /// Takes note of an event of the link. True where it is about the job of this module alone.
    pub fn note(&mut self, event: &Event) -> bool {
        match event {
            Event::JobStarted { name } => name == JOB,
            Event::JobEnded(report) if report.name == JOB => {
                let image = self.running.take().and_then(|result| result.try_recv().ok());
                self.settings = image.or(self.settings.take());
                true
            }
            // Whatever it was may have changed settings.
            Event::JobEnded(_) => {
                self.wants_reading = true;
                false
            }
            Event::Stopped(report) if report.confirmed() => {
                self.script = Script::Stopped;
                false
            }
            _ => false,
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

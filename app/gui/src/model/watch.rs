//! What the one sentence on Device Status is made of besides the status word and the unit's settings: the input pins, and what is
//! known of the script. Nothing here edits.

use brushwork_link::device::{Event, PinSignal, Sample};

use super::settings::UnitSettings;
use crate::family::Family;

/// What is known of one unit beyond its status word and its settings.
#[derive(Debug, Default)]
pub struct Watch {
    pins: Option<Vec<PinSignal>>,
    /// Whether a script was started, or was stopped, over this link; no command tells whether one runs.
    pub script_runs: Option<bool>,
    /// The settings that it goes by.
    keys: Vec<String>,
    /// The revision of the settings that was looked at last.
    seen: Option<u64>,
}

impl Watch {
    /// Where the input pins stand, while they are read.
    pub fn pins(&self) -> Option<&[PinSignal]> {
        self.pins.as_deref()
    }

    /// A script was started over this link, or was stopped.
    pub fn note_script(&mut self, runs: bool) {
        self.script_runs = Some(runs);
    }

    /// Another unit, or another link: nothing is known.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The settings that it goes by; none of a family that is not diagnosed.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Looks at the settings, if they have changed; true then.
    pub fn see(&mut self, family: &dyn Family, unit: Option<&UnitSettings>) -> bool {
        let revision = unit.map(UnitSettings::revision);
        if self.seen == revision {
            return false;
        }
        self.seen = revision;
        self.keys = unit.map(|unit| family.diagnosis_keys(unit.table())).unwrap_or_default();
        true
    }

    /// Takes note of an event of the link.
    pub fn note(&mut self, event: &Event) {
        if let Event::Stopped(report) = event
            && report.confirmed()
        {
            self.script_runs = Some(false);
        }
    }

    /// Takes over where the input pins stand.
    pub fn note_sample(&mut self, sample: &Sample) {
        if !sample.signals.is_empty() {
            self.pins = Some(sample.signals.clone());
        }
    }
}

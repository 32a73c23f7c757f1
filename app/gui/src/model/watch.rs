//! What the one sentence on Device Status is made of besides the status word and the unit's settings: the input pins, and what is
//! known of the script. Nothing here edits.

use brushwork_link::device::{Event, PinSignal, Sample};
use brushwork_link::settings::SettingsImage;
use brushwork_mcp_client::diagnosis;
use brushwork_mcp_client::diagnosis::{PinEnd, Script};

use super::settings::UnitSettings;

/// What is known of one unit beyond its status word and its settings.
#[derive(Debug, Default)]
pub struct Watch {
    pins: Option<Vec<PinEnd>>,
    script: Script,
    /// The settings that it goes by.
    keys: Vec<String>,
    /// The revision of the settings that was looked at last.
    seen: Option<u64>,
}

impl Watch {
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
        *self = Self::default();
    }

    /// The settings that it goes by; none of a family that is not diagnosed.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Looks at the settings, if they have changed; true then.
    pub fn see(&mut self, unit: Option<&UnitSettings>) -> bool {
        let revision = unit.map(UnitSettings::revision);
        if self.seen == revision {
            return false;
        }
        self.seen = revision;
        self.keys = unit.map(|unit| diagnosis::keys(unit.table())).unwrap_or_default();
        true
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

    /// Whether each motor is homed or at a limit by an action of its pins, as the settings say; `None` where the pins are not known.
    pub fn homed(&self, settings: &SettingsImage) -> Option<[bool; 2]> {
        if !diagnosis::has_actions(settings) {
            return Some([false; 2]);
        }
        Some(diagnosis::homed(settings, self.pins.as_deref()?))
    }
}

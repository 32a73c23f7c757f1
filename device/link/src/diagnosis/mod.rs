//! Why the motors do not run, in one sentence with its cure: shared by the window and the command line.
//!
//! It judges what was read elsewhere ([`Evidence`]) and sends nothing. The findings come in the order in which a person
//! would mend them: what stops everything first, then what stops one kind of motion.

mod configured;
mod pins;
mod reported;
#[cfg(test)]
mod tests;

pub use configured::keys;
pub use pins::{PinEnd, has_actions, homed, pin_ends};

use crate::device::{Channel, Identity, StatusReport};
use crate::settings::SettingsImage;
use crate::transport::Stream;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;
use brushwork_mcp_wire::packet_serial::status::Conditions;
use serde::Serialize;

/// How much a finding keeps the motors from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hindrance {
    /// The motors still run, perhaps with less.
    Limits,
    /// One kind of command, or one motor, does not run.
    BlocksSome,
    /// No command moves them.
    BlocksAll,
}

/// One reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// How much it keeps the motors from.
    pub hindrance: Hindrance,
    /// What is so: a clause without a full stop.
    pub what: String,
    /// What to do: a sentence without its full stop.
    pub cure: String,
}

/// All reasons, the gravest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The reasons; empty when nothing speaks against motion.
    pub findings: Vec<Finding>,
}

/// What is known of a unit. The more of it is there, the more can be found; what is missing is not guessed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence<'a> {
    /// What the status word says.
    pub conditions: Conditions,
    /// The model, for the names of its pins.
    pub model: Option<&'static Model>,
    /// The settings in the controller's RAM.
    pub settings: Option<&'a SettingsImage>,
    /// Where each input pin stands within its range (command 147).
    pub pins: Option<&'a [PinEnd]>,
    /// Which of the controller's streams is spoken to.
    pub stream: Option<Stream>,
    /// What was measured.
    pub measured: Measured,
    /// What is known of its script.
    pub script: Script,
}

/// Measured values that make a sentence exact; `None` for what was not read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Main battery.
    pub main_volts: Option<f64>,
    /// Logic battery.
    pub logic_volts: Option<f64>,
    /// Both temperatures.
    pub celsius: [Option<f64>; 2],
    /// Both motor currents.
    pub amps: [Option<f64>; 2],
}

/// What is known of the unit's script. No command of the protocol tells whether one runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Script {
    /// Nothing.
    #[default]
    NotKnown,
    /// It was started over this link.
    Started,
    /// It was stopped over this link.
    Stopped,
}

impl<'a> Evidence<'a> {
    /// What a unit's status says, without settings and pins.
    #[must_use]
    pub fn of(report: &StatusReport, identity: &Identity) -> Self {
        let model = identity.model.and_then(models::lookup);
        let model = model.or_else(|| models::identify(&identity.version_text));
        Self { conditions: report.conditions, model, ..Self::default() }
    }

    /// The number of an input pin and its name: "pin 7 (DIN7/AN7/P7/ENC1A)".
    fn pin_name(&self, index: usize) -> String {
        let named = self.model.and_then(|model| model.pins.get(index));
        named.map_or_else(|| format!("pin {}", index + 1), |pin| format!("pin {}", pin.name()))
    }
}

impl Measured {
    /// From the newest readings of a unit's channels.
    pub fn of(read: impl Fn(Channel) -> Option<f64>) -> Self {
        Self {
            main_volts: read(Channel::MainBattery),
            logic_volts: read(Channel::LogicBattery),
            celsius: [Channel::Temperature1, Channel::Temperature2].map(&read),
            amps: [Channel::M1Current, Channel::M2Current].map(&read),
        }
    }
}

impl Diagnosis {
    /// The one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Some(first) = self.findings.first() else {
            return "Nothing that can be read keeps the motors from running: arm a screen and drive them."
                .to_owned();
        };
        let effect = match first.hindrance {
            Hindrance::BlocksAll => "The motors do not run",
            Hindrance::BlocksSome => "Some commands do not move the motors",
            Hindrance::Limits => "The motors run with limits",
        };
        let more = match self.findings.len() - 1 {
            0 => String::new(),
            1 => " (and 1 more reason)".to_owned(),
            others => format!(" (and {others} more reasons)"),
        };
        format!("{effect}: {}{more}. {}.", first.what, first.cure)
    }
}

/// Judges all that is known of a unit.
#[must_use]
pub fn diagnose(evidence: &Evidence<'_>) -> Diagnosis {
    let mut findings: Vec<Finding> =
        evidence.conditions.iter().filter_map(|condition| reported::of(condition, evidence)).collect();
    findings.extend(pins::findings(evidence));
    findings.extend(configured::findings(evidence));
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.hindrance));
    Diagnosis { findings }
}

fn finding(hindrance: Hindrance, what: impl Into<String>, cure: impl Into<String>) -> Finding {
    Finding { hindrance, what: what.into(), cure: cure.into() }
}

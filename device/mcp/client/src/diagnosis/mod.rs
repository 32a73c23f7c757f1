//! Why the motors do not run, in one sentence with its cure: shared by the window and the command line.
//!
//! It judges what was read elsewhere ([`Evidence`]) and sends nothing. The findings come in the order in which a person
//! would remedy them: what stops everything first, then what stops one kind of motion.

mod configured;
mod evidence;
mod finding;
mod pin_end;
mod pins;
mod reported;
#[cfg(test)]
mod tests;

pub use configured::keys;
pub use evidence::{Evidence, Measured, Script};
pub use finding::{Finding, Hindrance};
pub use pin_end::{PinEnd, pin_ends};
pub use pins::{has_actions, homed};

use crate::messages::DiagnosisMessage;
use brushwork_link::Message;
use brushwork_link::device::StatusReport;
use serde::Serialize;

/// All reasons, the gravest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The reasons; empty when nothing speaks against motion.
    pub findings: Vec<Finding>,
}

impl Diagnosis {
    /// The one sentence.
    #[must_use]
    pub fn sentence(&self) -> Message {
        let Some(Finding { hindrance, what, cure }) = self.findings.first().cloned() else {
            return DiagnosisMessage::NothingFound.into();
        };
        let effect = match hindrance {
            Hindrance::BlocksAll => DiagnosisMessage::NoneRun,
            Hindrance::BlocksSome => DiagnosisMessage::SomeDoNotMove,
            Hindrance::Limits => DiagnosisMessage::Limited,
        };
        let more = match self.findings.len() - 1 {
            0 => Message::default(),
            1 => DiagnosisMessage::OneMore.into(),
            others => DiagnosisMessage::SomeMore { others }.into(),
        };
        DiagnosisMessage::Because { effect: effect.into(), what, more, cure }.into()
    }
}

/// Judges all that is known of a unit.
#[must_use]
pub fn diagnose(evidence: &Evidence<'_>) -> Diagnosis {
    let active = evidence.status.into_iter().flat_map(StatusReport::active);
    let mut findings: Vec<Finding> =
        active.filter_map(|indicator| reported::of(indicator, evidence)).collect();
    findings.extend(pins::findings(evidence));
    findings.extend(configured::findings(evidence));
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.hindrance));
    Diagnosis { findings }
}

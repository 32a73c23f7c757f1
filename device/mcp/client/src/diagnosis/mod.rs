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
    let active = evidence.status.into_iter().flat_map(StatusReport::active);
    let mut findings: Vec<Finding> =
        active.filter_map(|indicator| reported::of(indicator, evidence)).collect();
    findings.extend(pins::findings(evidence));
    findings.extend(configured::findings(evidence));
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.hindrance));
    Diagnosis { findings }
}

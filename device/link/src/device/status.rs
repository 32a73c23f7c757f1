//! A controller's status in terms that all families share.

use serde::Serialize;
use std::time::Duration;

/// What a status word says at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatusReport {
    /// The unit.
    pub address: u8,
    /// Host time of the reply.
    pub at: Duration,
    /// The word as it came.
    pub word: u32,
    /// What is set in it, in the order of the family's table.
    pub conditions: Vec<Condition>,
}

/// One thing that a status word can say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Condition {
    /// Name for files: snake_case.
    pub key: &'static str,
    /// Name for people.
    pub text: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The lamp it lights, by its Ion Studio abbreviation: "M1OC".
    pub lamp: Option<&'static str>,
}

/// How bad a condition is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The controller still drives, perhaps with less.
    Warning,
    /// The controller stops motors for it. Disarms.
    Fault,
}

impl StatusReport {
    /// The conditions for which motors are stopped.
    pub fn faults(&self) -> impl Iterator<Item = &Condition> {
        self.conditions.iter().filter(|condition| condition.severity == Severity::Fault)
    }

    /// Whether a lamp is lit.
    #[must_use]
    pub fn is_lit(&self, lamp: &str) -> bool {
        self.conditions.iter().any(|condition| condition.lamp == Some(lamp))
    }
}

//! One status lamp of a controller: its name and what it says.

use brushwork_values::Severity;

/// One status lamp.
#[derive(Debug, PartialEq, Eq)]
pub struct LampInfo {
    /// A few letters, for the bottom of the window. Each lamp of a family has its own.
    pub short: &'static str,
    /// In full.
    pub title: &'static str,
}

/// What a lamp says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum LampState {
    /// Nothing is known: no controller, or it was not asked yet.
    #[default]
    Unknown,
    /// The connected controller cannot tell.
    NotApplicable,
    Ok,
    /// Something is so that is neither good nor bad, such as a closed limit switch.
    Active,
    Warning,
    Error,
}

impl LampState {
    pub const fn word(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::NotApplicable => "not reported",
            Self::Ok => "OK",
            Self::Active => "active",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// How an indicator of this severity is shown.
pub const fn state_of(severity: Severity) -> LampState {
    match severity {
        Severity::Signal => LampState::Active,
        Severity::Warning => LampState::Warning,
        Severity::Error => LampState::Error,
    }
}

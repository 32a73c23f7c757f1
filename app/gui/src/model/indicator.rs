//! One status indicator of a controller: its name and what it says.

use brushwork_values::Severity;

/// One status indicator.
#[derive(Debug, PartialEq, Eq)]
pub struct IndicatorInfo {
    /// A few letters, for the bottom of the window. Each indicator of a family has its own.
    pub short: &'static str,
    /// In full.
    pub title: &'static str,
}

/// What an indicator says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum IndicatorState {
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

impl IndicatorState {
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
pub const fn state_of(severity: Severity) -> IndicatorState {
    match severity {
        Severity::Signal => IndicatorState::Active,
        Severity::Warning => IndicatorState::Warning,
        Severity::Error => IndicatorState::Error,
    }
}

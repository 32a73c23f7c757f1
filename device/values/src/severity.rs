//! How grave it is what a controller reports.

use serde::Serialize;

/// How grave a state is that a controller reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// A state that is neither good nor bad, such as a home switch.
    Signal,
    /// The unit goes on, perhaps with less output.
    Warning,
    /// The unit has stopped one motor or both.
    Error,
}

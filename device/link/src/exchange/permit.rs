//! What may go out at this moment, and what comes back.

use super::request::Span;
use brushwork_values::Values;

/// What may go out at this moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Permit {
    /// Commands that drive motors: a screen for them is armed.
    pub motion: bool,
    /// Starting a script: a screen for scripts is armed.
    pub script: bool,
    /// Layouts that are guesses: the controller is simulated.
    pub guesses: bool,
    /// Leaving the protocol for the firmware loader: the user has accepted the risk.
    pub loader: bool,
}

/// A reply with the host times of its exchange.
#[derive(Clone, Debug, PartialEq)]
pub struct Reply<V = Values> {
    /// What came back; empty for an acknowledgement.
    pub values: V,
    /// When it was asked and when it was answered.
    pub span: Span,
}

//! One reason why motors do not run, with its cure.

use crate::messages::CureMessage;
use brushwork_link::Message;
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
    pub what: Message,
    /// What to do: a sentence without its full stop.
    pub cure: Message,
}

pub(super) fn finding(hindrance: Hindrance, what: impl Into<Message>, cure: CureMessage) -> Finding {
    Finding { hindrance, what: what.into(), cure: cure.into() }
}

//! What became of some work on settings.

use crate::model::message::Gravity;
use brushwork_link::Message;

/// What became of some work, for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    pub gravity: Gravity,
    pub summary: Message,
    /// More than fits the message line.
    pub sentences: Vec<Message>,
    /// Where the unit answers now, if the work can have changed that.
    pub address: Option<u8>,
}

impl Summary {
    pub fn note(summary: impl Into<Message>) -> Self {
        Self { gravity: Gravity::Note, summary: summary.into(), sentences: Vec::new(), address: None }
    }

    /// For the message line alone.
    pub(super) fn said(self) -> Vec<(Gravity, Message)> {
        vec![(self.gravity, self.summary)]
    }
}

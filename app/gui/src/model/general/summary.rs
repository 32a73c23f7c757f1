//! What became of some work on settings.

use crate::model::message::Gravity;

/// What became of some work, for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Summary {
    pub gravity: Gravity,
    pub summary: String,
    /// More than fits the message line.
    pub sentences: Vec<String>,
    /// Where the unit answers now, if the work can have changed that.
    pub address: Option<u8>,
}

impl Summary {
    pub fn note(summary: String) -> Self {
        Self { gravity: Gravity::Note, summary, sentences: Vec::new(), address: None }
    }
}

/// "1 setting", "7 settings".
pub(super) fn settings(count: usize) -> String {
    if count == 1 { "1 setting".to_owned() } else { format!("{count} settings") }
}

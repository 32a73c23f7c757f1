//! A failure as it is shown to the user: what was tried, on what, what came back, what to do.
//!
//! The typed errors of the layers below stay what programs match on; this is their last form.

use brushwork_values::Message;
use serde::Serialize;
use std::fmt;

/// One failure as a sentence, kept in its parts so that a window can lay them out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Failure {
    /// What was tried, as a bare verb phrase: "read the firmware version".
    pub tried: Message,
    /// On what: "0x80 at /dev/ttyACM0". Empty when the phrase says it already.
    pub on: String,
    /// What came back, without a full stop: "no answer within 60 ms (3 tries)".
    pub came_back: Message,
    /// What to do, a sentence without its full stop. Empty when there is nothing to do.
    pub remedy: Message,
}

impl Failure {
    /// A failure from its four parts.
    pub fn new(
        tried: impl Into<Message>,
        on: impl Into<String>,
        came_back: impl Into<Message>,
        remedy: impl Into<Message>,
    ) -> Self {
        Self { tried: tried.into(), on: on.into(), came_back: came_back.into(), remedy: remedy.into() }
    }
}

impl Failure {
    /// The failure as one sentence among others.
    #[must_use]
    pub fn message(&self) -> Message {
        Message::error(self.clone())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Could not {}", self.tried)?;
        if !self.on.is_empty() {
            write!(f, " on {}", self.on)?;
        }
        write!(f, ": {}.", self.came_back)?;
        if !self.remedy.is_empty() {
            write!(f, " {}.", self.remedy)?;
        }
        Ok(())
    }
}

impl std::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::{ActMessage, CauseMessage, RemedyMessage};

    #[test]
    fn a_failure_reads_as_a_sentence_with_all_four_parts() {
        let failure =
            Failure::new(ActMessage::Move, "0x80 at COM3", CauseMessage::NoAnswer, RemedyMessage::TryAgain);
        assert_eq!(failure.to_string(), "Could not move the motors on 0x80 at COM3: no answer. Try again.");
    }

    #[test]
    fn parts_that_are_empty_leave_no_trace() {
        let failure = Failure::new(ActMessage::ListPorts, "", CauseMessage::NoAnswer, Message::default());
        assert_eq!(failure.to_string(), "Could not list the serial ports: no answer.");
    }
}

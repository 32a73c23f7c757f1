//! Why a transfer broke, and in which state that leaves the controller.

use crate::messages::{McpActMessage, McpRemedyMessage};
use brushwork_link::failure::Failure;
use brushwork_link::transport::TransportError;
use brushwork_values::{Words, error_key};
use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

/// In which state a controller is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// Its firmware is untouched; a restart brings it back.
    Untouched,
    /// It may be erasing, or have erased, its flash memory.
    PerhapsErasing,
    /// It has no firmware and waits for it in its loader.
    WithoutFirmware,
    /// It has the whole image; only its restart may be missing.
    Complete,
}

impl Left {
    /// What the user should do, as sentences without the last full stop.
    #[must_use]
    pub fn remedy(self) -> McpRemedyMessage {
        match self {
            Self::Untouched => McpRemedyMessage::Untouched,
            Self::PerhapsErasing => McpRemedyMessage::PerhapsErasing,
            Self::WithoutFirmware => McpRemedyMessage::WithoutFirmware,
            Self::Complete => McpRemedyMessage::Complete,
        }
    }
}

/// Why an image did not get to its end.
#[derive(Clone, Debug, thiserror::Error)]
pub enum SendError {
    /// It was cancelled before anything was erased.
    #[error("it was cancelled before anything was erased")]
    Cancelled,
    /// The greeting was not answered.
    #[error("the loader did not answer the greeting within {} s", waited.as_secs())]
    NoGreeting {
        /// How long it was waited for.
        waited: Duration,
    },
    /// A page was not answered: a byte of it, or its answer, was lost.
    #[error("page {} of {of} was not confirmed within {} ms", page + 1, waited.as_millis())]
    PageLost {
        /// Which, counted from 0.
        page: usize,
        /// How many there are.
        of: usize,
        /// How long it was waited for.
        waited: Duration,
    },
    /// A page was answered with something else.
    #[error("page {} of {of} was answered with 0x{got:02X} instead of 0xAA", page + 1)]
    PageRefused {
        /// Which, counted from 0.
        page: usize,
        /// How many there are.
        of: usize,
        /// What came back.
        got: u8,
    },
    /// The line is gone.
    #[error("the line was lost")]
    Line {
        /// In which state that leaves the controller.
        left: Left,
        /// What the port said.
        #[source]
        source: TransportError,
    },
}

impl SendError {
    /// In which state the controller is left.
    #[must_use]
    pub fn left(&self) -> Left {
        match self {
            Self::Cancelled => Left::Untouched,
            Self::NoGreeting { .. } => Left::PerhapsErasing,
            Self::PageLost { .. } | Self::PageRefused { .. } => Left::WithoutFirmware,
            Self::Line { left, .. } => *left,
        }
    }

    /// The failure as it is shown.
    #[must_use]
    pub fn failure(&self, on: impl Into<String>) -> Failure {
        let came_back = WithCauses(self.clone());
        Failure::new(McpActMessage::SendFirmware, on, came_back, self.left().remedy())
    }

    fn full(&self) -> String {
        match self {
            Self::Line { source, .. } => format!("{self}: {}", source.full()),
            Self::Cancelled | Self::NoGreeting { .. } | Self::PageLost { .. } | Self::PageRefused { .. } => {
                self.to_string()
            }
        }
    }
}

#[derive(Debug)]
struct WithCauses(SendError);

impl fmt::Display for WithCauses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.full())
    }
}

impl Words for WithCauses {
    fn key(&self) -> Cow<'static, str> {
        error_key(&self.0).into()
    }
}

//! The traffic panel's state: what went over the wire, a composer for one command, and the bytes that wait to be sent.

mod kept;
mod log;
pub mod pending;

pub use kept::{KeptCommand, Transact};
pub use log::{Filter, Log, MOST, MOST_BYTES, Outcome, Transaction};

use std::path::Path;

use brushwork_link::device::Event;
use brushwork_link::files::{replace_file, write_new_file};

use crate::files::FileDialog;
use crate::messages::TrafficMessage;

/// What the panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    #[default]
    Log,
    Composer,
    Pending,
}

/// The state of the panel.
#[derive(Debug, Default)]
pub struct Traffic {
    /// Whether the panel is shown; traffic is recorded while it is.
    pub open: bool,
    pub tab: Tab,
    pub log: Log,
    /// A command that changes settings and waits for their backup.
    pub kept: KeptCommand,
    /// The name that was typed for a file, while one is asked for.
    pub saving: Option<String>,
    /// The name that the desktop's dialog gave, which has asked before another file is replaced.
    pub asked_about: Option<String>,
    pub dialog: Option<FileDialog>,
}

impl Traffic {
    /// Takes note of an event of the link.
    pub fn note(&mut self, event: &Event) {
        if let Event::Traffic { traffic, text, sound } = event {
            self.log.take(traffic, text, *sound);
        } else if let Event::Transacted { id, result } = event {
            self.kept.answered(*id, result);
        }
    }

    /// The link is gone: a request that waits for its answer waits for nothing.
    pub fn link_ended(&mut self) {
        self.log.link_ended();
        self.kept.forget();
    }

    /// Writes what the filter lets through to a file, a new one unless the dialog has asked about it; what became of it, as a sentence.
    pub fn save(&self, path: &Path) -> Result<TrafficMessage, TrafficMessage> {
        let text = self.log.to_text();
        let lines = self.log.shown_len();
        let shown = path.display().to_string();
        let write = if self.asked_about.as_ref() == Some(&shown) { replace_file } else { write_new_file };
        match write(path, text.as_bytes()) {
            Ok(()) if lines == 1 => Ok(TrafficMessage::SavedOne { path: shown }),
            Ok(()) => Ok(TrafficMessage::Saved { count: lines, path: shown }),
            Err(error) => Err(TrafficMessage::NotSaved { path: shown, error: error.to_string() }),
        }
    }
}

//! The traffic panel's state: what went over the wire, a composer for one command, and the bytes that wait to be sent.

mod kept;
mod log;
pub mod pending;

pub use kept::{KeptCommand, Transact};
pub use log::{Filter, Log, MOST, MOST_BYTES, Outcome, Transaction};

use std::path::Path;

use brushwork_link::device::Event;
use brushwork_link::files::write_new_file;

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

    /// Writes what the filter lets through to a new file; what became of it, as a sentence.
    pub fn save(&self, path: &Path) -> Result<TrafficMessage, TrafficMessage> {
        let text = self.log.to_text();
        let lines = self.log.shown_len();
        let shown = path.display().to_string();
        match write_new_file(path, text.as_bytes()) {
            Ok(()) => Ok(TrafficMessage::Saved { count: lines, path: shown }),
            Err(error) => Err(TrafficMessage::NotSaved { path: shown, error: error.to_string() }),
        }
    }
}

//! What a unit's script does, where a unit can run one.

use serde::Serialize;

/// What a unit's script does, for panels and tests. No command of the protocol tells it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ScriptView {
    /// What the script memory holds.
    pub holds: Content,
    /// Whether a script runs.
    pub run: ScriptRun,
    /// Whether the debugger holds it where it is. For its controller it runs.
    pub is_paused: bool,
}

/// How far a script is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "state", rename_all = "snake_case")]
pub enum ScriptRun {
    /// None was started since power-up.
    Idle,
    /// It runs.
    Running {
        /// The line it stands on: that of a PAUSE while it waits there, else the one that comes next.
        line: u32,
    },
    /// END, or the end of its text.
    Ended {
        /// The line it ended on.
        line: u32,
    },
    /// It was stopped by a command, a pin or a new image.
    Stopped {
        /// The line it was on.
        line: u32,
    },
    /// Something went wrong in it.
    Faulted {
        /// The line it was on.
        line: u32,
        /// What went wrong.
        what: String,
    },
}

impl ScriptRun {
    /// Whether it runs.
    #[must_use]
    pub fn is_running(&self) -> bool {
        matches!(self, Self::Running { .. })
    }
}

/// What the script memory holds, by its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Content {
    /// It is erased.
    Nothing,
    /// An image of this project's own format, which simulated controllers run.
    Own,
    /// Anything else, such as an image for a real controller.
    Foreign,
}

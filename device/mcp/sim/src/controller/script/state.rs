//! A stored script that starts, runs and stops.

use super::i2c::I2cMaster;
use super::memory::ScriptMemory;
use super::sending::SendTimes;
use super::streams::Streams;
use brushwork_plant::world::{Content, ScriptRun, ScriptView};
use brushwork_script::debug::{Debugger, StopCause};
use brushwork_script::image::{self, ImageError};
use brushwork_script::vm::{Machine, State};
use std::sync::Arc;
use std::time::Duration;

/// Autorun delays below this switch autorun off (MCP manual, command 246).
pub const MIN_AUTORUN_MS: u32 = 100;

/// The script's state in RAM.
#[derive(Clone, Debug, Default)]
pub struct ScriptState {
    /// Kept after its end, to be looked at.
    pub(super) machine: Option<Machine>,
    /// How far the script has run, in time since power-up.
    pub(super) clock: Duration,
    pub(super) stopped: bool,
    /// What stopped it.
    pub stopped_by: Option<StopCause>,
    /// It was started, and the debugger was not told yet.
    pub is_fresh: bool,
    autorun_done: bool,
    /// Bytes for GETS.
    pub streams: Streams,
    /// What is on its way out.
    pub sending: SendTimes,
    /// The I2C bus as its master sees it.
    pub i2c: I2cMaster,
    /// Motors whose last command came from the script.
    pub drives: [bool; 2],
    /// Time-out of the CAN stream, which has no setting of its own.
    pub can_timeout_ms: u32,
}

/// Why a script was not started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StartRefused {
    /// Nothing is stored.
    #[error("no script is stored")]
    Nothing,
    /// What is stored is no image that this machine runs.
    #[error(transparent)]
    Image(#[from] ImageError),
}

impl ScriptState {
    /// Whether a script runs.
    pub fn is_running(&self) -> bool {
        let over = |machine: &Machine| matches!(machine.state(), State::Ended | State::Faulted(_));
        !self.stopped && self.machine.as_ref().is_some_and(|machine| !over(machine))
    }

    /// The script that runs or ran last.
    pub fn machine(&self) -> Option<&Machine> {
        self.machine.as_ref()
    }

    /// How far it is.
    pub fn view(&self, memory: &ScriptMemory, debugger: &Debugger) -> ScriptView {
        let is_paused = self.is_running() && debugger.is_paused();
        ScriptView { holds: memory.content(), run: self.run_view(debugger), is_paused }
    }

    /// Starts the stored image from its beginning. Assumed: a script that runs already goes on, since there is an action of its own that
    /// resets it (MCP manual 1.9.8).
    pub fn start(&mut self, memory: &ScriptMemory, up_for: Duration) -> Result<(), StartRefused> {
        if self.is_running() { Ok(()) } else { self.restart(memory, up_for) }
    }

    /// Starts the stored image from its beginning, whatever runs now.
    pub fn restart(&mut self, memory: &ScriptMemory, up_for: Duration) -> Result<(), StartRefused> {
        self.stop();
        if memory.content() == Content::Nothing {
            return Err(StartRefused::Nothing);
        }
        let program = image::decode(memory.image())?;
        self.machine = Some(Machine::new(Arc::new(program)));
        self.clock = up_for;
        self.stopped = false;
        self.stopped_by = None;
        self.is_fresh = true;
        self.streams.clear();
        self.i2c = I2cMaster::default();
        Ok(())
    }

    /// Stops the script; it does not start by itself any more until the next power-up. Assumed: motors go on as they were told.
    pub fn stop(&mut self) {
        if self.is_running() {
            self.stopped = true;
            self.stopped_by = Some(StopCause::Command);
        }
        self.autorun_done = true;
        self.drives = [false; 2];
    }

    /// Stops the script for another reason than a command.
    pub fn stop_for(&mut self, cause: StopCause) {
        let was_running = self.is_running();
        self.stop();
        if was_running {
            self.stopped_by = Some(cause);
        }
    }

    /// Starts the image once, when the autorun delay after power-up has passed.
    pub fn autorun(&mut self, delay_ms: u32, up_for: Duration, memory: &ScriptMemory) {
        let due = up_for >= Duration::from_millis(delay_ms.into());
        if !self.autorun_done && delay_ms >= MIN_AUTORUN_MS && due {
            self.autorun_done = true;
            // There is nobody to tell; the unit simply runs none.
            let _ = self.start(memory, up_for);
        }
    }

    fn run_view(&self, debugger: &Debugger) -> ScriptRun {
        let Some(machine) = &self.machine else {
            return ScriptRun::Idle;
        };
        let line = debugger.line_of(machine);
        match machine.state() {
            State::Ended => ScriptRun::Ended { line },
            State::Faulted(fault) => ScriptRun::Faulted { line: fault.line, what: fault.kind.to_string() },
            _ if self.stopped => ScriptRun::Stopped { line },
            State::Ready | State::Pausing { .. } | State::Listening { .. } => ScriptRun::Running { line },
        }
    }
}

//! The debugger of a board's program, past the wire: what it is asked for, and what it shows.

use super::unit::Motorvator;
use brushwork_plant::world::{Content, ScriptRun, ScriptView};
use brushwork_script::debug::{Reason, Request, StopCause, View, Wanted};
use brushwork_script::vm::State;

impl Motorvator {
    /// Asks the debugger for things, one after the other, and looks at the program.
    pub fn debug(&mut self, requests: Vec<Request>, wanted: &Wanted) -> View {
        let Self { debugger, machine, hardware, .. } = self;
        for request in requests {
            debugger.ask(request, machine.as_mut(), hardware);
        }
        debugger.view(machine.as_mut(), hardware, wanted)
    }

    /// The same without power: there is nothing to look at.
    pub fn debug_without_power(&mut self, requests: Vec<Request>) -> View {
        requests.into_iter().for_each(|request| self.debugger.ask_alone(request, None));
        self.debugger.stopped(StopCause::PowerLost);
        View { now: self.now(), reason: Reason::Stopped(StopCause::PowerLost), ..View::default() }
    }

    /// Whether the debugger holds the program, and what it drives with it.
    #[must_use]
    pub fn is_frozen(&self) -> bool {
        self.debugger.holds_world() && self.is_running()
    }

    /// What the program does, for a panel.
    #[must_use]
    pub fn script_view(&self) -> ScriptView {
        let run = match &self.machine {
            None => ScriptRun::Idle,
            Some(machine) => {
                let line = self.debugger.line_of(machine);
                match machine.state() {
                    State::Ended => ScriptRun::Ended { line },
                    State::Faulted(fault) => ScriptRun::Faulted { line, what: fault.kind.to_string() },
                    State::Ready | State::Pausing { .. } | State::Listening { .. } => {
                        ScriptRun::Running { line }
                    }
                }
            }
        };
        let holds = if self.program.is_some() { Content::Own } else { Content::Nothing };
        ScriptView { holds, run, is_paused: self.debugger.is_paused() }
    }
}

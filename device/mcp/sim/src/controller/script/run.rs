//! Time for a script: how many instructions a second it runs, when it is due, and what waiting and sending cost.
//!
//! A script runs in slices. Within one its clock stands at the slice's beginning, so that what it does does not depend on how the
//! controller is advanced.

use super::super::Controller;
use super::streams::CAN;
use super::{ScriptHost, ScriptState};
use brushwork_script::debug::Debugger;
use brushwork_script::vm::{Host, Machine, State};
use std::time::Duration;

/// Time of one instruction of our byte code. Assumed: no source tells how fast scripts run; the processor has 160 MHz (MCP manual,
/// SYSCLK), and 1280 of its clocks for an instruction that is interpreted are a careful figure.
pub const INSTRUCTION_TIME: Duration = Duration::from_micros(8);
/// Instructions of a slice.
pub const SLICE_INSTRUCTIONS: u32 = 25;
/// How soon a script is looked at again that was due and did not run.
const IDLE_TIME: Duration = Duration::from_millis(1);

impl ScriptState {
    /// When the script wants to run next, in time since power-up; never while it waits for a byte that has not come.
    fn due_at(&self) -> Option<Duration> {
        if self.stopped {
            return None;
        }
        match self.machine.as_ref()?.state() {
            State::Ready => Some(self.clock),
            State::Pausing { until } => Some((*until).max(self.clock)),
            State::Listening { stream } => {
                let stream = *stream as usize;
                let came_at = self.streams.last_byte_at(stream).filter(|_| self.streams.count(stream) > 0)?;
                Some(came_at.max(self.clock))
            }
            State::Ended | State::Faulted(_) => None,
        }
    }

    fn listens_to(&self, stream: usize) -> bool {
        let state = self.machine.as_ref().map(Machine::state);
        !self.stopped
            && matches!(state, Some(State::Listening { stream: heard }) if *heard as usize == stream)
    }
}

impl Controller {
    /// Runs the script up to a moment of the machine's time.
    pub(crate) fn run_script(&mut self, to: Duration) {
        let Some(firmware) = &self.firmware else { return };
        if firmware.loader.is_some() || !firmware.script.is_running() {
            return;
        }
        let booted_at = firmware.booted_at;
        while let Some(at) = self.script_due_at().filter(|at| booted_at + *at <= to) {
            self.run_slice(at);
        }
    }

    /// When the script wants to run next, in time since power-up.
    fn script_due_at(&self) -> Option<Duration> {
        let firmware = self.firmware.as_ref()?;
        let over_can = || {
            let at = self.world.can_line.next_at()?.saturating_sub(firmware.booted_at);
            firmware.script.listens_to(CAN).then(|| at.max(firmware.script.clock))
        };
        firmware.script.due_at().or_else(over_can).or_else(|| self.debugger_due_at())
    }

    /// The debugger has given bytes to a stream that the script listens to.
    fn debugger_due_at(&self) -> Option<Duration> {
        let firmware = self.firmware.as_ref()?;
        let up_for = self.unit_now().saturating_sub(firmware.booted_at);
        match firmware.script.machine.as_ref()?.state() {
            State::Listening { stream } if !self.debugger.is_paused() && self.debugger.has_given(*stream) => {
                Some(up_for.max(firmware.script.clock))
            }
            State::Ready
            | State::Pausing { .. }
            | State::Listening { .. }
            | State::Ended
            | State::Faulted(_) => None,
        }
    }

    fn run_slice(&mut self, at: Duration) {
        if let Some(firmware) = &mut self.firmware {
            firmware.hear_can(&mut self.world, at);
            firmware.script.clock = firmware.script.clock.max(at);
        }
        let ran = self.with_host(at, |debugger, machine, host| {
            let machine = machine?;
            let before = machine.executed();
            debugger.run(machine, host, SLICE_INSTRUCTIONS);
            Some(machine.executed() - before)
        });
        let instructions = u32::try_from(ran.flatten().unwrap_or(0)).unwrap_or(u32::MAX);
        let Some(firmware) = &mut self.firmware else { return };
        // A slice in which nothing ran must still move the clock, or the controller would stand still.
        firmware.script.clock += if instructions == 0 { IDLE_TIME } else { INSTRUCTION_TIME * instructions };
        if !firmware.script.is_running() {
            firmware.script.drives = [false; 2];
        }
    }

    /// Lets somebody look at the script and reach what it reaches, now, with its debugger; `None` without power.
    pub fn with_script<T>(
        &mut self,
        look: impl FnOnce(&mut Debugger, Option<&mut Machine>, &mut dyn Host) -> T,
    ) -> Option<T> {
        let up_for = self.unit_now().saturating_sub(self.firmware.as_ref()?.booted_at);
        self.with_host(up_for, |debugger, machine, host| look(debugger, machine, host))
    }

    /// The script and its host at a time since power-up. What it sends is handed to the streams afterwards.
    fn with_host<T>(
        &mut self,
        up_for: Duration,
        act: impl FnOnce(&mut Debugger, Option<&mut Machine>, &mut ScriptHost<'_>) -> T,
    ) -> Option<T> {
        let firmware = self.firmware.as_mut()?;
        let mut machine = firmware.script.machine.take();
        tell(&mut self.debugger, machine.as_ref(), &mut firmware.script);
        let mut host = ScriptHost::new(firmware, &mut self.world, up_for);
        let done = act(&mut self.debugger, machine.as_mut(), &mut host);
        let said = host.finish();
        firmware.script.machine = machine;
        for (stream, bytes) in said {
            self.ports[stream.index()].say(&bytes);
        }
        Some(done)
    }
}

/// Tells the debugger of starts and stops since it was asked last.
fn tell(debugger: &mut Debugger, machine: Option<&Machine>, script: &mut ScriptState) {
    if let Some(machine) = machine.filter(|_| std::mem::take(&mut script.is_fresh)) {
        debugger.started(machine);
    }
    if let Some(cause) = script.stopped_by.take() {
        debugger.stopped(cause);
    }
}

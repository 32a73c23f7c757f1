//! What a debugger shows: one value that can be handed to another thread.

use super::breakpoint::BreakpointState;
use super::reason::{Reason, Wait};
use super::terminal::{Chunk, Tapped};
use super::value::Value;
use super::watch::Watch;
use super::{Debugger, takes};
use crate::mcl::registers::RegisterId;
use crate::op::Cell;
use crate::vm::{Host, Machine, State};
use std::sync::Arc;
use std::time::Duration;

/// What is to be shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wanted {
    /// Expressions. They are worked out only if the program is the one they were made for.
    pub watches: Arc<Vec<Result<Watch, String>>>,
    /// The code that the watches were made for ([`super::code_id`]).
    pub code: u64,
    /// Registers.
    pub registers: Arc<Vec<RegisterId>>,
    /// Output from this byte on.
    pub output_from: u64,
}

/// A register with its elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Which.
    pub id: RegisterId,
    /// Each element as a cell.
    pub cells: Vec<u32>,
}

/// An argument of a subroutine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Argument {
    /// The variable it was stored in, where that can be told.
    pub cell: Option<Cell>,
    /// What it was as the subroutine was called.
    pub value: u32,
}

/// A subroutine that has not returned, or the main program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The line it stands on.
    pub line: u32,
    /// Its first instruction.
    pub entered_at: u32,
    /// What it was given; none where it was called before anybody looked.
    pub arguments: Option<Vec<Argument>>,
}

/// A script as it is now.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Which code the script is of; 0 without one.
    pub code: u64,
    /// Time since power-up.
    pub now: Duration,
    /// Why it is where it is.
    pub reason: Reason,
    /// Whether it stands because of the debugger.
    pub is_paused: bool,
    /// Whether it runs or waits.
    pub is_running: bool,
    /// The line that comes next; 0 without a script.
    pub line: u32,
    /// Instructions run so far.
    pub executed: u64,
    /// The call stack, the innermost first; the main program is the last.
    pub frames: Vec<Frame>,
    /// The variables.
    pub memory: Vec<u8>,
    /// The registers that were wanted.
    pub registers: Vec<Readings>,
    /// The expressions that were wanted, in their order.
    pub watches: Vec<Result<Value, String>>,
    /// The breakpoints.
    pub breakpoints: Vec<BreakpointState>,
    /// How often each line was begun, by its number.
    pub counts: Vec<u64>,
    /// Output since the byte that was wanted.
    pub output: Vec<Chunk>,
    /// Bytes of output so far.
    pub output_count: u64,
    /// Given bytes that wait to be read.
    pub typed_waiting: usize,
    /// What became of the last thing that was set.
    pub answer: Option<(u64, Result<String, String>)>,
    /// Whether the world stands still now.
    pub world_frozen: bool,
}

impl View {
    /// Why the script is where it is.
    #[must_use]
    pub fn sentence(&self) -> String {
        self.reason.sentence(self.line, self.now)
    }
}

impl Debugger {
    /// The script as it is now.
    pub fn view<H: Host + ?Sized>(
        &mut self,
        machine: Option<&mut Machine>,
        host: &mut H,
        wanted: &Wanted,
    ) -> View {
        let mut view = View {
            now: host.now(),
            reason: self.reason.clone(),
            breakpoints: self.breakpoints.clone(),
            counts: self.counts.clone(),
            output: self.terminal.since(wanted.output_from),
            output_count: self.terminal.count(),
            typed_waiting: (0..8).map(|stream| self.terminal.waiting(stream)).sum(),
            answer: self.answer.clone(),
            ..View::default()
        };
        if let Some(machine) = machine.as_deref() {
            self.show_machine(machine, &mut view);
        }
        let host = &mut Tapped { host, terminal: &mut self.terminal };
        let read = |id: &RegisterId| Readings {
            id: *id,
            cells: (0..id.row().length)
                .map(|element| id.row().kind.keep(host.register(*id, element)))
                .collect(),
        };
        view.registers = wanted.registers.iter().map(read).collect();
        if let Some(machine) = machine.filter(|_| wanted.code == self.code) {
            view.watches = wanted.watches.iter().map(|watch| worked_out(watch, machine, host)).collect();
        }
        view
    }

    /// The line a script stands on.
    #[must_use]
    pub fn line_of(&self, machine: &Machine) -> u32 {
        // Held by the debugger it stands where that says, though the machine's own wait may be over.
        if self.is_paused() { line_of(machine, &self.reason) } else { machine.standing_line() }
    }

    fn show_machine(&self, machine: &Machine, view: &mut View) {
        view.code = self.code;
        view.executed = machine.executed();
        view.is_paused = self.is_paused();
        if !self.attached {
            view.reason = reason_of(machine, &self.reason);
        }
        view.line = line_of(machine, &view.reason);
        let was_ended = matches!(self.reason, Reason::Stopped(_) | Reason::NotStarted);
        view.is_running = !view.is_paused && !was_ended && !super::is_over(machine.state());
        view.world_frozen = self.holds_world();
        view.frames = frames(machine, view.line, &self.given);
        view.memory = machine.memory().bytes().to_vec();
    }
}

fn worked_out<H: Host + ?Sized>(
    watch: &Result<Watch, String>,
    machine: &mut Machine,
    host: &mut H,
) -> Result<Value, String> {
    match watch {
        Ok(watch) => watch.value(machine, host),
        Err(why) => Err(why.clone()),
    }
}

/// The line a script stands on. One that waits in PAUSE has that behind it already.
fn line_of(machine: &Machine, reason: &Reason) -> u32 {
    match reason {
        Reason::Waiting(Wait::Pause { .. } | Wait::Busy { .. })
        | Reason::Asked(Some(Wait::Pause { .. } | Wait::Busy { .. })) => machine.line_behind(),
        _ => machine.line(),
    }
}

/// What the machine alone tells.
pub(super) fn reason_of(machine: &Machine, known: &Reason) -> Reason {
    match machine.state() {
        _ if matches!(known, Reason::Stopped(_)) => known.clone(),
        State::Ended => Reason::Ended,
        State::Faulted(fault) => Reason::Faulted(fault.clone()),
        _ => super::waits(machine).map_or(Reason::Running, Reason::Waiting),
    }
}

fn frames(machine: &Machine, line: u32, given: &[Option<Vec<u32>>]) -> Vec<Frame> {
    let program = machine.program();
    let line_of = |at: u32| program.lines.get(at as usize).copied().unwrap_or(0);
    let mut line = line;
    let mut frames = Vec::new();
    for (depth, call) in machine.calls().iter().enumerate().rev() {
        let arguments = given.get(depth).and_then(Option::as_ref).map(|values| {
            let cells = takes(program, call.entered_at, values.len());
            cells.into_iter().zip(values).map(|(cell, value)| Argument { cell, value: *value }).collect()
        });
        frames.push(Frame { line, entered_at: call.entered_at, arguments });
        line = line_of(call.returns_to.saturating_sub(1));
    }
    frames.push(Frame { line, entered_at: 0, arguments: Some(Vec::new()) });
    frames
}

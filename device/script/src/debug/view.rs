//! Looks at a script for those who debug it.

use super::Debugger;
use super::reason::Reason;
use super::shown::{Argument, Frame, Readings, View, Wanted};
use super::standing::{is_over, line_of, reason_of};
use super::terminal::Tapped;
use super::value::Value;
use super::watch::Watch;
use crate::mcl::registers::RegisterId;
use crate::op::{Cell, Op};
use crate::program::Program;
use crate::vm::{Host, Machine};

impl Debugger {
    /// The script as it is now.
    pub fn view(&mut self, machine: Option<&mut Machine>, host: &mut dyn Host, wanted: &Wanted) -> View {
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
        view.is_running = !view.is_paused && !was_ended && !is_over(machine.state());
        view.world_frozen = self.holds_world();
        view.frames = frames(machine, view.line, &self.given);
        view.memory = machine.memory().bytes().to_vec();
    }
}

fn worked_out(
    watch: &Result<Watch, String>,
    machine: &mut Machine,
    host: &mut dyn Host,
) -> Result<Value, String> {
    match watch {
        Ok(watch) => watch.value(machine, host),
        Err(why) => Err(why.clone()),
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

/// Where a subroutine puts what it is given: it takes the last argument first.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn takes(program: &Program, entered_at: u32, count: usize) -> Vec<Option<Cell>> {
    let ops = program.ops.get(entered_at as usize..).unwrap_or_default();
    let stores = ops.iter().map_while(|op| match op {
        Op::Store(cell) => Some(Some(*cell)),
        _ => None,
    });
    let mut cells: Vec<_> = stores.take(count).collect();
    cells.resize(count, None);
    cells.reverse();
    cells
}

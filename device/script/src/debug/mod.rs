//! The debugger: runs a [`Machine`] for its host and stops it where a person wants to look. No clock, no IO, no thread; what it does to
//! a program is nothing but to let it wait.
//!
//! [`Debugger::run`] stands in place of [`Machine::run`]. While nobody debugs it is the same. A line is where a script stops: a step
//! ends, and a breakpoint lies, before the first instruction of a line. What stands here knows no names: a downloaded image may have
//! none. [`crate::names::Names`] has them, and makes the [`Watch`]es and [`Setting`]s that are asked for here.

mod breakpoint;
mod lines;
mod reason;
mod shown;
mod standing;
mod terminal;
mod value;
mod view;
mod watch;

pub use breakpoint::{Breakpoint, BreakpointState};
pub use lines::{LineTable, code_id};
pub use reason::{Reason, StepKind, StopCause, Wait};
pub use shown::{Argument, Frame, Readings, View, Wanted};
pub use terminal::{Chunk, Terminal};
pub use value::{Show, Value, one};
pub use watch::{Setting, Watch};

use crate::board::Board;
use crate::op::Op;
use crate::program::Program;
use crate::vm::{Host, Machine, State};
use breakpoint::Verdict;
use standing::{is_over, reason_of, waits};
use std::sync::Arc;
use terminal::Tapped;

/// What a debugger can be asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Whether anybody debugs: counts lines and listens to the streams from now on. Without, a paused script goes on.
    Attach(bool),
    /// These breakpoints and no others.
    Breakpoints(Vec<Breakpoint>),
    /// Goes on.
    Continue,
    /// Stops at the next line.
    Pause,
    /// Runs one line, and on until the step is finished.
    Step(StepKind),
    /// Goes on to this line, or the next one that has code.
    RunTo(u32),
    /// Whether the next start, and each one after it, stops before the first line.
    StopAtEntry(bool),
    /// Whether the world around the controller stands still while the script is paused.
    FreezeWorld(bool),
    /// Gives bytes to a stream, for GETS.
    Give {
        /// The stream.
        stream: u32,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// Sets a variable or a register of a script that does not run; the answer comes in the view with this number.
    Set {
        /// Chosen by whoever asks.
        id: u64,
        /// What is set to what.
        setting: Setting,
    },
    /// Begins to count lines from zero again.
    ClearCounts,
}

/// How a script that is not paused runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Mode {
    #[default]
    Free,
    /// To the next line, or the next one that is not deeper than `depth`.
    Step { kind: StepKind, depth: usize },
    /// To this line.
    To(u32),
    /// To the next line, since Pause was asked for.
    Stopping,
}

/// Watches over one script.
#[derive(Clone, Debug, Default)]
pub struct Debugger {
    attached: bool,
    stops_at_entry: bool,
    freezes_world: bool,
    breakpoints: Vec<BreakpointState>,
    mode: Mode,
    paused: bool,
    /// Whether anything was run since the script stood here last.
    moved: bool,
    reason: Reason,
    terminal: Terminal,
    answer: Option<(u64, Result<String, String>)>,
    program: Option<Arc<Program>>,
    code: u64,
    lines: LineTable,
    /// How often each line was begun, by its number.
    counts: Vec<u64>,
    /// Values that subroutines on the call stack were given; unknown to those that began before anybody looked.
    given: Vec<Option<Vec<u32>>>,
    /// What the machine had run when it was seen last.
    executed: u64,
}

impl Debugger {
    /// Runs at most `budget` instructions and says how far the machine is, as [`Machine::run`] does; none while the script is paused.
    pub fn run<'m, H: Host>(&mut self, machine: &'m mut Machine, host: &mut H, budget: u32) -> &'m State {
        if !self.attached {
            return machine.run(host, budget);
        }
        self.notice_start(machine);
        for _ in 0..budget {
            if !self.paused {
                self.let_events_in(machine, host);
            }
            if self.paused || self.stops_before(machine, host) || !self.step(machine, host) {
                break;
            }
        }
        self.executed = machine.executed();
        machine.state()
    }

    /// Whether the world is to stand still now.
    #[must_use]
    pub fn holds_world(&self) -> bool {
        self.attached && self.paused && self.freezes_world
    }

    /// Whether the script stands because of the debugger.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.attached && self.paused
    }

    /// Whether anybody debugs.
    #[must_use]
    pub fn is_attached(&self) -> bool {
        self.attached
    }

    /// Whether bytes that were given to a stream wait to be read.
    #[must_use]
    pub fn has_given(&self, stream: u32) -> bool {
        self.attached && self.terminal.waiting(stream) > 0
    }

    /// A script was started from its beginning.
    pub fn started(&mut self, machine: &Machine) {
        self.adopt(machine);
        self.terminal.forget_typed();
        self.mode = Mode::Free;
        self.paused = self.attached && self.stops_at_entry;
        self.moved = !self.paused;
        self.reason = if self.paused { Reason::Entry } else { Reason::Running };
    }

    /// Looks at a machine for the first time since it was started, or since anybody looked.
    fn adopt(&mut self, machine: &Machine) {
        if !self.program.as_ref().is_some_and(|program| Arc::ptr_eq(program, machine.program())) {
            self.program = Some(machine.program().clone());
            self.code = code_id(machine.program());
            self.lines = LineTable::of(machine.program());
        }
        self.counts = vec![0; self.lines.last() as usize + 1];
        self.given = vec![None; machine.calls().len()];
        self.executed = machine.executed();
        self.breakpoints.iter_mut().for_each(|breakpoint| breakpoint.settle(&self.lines));
    }

    /// A script was ended by something else than itself. It can be started again, not gone on with.
    pub fn stopped(&mut self, cause: StopCause) {
        self.paused = false;
        self.mode = Mode::Free;
        self.reason = Reason::Stopped(cause);
    }

    /// Does what was asked for; without a machine what concerns one is passed by.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn ask(&mut self, request: Request, machine: Option<&mut Machine>, host: &mut dyn Host) {
        match request {
            Request::Set { id, setting } => self.answer = Some((id, self.set(&setting, machine, host))),
            other => self.ask_alone(other, machine.as_deref()),
        }
    }

    /// The same where there is no host, as in a controller without power: nothing can be set then.
    pub fn ask_alone(&mut self, request: Request, machine: Option<&Machine>) {
        match request {
            Request::Attach(on) => self.attach(on, machine),
            Request::Breakpoints(wanted) => self.set_breakpoints(wanted),
            Request::StopAtEntry(on) => self.stops_at_entry = on,
            Request::FreezeWorld(on) => self.freezes_world = on,
            Request::Give { stream, bytes } => {
                self.terminal.give(stream, &bytes);
            }
            Request::ClearCounts => self.counts.fill(0),
            Request::Set { id, .. } => {
                self.answer = Some((id, Err("The controller has no power.".to_owned())));
            }
            Request::Continue => self.resume(Mode::Free),
            Request::RunTo(line) => {
                let line = self.lines.next_with_code(line);
                self.resume(line.map_or(Mode::Free, Mode::To));
            }
            Request::Step(kind) => {
                let depth = machine.map_or(0, |machine| machine.calls().len());
                self.resume(Mode::Step { kind, depth });
            }
            Request::Pause => self.pause(machine),
        }
    }

    fn attach(&mut self, on: bool, machine: Option<&Machine>) {
        if on == self.attached {
            return;
        }
        self.attached = on;
        self.paused = false;
        self.mode = Mode::Free;
        if let Some(machine) = machine.filter(|_| on) {
            self.adopt(machine);
            self.moved = true;
            self.reason = reason_of(machine, &self.reason);
        }
    }

    /// Keeps the hits of those that stay where they are.
    fn set_breakpoints(&mut self, wanted: Vec<Breakpoint>) {
        let old = std::mem::take(&mut self.breakpoints);
        self.breakpoints =
            wanted.into_iter().map(|wanted| BreakpointState::new(wanted, &self.lines)).collect();
        for breakpoint in &mut self.breakpoints {
            let before = old.iter().find(|old| old.wanted.line == breakpoint.wanted.line);
            breakpoint.hits = before.map_or(0, |before| before.hits);
        }
    }

    /// A script that runs already is not disturbed but for the next line at which it stops.
    fn resume(&mut self, mode: Mode) {
        if !self.paused {
            self.mode = if matches!(mode, Mode::Step { .. }) { Mode::Stopping } else { mode };
            return;
        }
        self.mode = mode;
        self.paused = false;
        self.reason = Reason::Running;
    }

    /// A script that waits is paused at once, any other before its next line.
    fn pause(&mut self, machine: Option<&Machine>) {
        let Some(machine) = machine.filter(|machine| !self.paused && !is_over(machine.state())) else {
            return;
        };
        match waits(machine) {
            Some(wait) => self.stand(Reason::Asked(Some(wait))),
            None => self.mode = Mode::Stopping,
        }
    }

    fn stand(&mut self, reason: Reason) {
        self.paused = true;
        // The line that follows a PAUSE has not been looked at yet.
        self.moved = matches!(
            reason,
            Reason::Asked(Some(Wait::Pause { .. } | Wait::Ticks { .. } | Wait::Busy { .. }))
        );
        self.mode = Mode::Free;
        self.reason = reason;
    }

    fn set(
        &mut self,
        setting: &Setting,
        machine: Option<&mut Machine>,
        host: &mut dyn Host,
    ) -> Result<String, String> {
        let machine = machine.ok_or_else(|| "There is no script: download and start one.".to_owned())?;
        if !self.paused && !is_over(machine.state()) {
            return Err(format!("`{}` cannot be set while the script runs: pause it first.", setting.place));
        }
        let value = setting.set(machine, host)?;
        Ok(format!("{} is {} now.", setting.place, value.text(Show::Decimal)))
    }

    /// A machine that went back to its beginning was started, even if nobody said so.
    fn notice_start(&mut self, machine: &Machine) {
        let is_known = self.program.as_ref().is_some_and(|known| Arc::ptr_eq(known, machine.program()));
        if !is_known || machine.executed() < self.executed {
            self.started(machine);
        }
    }

    /// An event calls its handler before anyone looks which line comes next.
    fn let_events_in(&mut self, machine: &mut Machine, host: &dyn Host) {
        let depth = machine.calls().len();
        if matches!(machine.state(), State::Ready | State::Pausing { .. }) {
            machine.settle(host);
        }
        self.moved |= machine.calls().len() != depth;
        self.follow_calls(depth, machine);
    }

    /// Whether the script is to stand where it is.
    fn stops_before(&mut self, machine: &mut Machine, host: &mut dyn Host) -> bool {
        let can_go_on = match machine.state() {
            State::Ready => true,
            State::Pausing { until } => host.now() >= *until,
            State::Listening { .. } | State::Ended | State::Faulted(_) => false,
        };
        if !self.moved || !can_go_on {
            return false;
        }
        if matches!(machine.program().ops.get(machine.at() as usize), Some(Op::Board(Board::Debug))) {
            self.stand(Reason::Statement(machine.line()));
            return true;
        }
        let Some(line) = self.lines.begins(machine.at()) else { return false };
        if let Some(reason) = self.verdict(line, machine, host).or_else(|| self.mode_ends(line, machine)) {
            self.stand(reason);
        }
        self.paused
    }

    /// What the breakpoint on a line says.
    fn verdict(&mut self, line: u32, machine: &mut Machine, host: &mut dyn Host) -> Option<Reason> {
        let breakpoint = self.breakpoints.iter_mut().find(|breakpoint| breakpoint.is_on(line))?;
        match breakpoint.reached(machine, host) {
            Verdict::GoOn => None,
            Verdict::Stop(reason) => Some(reason),
        }
    }

    fn mode_ends(&self, line: u32, machine: &Machine) -> Option<Reason> {
        let here = machine.calls().len();
        match self.mode {
            Mode::Free => None,
            Mode::Stopping => Some(Reason::Asked(None)),
            Mode::To(wanted) => (line == wanted).then_some(Reason::Cursor),
            Mode::Step { kind, depth } => {
                let is_finished = match kind {
                    StepKind::Into => true,
                    StepKind::Over => here <= depth,
                    StepKind::Out => here < depth,
                };
                is_finished.then_some(Reason::Step(kind))
            }
        }
    }

    /// Runs one instruction. False if the machine can run no further in this call.
    fn step(&mut self, machine: &mut Machine, host: &mut dyn Host) -> bool {
        let (at, depth, executed) = (machine.at(), machine.calls().len(), machine.executed());
        let waited = matches!(machine.state(), State::Listening { .. });
        machine.run(&mut Tapped { host, terminal: &mut self.terminal }, 1);
        if machine.executed() != executed && !waited {
            self.count(at);
        }
        self.moved |= machine.executed() != executed && waits(machine).is_none_or(|_| !waited);
        self.follow_calls(depth, machine);
        match machine.state() {
            State::Ready => {
                if self.reason != Reason::Running {
                    self.reason = Reason::Running;
                }
                return true;
            }
            State::Ended => self.reason = Reason::Ended,
            State::Faulted(fault) => self.reason = Reason::Faulted(fault.clone()),
            State::Pausing { .. } | State::Listening { .. } => {
                let wait = waits(machine);
                if self.mode == Mode::Stopping {
                    self.stand(Reason::Asked(wait));
                } else if let Some(wait) = wait {
                    self.reason = Reason::Waiting(wait);
                }
            }
        }
        false
    }

    fn count(&mut self, at: u32) {
        if let Some(line) = self.lines.begins(at)
            && let Some(count) = self.counts.get_mut(line as usize)
        {
            *count += 1;
        }
    }

    /// Notes what a subroutine is given as it is called, before it takes it.
    fn follow_calls(&mut self, before: usize, machine: &Machine) {
        let depth = machine.calls().len();
        if depth != before {
            self.given.truncate(depth);
            if depth > before {
                self.given.resize(depth - 1, None);
                self.given.push(Some(machine.arguments().to_vec()));
            }
        }
    }
}

//! The virtual machine: runs a [`Program`] a bounded number of instructions at a time, in a [`Host`] that has the clock, the streams
//! and the motors.

mod board;
mod counter;
pub mod digits;
mod events;
mod execute;
mod fault;
mod host;
mod memory;
mod reading;
mod streams;

pub use events::{after_ticks, ticks};
pub use fault::{Fault, FaultKind};
pub use host::Host;
pub use memory::{Memory, element};

use crate::arithmetic::{self, Type};
use crate::op::Array;
use crate::program::{Program, limits};
use counter::Loop;
use events::{Events, Kept};
use reading::Reading;
use std::sync::Arc;
use std::time::Duration;

/// A running program.
#[derive(Clone, Debug)]
pub struct Machine {
    program: Arc<Program>,
    memory: Memory,
    stack: Vec<u32>,
    calls: Vec<Call>,
    loops: Vec<Loop>,
    at: u32,
    state: State,
    sink: Sink,
    source: u32,
    reading: Reading,
    result: (u32, Type),
    executed: u64,
    events: Events,
    kept: Vec<Kept>,
}

/// A subroutine that has not returned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// The instruction it returns to.
    pub returns_to: u32,
    /// Its first instruction.
    pub entered_at: u32,
    /// Height of the stack without its arguments.
    base: usize,
    /// Of the handler of an event: what the last subroutine had returned when the event came.
    interrupted: Option<(u32, Type)>,
}

/// Where output goes.
#[derive(Clone, Copy, Debug)]
enum Sink {
    Stream(u32),
    Array { array: Array, next: u32 },
}

/// How far a machine is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// It can go on.
    Ready,
    /// It waits for this time.
    Pausing {
        /// Time since power-up.
        until: Duration,
    },
    /// It waits for a byte of this stream.
    Listening {
        /// The stream.
        stream: u32,
    },
    /// END or STOP.
    Ended,
    /// Something went wrong.
    Faulted(Fault),
}

impl Machine {
    /// A machine at the beginning of a program, with zeroed memory.
    #[must_use]
    pub fn new(program: Arc<Program>) -> Self {
        Self {
            memory: Memory::new(program.ram_bytes),
            loops: vec![Loop::default(); program.loops as usize],
            program,
            stack: Vec::with_capacity(64),
            calls: Vec::new(),
            at: 0,
            state: State::Ready,
            sink: Sink::Stream(0),
            source: 0,
            reading: Reading::default(),
            result: (0, Type::Unsigned),
            executed: 0,
            events: Events::default(),
            kept: Vec::new(),
        }
    }

    /// Goes back to the beginning, with zeroed memory.
    pub fn reset(&mut self) {
        *self = Self::new(self.program.clone());
    }

    /// Runs at most `budget` instructions and says how far it is. A machine that ended or faulted stays where it is.
    pub fn run<H: Host + ?Sized>(&mut self, host: &mut H, budget: u32) -> &State {
        self.settle(host);
        let program = self.program.clone();
        let mut left = budget;
        while left > 0 && matches!(self.state, State::Ready) {
            left -= 1;
            self.executed += 1;
            let at = self.at;
            let Some(op) = program.ops.get(at as usize) else {
                self.fault(at, FaultKind::BadJump);
                break;
            };
            self.at = at + 1;
            if let Err(kind) = self.execute(*op, &program, host) {
                self.fault(at, kind);
            }
        }
        &self.state
    }

    /// Ends a pause that is over, and lets an event that waits call its handler: the next instruction is known then.
    pub(crate) fn settle<H: Host + ?Sized>(&mut self, host: &H) {
        match self.state {
            State::Pausing { until } if host.now() >= until => self.state = State::Ready,
            State::Listening { .. } => self.state = State::Ready,
            State::Ready | State::Pausing { .. } | State::Ended | State::Faulted(_) => {}
        }
        if matches!(self.state, State::Ready) {
            self.serve_event();
        }
    }

    fn fault(&mut self, at: u32, kind: FaultKind) {
        self.at = at;
        let line = self.program.lines.get(at as usize).copied().unwrap_or(0);
        self.state = State::Faulted(Fault { line, kind });
    }

    /// How far it is.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The program it runs.
    #[must_use]
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// The next instruction.
    #[must_use]
    pub fn at(&self) -> u32 {
        self.at
    }

    /// The line of the text that comes next.
    #[must_use]
    pub fn line(&self) -> u32 {
        self.program.lines.get(self.at as usize).copied().unwrap_or(0)
    }

    /// The line of the text it stands on: while it waits in PAUSE, or for its host, that of the instruction it waits in, which it has
    /// behind it already.
    #[must_use]
    pub fn standing_line(&self) -> u32 {
        match self.state {
            State::Pausing { .. } => self.line_behind(),
            State::Ready | State::Listening { .. } | State::Ended | State::Faulted(_) => self.line(),
        }
    }

    /// The line of the instruction that was run last, where none has jumped since.
    pub(crate) fn line_behind(&self) -> u32 {
        self.program.lines.get(self.at.saturating_sub(1) as usize).copied().unwrap_or(0)
    }

    /// Subroutines that have not returned, the innermost last.
    #[must_use]
    pub fn calls(&self) -> &[Call] {
        &self.calls
    }

    /// What the innermost subroutine was given and has not taken from the stack yet, the first argument first.
    #[must_use]
    pub fn arguments(&self) -> &[u32] {
        let base = self.calls.last().map_or(self.stack.len(), |call| call.base);
        self.stack.get(base..).unwrap_or_default()
    }

    /// Puts a value on the stack of a machine that has not run yet.
    pub(crate) fn put_first(&mut self, value: u32) {
        self.stack.push(value);
    }

    /// The top of the stack: what an expression has come to.
    pub(crate) fn top(&self) -> Option<u32> {
        self.stack.last().copied()
    }

    /// Instructions run so far.
    #[must_use]
    pub fn executed(&self) -> u64 {
        self.executed
    }

    /// The variables.
    #[must_use]
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The variables, to be changed.
    pub fn memory_mut(&mut self) -> &mut Memory {
        &mut self.memory
    }

    fn push(&mut self, value: u32) -> Result<(), FaultKind> {
        if self.stack.len() >= limits::STACK_CELLS {
            return Err(FaultKind::StackFull);
        }
        self.stack.push(value);
        Ok(())
    }

    fn pop(&mut self) -> Result<u32, FaultKind> {
        self.stack.pop().ok_or(FaultKind::StackEmpty)
    }

    /// What the last subroutine returned, as another type.
    fn result_as(&self, kind: Type) -> u32 {
        arithmetic::convert(self.result.0, self.result.1, kind)
    }

    /// The line of an instruction and the label it belongs to, for call stacks.
    #[must_use]
    pub fn label_of(&self, at: u32) -> Option<&str> {
        let labels = self.program.labels.iter().filter(|(_, label)| *label <= at);
        labels.max_by_key(|(_, label)| *label).map(|(name, _)| name.as_str())
    }
}

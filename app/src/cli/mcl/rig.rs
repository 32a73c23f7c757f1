//! What a script runs in: for now a machine with plain memory in place of a controller's registers and motors.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::program::Program;
use brushwork_script::vm::{Host, Machine, State};

use super::args::RunArgs;

/// Instructions in a millisecond of the controller's time.
const INSTRUCTIONS_PER_MS: u32 = 200;

/// A script and what it runs in.
pub struct Rig {
    machine: Machine,
    desk: Desk,
}

/// How far a script is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Run {
    /// It runs.
    Running {
        /// The line that comes next.
        line: u32,
    },
    /// END or STOP.
    Ended {
        /// The line it ended on.
        line: u32,
    },
    /// Something went wrong.
    Faulted {
        /// The line it was on.
        line: u32,
        /// What.
        what: String,
    },
}

impl Rig {
    /// A controller that is about to run a script.
    ///
    /// # Errors
    /// A sentence: there is no such model or preset.
    pub fn new(args: &RunArgs, program: &Program) -> Result<Self, String> {
        let desk = Desk { stream: args.stream.into(), ..Desk::default() };
        Ok(Self { machine: Machine::new(Arc::new(program.clone())), desk })
    }

    /// Time since the start.
    pub fn now(&self) -> Duration {
        self.desk.now
    }

    /// How far the script is.
    pub fn run(&self) -> Run {
        let line = self.machine.line();
        match self.machine.state() {
            State::Ended => Run::Ended { line },
            State::Faulted(fault) => Run::Faulted { line: fault.line, what: fault.kind.to_string() },
            _ => Run::Running { line },
        }
    }

    /// Instructions run so far.
    pub fn executed(&self) -> u64 {
        self.machine.executed()
    }

    /// Whether the script waits for a byte.
    pub fn is_listening(&self) -> bool {
        matches!(self.machine.state(), State::Listening { stream } if *stream == self.desk.stream)
            && self.desk.waiting.is_empty()
    }

    /// Whether bytes are on their way out.
    pub fn is_sending(&self) -> bool {
        false
    }

    /// Takes as many of these bytes as there is room for, and says how many.
    pub fn feed(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(255usize.saturating_sub(self.desk.waiting.len()));
        self.desk.waiting.extend(&bytes[..taken]);
        taken
    }

    /// Lets time pass.
    pub fn advance(&mut self, by: Duration) {
        let end = self.desk.now + by;
        self.machine.run(&mut self.desk, INSTRUCTIONS_PER_MS);
        self.desk.now = end;
    }

    /// What the script has sent.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.desk.sent)
    }
}

#[derive(Default)]
struct Desk {
    now: Duration,
    stream: u32,
    sent: Vec<u8>,
    waiting: VecDeque<u8>,
    registers: HashMap<(u8, u8), u32>,
    eeprom: HashMap<u32, u8>,
}

impl Host for Desk {
    fn now(&self) -> Duration {
        self.now
    }

    fn register(&mut self, id: RegisterId, element: u8) -> u32 {
        match id.row().name {
            "SYSTICK" => self.now.as_millis() as u32,
            "SYSUSTICK" => self.now.as_micros() as u32,
            _ => self.registers.get(&(id.0, element)).copied().unwrap_or(0),
        }
    }

    fn set_register(&mut self, id: RegisterId, element: u8, value: u32) {
        self.registers.insert((id.0, element), value);
    }

    fn put(&mut self, stream: u32, byte: u8) {
        if stream == self.stream {
            self.sent.push(byte);
        }
    }

    fn get(&mut self, stream: u32) -> Option<u8> {
        if stream == self.stream { self.waiting.pop_front() } else { None }
    }

    fn motion(&mut self, _: Motion, _: &[i32]) {}

    fn read_eeprom(&mut self, address: u32) -> u8 {
        self.eeprom.get(&address).copied().unwrap_or(0xFF)
    }

    fn write_eeprom(&mut self, address: u32, value: u8) {
        self.eeprom.insert(address, value);
    }

    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        false
    }

    fn i2c_read(&mut self, _: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        None
    }
}

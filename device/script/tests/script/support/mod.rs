//! A host without a controller: streams as buffers, registers that hold what is stored, a clock that jumps over pauses.

#![allow(dead_code, reason = "each test file uses its part")]

pub mod examples;
pub mod mutation;
pub mod worst;

use brushwork_script::board::Board;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::{self, registers::RegisterId};
use brushwork_script::vm::{Host, Machine, State};
use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

#[derive(Debug, Default)]
pub struct TestHost {
    pub now: Duration,
    pub sent: HashMap<u32, Vec<u8>>,
    pub waiting: HashMap<u32, VecDeque<u8>>,
    pub registers: HashMap<(u8, u8), u32>,
    pub motions: Vec<(Motion, Vec<i32>)>,
    pub eeprom: HashMap<u32, u8>,
    pub i2c: Vec<Vec<u8>>,
    /// What the I2C device answers; none is no device.
    pub i2c_reply: Option<Vec<u8>>,
    /// Commands of the board, with the time of each.
    pub board: Vec<(Duration, Board, Vec<u32>)>,
    pub frames: Vec<Vec<u8>>,
    /// What was received last.
    pub received: Vec<u8>,
}

impl Host for TestHost {
    fn now(&self) -> Duration {
        self.now
    }

    fn register(&mut self, id: RegisterId, element: u8) -> u32 {
        self.registers.get(&(id.0, element)).copied().unwrap_or(0)
    }

    fn set_register(&mut self, id: RegisterId, element: u8, value: u32) {
        self.registers.insert((id.0, element), value);
    }

    fn put(&mut self, stream: u32, byte: u8) {
        self.sent.entry(stream).or_default().push(byte);
    }

    fn get(&mut self, stream: u32) -> Option<u8> {
        self.waiting.get_mut(&stream)?.pop_front()
    }

    fn motion(&mut self, command: Motion, arguments: &[i32]) {
        self.motions.push((command, arguments.to_vec()));
    }

    fn read_eeprom(&mut self, address: u32) -> u8 {
        self.eeprom.get(&address).copied().unwrap_or(0)
    }

    fn write_eeprom(&mut self, address: u32, value: u8) {
        self.eeprom.insert(address, value);
    }

    fn i2c_write(&mut self, bytes: &[u8], _stop: bool, _timeout: Option<Duration>) -> bool {
        self.i2c.push(bytes.to_vec());
        self.i2c_reply.is_some()
    }

    fn i2c_read(&mut self, count: usize, _timeout: Option<Duration>) -> Option<Vec<u8>> {
        self.i2c_reply.as_ref().map(|reply| reply.iter().copied().cycle().take(count).collect())
    }

    fn board(&mut self, command: Board, arguments: &[u32]) -> u32 {
        self.board.push((self.now, command, arguments.to_vec()));
        42
    }

    fn send(&mut self, bytes: &[u8]) {
        self.frames.push(bytes.to_vec());
    }

    fn receive(&mut self) -> Vec<u8> {
        self.received.clone()
    }
}

/// A machine with a program that has to compile.
pub fn machine(text: &str) -> Machine {
    let compiled = mcl::compile(text);
    let lines = brushwork_script::text::Lines::of(text);
    let page: String =
        compiled.diagnostics.iter().map(|diagnostic| diagnostic.render("test.mcl", text, &lines)).collect();
    Machine::new(Arc::new(compiled.program.unwrap_or_else(|| panic!("{page}"))))
}

/// Runs a machine one instruction after the other, a hundred or up to a pause at a time, jumping over pauses.
pub fn run_on(machine: &mut Machine, host: &mut TestHost, most: u32) -> State {
    for _ in 0..most / 100 {
        match machine.run(host, 100) {
            State::Pausing { until } => host.now = *until,
            State::Ready => {}
            state => return state.clone(),
        }
    }
    State::Ready
}

/// Runs a machine to its end or to this many instructions, so many at a time: of thousands it runs several in one.
pub fn run_in_slices(machine: &mut Machine, host: &mut TestHost, most: u32, slice: u32) -> State {
    let most = machine.executed() + u64::from(most);
    let mut turns = 0;
    while machine.executed() < most {
        turns += 1;
        assert!(turns < 1_000_000, "it hangs");
        let left = u32::try_from(most - machine.executed()).unwrap_or(u32::MAX);
        match machine.run(host, slice.min(left)) {
            State::Pausing { until } => host.now = *until,
            State::Ready => {}
            state => return state.clone(),
        }
    }
    State::Ready
}

/// What a program sends to stream 0, with its last state; the same both ways in which a machine runs.
pub fn run(text: &str) -> (String, State) {
    let [one_by_one, several] = [100, 100_000].map(|slice| {
        let mut host = TestHost::default();
        let state = run_in_slices(&mut machine(text), &mut host, 200_000, slice);
        let sent = host.sent.remove(&0).unwrap_or_default();
        (sent.into_iter().map(char::from).collect(), state)
    });
    assert_eq!(one_by_one, several, "{text}");
    several
}

/// What a program sends to stream 0 before it ends.
pub fn output(text: &str) -> String {
    let (sent, state) = run(text);
    assert_eq!(state, State::Ended, "{text}\nsent {sent:?}");
    sent
}

/// The value of an expression, as SDEC writes it.
pub fn value(expression: &str) -> String {
    output(&format!("puts 0,[sdec {expression}]\nend\n"))
}

/// Whether two hosts saw the same.
pub fn same_host(a: &TestHost, b: &TestHost) -> bool {
    let outside = |host: &TestHost| (host.sent.clone(), host.registers.clone(), host.eeprom.clone());
    let done = |host: &TestHost| (host.motions.clone(), host.i2c.clone(), host.waiting.clone());
    a.now == b.now && outside(a) == outside(b) && done(a) == done(b)
}

//! A machine for tests of what stands around a machine: it answers each pair of bytes with four copies of the second one.
#![allow(dead_code, reason = "each test file uses what it needs")]

use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets::{presets, world_of};
use brushwork_plant::server::SimHandle;
use brushwork_plant::world::{World, WorldAction, WorldView};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

pub const USB: StreamIndex = StreamIndex::Usb;

/// Longer than anything here takes, on a busy computer with a slow disk too.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// Asks until it holds or patience ends.
pub fn eventually(mut holds: impl FnMut() -> bool) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        if holds() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    false
}

/// Lets a server take at least one whole turn: it has looked at its line after this was called.
pub fn let_turn<M: Machine + 'static>(handle: &SimHandle<M>) {
    for _ in 0..3 {
        handle.inspect(|_| ()).expect("it runs");
    }
}

#[derive(Debug)]
pub struct Parrot {
    pub now: Duration,
    pub turnaround: Duration,
    pub bits_per_second: u32,
    pub duty: f64,
    /// Every byte received and when.
    pub heard: Vec<(Duration, u8)>,
    world: World,
    ticks: u64,
    replies: VecDeque<(Duration, Vec<u8>)>,
}

impl Parrot {
    pub fn new() -> Self {
        let preset = &presets()[0];
        Self {
            now: Duration::ZERO,
            turnaround: Duration::ZERO,
            bits_per_second: 115_200,
            duty: 0.0,
            heard: Vec::new(),
            world: World::new(&world_of(preset, preset, 4), 0).expect("presets are valid"),
            ticks: 0,
            replies: VecDeque::new(),
        }
    }
}

impl Machine for Parrot {
    fn now(&self) -> Duration {
        self.now
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        assert_eq!(stream, USB);
        for byte in bytes {
            self.heard.push((self.now, *byte));
            if self.heard.len().is_multiple_of(2) {
                self.replies.push_back((self.now + self.turnaround, vec![*byte; 4]));
            }
        }
    }

    fn advance(&mut self, to: Duration) {
        self.now = self.now.max(to);
        while Duration::from_secs(self.ticks + 1) / 300 <= self.now {
            self.ticks += 1;
            self.world.advance([BridgeOutput::Duty(self.duty); 2], 1.0 / 300.0);
        }
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.replies.front().map(|(at, _)| *at)
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        if stream != USB {
            return None;
        }
        self.replies.pop_front_if(|(at, _)| *at <= self.now).map(|(_, reply)| reply)
    }

    fn bits_per_second(&self, _: StreamIndex) -> u32 {
        self.bits_per_second
    }

    fn units(&self) -> usize {
        1
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        if unit == 0 {
            self.world.apply(action);
        }
    }

    fn views(&self) -> Vec<WorldView> {
        vec![self.world.view(self.now)]
    }

    fn plugged(&self) -> bool {
        self.world.plugged()
    }
}

/// Sends `bytes` at the machine's time and gathers what comes back within `window`, each piece with its time.
pub fn exchange(machine: &mut impl Machine, bytes: &[u8], window: Duration) -> Vec<(Duration, Vec<u8>)> {
    let end = machine.now() + window;
    machine.receive(USB, bytes);
    let mut pieces = Vec::new();
    loop {
        while let Some(piece) = machine.take_output(USB) {
            pieces.push((machine.now(), piece));
        }
        match machine.next_output_at().filter(|at| *at <= end) {
            Some(at) => machine.advance(at),
            None => break machine.advance(end),
        }
    }
    pieces
}

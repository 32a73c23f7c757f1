//! What a script sent, and what a person types for it: a host around the host that listens in.

use crate::board::Board;
use crate::mcl::ast::Motion;
use crate::mcl::registers::RegisterId;
use crate::mcl::words;
use crate::vm::Host;
use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

/// Bytes of output that are kept for whoever looks.
const KEPT: usize = 64 * 1024;
/// Bytes that may wait to be read by the script, per stream.
const WAITING: usize = 4096;

/// Bytes sent one after the other to one stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// The stream.
    pub stream: u32,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// The bytes of a script's streams.
#[derive(Clone, Debug, Default)]
pub struct Terminal {
    sent: VecDeque<(u32, u8)>,
    /// Bytes sent since the beginning, those that are not kept any more included.
    count: u64,
    typed: BTreeMap<u32, VecDeque<u8>>,
}

impl Terminal {
    /// How many bytes were sent.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// What was sent after the first `seen` bytes, as far as it is kept.
    #[must_use]
    pub fn since(&self, seen: u64) -> Vec<Chunk> {
        let unseen = self.count.saturating_sub(seen).min(self.sent.len() as u64) as usize;
        let mut chunks: Vec<Chunk> = Vec::new();
        for (stream, byte) in self.sent.range(self.sent.len() - unseen..) {
            match chunks.last_mut().filter(|chunk| chunk.stream == *stream) {
                Some(chunk) => chunk.bytes.push(*byte),
                None => chunks.push(Chunk { stream: *stream, bytes: vec![*byte] }),
            }
        }
        chunks
    }

    /// Gives bytes to a stream, to be read before those that come over the wire. What does not fit is lost; says how many fitted.
    pub fn give(&mut self, stream: u32, bytes: &[u8]) -> usize {
        let waiting = self.typed.entry(stream).or_default();
        let fits = bytes.len().min(WAITING.saturating_sub(waiting.len()));
        waiting.extend(&bytes[..fits]);
        fits
    }

    /// How many given bytes of a stream were not read yet.
    #[must_use]
    pub fn waiting(&self, stream: u32) -> usize {
        self.typed.get(&stream).map_or(0, VecDeque::len)
    }

    /// Forgets what was given and not read.
    pub fn forget_typed(&mut self) {
        self.typed.clear();
    }

    fn note(&mut self, stream: u32, byte: u8) {
        if self.sent.len() == KEPT {
            self.sent.pop_front();
        }
        self.sent.push_back((stream, byte));
        self.count += 1;
    }
}

/// A host whose streams are listened to.
pub(super) struct Tapped<'a> {
    pub host: &'a mut dyn Host,
    pub terminal: &'a mut Terminal,
}

impl Host for Tapped<'_> {
    fn now(&self) -> Duration {
        self.host.now()
    }

    fn register(&mut self, id: RegisterId, element: u8) -> u32 {
        let value = self.host.register(id, element);
        if words::register("STREAMCOUNT").is_some_and(|(count, _)| count == id) {
            let typed = u32::try_from(self.terminal.waiting(element.into())).unwrap_or(u32::MAX);
            return value.saturating_add(typed).min(0xFF);
        }
        value
    }

    fn set_register(&mut self, id: RegisterId, element: u8, value: u32) {
        self.host.set_register(id, element, value);
    }

    fn put(&mut self, stream: u32, byte: u8) {
        self.terminal.note(stream, byte);
        self.host.put(stream, byte);
    }

    fn get(&mut self, stream: u32) -> Option<u8> {
        let typed = self.terminal.typed.get_mut(&stream).and_then(VecDeque::pop_front);
        typed.or_else(|| self.host.get(stream))
    }

    fn busy_until(&self) -> Option<Duration> {
        self.host.busy_until()
    }

    fn motion(&mut self, command: Motion, arguments: &[i32]) {
        self.host.motion(command, arguments);
    }

    fn read_eeprom(&mut self, address: u32) -> u8 {
        self.host.read_eeprom(address)
    }

    fn write_eeprom(&mut self, address: u32, value: u8) {
        self.host.write_eeprom(address, value);
    }

    fn i2c_write(&mut self, bytes: &[u8], stop: bool, timeout: Option<Duration>) -> bool {
        self.host.i2c_write(bytes, stop, timeout)
    }

    fn i2c_read(&mut self, count: usize, timeout: Option<Duration>) -> Option<Vec<u8>> {
        self.host.i2c_read(count, timeout)
    }

    fn board(&mut self, command: Board, arguments: &[u32]) -> u32 {
        self.host.board(command, arguments)
    }

    fn send(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.terminal.note(0, *byte));
        self.host.send(bytes);
    }

    fn receive(&mut self) -> Vec<u8> {
        self.host.receive()
    }
}

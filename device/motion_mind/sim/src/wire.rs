//! The serial side of one unit: commands out of bytes, replies after their delay.

use super::assumed::{LONG_TEXT_REPLY_DELAY, REPLY_DELAY, TEXT_REPLY_DELAY};
use brushwork_motion_mind_wire::Protocol;
use brushwork_motion_mind_wire::{
    Address, Command, FrameEvent, FrameReader, LineEvent, LineReader, Part, Reply, encode_frame_reply,
    encode_line_reply,
};
use std::collections::VecDeque;
use std::time::Duration;

/// Something that came over the wire and asks for a reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// A command, of whatever address.
    Command(Address, Command),
    /// The self-test.
    SelfTest(Address),
    /// A line that is no command, and its address if it has one.
    NotUnderstood(Option<Address>),
}

/// One end of the wire.
#[derive(Clone, Debug)]
pub struct Wire {
    protocol: Protocol,
    frames: FrameReader,
    lines: LineReader,
    replies: VecDeque<(Duration, Vec<u8>)>,
    deaf_until: Duration,
}

impl Wire {
    pub fn new(protocol: Protocol) -> Self {
        Self {
            protocol,
            frames: FrameReader::new(),
            lines: LineReader::new(),
            replies: VecDeque::new(),
            deaf_until: Duration::ZERO,
        }
    }

    /// Forgets what came and what was to be said, as without power.
    pub fn forget(&mut self) {
        *self = Self::new(self.protocol);
    }

    /// Hears nothing until then.
    pub fn deaf_until(&mut self, until: Duration) {
        self.deaf_until = until;
    }

    /// Takes the byte that came at `now`.
    pub fn receive(&mut self, byte: u8, now: Duration) -> Option<Order> {
        if now < self.deaf_until {
            return None;
        }
        match self.protocol {
            Protocol::Binary => match self.frames.feed(byte, now)? {
                FrameEvent::Command(address, command) => Some(Order::Command(address, command)),
                FrameEvent::Dropped(_) => None,
            },
            Protocol::Text => Some(match self.lines.feed(byte)? {
                LineEvent::Command(address, command) => Order::Command(address, command),
                LineEvent::SelfTest(address) => Order::SelfTest(address),
                LineEvent::NotUnderstood { address, .. } => Order::NotUnderstood(address),
            }),
        }
    }

    /// Queues the answer to a command that was done at `at`. A unit whose address is a broadcast says nothing.
    pub fn say(&mut self, command: Option<&Command>, reply: &Reply, own: Address, at: Duration) {
        if own.is_broadcast() {
            return;
        }
        let part = match command {
            Some(Command::ReadText(part)) => Some(*part),
            _ => None,
        };
        let (bytes, delay) = match self.protocol {
            Protocol::Binary => (encode_frame_reply(own, reply), REPLY_DELAY),
            Protocol::Text => (encode_line_reply(part, reply).into_bytes(), text_delay(part)),
        };
        if !bytes.is_empty() {
            let after = self.replies.back().map_or(Duration::ZERO, |(at, _)| *at);
            self.replies.push_back(((at + delay).max(after), bytes));
        }
    }

    pub fn next_output_at(&self) -> Option<Duration> {
        self.replies.front().map(|(at, _)| *at)
    }

    pub fn take_output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.replies.pop_front_if(|(at, _)| *at <= now).map(|(_, bytes)| bytes)
    }
}

fn text_delay(part: Option<Part>) -> Duration {
    match part {
        Some(Part::StatusBits | Part::FunctionBits | Part::All) => LONG_TEXT_REPLY_DELAY,
        Some(Part::Register(_)) | None => TEXT_REPLY_DELAY,
    }
}

//! Bytes at the baud rate: a wrapper that lets each byte of a machine take its time on the wire, both ways.
//!
//! It has no clock of its own: like any machine it is advanced, and it hands each byte on at the very moment at which its last
//! bit is through, to the machine as to the host. The machine's own turnaround is the time between the last bit of a request and the
//! first of its reply.

use crate::machine::{Machine, StreamIndex, passed_on};
use std::collections::VecDeque;
use std::time::Duration;

/// Bits a byte takes on the wire: start, eight data bits, stop.
pub const BITS_PER_BYTE: u32 = 10;

/// Time one byte takes at a rate.
pub fn byte_time(bits_per_second: u32) -> Duration {
    Duration::from_nanos(u64::from(BITS_PER_BYTE) * 1_000_000_000 / u64::from(bits_per_second.max(1)))
}

/// A machine behind lines of limited speed.
#[derive(Debug)]
pub struct Paced<M> {
    inner: M,
    enabled: bool,
    lines: [Line; StreamIndex::ALL.len()],
}

#[derive(Debug, Default)]
struct Line {
    /// Bytes on their way to the machine, each with the time its last bit arrives.
    requests: VecDeque<(Duration, u8)>,
    /// Bytes on their way to the host, each with the time its last bit arrives.
    replies: VecDeque<(Duration, u8)>,
    last_reply_byte_at: Duration,
}

impl<M: Machine> Paced<M> {
    /// `enabled` false lets everything through at once.
    pub fn new(inner: M, enabled: bool) -> Self {
        Self { inner, enabled, lines: Default::default() }
    }

    /// The machine behind the lines.
    pub fn inner_mut(&mut self) -> &mut M {
        &mut self.inner
    }

    /// Takes away what is on its way on all lines, as when the host's cable is pulled or its program closes the port.
    pub fn clear(&mut self) {
        self.lines = Default::default();
    }

    /// The next moment after `now` at which something happens on a line or the machine says something.
    fn next_event(&self) -> Option<Duration> {
        let on_lines = self.lines.iter().filter_map(|line| line.requests.front().map(|(at, _)| *at)).min();
        earliest(on_lines, self.inner.next_output_at().filter(|at| *at > self.inner.now()))
    }

    /// Hands over the bytes that have arrived and takes up what the machine answers.
    fn exchange(&mut self) {
        let now = self.inner.now();
        for stream in StreamIndex::ALL {
            let line = &mut self.lines[stream.index()];
            while let Some((_, byte)) = line.requests.pop_front_if(|(at, _)| *at <= now) {
                self.inner.receive(stream, &[byte]);
            }
            let byte_time = byte_time(self.inner.bits_per_second(stream));
            while let Some(reply) = self.inner.take_output(stream) {
                line.last_reply_byte_at = line.last_reply_byte_at.max(now);
                for byte in reply {
                    line.last_reply_byte_at += byte_time;
                    line.replies.push_back((line.last_reply_byte_at, byte));
                }
            }
        }
    }
}

impl<M: Machine> Machine for Paced<M> {
    fn now(&self) -> Duration {
        self.inner.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        if !self.enabled {
            return self.inner.receive(stream, bytes);
        }
        let byte_time = byte_time(self.inner.bits_per_second(stream));
        let line = &mut self.lines[stream.index()];
        let mut at = line.requests.back().map_or(self.inner.now(), |(at, _)| *at);
        for byte in bytes {
            at += byte_time;
            line.requests.push_back((at, *byte));
        }
    }

    fn advance(&mut self, to: Duration) {
        if !self.enabled {
            return self.inner.advance(to);
        }
        self.exchange();
        while let Some(at) = self.next_event().filter(|at| *at <= to) {
            self.inner.advance(at);
            self.exchange();
        }
        self.inner.advance(to);
        self.exchange();
    }

    fn next_output_at(&self) -> Option<Duration> {
        if !self.enabled {
            return self.inner.next_output_at();
        }
        let replies = self.lines.iter().filter_map(|line| line.replies.front().map(|(at, _)| *at)).min();
        // A byte on its way, or an answer about to begin, is no reply before one more byte has passed.
        let fastest = StreamIndex::ALL.map(|stream| byte_time(self.inner.bits_per_second(stream)));
        let soonest = fastest.into_iter().min().unwrap_or_default();
        earliest(replies, self.next_event().map(|at| at + soonest))
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        if !self.enabled {
            return self.inner.take_output(stream);
        }
        let now = self.inner.now();
        let replies = &mut self.lines[stream.index()].replies;
        let arrived = replies.partition_point(|(at, _)| *at <= now);
        (arrived > 0).then(|| replies.drain(..arrived).map(|(_, byte)| byte).collect())
    }

    passed_on!();
}

fn earliest(a: Option<Duration>, b: Option<Duration>) -> Option<Duration> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (one, other) => one.or(other),
    }
}

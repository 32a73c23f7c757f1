//! One serial stream: bytes in, requests out; replies in, with the time at which they leave.

use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{Framed, FramerEvent, Generation, RequestFramer};
use brushwork_plant::machine::StreamIndex;
use std::collections::VecDeque;
use std::time::Duration;

/// Time from the last byte of a request to the first of its reply at 38400 bit/s and below (MCP manual 2.2.6: at least 1 ms).
pub const SLOW_TURNAROUND: Duration = Duration::from_millis(1);
/// The same above 38400 bit/s and over USB. Assumed.
pub const FAST_TURNAROUND: Duration = Duration::from_micros(50);
/// Up to this rate a reply is held back.
const SLOW_RATE_BPS: u32 = 38_400;
/// Bytes of a script that wait for somebody who reads them.
const SAID_BYTES: usize = 64 * 1024;

/// One stream.
#[derive(Clone, Debug)]
pub(super) struct Port {
    framer: RequestFramer,
    outbox: VecDeque<(Duration, Vec<u8>)>,
    /// What a script has sent and nobody has taken yet.
    said: Vec<u8>,
}

/// How long a stream waits before it answers.
pub fn turnaround(stream: StreamIndex, rate_bps: u32) -> Duration {
    if stream != StreamIndex::Usb && rate_bps <= SLOW_RATE_BPS { SLOW_TURNAROUND } else { FAST_TURNAROUND }
}

impl Port {
    pub fn new(generation: Generation, family: Family) -> Self {
        Self {
            framer: RequestFramer::for_family(generation, family),
            outbox: VecDeque::new(),
            said: Vec::new(),
        }
    }

    /// Takes one byte; a request that is whole now comes back.
    pub fn feed(&mut self, byte: u8, now: Duration) -> Option<Framed> {
        match self.framer.feed(byte, now)? {
            FramerEvent::Request(framed) => Some(framed),
            FramerEvent::Discarded(_) => None,
        }
    }

    /// Sends `bytes` in one write at `due`, or right after what is waiting.
    pub fn send(&mut self, bytes: Vec<u8>, due: Duration) {
        let last = self.outbox.back().map_or(Duration::ZERO, |(at, _)| *at);
        self.outbox.push_back((due.max(last), bytes));
    }

    /// Takes what a script sends; what nobody takes in time is lost, as on any port.
    pub fn say(&mut self, bytes: &[u8]) {
        let room = SAID_BYTES.saturating_sub(self.said.len());
        self.said.extend(&bytes[..bytes.len().min(room)]);
    }

    /// When the next reply leaves. What scripts send is not waited for: a stream that nobody reads would never be done.
    pub fn next_output_at(&self) -> Option<Duration> {
        self.outbox.front().map(|(due, _)| *due)
    }

    /// Takes the next write if it has left by `now`.
    pub fn take_output(&mut self, now: Duration) -> Option<Vec<u8>> {
        if self.next_output_at().is_some_and(|at| at <= now) {
            return self.outbox.pop_front().map(|(_, bytes)| bytes);
        }
        (!self.said.is_empty()).then(|| std::mem::take(&mut self.said))
    }

    /// Forgets everything, as when the power goes.
    pub fn reset(&mut self) {
        self.framer.reset();
        self.outbox.clear();
        self.said.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_ports_wait_a_millisecond() {
        assert_eq!(turnaround(StreamIndex::Uart0, 38_400), SLOW_TURNAROUND);
        assert_eq!(turnaround(StreamIndex::Uart0, 115_200), FAST_TURNAROUND);
        assert_eq!(turnaround(StreamIndex::Usb, 9_600), FAST_TURNAROUND);
    }

    #[test]
    fn writes_leave_in_order_and_not_before_their_time() {
        let mut port = Port::new(Generation::Gen1, Family::Mcp);
        let ms = Duration::from_millis;
        port.send(vec![1], ms(5));
        port.send(vec![2], ms(3));
        assert_eq!(port.next_output_at(), Some(ms(5)));
        assert_eq!(port.take_output(ms(4)), None);
        assert_eq!(port.take_output(ms(5)), Some(vec![1]));
        assert_eq!(port.take_output(ms(5)), Some(vec![2]));
        assert_eq!(port.take_output(ms(9)), None);
    }
}

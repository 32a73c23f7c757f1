//! What scripts and streams say to each other: which is which, and the bytes that wait for GETS.
//!
//! Streams have the numbers of GETS and PUTS (MCP manual 3.4.1): 0 USB, 1 CAN, 2 TTL, 3 RS-232; the tables of the stream registers
//! have the same four. Assumed: the TTL stream is UART1, the first of the three that command 145 numbers, since I2C takes the place of
//! that one too; a stream's buffer holds 255 bytes, the most that STREAMCOUNT can tell, and what comes to a full one is lost.

use brushwork_plant::machine::StreamIndex;
use std::collections::VecDeque;
use std::time::Duration;

/// How many streams scripts know.
pub const STREAMS: usize = 4;
/// The number of the CAN stream.
pub const CAN: usize = 1;
/// Bytes that can wait for GETS.
pub const BUFFER_BYTES: usize = 255;

/// The serial stream behind a stream number; none for CAN and for numbers that mean nothing.
pub fn port_of(stream: usize) -> Option<StreamIndex> {
    match stream {
        0 => Some(StreamIndex::Usb),
        2 => Some(StreamIndex::Uart1),
        3 => Some(StreamIndex::Uart0),
        _ => None,
    }
}

/// The stream number of a serial stream; none for those that scripts do not know.
pub fn number_of(port: StreamIndex) -> Option<usize> {
    (0..STREAMS).find(|stream| port_of(*stream) == Some(port))
}

/// Bytes waiting for GETS.
#[derive(Clone, Debug, Default)]
pub struct Streams {
    waiting: [VecDeque<u8>; STREAMS],
    last_byte_at: [Option<Duration>; STREAMS],
}

impl Streams {
    /// A byte has come at this up-time.
    pub fn take_in(&mut self, stream: usize, byte: u8, up_for: Duration) {
        self.last_byte_at[stream] = Some(up_for);
        if self.waiting[stream].len() < BUFFER_BYTES {
            self.waiting[stream].push_back(byte);
        }
    }

    /// The next byte for GETS.
    pub fn next(&mut self, stream: usize) -> Option<u8> {
        self.waiting.get_mut(stream)?.pop_front()
    }

    /// Bytes that wait.
    pub fn count(&self, stream: usize) -> usize {
        self.waiting.get(stream).map_or(0, VecDeque::len)
    }

    /// When the last byte came.
    pub fn last_byte_at(&self, stream: usize) -> Option<Duration> {
        self.last_byte_at.get(stream).copied().flatten()
    }

    /// Throws away what waits.
    pub fn clear(&mut self) {
        self.waiting.iter_mut().for_each(VecDeque::clear);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_ports_are_one_table() {
        for stream in 0..STREAMS {
            assert_eq!(port_of(stream).and_then(number_of), port_of(stream).map(|_| stream));
        }
        assert_eq!((port_of(CAN), number_of(StreamIndex::Uart2)), (None, None));
    }

    #[test]
    fn a_full_buffer_loses_what_comes_last() {
        let mut streams = Streams::default();
        for byte in 0..=255 {
            streams.take_in(0, byte, Duration::from_millis(7));
        }
        assert_eq!((streams.count(0), streams.next(0), streams.next(9)), (255, Some(0), None));
        assert_eq!(streams.last_byte_at(0), Some(Duration::from_millis(7)));
    }
}

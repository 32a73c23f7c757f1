//! Bytes through a pair of bounded channels, to a simulated controller in the same program.

use super::byte_stream::{Transport, TransportError, WRITE_TIMEOUT};
use crate::work::receive_within;
use crossbeam_channel::{Receiver, RecvTimeoutError, SendTimeoutError, Sender, bounded};
use std::time::Duration;

/// The client's end of an in-process link. Each message is one write of either side.
pub struct ChannelTransport {
    to_controller: Sender<Vec<u8>>,
    from_controller: Receiver<Vec<u8>>,
    unread: Vec<u8>,
    name: String,
}

impl ChannelTransport {
    /// A transport over channels that somebody else serves; `name` is what the user sees.
    #[must_use]
    pub fn new(to_controller: Sender<Vec<u8>>, from_controller: Receiver<Vec<u8>>, name: String) -> Self {
        Self { to_controller, from_controller, unread: Vec::new(), name }
    }

    /// A transport and the controller's two ends: what it receives, and where it answers.
    #[must_use]
    pub fn pair(name: &str) -> (Self, Receiver<Vec<u8>>, Sender<Vec<u8>>) {
        let (to_controller, requests) = bounded(256);
        let (replies, from_controller) = bounded(256);
        (Self::new(to_controller, from_controller, name.to_owned()), requests, replies)
    }

    /// Moves as much of the unread bytes as fits.
    fn hand_over(&mut self, buffer: &mut [u8]) -> usize {
        let count = self.unread.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.unread[..count]);
        self.unread.drain(..count);
        count
    }

    fn gone() -> TransportError {
        TransportError::Gone { detail: "the simulated controller was unplugged or has ended".to_owned() }
    }
}

impl Transport for ChannelTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        match self.to_controller.send_timeout(bytes.to_vec(), WRITE_TIMEOUT) {
            Ok(()) => Ok(()),
            Err(SendTimeoutError::Timeout(_)) => {
                Err(TransportError::WriteStuck { written: 0, length: bytes.len() })
            }
            Err(SendTimeoutError::Disconnected(_)) => Err(Self::gone()),
        }
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if self.unread.is_empty() {
            match receive_within(&self.from_controller, timeout) {
                Ok(bytes) => self.unread = bytes,
                Err(RecvTimeoutError::Timeout) => return Ok(0),
                Err(RecvTimeoutError::Disconnected) => return Err(Self::gone()),
            }
        }
        Ok(self.hand_over(buffer))
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let waiting: usize = self.from_controller.try_iter().map(|bytes| bytes.len()).sum();
        let count = waiting + self.unread.len();
        self.unread.clear();
        Ok(count)
    }

    fn describe(&self) -> String {
        self.name.clone()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(100)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_message_is_read_in_pieces_and_in_order() {
        let (mut transport, requests, replies) = ChannelTransport::pair("test");
        transport.write(&[0x80, 21]).unwrap();
        assert_eq!(requests.recv().unwrap(), [0x80, 21]);
        replies.send(vec![1, 2, 3]).unwrap();
        let mut buffer = [0; 2];
        assert_eq!(transport.read(&mut buffer, Duration::ZERO).unwrap(), 2);
        assert_eq!(buffer, [1, 2]);
        assert_eq!(transport.read(&mut buffer, Duration::ZERO).unwrap(), 1);
        assert_eq!(buffer[0], 3);
        assert_eq!(transport.read(&mut buffer, Duration::ZERO).unwrap(), 0, "nothing more came");
    }

    #[test]
    fn discarding_counts_what_was_waiting() {
        let (mut transport, _requests, replies) = ChannelTransport::pair("test");
        replies.send(vec![1, 2, 3]).unwrap();
        replies.send(vec![4]).unwrap();
        assert_eq!(transport.discard_input().unwrap(), 4);
        assert_eq!(transport.discard_input().unwrap(), 0);
    }

    #[test]
    fn a_controller_that_is_gone_is_told_as_gone_on_both_ways() {
        let (mut transport, requests, replies) = ChannelTransport::pair("test");
        drop((requests, replies));
        assert!(matches!(transport.write(&[1]), Err(TransportError::Gone { .. })));
        assert!(matches!(transport.read(&mut [0], Duration::ZERO), Err(TransportError::Gone { .. })));
    }
}

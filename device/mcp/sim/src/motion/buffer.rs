//! The buffer of motion commands of a channel (MCP manual, command 47).

use super::{DistanceMove, PositionMove};

/// Reading of command 47 when nothing is buffered and the last buffered command has finished.
pub const BUFFER_EMPTY: u8 = 0x80;

/// Commands a buffer holds, the executing one included: 64 (MCP manual, command 47), so that at most 63 = 0x3F wait.
pub const BUFFER_CAPACITY: usize = 64;

/// A command that can wait in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferedMove {
    Distance(DistanceMove),
    Position(PositionMove),
}

/// Commands waiting behind the executing one, first come first served, without heap.
#[derive(Clone, Debug)]
pub(crate) struct CommandQueue {
    moves: [Option<BufferedMove>; BUFFER_CAPACITY - 1],
    first: usize,
    len: usize,
}

impl CommandQueue {
    pub fn new() -> Self {
        CommandQueue { moves: [None; BUFFER_CAPACITY - 1], first: 0, len: 0 }
    }

    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// False when full; then nothing is added.
    #[must_use]
    pub fn push(&mut self, buffered: BufferedMove) -> bool {
        if self.len == self.moves.len() {
            return false;
        }
        self.moves[(self.first + self.len) % self.moves.len()] = Some(buffered);
        self.len += 1;
        true
    }

    pub fn pop(&mut self) -> Option<BufferedMove> {
        if self.len == 0 {
            return None;
        }
        let buffered = self.moves[self.first].take();
        self.first = (self.first + 1) % self.moves.len();
        self.len -= 1;
        buffered
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(distance_counts: u32) -> BufferedMove {
        BufferedMove::Distance(DistanceMove { speed_counts_per_s: 1, acceleration: None, distance_counts })
    }

    #[test]
    fn the_queue_keeps_order_across_its_end_and_refuses_what_does_not_fit() {
        let mut queue = CommandQueue::new();
        for number in 0..40 {
            assert!(queue.push(distance(number)));
        }
        for number in 0..30 {
            assert_eq!(queue.pop(), Some(distance(number)));
        }
        for number in 40..93 {
            assert!(queue.push(distance(number)));
        }
        assert_eq!(queue.len(), 63);
        assert!(!queue.push(distance(999)));
        for number in 30..93 {
            assert_eq!(queue.pop(), Some(distance(number)));
        }
        assert_eq!(queue.pop(), None);
    }
}

//! What commands 180 to 182, 190 and 191 reach: a CAN port that hears itself, and an object dictionary.
//!
//! Assumed as a whole: the vendor's libraries contradict each other about these commands. Frames that are put come back, as in
//! a controller in loop-back mode; the dictionary keeps what is written to it. Objects 0x2000 + command number mirror packet serial
//! commands (public clients, 2015-2020); the controller fills them in before it looks here.

use std::collections::{BTreeMap, VecDeque};

/// Frames the port can hold.
const RECEIVE_QUEUE: usize = 16;

/// CANopen abort code "object does not exist in the object dictionary".
pub const NO_SUCH_OBJECT: u32 = 0x0602_0000;
/// CANopen abort code "sub-index does not exist".
pub const NO_SUCH_SUBINDEX: u32 = 0x0609_0011;
/// Result of a successful access.
pub const ACCESS_DONE: u32 = 0;

/// Index of the object that stands for packet serial command 0.
pub const COMMAND_OBJECTS: u16 = 0x2000;

/// One CAN frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CanFrame {
    /// COB id.
    pub cob_id: u16,
    /// Remote transmission request.
    pub remote: u8,
    /// Bytes in use, at most 8.
    pub length: u8,
    /// The data, the unused rest as sent.
    pub data: [u8; 8],
}

/// One object dictionary entry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CanObject {
    /// The value.
    pub value: u32,
    /// Its size in bytes.
    pub size: u8,
}

/// The port and the dictionary.
#[derive(Clone, Debug, Default)]
pub struct Can {
    received: VecDeque<CanFrame>,
    objects: BTreeMap<(u16, u8), CanObject>,
}

impl Can {
    /// Error state as register CANESR has it (MCP manual 3.1): bits 31 to 24 receive errors, 23 to 16 transmit errors,
    /// 2 bus off, 1 passive, 0 warning. A port in loop-back has none.
    pub fn error_state(&self) -> u32 {
        0
    }

    /// Puts a frame on the bus; it comes back. With a full queue the oldest is lost.
    pub fn put(&mut self, frame: CanFrame) {
        if self.received.len() == RECEIVE_QUEUE {
            self.received.pop_front();
        }
        self.received.push_back(frame);
    }

    /// Takes the oldest frame received.
    pub fn take(&mut self) -> Option<CanFrame> {
        self.received.pop_front()
    }

    /// Writes an entry.
    pub fn write(&mut self, index: u16, subindex: u8, object: CanObject) -> u32 {
        self.objects.insert((index, subindex), object);
        ACCESS_DONE
    }

    /// Reads an entry.
    pub fn read(&self, index: u16, subindex: u8) -> Result<CanObject, u32> {
        match self.objects.get(&(index, subindex)) {
            Some(object) => Ok(*object),
            None if self.objects.keys().any(|(known, _)| *known == index) => Err(NO_SUCH_SUBINDEX),
            None => Err(NO_SUCH_OBJECT),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_back_in_order_and_a_full_queue_loses_the_oldest() {
        let mut can = Can::default();
        assert_eq!(can.take(), None);
        for id in 0..=RECEIVE_QUEUE as u16 {
            can.put(CanFrame { cob_id: id, ..CanFrame::default() });
        }
        assert_eq!(can.take().map(|frame| frame.cob_id), Some(1));
    }

    #[test]
    fn the_dictionary_keeps_what_it_is_given_and_names_what_it_lacks() {
        let mut can = Can::default();
        assert_eq!(can.read(0x1000, 0), Err(NO_SUCH_OBJECT));
        can.write(0x1000, 0, CanObject { value: 7, size: 1 });
        assert_eq!(can.read(0x1000, 0), Ok(CanObject { value: 7, size: 1 }));
        assert_eq!(can.read(0x1000, 1), Err(NO_SUCH_SUBINDEX));
    }
}

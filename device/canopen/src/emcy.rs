//! Emergency messages (CiA 301).

use super::{Frame, Function, NodeId};

/// What a node reports when something went wrong, and when it is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Emergency {
    /// The node.
    pub node: NodeId,
    /// What: the high byte is a class, 0x0000 means "over".
    pub code: u16,
    /// The error register, object 0x1001.
    pub register: u8,
    /// Of the manufacturer's choice.
    pub data: [u8; 5],
}

impl Emergency {
    /// The frame.
    #[must_use]
    pub fn frame(&self) -> Frame {
        let [low, high] = self.code.to_le_bytes();
        let [a, b, c, d, e] = self.data;
        Frame::full(Function::Emergency(self.node).id(), [low, high, self.register, a, b, c, d, e])
    }

    /// Reads the frame.
    #[must_use]
    pub fn read(frame: &Frame) -> Option<Self> {
        let Function::Emergency(node) = Function::of(frame.id())? else { return None };
        let [low, high, register, a, b, c, d, e] = frame.bytes() else { return None };
        let code = u16::from_le_bytes([*low, *high]);
        Some(Self { node, code, register: *register, data: [*a, *b, *c, *d, *e] })
    }

    /// What the class of its code stands for (CiA 301, table of emergency error codes).
    #[must_use]
    pub fn class(&self) -> &'static str {
        match self.code >> 8 {
            0x00 => "no error any more",
            0x10 => "generic error",
            0x20..=0x23 => "current",
            0x30..=0x33 => "voltage",
            0x40..=0x42 => "temperature",
            0x50 => "hardware",
            0x60..=0x63 => "software",
            0x70 => "additional modules",
            0x80..=0x82 => "monitoring",
            0x90 => "external error",
            0xF0 => "additional functions",
            0xFF => "device specific",
            _ => "reserved",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::CanId;
    use super::*;

    #[test]
    fn a_lost_heartbeat_is_reported_as_8130() {
        let emergency =
            Emergency { node: NodeId::new(3).unwrap(), code: 0x8130, register: 0x11, data: [1, 2, 3, 4, 5] };
        let frame = emergency.frame();
        assert_eq!(frame.id(), CanId::Standard(0x083)); // 0x080 + node
        // code low, code high, error register (generic and communication), five bytes of the manufacturer
        assert_eq!(frame.bytes(), [0x30, 0x81, 0x11, 1, 2, 3, 4, 5]);
        assert_eq!(Emergency::read(&frame), Some(emergency));
        assert_eq!(emergency.class(), "monitoring");
    }
}

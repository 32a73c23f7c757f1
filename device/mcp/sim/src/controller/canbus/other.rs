//! A node of another maker on the same bus: it answers for its device type and name, and takes whatever is written to it.

use brushwork_canopen::nmt::objects;
use brushwork_canopen::sdo::{Abort, Dictionary, Server};
use brushwork_canopen::{Frame, Function, NodeId};

/// A drive of the profile CiA 402 in its first two words.
const DEVICE_TYPE: u32 = 0x0002_0192;

/// The node, and what was written to it.
#[derive(Clone, Debug)]
pub struct OtherNode {
    node: NodeId,
    server: Server,
    objects: Objects,
}

#[derive(Clone, Debug, Default)]
struct Objects {
    written: Vec<(u16, u8)>,
}

impl OtherNode {
    /// A node of that number.
    pub fn new(node: NodeId) -> Self {
        Self { node, server: Server::default(), objects: Objects::default() }
    }

    /// The objects that were written, index and subindex, in order.
    pub fn written(&self) -> &[(u16, u8)] {
        &self.objects.written
    }

    /// Takes a frame from the bus and says what it answers.
    pub fn take(&mut self, frame: &Frame) -> Option<Frame> {
        if Function::of(frame.id()) != Some(Function::SdoRequest(self.node)) {
            return None;
        }
        let answer = self.server.take(frame.bytes(), &mut self.objects)?;
        Some(Frame::full(Function::SdoResponse(self.node).id(), answer))
    }
}

impl Dictionary for Objects {
    fn read(&mut self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort> {
        match (index, subindex) {
            (objects::DEVICE_TYPE, 0) => Ok(DEVICE_TYPE.to_le_bytes().to_vec()),
            (objects::DEVICE_NAME, 0) => Ok(b"Another drive".to_vec()),
            _ => Err(Abort::NO_OBJECT),
        }
    }

    fn write(&mut self, index: u16, subindex: u8, _: &[u8]) -> Result<(), Abort> {
        self.written.push((index, subindex));
        Ok(())
    }
}

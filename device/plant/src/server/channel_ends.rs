//! What a client inside the program holds of its line.

use super::shared_time::SharedTime;
use crossbeam_channel::{Receiver, Sender};

/// The client's two ends of an in-process line. Each message is one write. When the controller is unplugged both ends are
/// disconnected.
#[derive(Debug)]
pub struct ChannelEnds {
    /// Bytes to the controller.
    pub to_controller: Sender<Vec<u8>>,
    /// Bytes from the controller.
    pub from_controller: Receiver<Vec<u8>>,
    /// The machine's time, in which the client may take part.
    pub time: SharedTime,
}

//! What the driver needs of an endpoint.

use super::channel_ends::ChannelEnds;
use super::error::ServerError;
use super::shared_time::SharedTime;
use std::time::Duration;

/// One endpoint: bytes in and out, whether or not a client is there.
pub trait Line: Send {
    /// Waits until bytes are there, at most `timeout`, and appends them to `bytes`.
    fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard;

    /// Sends a reply in one write. Without a client, and where the client does not read, the bytes are lost.
    fn send(&mut self, reply: &[u8]);

    /// Takes the endpoint away, as when the cable is pulled out: a client sees the device gone.
    fn unplug(&mut self);

    /// Brings the endpoint back.
    fn plug_in(&mut self) -> Result<(), ServerError>;

    /// Whether a client that is there holds the port's RTS line, as this program's own does. A pseudo-terminal and a socket have none.
    fn has_rts(&self) -> bool {
        false
    }

    /// Connects a client inside the program, which may share the machine's time; none where the endpoint is no channel.
    fn new_channel(&mut self, _time: &SharedTime) -> Option<ChannelEnds> {
        None
    }
}

/// What a wait brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heard {
    /// Bytes, or nothing in that time.
    Line,
    /// The client closed: what was on its way to it is lost.
    ClientLeft,
}

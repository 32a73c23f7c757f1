//! The endpoint inside the program: a pair of bounded channels.

use super::channel_ends::ChannelEnds;
use super::error::ServerError;
use super::line::{Heard, Line};
use super::shared_time::SharedTime;
use crossbeam_channel::{Receiver, Select, Sender, bounded};
use std::thread;
use std::time::Duration;

/// Writes of either side that may wait to be read.
const CAPACITY: usize = 256;

/// The controller's side.
#[derive(Debug, Default)]
pub struct ChannelLine {
    client: Option<Client>,
}

#[derive(Debug)]
struct Client {
    requests: Receiver<Vec<u8>>,
    replies: Sender<Vec<u8>>,
}

impl Line for ChannelLine {
    fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard {
        let Some(Client { requests, .. }) = &self.client else {
            thread::sleep(timeout);
            return Heard::Line;
        };
        // A choice among one sleeps at once. `recv_timeout` gives the processor away a few times first, and on a crowded computer each time
        // costs a turn of all the others: a reply then was 44 ms late in the median.
        let mut only = Select::new();
        only.recv(requests);
        let Ok(chosen) = only.select_timeout(timeout) else { return Heard::Line };
        if let Ok(first) = chosen.recv(requests) {
            bytes.extend(first);
            bytes.extend(requests.try_iter().flatten());
            Heard::Line
        } else {
            self.client = None;
            Heard::ClientLeft
        }
    }

    fn send(&mut self, reply: &[u8]) {
        if let Some(Client { replies, .. }) = &self.client {
            // A full channel belongs to a client that does not read: the bytes are lost, as on any port.
            let _ = replies.try_send(reply.to_vec());
        }
    }

    fn unplug(&mut self) {
        self.client = None;
    }

    fn plug_in(&mut self) -> Result<(), ServerError> {
        Ok(())
    }

    fn has_rts(&self) -> bool {
        true
    }

    fn new_channel(&mut self, time: &SharedTime) -> Option<ChannelEnds> {
        let (to_controller, requests) = bounded(CAPACITY);
        let (replies, from_controller) = bounded(CAPACITY);
        self.client = Some(Client { requests, replies });
        Some(ChannelEnds { to_controller, from_controller, time: time.clone() })
    }
}

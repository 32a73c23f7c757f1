//! The device threads of all links, open and opening. What is known of each link is its connection in the model.

use std::collections::BTreeMap;
use std::sync::Arc;

use brushwork_link::device::{DeviceHandle, Stopper};
use crossbeam_channel::Receiver;

use super::model::ConnectionId;
use super::parts::{OpenLink, SimulatedWorld};
use brushwork_core::session::SessionError;

/// What belongs to one connection outside the model.
#[derive(Default)]
pub struct Link {
    pub opening: Option<Receiver<Result<OpenLink, SessionError>>>,
    pub device: Option<DeviceHandle>,
    /// Whether the device thread was told to read the input pins.
    pub reads_signals: bool,
    /// Whether the device thread was told to tell what goes over the wire.
    pub traced: bool,
    /// Lives on when the link ends, so that a cable that was pulled out can be put back.
    pub world: Option<Arc<dyn SimulatedWorld>>,
}

/// The links of all connections.
#[derive(Default)]
pub struct Links(BTreeMap<ConnectionId, Link>);

impl Links {
    pub fn get(&self, connection: ConnectionId) -> Option<&Link> {
        self.0.get(&connection)
    }

    pub fn entry(&mut self, connection: ConnectionId) -> &mut Link {
        self.0.entry(connection).or_default()
    }

    pub fn device(&self, connection: ConnectionId) -> Option<&DeviceHandle> {
        self.0.get(&connection)?.device.as_ref()
    }

    /// Every connection that has or had a link.
    pub fn ids(&self) -> Vec<ConnectionId> {
        self.0.keys().copied().collect()
    }

    /// What stops the open links.
    pub fn stoppers(&self) -> impl Iterator<Item = Stopper> {
        self.0.values().filter_map(|link| link.device.as_ref()).map(DeviceHandle::stopper)
    }

    /// Stops all motors of every open link. Waits for none of them.
    pub fn stop_all(&self) {
        self.0.values().filter_map(|link| link.device.as_ref()).for_each(DeviceHandle::stop_all);
    }

    /// Forgets a connection's link and closes it if it is open.
    pub fn remove(&mut self, connection: ConnectionId) {
        if let Some(link) = self.0.remove(&connection) {
            link.device.map(close);
        }
    }
}

/// Every link is stopped before any is waited for, so that one that hangs does not keep the others from it.
impl Drop for Links {
    fn drop(&mut self) {
        self.stop_all();
        let devices = std::mem::take(&mut self.0).into_values().filter_map(|link| link.device);
        let closing: Vec<_> = devices.map(close).collect();
        for thread in closing.into_iter().flatten() {
            // A panic there is reported by its own thread.
            let _ = thread.join();
        }
    }
}

/// Closes a link. Dropping waits for the link's thread to end, the window does not; without a thread it has to.
pub fn close(device: DeviceHandle) -> Option<std::thread::JoinHandle<()>> {
    std::thread::Builder::new().name("close link".to_owned()).spawn(move || drop(device)).ok()
}

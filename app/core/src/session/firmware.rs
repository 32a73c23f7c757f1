//! Sending firmware to a unit that is in its loader, on a thread of its own.
//!
//! The device thread has let go of the line by then ([`Event::LoaderEntered`](brushwork_link::device::Event::LoaderEntered)). A real unit
//! comes back as another USB device, so its port is looked for by name; everything else is opened again as it was.

use crate::messages::{CoreActMessage, CoreCauseMessage, UpdateMessage};
use brushwork_link::Message;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use brushwork_link::loader::Loads;
use brushwork_link::transport::{ConnectTarget, PortInfo, Transport, list_ports};
use brushwork_link::{Failure, SystemClock};
use crossbeam_channel::{Receiver, Sender, bounded};

use super::{Simulation, connect};

/// How long a unit may take to appear as a loader on USB. Assumed; the library that is public waits for Windows to find it.
const APPEAR_LIMIT: Duration = Duration::from_secs(60);
/// How often the ports are looked through.
const LOOK_INTERVAL: Duration = Duration::from_millis(200);
/// How long a line that stays the same is left alone while the unit restarts.
const RESTART_PAUSE: Duration = Duration::from_millis(300);

/// Where a unit will be found once it is in its loader.
#[derive(Clone, Debug)]
pub struct LoaderPlace {
    target: ConnectTarget,
    simulation: Option<Arc<Simulation>>,
    changes_name: bool,
}

/// What an upload tells.
#[derive(Clone, Debug)]
pub enum UploadEvent<F: Loads> {
    /// It goes on.
    Progress(F::Progress),
    /// It ended, well or not.
    Ended(Result<F::Sent, Failure>),
}

/// A running upload. Dropping it does not end it: there is no safe moment for that.
#[derive(Debug)]
pub struct Upload<F: Loads> {
    events: Receiver<UploadEvent<F>>,
    cancelled: Arc<AtomicBool>,
}

impl LoaderPlace {
    /// Where the unit behind `target` will be. To be asked while it is still connected, or of the loader's own port.
    #[must_use]
    pub fn of(target: &ConnectTarget, simulation: Option<Arc<Simulation>>) -> Self {
        Self::among(target, simulation, &list_ports().unwrap_or_default())
    }

    /// The same where the ports are known already.
    #[must_use]
    pub fn among(target: &ConnectTarget, simulation: Option<Arc<Simulation>>, ports: &[PortInfo]) -> Self {
        let changes_name = match target {
            ConnectTarget::Serial { path, .. } => {
                ports.iter().any(|port| port.is_usb && port.name == real_path(path))
            }
            ConnectTarget::Tcp { .. } | ConnectTarget::Can { .. } | ConnectTarget::Sim(_) => false,
        };
        Self { target: target.clone(), simulation, changes_name }
    }

    /// Opens the line to the loader, waiting for it to appear.
    fn open<F: Loads>(&self, goes_on: &dyn Fn() -> bool) -> Result<Box<dyn Transport>, Failure> {
        let begun_at = Instant::now();
        let mut came_back = CoreCauseMessage::NoLoader.into();
        while goes_on() && begun_at.elapsed() < APPEAR_LIMIT {
            std::thread::sleep(if self.changes_name { LOOK_INTERVAL } else { RESTART_PAUSE });
            match self.look() {
                Ok(Some(transport)) => return Ok(transport),
                Ok(None) => {}
                Err(why) => came_back = why,
            }
        }
        let came_back = if goes_on() { came_back } else { F::cancelled() };
        Err(Failure::new(CoreActMessage::OpenLoader, self.target.to_string(), came_back, F::nothing_sent()))
    }

    fn look(&self) -> Result<Option<Box<dyn Transport>>, Message> {
        let target = match &self.target {
            ConnectTarget::Serial { baud, line, .. } if self.changes_name => {
                let ports = list_ports().map_err(Message::error)?;
                match loader_port(&ports)? {
                    Some(path) => ConnectTarget::Serial { path, baud: *baud, line: *line },
                    None => return Ok(None),
                }
            }
            same @ (ConnectTarget::Serial { .. }
            | ConnectTarget::Tcp { .. }
            | ConnectTarget::Can { .. }
            | ConnectTarget::Sim(_)) => same.clone(),
        };
        connect(&target, self.simulation.clone())
            .map(|(transport, _)| Some(transport))
            .map_err(Message::error)
    }
}

impl<F: Loads> Upload<F> {
    /// Starts to send firmware.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(place: LoaderPlace, firmware: F) -> Result<Self, UpdateMessage> {
        let (events, receiver) = bounded(64);
        let cancelled = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&cancelled);
        let work = move || {
            let ended = run(&place, &firmware, &seen, &events);
            // Nobody may be left to hear it.
            let _ = events.send(UploadEvent::Ended(ended));
        };
        let thread = std::thread::Builder::new().name("firmware".to_owned());
        thread.spawn(work).map_err(|error| UpdateMessage::NoThread { error: error.to_string() })?;
        Ok(Self { events: receiver, cancelled })
    }

    /// What it tells.
    #[must_use]
    pub fn events(&self) -> &Receiver<UploadEvent<F>> {
        &self.events
    }

    /// Ends it, provided that nothing has been erased yet; afterwards this does nothing.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
    }
}

fn run<F: Loads>(
    place: &LoaderPlace,
    firmware: &F,
    cancelled: &AtomicBool,
    events: &Sender<UploadEvent<F>>,
) -> Result<F::Sent, Failure> {
    let goes_on = || !cancelled.load(Ordering::SeqCst);
    let mut transport = place.open::<F>(&goes_on)?;
    let mut reported = None;
    firmware.send(transport.as_mut(), &*SystemClock::shared(), &mut |progress| {
        // A window that does not look misses some pages, never the end.
        if reported != Some(progress) {
            let _ = events.try_send(UploadEvent::Progress(progress));
            reported = Some(progress);
        }
        goes_on()
    })
}

/// The one port that belongs to a loader.
fn loader_port(ports: &[PortInfo]) -> Result<Option<String>, CoreCauseMessage> {
    let mut loaders = ports.iter().filter(|port| port.is_loader());
    let first = loaders.next().map(|port| port.name.clone());
    match loaders.next() {
        Some(second) => {
            let (first, second) = (first.unwrap_or_default(), second.name.clone());
            Err(CoreCauseMessage::TwoLoaders { first, second })
        }
        None => Ok(first),
    }
}

pub(super) fn real_path(path: &str) -> String {
    let real = std::fs::canonicalize(path).ok().and_then(|real| real.to_str().map(str::to_owned));
    real.unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(name: &str, product: &str) -> PortInfo {
        PortInfo {
            name: name.to_owned(),
            is_usb: true,
            product: Some(product.to_owned()),
            ..PortInfo::default()
        }
    }

    #[test]
    fn the_loader_is_known_by_its_usb_name_and_two_are_one_too_many() {
        brushwork_link::install(&[&brushwork_mcp_client::McpDriver]);
        let controller = port("/dev/ttyACM0", "MCP266 2x60A");
        let loader = port("/dev/ttyACM1", "MCP266ASTULDR");
        let other = port("/dev/ttyACM2", "MCP2160ULDR");
        assert_eq!(loader_port(std::slice::from_ref(&controller)).unwrap(), None);
        assert_eq!(loader_port(&[controller, loader.clone()]).unwrap().as_deref(), Some("/dev/ttyACM1"));
        let error = loader_port(&[loader, other]).unwrap_err().to_string();
        assert!(error.contains("/dev/ttyACM1 and /dev/ttyACM2"), "{error}");
    }

    #[test]
    fn a_line_of_a_simulated_controller_keeps_its_name() {
        let target: ConnectTarget = "sim:mcp266".parse().unwrap();
        assert!(!LoaderPlace::of(&target, None).changes_name);
    }
}

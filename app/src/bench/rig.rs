//! A paced simulated controller on a real pseudo-terminal (TCP where there are none), tapped on the client's side and watched at its bridge.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use brushwork_link::device::{Addresses, DeviceHandle, DeviceOptions, DeviceThread, Event, PollRate};
use brushwork_link::transport::{SerialTransport, Stream, TcpTransport, Transport};
use brushwork_link::{Clock, FamilyChoice, SystemClock};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};

use super::tap::{Log, Tap};
use super::watched::{Bridge, Watched};
use brushwork_cli::interrupt::Interrupt;

/// How long the device thread may take to find the controller.
const FIND_LIMIT: Duration = Duration::from_secs(10);

/// The controller at the far end of a wire.
pub struct Far {
    /// The simulated unit.
    pub machine: Box<dyn Machine>,
    /// Its stream that is served: one whose rate counts.
    pub index: StreamIndex,
    /// What that stream is to a client.
    pub stream: Stream,
    /// What it speaks.
    pub family: FamilyChoice,
    /// Its address.
    pub address: u8,
}

/// A controller at the far end of a wire.
pub struct Rig {
    server: SimHandle<Watched>,
    rate_bps: u32,
    options: DeviceOptions,
    /// What passes on the wire.
    pub log: Log,
    /// What the controller's bridge does.
    pub bridge: Bridge,
}

impl Rig {
    /// Puts the controller on a wire of the rate that its stream is set to.
    pub fn start(far: Far) -> Result<Self, String> {
        let rate_bps = far.machine.bits_per_second(far.index);
        let bridge = Bridge::default();
        let machine = Watched::new(far.machine, bridge.clone());
        let options = ServerOptions { stream: far.index, pace: true, ..ServerOptions::default() };
        let server = Server::spawn(machine, options, &endpoint()).map_err(|error| error.to_string())?;
        let options = DeviceOptions {
            addresses: Addresses::Only(far.address),
            family: far.family,
            stream: Some(far.stream),
            poll: PollRate::Fastest,
            ..DeviceOptions::default()
        };
        Ok(Self { server, rate_bps, options, log: Log::default(), bridge })
    }

    /// What lies between the ends, for notes.
    pub fn line(&self) -> &'static str {
        if cfg!(unix) { "pseudo-terminal" } else { "TCP" }
    }

    /// Bits per second of the wire.
    pub fn rate_bps(&self) -> u32 {
        self.rate_bps
    }

    /// A device thread at the near end that polls as fast as it can, once it has found the controller.
    pub fn connect(&self, interrupt: &Interrupt) -> Result<DeviceHandle, String> {
        let device = self.open()?;
        let deadline = Instant::now() + FIND_LIMIT;
        while Instant::now() < deadline && !interrupt.is_raised() {
            match device.events().recv_timeout(Duration::from_millis(20)) {
                Ok(Event::Selected { .. }) => return Ok(device),
                Ok(Event::Lost(failure)) => return Err(failure.to_string().trim_end_matches('.').to_owned()),
                _ => {}
            }
        }
        Err("the simulated controller was not found in time".to_owned())
    }

    /// The same, before it has found anything.
    pub fn open(&self) -> Result<DeviceHandle, String> {
        let tap = Tap::new(self.transport()?, self.log.clone());
        let clock: Arc<dyn Clock> = SystemClock::shared();
        DeviceThread::spawn(Box::new(tap), clock, self.options.clone()).map_err(|error| error.to_string())
    }

    fn transport(&self) -> Result<Box<dyn Transport>, String> {
        let address = self.server.address();
        match address.strip_prefix("tcp:") {
            Some(address) => TcpTransport::connect(address)
                .map(|transport| Box::new(transport) as Box<dyn Transport>)
                .map_err(|error| error.to_string()),
            None => SerialTransport::open(address, self.rate_bps)
                .map(|transport| Box::new(transport) as Box<dyn Transport>)
                .map_err(|error| error.to_string()),
        }
    }
}

/// A link of this process's own in the folder for temporary files.
fn endpoint() -> Endpoint {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = format!("brushwork-bench-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    if cfg!(unix) {
        Endpoint::Pty { link: std::env::temp_dir().join(name) }
    } else {
        Endpoint::Tcp(std::net::SocketAddr::from(([127, 0, 0, 1], 0)))
    }
}

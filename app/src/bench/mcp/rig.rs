//! A paced simulated controller on a real pseudo-terminal (TCP where there are none), tapped on the client's side.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use brushwork_link::device::{Addresses, DeviceHandle, DeviceOptions, DeviceThread, Event, PollRate};
use brushwork_link::transport::{SerialTransport, Stream, TcpTransport, Transport};
use brushwork_link::{Clock, SystemClock};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, turnaround};
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};

use super::super::tap::{Log, Tap};
use brushwork_cli::interrupt::Interrupt;

/// The stream that is served: one whose rate counts.
const SERVED: StreamIndex = StreamIndex::Uart1;
/// How long the device thread may take to find the controller.
const FIND_LIMIT: Duration = Duration::from_secs(10);

/// A controller at the far end of a wire.
pub struct Rig {
    server: SimHandle<Bus>,
    rate_bps: u32,
    /// What passes on the wire.
    pub log: Log,
}

impl Rig {
    /// An MCP266 of this generation whose TTL1 stream is set to `rate_bps`.
    pub fn start(generation: Generation, rate_bps: u32) -> Result<Self, String> {
        let config = ControllerConfig { generation, ..ControllerConfig::default() };
        let unit = |config| Controller::new(config).map_err(|error| error.to_string());
        let mut settings = unit(config.clone())?.settings();
        settings.streams[SERVED.index()].rate_bps = rate_bps;
        let unit = unit(ControllerConfig { settings: Some(settings), ..config })?;
        let options = ServerOptions { stream: SERVED, pace: true, ..ServerOptions::default() };
        let server = Server::spawn(Bus::single(unit, SERVED), options, &endpoint())
            .map_err(|error| error.to_string())?;
        Ok(Self { server, rate_bps, log: Log::default() })
    }

    /// What lies between the ends, for notes.
    pub fn line(&self) -> &'static str {
        if cfg!(unix) { "pseudo-terminal" } else { "TCP" }
    }

    /// Bits per second of the wire.
    pub fn rate_bps(&self) -> u32 {
        self.rate_bps
    }

    /// The time the simulator states between a request and its reply.
    pub fn turnaround(&self) -> Duration {
        turnaround(SERVED, self.rate_bps)
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
        let options = DeviceOptions {
            addresses: Addresses::Only(Address::DEFAULT.get()),
            stream: Some(Stream::Ttl1),
            poll: PollRate::Fastest,
            ..DeviceOptions::default()
        };
        let clock: Arc<dyn Clock> = SystemClock::shared();
        DeviceThread::spawn(Box::new(tap), clock, options).map_err(|error| error.to_string())
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

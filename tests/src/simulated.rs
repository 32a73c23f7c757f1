//! A simulated controller that runs in real time on a pseudo-terminal of its own, with the test looking over its shoulder.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use brushwork_protocol::canopen::NodeId;
use brushwork_protocol::canopen::adapter::Form;
use brushwork_protocol::packet_serial::{Generation, Motor};
use brushwork_sim::bridge::BridgeOutput;
use brushwork_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_sim::machine::{Machine as _, StreamIndex};
use brushwork_sim::server::{Endpoint, Server, ServerOptions, SimHandle};
use brushwork_sim::world::WorldAction;
use serde_json::Value;
use tempfile::TempDir;

use crate::{foreign, truth};

/// Between two looks of [`OnPty::wait_until`].
const LOOK_INTERVAL: Duration = Duration::from_millis(2);

/// A controller on a pseudo-terminal; both go when this is dropped.
pub struct OnPty {
    handle: SimHandle<Bus>,
    folder: TempDir,
}

impl OnPty {
    /// An MCP266 without noise, on its USB port.
    #[must_use]
    pub fn start(generation: Generation) -> Self {
        Self::start_with(ControllerConfig { generation, ..ControllerConfig::default() }, StreamIndex::Usb)
    }

    /// Any controller, on any of its ports.
    ///
    /// # Panics
    /// When the controller cannot be built or the system gives no pseudo-terminal.
    #[must_use]
    pub fn start_with(config: ControllerConfig, stream: StreamIndex) -> Self {
        let controller = Controller::new(config).expect("the presets make a controller");
        Self::serve(Bus::single(controller, stream), stream)
    }

    /// An MCP266 as a node of a CAN bus, behind an adapter.
    ///
    /// # Panics
    /// When the system gives no pseudo-terminal.
    #[must_use]
    pub fn on_can(node: NodeId, form: Form) -> Self {
        let mut config = ControllerConfig::default();
        config.set_node(node);
        let controller = Controller::new(config).expect("the presets make a controller");
        let bus = Bus::on_can(vec![controller], form).expect("there is a unit");
        Self::serve(bus, StreamIndex::Usb)
    }

    fn serve(bus: Bus, stream: StreamIndex) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let endpoint = Endpoint::Pty { link: folder.path().join("controller") };
        let options = ServerOptions { stream, ..ServerOptions::default() };
        let handle =
            Server::spawn(bus, options, &endpoint).expect("the system has a pseudo-terminal to give");
        Self { handle, folder }
    }

    /// The path that a client opens.
    #[must_use]
    pub fn port(&self) -> PathBuf {
        self.folder.path().join("controller")
    }

    /// Looks at the controller between two steps.
    ///
    /// # Panics
    /// When the server has ended.
    pub fn look<T: Send + 'static>(&self, look: impl FnOnce(&Controller) -> T + Send + 'static) -> T {
        self.handle.inspect(|bus| look(&bus.controllers()[0])).expect("the server runs as long as this does")
    }

    /// Does something to the machine.
    ///
    /// # Panics
    /// When the server has ended.
    pub fn apply(&self, action: WorldAction) {
        self.handle.apply(0, action).expect("the server runs as long as this does");
    }

    /// Lets bytes come in as if the client had sent them.
    ///
    /// # Panics
    /// When the server has ended.
    pub fn receive(&self, bytes: Vec<u8>) {
        let receive = move |bus: &mut Bus| {
            let stream = bus.stream();
            bus.receive(stream, &bytes);
        };
        self.handle.inspect(receive).expect("the server runs as long as this does");
    }

    /// Waits until `holds` does, and returns how long that took; none when `limit` passes first.
    pub fn wait_until(&self, limit: Duration, holds: fn(&Controller) -> bool) -> Option<Duration> {
        let start = Instant::now();
        while start.elapsed() < limit {
            if self.look(holds) {
                return Some(start.elapsed());
            }
            std::thread::sleep(LOOK_INTERVAL);
        }
        None
    }
}

/// Whether the bridge of either motor is driven.
#[must_use]
pub fn is_driven(controller: &Controller) -> bool {
    let outputs = controller.view().axes.map(|axis| axis.output);
    outputs.iter().any(|output| matches!(output, BridgeOutput::Duty(duty) if *duty != 0.0))
}

/// Whether both bridges are at rest and both shafts have all but stopped.
#[must_use]
pub fn is_at_rest(controller: &Controller) -> bool {
    const STILL_COUNTS_PER_S: f64 = 20.0;
    let slow = |motor| truth::speed_counts_per_s(controller, motor).abs() < STILL_COUNTS_PER_S;
    !is_driven(controller) && Motor::BOTH.into_iter().all(slow)
}

impl foreign::Simulated for OnPty {
    fn truth(&mut self) -> Value {
        self.look(truth::of)
    }

    fn act(&mut self, action: &str) -> Result<(), String> {
        let action = match action {
            "press_estop" => WorldAction::EStop { pressed: true },
            "release_estop" => WorldAction::EStop { pressed: false },
            other => return Err(format!("no action `{other}`")),
        };
        self.apply(action);
        Ok(())
    }
}

//! A simulated controller that runs in real time on a port of its own, with the test looking over its shoulder.

use std::path::PathBuf;
use std::time::Duration;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_child::ahead;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use serde_json::Value;
use tempfile::TempDir;

use crate::{foreign, truth, wait};

/// The time-out of a [`OnPort::patient`] controller.
pub const PATIENT_TIME_OUT: Duration = Duration::from_secs(60);

/// How a program is told of a pseudo-terminal that may be late, behind its path. See [`OnPty`].
pub const LATE_PTY: &str = ",latency=4000";

/// The name of the pseudo-terminal.
const LINK: &str = "controller";

/// How the motors were switched off, in the controller's own time, which does not depend on how busy the machine is.
#[derive(Clone, Copy, Debug)]
pub struct Off {
    /// The longest silence on the line while the motors were still seen driven.
    pub driven_in_silence: Duration,
    /// How long the line had been silent when they were first seen off.
    pub silent_for: Duration,
}

/// A controller on a pseudo-terminal, or else on a TCP port; both go when this is dropped.
pub struct OnPort<const IS_PTY: bool> {
    handle: SimHandle<Bus>,
    folder: TempDir,
}

/// A controller on a pseudo-terminal: for clients that open a file, and where the serial port is what is looked at.
///
/// On a busy machine it is late. Between a client and a server that went before all other programs, by a real-time policy, answers took up to 2 s
/// beside this suite and four busy processes; between the same two, at the same time, no answer through TCP took 50 ms. What is late is Linux: what
/// is written at one end comes to the other by a worker of the kernel (`kworker`, workqueue `events_unbound`), which waits for a processor like any
/// thread of no priority, and a reader waits for it. Beside four busy processes a byte and its answer took up to 0.3 s, and 4 ms when these
/// workers, and nothing else, had been given a real-time policy, which is the machine's own affair and not that of a test.
pub type OnPty = OnPort<true>;

/// A controller on a TCP port.
pub type OnTcp = OnPort<false>;

impl<const IS_PTY: bool> OnPort<IS_PTY> {
    /// An MCP266 without noise, on its USB port.
    #[must_use]
    pub fn start(generation: Generation) -> Self {
        Self::start_with(ControllerConfig { generation, ..ControllerConfig::default() }, StreamIndex::Usb)
    }

    /// A controller with a time-out so long that it is not what stops the motors in a test.
    #[must_use]
    pub fn patient(generation: Generation) -> Self {
        Self::start_with(patient(generation), StreamIndex::Usb)
    }

    /// Any controller, on any of its ports.
    ///
    /// # Panics
    /// When the controller cannot be built or the system gives no port.
    #[must_use]
    pub fn start_with(config: ControllerConfig, stream: StreamIndex) -> Self {
        let controller = Controller::new(config).expect("the presets make a controller");
        Self::serve(Bus::single(controller, stream), stream)
    }

    /// MCP266s at these addresses on one TTL line, with the time-out of a [`OnPort::patient`] one.
    ///
    /// # Panics
    /// When the system gives no port.
    #[must_use]
    pub fn line(addresses: &[u8]) -> Self {
        Self::line_of(ControllerConfig::default().generation, addresses)
    }

    /// The same with firmware of a generation.
    ///
    /// # Panics
    /// When the system gives no port.
    #[must_use]
    pub fn line_of(generation: Generation, addresses: &[u8]) -> Self {
        let unit = |address: &u8| {
            let address_of_unit = Address::new(*address).expect("an address of packet serial");
            let mut config =
                ControllerConfig { generation, address: address_of_unit, ..ControllerConfig::default() };
            let mut settings = Settings::factory(config.model, *address);
            settings.streams[StreamIndex::Uart1.index()].timeout_ms = PATIENT_TIME_OUT.as_millis() as u32;
            config.settings = Some(settings);
            Controller::new(config).expect("the presets make a controller")
        };
        let bus = Bus::new(addresses.iter().map(unit).collect(), StreamIndex::Uart1);
        Self::serve(bus.expect("a TTL line takes several"), StreamIndex::Uart1)
    }

    /// Has both motors of every unit of a [`OnPort::line`] driven at half duty, as if another program had done it.
    ///
    /// # Panics
    /// When the server has ended.
    pub fn set_all_going(&self) {
        let units = self.handle.inspect(|bus| bus.controllers().len()).expect("the server runs");
        for index in 0..units {
            let packet = move |bus: &mut Bus| {
                let unit = &mut bus.controllers_mut()[index];
                let address = Address::new(unit.settings().unit.address).expect("it was given one");
                let generation = unit.config().generation;
                let request = Request::new(address, number::DUTY_BOTH, &[16_000, 16_000]);
                unit.receive(
                    StreamIndex::Uart1,
                    &request.encode(generation).expect("every generation has it"),
                );
            };
            self.handle.inspect(packet).expect("the server runs as long as this does");
        }
        wait::until(
            "driven motors",
            || self.driven() == vec![true; units],
            || format!("{:?}", self.driven()),
        );
    }

    /// Which units of a line have a bridge that is driven.
    ///
    /// # Panics
    /// When the server has ended.
    #[must_use]
    pub fn driven(&self) -> Vec<bool> {
        let look = |bus: &mut Bus| bus.controllers().iter().map(is_driven).collect();
        self.handle.inspect(look).expect("the server runs as long as this does")
    }

    /// An MCP266 as a node of a CAN bus, behind an adapter.
    ///
    /// # Panics
    /// When the system gives no port.
    #[must_use]
    pub fn on_can(node: NodeId, form: Form) -> Self {
        Self::nodes(&[node], form)
    }

    /// Several of them on one bus.
    ///
    /// # Panics
    /// When the system gives no port.
    #[must_use]
    pub fn nodes(nodes: &[NodeId], form: Form) -> Self {
        let unit = |node: &NodeId| {
            let mut config = ControllerConfig::default();
            config.set_node(*node);
            Controller::new(config).expect("the presets make a controller")
        };
        let bus = Bus::on_can(nodes.iter().map(unit).collect(), form).expect("there is a unit");
        Self::serve(bus, StreamIndex::Usb)
    }

    fn serve(bus: Bus, stream: StreamIndex) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let endpoint = if IS_PTY {
            Endpoint::Pty { link: folder.path().join(LINK) }
        } else {
            Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address"))
        };
        let options = ServerOptions { stream, ..ServerOptions::default() };
        let handle = ahead(|| Server::spawn(bus, options, &endpoint));
        let handle = handle.expect("the system has a port to give");
        Self { handle, folder }
    }

    /// The path that a client opens, or the TCP port as a program is told of it.
    #[must_use]
    pub fn port(&self) -> PathBuf {
        if IS_PTY {
            self.folder.path().join(LINK)
        } else {
            format!("tcp:{}", self.handle.address().trim_start_matches("tcp:")).into()
        }
    }

    /// What a program connects to. It is told that a pseudo-terminal may be late.
    #[must_use]
    pub fn target(&self) -> String {
        let late = if IS_PTY { LATE_PTY } else { "" };
        format!("{}{late}", self.port().display())
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

    /// Waits until `holds` does.
    ///
    /// # Panics
    /// When it never does.
    pub fn wait_until(&self, what: &str, holds: fn(&Controller) -> bool) {
        wait::until(what, || self.look(holds), || format!("{:#?}", self.look(Controller::view)));
    }

    /// Waits until so much of the controller's own time has passed.
    ///
    /// # Panics
    /// When its time stands still.
    pub fn let_pass(&self, time: Duration) {
        let end = self.look(Controller::now) + time;
        wait::until(
            "the controller's time",
            || self.look(Controller::now) >= end,
            || format!("not {end:?} yet"),
        );
    }

    /// Waits until both bridges are off.
    ///
    /// # Panics
    /// When they never are.
    #[must_use]
    pub fn wait_until_off(&self) -> Off {
        let mut driven_in_silence = Duration::ZERO;
        let look = || {
            let (driven, silent_for) = self.look(|unit| (is_driven(unit), silence(unit)));
            if driven {
                driven_in_silence = driven_in_silence.max(silent_for);
            }
            (!driven).then_some(silent_for)
        };
        let there = || format!("{:#?}", self.look(Controller::view));
        let silent_for = wait::until_some("bridges without duty", look, there);
        Off { driven_in_silence, silent_for }
    }
}

impl Off {
    /// Somebody on the line stopped the motors of a [`OnPort::patient`] controller.
    ///
    /// # Panics
    /// When it was the controller's own time-out.
    pub fn assert_by_command(self) {
        assert!(self.silent_for < PATIENT_TIME_OUT, "only the time-out stopped the motors: {self:?}");
    }

    /// The controller stopped its motors after so much silence.
    ///
    /// # Panics
    /// When somebody else did, or it waited longer.
    pub fn assert_by_time_out(self, time_out: Duration) {
        /// A few ticks, and the ramp to rest.
        const RAMP: Duration = Duration::from_millis(60);
        assert!(self.silent_for >= time_out, "not the time-out stopped the motors: {self:?}");
        assert!(self.driven_in_silence <= time_out + RAMP, "{self:?} with a time-out of {time_out:?}");
    }
}

/// An MCP266 that goes on for a minute when nobody speaks to it over USB.
#[must_use]
pub fn patient(generation: Generation) -> ControllerConfig {
    let mut config = ControllerConfig { generation, ..ControllerConfig::default() };
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.streams[0].timeout_ms = PATIENT_TIME_OUT.as_millis() as u32;
    config.settings = Some(settings);
    config
}

/// How long the line of a controller has been silent.
#[must_use]
pub fn silence(controller: &Controller) -> Duration {
    controller.unit().and_then(|unit| unit.silence()).unwrap_or_default()
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

impl<const IS_PTY: bool> foreign::Simulated for OnPort<IS_PTY> {
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

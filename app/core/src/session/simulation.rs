//! A simulated machine that runs in this program, in real time.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_link::FamilyChoice;
use brushwork_link::HiddenSettings;
use brushwork_link::UnitAddress;
use brushwork_link::transport::{ChannelTransport, Stream};
use brushwork_mcp_client::script::CHECKSUM_KEY;
use brushwork_mcp_client::unit_address;
use brushwork_mcp_sim::controller::{Bus, BusError, Controller, ControllerConfig};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_motion_mind_client::unit_address as mind_address;
use brushwork_plant::ParamsError;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::presets;
use brushwork_plant::server::{ChannelEnds, Endpoint, Server, ServerError, ServerOptions, SimHandle};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};

use super::line::SimulatedLine;
use super::motion_mind_spec::MotionMindSpec;
use super::sim_spec::{SimSpec, SimSpecError, UnitSpec};

/// One or more simulated controllers on one line, and the worlds around them.
pub struct Simulation {
    text: String,
    addresses: Vec<UnitAddress>,
    stream: Stream,
    can_form: Option<Form>,
    nodes: Vec<NodeId>,
    server: SimHandle<SimulatedLine>,
    /// The family of its units.
    family: FamilyChoice,
    /// The last look at a script that was asked for.
    script: Arc<Mutex<Option<View>>>,
}

/// Why a simulated controller cannot be started or reached. Each is a whole sentence for the user.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The text behind `sim:`.
    #[error("Could not start the simulated controller sim:{text}: {source}.")]
    Spec {
        /// As typed.
        text: String,
        /// What is wrong with it.
        #[source]
        source: SimSpecError,
    },
    /// The text behind `sim:motion-mind-3`.
    #[error("Could not start the simulated controller sim:{text}: {why}.")]
    MotionMindSpec {
        /// As typed.
        text: String,
        /// What is wrong with it.
        why: String,
    },
    /// Figures of a preset that make no sense.
    #[error("Could not start the simulated controller: {0}.")]
    Params(#[from] ParamsError),
    /// Several units where there is room for one.
    #[error("Could not start the simulated controllers: {0}.")]
    Bus(#[from] BusError),
    /// It cannot be served.
    #[error("Could not start the simulated controller: {0}.")]
    Server(#[source] ServerError),
    /// Its cable is out.
    #[error(
        "Could not connect to the simulated controller: its cable is unplugged. Plug it in again in the simulated world's panel."
    )]
    Unplugged,
    /// It runs no more.
    #[error("Could not connect to the simulated controller: {0}. Start it again.")]
    Gone(#[source] ServerError),
}

impl Simulation {
    /// Starts what the text behind `sim:` describes.
    ///
    /// # Errors
    /// The text names something that does not exist, or the system gives no thread.
    pub fn start(text: &str) -> Result<Self, SimulationError> {
        if MotionMindSpec::is_asked_for(text) {
            return Self::start_motion_minds(text);
        }
        let spec =
            SimSpec::parse(text).map_err(|source| SimulationError::Spec { text: text.to_owned(), source })?;
        // Several units can only share a TTL wire; one alone hangs on USB.
        let (index, stream) = match spec.units.len() {
            _ if spec.can.is_some() => (StreamIndex::Usb, Stream::Usb),
            1 => (StreamIndex::Usb, Stream::Usb),
            _ => (StreamIndex::Uart1, Stream::Ttl1),
        };
        let bus = bus_of(&spec, index)?;
        let options = ServerOptions { stream: index, seed: spec.seed, ..ServerOptions::default() };
        let line = SimulatedLine::Packets(Box::new(bus));
        let server = Server::spawn(line, options, &Endpoint::Channel).map_err(SimulationError::Server)?;
        let nodes = spec.units.iter().map(|unit| unit.node).collect();
        let addresses = spec.units.iter().map(|unit| unit_address(unit.address)).collect();
        Ok(Self {
            text: text.to_owned(),
            addresses,
            stream,
            can_form: spec.can,
            nodes,
            server,
            family: FamilyChoice::of(brushwork_mcp_client::MCP),
            script: Arc::default(),
        })
    }

    fn start_motion_minds(text: &str) -> Result<Self, SimulationError> {
        let spec = MotionMindSpec::parse(text)
            .map_err(|why| SimulationError::MotionMindSpec { text: text.to_owned(), why })?;
        let line = SimulatedLine::MotionMinds(Box::new(spec.bus()?));
        let options = ServerOptions { seed: spec.seed, ..ServerOptions::default() };
        let server = Server::spawn(line, options, &Endpoint::Channel).map_err(SimulationError::Server)?;
        let addresses = spec.addresses.iter().filter_map(|address| mind_address(address.get())).collect();
        Ok(Self {
            text: text.to_owned(),
            addresses,
            stream: Stream::Rs232,
            can_form: None,
            nodes: Vec::new(),
            server,
            family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
            script: Arc::default(),
        })
    }

    /// The protocol family of its units.
    pub fn family(&self) -> FamilyChoice {
        self.family
    }

    /// Whether it runs and is what `text` describes.
    pub fn is(&self, text: &str) -> bool {
        self.text == text && self.server.is_running()
    }

    /// How the adapter writes frames, where the line is one to a CAN bus.
    pub fn can_form(&self) -> Option<Form> {
        self.can_form
    }

    /// Whether there is one unit alone.
    pub fn is_single(&self) -> bool {
        self.addresses.len() == 1
    }

    /// The stream of the controller that its line is on.
    pub fn stream(&self) -> Stream {
        self.stream
    }

    /// Plugs a client in; the one before is disconnected.
    ///
    /// # Errors
    /// The cable is unplugged, or the machine has ended.
    pub fn connect(&self) -> Result<ChannelTransport, SimulationError> {
        let ChannelEnds { to_controller, from_controller } =
            self.server.new_channel().map_err(|error| match error {
                ServerError::Unplugged => SimulationError::Unplugged,
                other => SimulationError::Gone(other),
            })?;
        Ok(ChannelTransport::new(to_controller, from_controller, format!("sim:{}", self.text)))
    }

    /// Does something to the world of a unit, counted from 0. Never waits.
    ///
    /// # Errors
    /// The machine has ended or its queue is full.
    pub fn apply(&self, unit: usize, action: WorldAction) -> Result<(), ServerError> {
        self.server.apply(unit, action)
    }

    /// The worlds of all units. Never waits.
    pub fn views(&self) -> Arc<Vec<WorldView>> {
        self.server.views()
    }

    /// Asks the debugger of a unit's script for something, and for a look at it. Never waits.
    ///
    /// # Errors
    /// The machine has ended or its queue is full.
    pub fn debug(&self, unit: usize, requests: Vec<Request>, wanted: Wanted) -> Result<(), ServerError> {
        let script = Arc::clone(&self.script);
        self.server.post(move |bus| {
            let controllers = bus.packets_mut().map(Bus::controllers_mut);
            let view =
                controllers.and_then(|units| units.get_mut(unit)).map(|unit| unit.debug(requests, &wanted));
            *script.lock().unwrap_or_else(PoisonError::into_inner) = view;
        })
    }

    /// The newest look at the script that was asked for, once.
    pub fn script(&self) -> Option<View> {
        self.script.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// The served machine, for those who need its truth.
    pub fn server(&self) -> &SimHandle<SimulatedLine> {
        &self.server
    }

    /// Which unit, counted from 0, has this number on its bus: an address, or a node id on a CAN bus.
    pub fn unit_of(&self, id: u8) -> Option<usize> {
        match self.can_form {
            Some(_) => self.nodes.iter().position(|node| node.get() == id),
            None => self.unit_at(UnitAddress::new(self.family.family()?, id)?),
        }
    }

    /// Which unit, counted from 0, has the address it was started with.
    pub fn unit_at(&self, address: UnitAddress) -> Option<usize> {
        self.addresses.iter().position(|unit| *unit == address)
    }
}

impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Simulation").field("text", &self.text).finish_non_exhaustive()
    }
}

impl HiddenSettings for Simulation {
    fn get(&self, address: UnitAddress, key: &str) -> Option<i64> {
        let unit = self.unit_at(address)?;
        if key == CHECKSUM_KEY {
            let look = move |line: &mut SimulatedLine| {
                Some(crc16_xmodem(line.packets()?.controllers().get(unit)?.script_image()))
            };
            return self.server.inspect(look).ok().flatten().map(i64::from);
        }
        let key = key.to_owned();
        let look = move |line: &mut SimulatedLine| {
            line.packets()?.controllers().get(unit)?.settings().hidden(&key).ok()
        };
        self.server.inspect(look).ok().flatten()
    }

    fn set(&self, address: UnitAddress, key: &str, value: i64) -> Result<(), String> {
        let unit =
            self.unit_at(address).ok_or_else(|| format!("There is no simulated unit at {address}."))?;
        let action = WorldAction::SetHidden { key: key.to_owned(), value };
        let act = move |line: &mut SimulatedLine| {
            Some(line.packets_mut()?.controllers_mut().get_mut(unit)?.apply(&action))
        };
        match self.server.inspect(act) {
            Ok(Some(Ok(()))) => Ok(()),
            Ok(Some(Err(unknown))) => Err(format!("{unknown}.")),
            Ok(None) => Err("This simulated controller has no settings past the wire.".to_owned()),
            Err(error) => Err(format!("{error}.")),
        }
    }
}

/// The machines that a description asks for, on one wire.
///
/// # Errors
/// Several units do not fit on this kind of wire.
pub fn bus_of(spec: &SimSpec, stream: StreamIndex) -> Result<Bus, SimulationError> {
    let units = spec.units.iter().map(|unit| controller(unit, spec.seed)).collect::<Result<Vec<_>, _>>()?;
    match spec.can {
        Some(form) => Ok(Bus::on_can(units, form)?),
        None => Ok(Bus::new(units, stream)?),
    }
}

fn controller(unit: &UnitSpec, seed: u64) -> Result<Controller, ParamsError> {
    Controller::new(config_of(unit, seed))
}

/// What a unit is made of.
pub fn config_of(unit: &UnitSpec, seed: u64) -> ControllerConfig {
    let preset = |index: usize| {
        presets::lookup(&unit.presets[index])
            .expect("the names of presets were checked when the text was read")
    };
    let mut config = ControllerConfig {
        generation: unit.generation,
        address: unit.address,
        world: presets::world_of(preset(0), preset(1), unit.model.pins.len()),
        seed,
        ..ControllerConfig::of(unit.model)
    };
    if unit.node != NodeId::DEFAULT {
        config.set_node(unit.node);
    }
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wait::{PATIENCE, until_some};
    use brushwork_link::Transport as _;
    use brushwork_mcp_wire::crc::crc16_xmodem;
    use brushwork_plant::server::Pace;
    use brushwork_script::debug::{Breakpoint, Reason};
    use std::time::Duration;

    /// Command 21 to 0x80; the reply begins with the name.
    fn name_of(transport: &mut ChannelTransport) -> String {
        transport.write(&[0x80, 21]).unwrap();
        let mut buffer = [0; 64];
        let count = transport.read(&mut buffer, Duration::from_secs(5)).unwrap();
        String::from_utf8_lossy(&buffer[..count]).into_owned()
    }

    #[test]
    fn a_simulated_controller_answers_and_outlives_its_client() {
        let simulation = Simulation::start("mcp266").unwrap();
        let mut first = simulation.connect().unwrap();
        assert!(name_of(&mut first).contains("MCP266"));
        drop(first);
        assert!(name_of(&mut simulation.connect().unwrap()).contains("MCP266"));
        assert!(simulation.is("mcp266") && !simulation.is("mcp263"));
    }

    #[test]
    fn an_unplugged_cable_is_named_with_the_cure() {
        let simulation = Simulation::start("mcp266").unwrap();
        simulation.apply(0, WorldAction::Unplug { unplugged: true }).unwrap();
        let error = simulation.connect().err().unwrap();
        assert!(error.to_string().contains("Plug it in again"), "{error}");
    }

    #[test]
    fn hidden_settings_reach_the_unit_at_their_address() {
        let simulation = Simulation::start("mcp266,address=0x80,address=0x81").unwrap();
        let address = UnitAddress::new(brushwork_mcp_client::MCP, 0x81).unwrap();
        HiddenSettings::set(&simulation, address, "unit.bridge_channels", 1).unwrap();
        assert_eq!(HiddenSettings::get(&simulation, address, "unit.bridge_channels"), Some(1));
        assert_eq!(
            HiddenSettings::get(
                &simulation,
                UnitAddress::factory(brushwork_mcp_client::MCP),
                "unit.bridge_channels"
            ),
            Some(0)
        );
        assert!(HiddenSettings::set(&simulation, address, "no.such", 1).is_err());
    }

    const DRIVER: &str = "rounds var long\nmain\nrounds = rounds+1\npause 10\ngoto main\n";

    /// Looks at the script once something is so.
    fn seen(simulation: &Simulation, requests: &[Request], mut holds: impl FnMut(&View) -> bool) -> View {
        let mut requests = requests.to_vec();
        let look = || {
            let asked = std::mem::take(&mut requests);
            simulation.debug(0, asked, Wanted::default()).unwrap();
            simulation.script().filter(|view| holds(view))
        };
        until_some("the script", look, || format!("{:?}", simulation.script()))
    }

    #[test]
    fn full_speed_leads_to_a_breakpoint_and_stops_hurrying_there_with_the_link_alive() {
        let simulation = Simulation::start("mcp266").unwrap();
        let mut transport = simulation.connect().unwrap();
        let program = brushwork_script::mcl::compile(DRIVER).program.unwrap();
        let image = brushwork_script::image::encode(&program);
        simulation
            .server()
            .inspect(move |line| {
                line.packets_mut().map(|bus| bus.controllers_mut()[0].install_script(&image))
            })
            .unwrap();
        // The thousandth round is ten seconds of the controller's time away.
        let breakpoint = Breakpoint { from_hit: 1_000, ..Breakpoint::at(3) };
        seen(&simulation, &[Request::Attach(true), Request::Breakpoints(vec![breakpoint])], |_| true);
        let mut start = vec![0x80, 248];
        start.extend(crc16_xmodem(&start).to_be_bytes());
        transport.write(&start).unwrap();
        assert_eq!(transport.read(&mut [0; 8], PATIENCE).unwrap(), 1);
        seen(&simulation, &[], |view| view.is_running);
        simulation.server().set_pace(Pace::Max);
        assert!(name_of(&mut transport).contains("MCP266"), "it answers while it hurries");
        let view = seen(&simulation, &[], |view| view.is_paused);
        assert!(matches!(view.reason, Reason::Breakpoint { line: 3, hits: 1_000, .. }), "{view:?}");
        assert!(view.now >= Duration::from_secs(10), "{:?}", view.now);
        assert_eq!(simulation.server().pace(), Pace::REAL);
        assert!(name_of(&mut transport).contains("MCP266"));
    }
}

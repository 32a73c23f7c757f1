//! A simulated machine that runs in this program, in real time.

use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_family::{Simulator, SimulatorError, Started, simulator};
use brushwork_link::transport::{ChannelTransport, Stream};
use brushwork_link::{Clock, FamilyChoice, HiddenSettings, UnitAddress};
use brushwork_plant::ParamsError;
use brushwork_plant::server::{
    ChannelEnds, Endpoint, Server, ServerError, ServerOptions, SharedTime, SimHandle,
};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;

use super::in_step::{self, InStep};
use super::line::SimulatedLine;
use crate::examine::like;

/// Before the file of an examination, whose unit is imitated.
pub const LIKE: &str = "like=";

/// One or more simulated controllers on one line, and the worlds around them.
pub struct Simulation {
    text: String,
    addresses: Vec<UnitAddress>,
    stream: Stream,
    /// How its CAN adapter speaks, where it stands behind one.
    pub can_form: Option<Form>,
    nodes: Vec<NodeId>,
    server: SimHandle<SimulatedLine>,
    /// What made its units.
    simulator: &'static dyn Simulator,
    /// What it cannot imitate of the unit that it was made like, a sentence each.
    unlike: Vec<String>,
    /// The last look at a script that was asked for.
    script: Arc<Mutex<Option<View>>>,
}

/// Why a simulated controller cannot be started or reached. Each is a whole sentence for the user.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The text behind `sim:`.
    #[error("Could not start the simulated controller sim:{text}: {why}.")]
    Spec {
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
    Line(String),
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
        let (simulator, started, unlike) = make(text)?;
        let Started { machine, addresses, nodes, can_form, index, stream, seed } = started;
        let options = ServerOptions { stream: index, seed, ..ServerOptions::default() };
        let line = SimulatedLine::new(machine);
        let server = Server::spawn(line, options, &Endpoint::Channel).map_err(SimulationError::Server)?;
        let (text, script) = (text.to_owned(), Arc::default());
        Ok(Self { text, addresses, stream, can_form, nodes, server, simulator, unlike, script })
    }

    /// The protocol family of its units.
    pub fn family(&self) -> FamilyChoice {
        FamilyChoice::of(self.simulator.family())
    }

    /// What it cannot imitate of the unit that it was made like, a sentence each.
    pub fn unlike(&self) -> &[String] {
        &self.unlike
    }

    /// Whether it runs and is what `text` describes.
    pub fn is(&self, text: &str) -> bool {
        self.text == text && self.server.is_running()
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
        Ok(self.plug_in()?.0)
    }

    /// The same for a client whose clock stands still with the machine where this computer is too busy for one of them. The clock counts
    /// from where `clock` is.
    ///
    /// # Errors
    /// As for [`Self::connect`].
    pub fn connect_in_step(&self, clock: &dyn Clock) -> Result<InStep, SimulationError> {
        let (transport, time) = self.plug_in()?;
        Ok(in_step::pair(transport, &time, clock.now()))
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn plug_in(&self) -> Result<(ChannelTransport, SharedTime), SimulationError> {
        let ChannelEnds { to_controller, from_controller, time } =
            self.server.new_channel().map_err(|error| match error {
                ServerError::Unplugged => SimulationError::Unplugged,
                other => SimulationError::Gone(other),
            })?;
        let name = format!("sim:{}", self.text);
        Ok((ChannelTransport::new(to_controller, from_controller, name), time))
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
        let (script, simulator) = (Arc::clone(&self.script), self.simulator);
        self.server.post(move |line| {
            let view = simulator.debug(line.machine_mut(), unit, requests, &wanted);
            *script.lock().unwrap_or_else(PoisonError::into_inner) = view;
        })
    }

    /// Whether its units run programs of a language that are put into their memory past the wire.
    pub fn runs(&self, language: Language) -> bool {
        self.simulator.runs(language)
    }

    /// Puts such a program into a unit's memory and starts it. Never waits.
    ///
    /// # Errors
    /// The machine has ended or its queue is full.
    pub fn run_program(&self, unit: usize, program: Arc<Program>) -> Result<(), ServerError> {
        let simulator = self.simulator;
        self.server.post(move |line| simulator.run_program(line.machine_mut(), unit, program))
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
            None => self.unit_at(UnitAddress::new(self.simulator.family(), id)?),
        }
    }

    /// Which unit, counted from 0, has the address it was started with.
    pub fn unit_at(&self, address: UnitAddress) -> Option<usize> {
        self.addresses.iter().position(|unit| *unit == address)
    }
}

/// Units that were made, what made them, and what of the unit that they were made like they do not imitate.
type Made = (&'static dyn Simulator, Started, Vec<String>);

/// Makes what the text behind `sim:` describes.
pub(super) fn make(text: &str) -> Result<Made, SimulationError> {
    let wrong = |why: String| SimulationError::Spec { text: text.to_owned(), why };
    if let Some(path) = text.strip_prefix(LIKE) {
        return like(Path::new(path)).map_err(wrong);
    }
    let Some(simulator) = simulator::asked_for(text) else {
        return Err(wrong("this program has no simulated controllers".to_owned()));
    };
    let started = simulator.start(text).map_err(|error| match error {
        SimulatorError::Spec(why) => wrong(why),
        SimulatorError::Params(error) => SimulationError::Params(error),
        SimulatorError::Line(why) => SimulationError::Line(why),
    })?;
    Ok((simulator, started, Vec::new()))
}

impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Simulation").field("text", &self.text).finish_non_exhaustive()
    }
}

impl HiddenSettings for Simulation {
    fn get(&self, address: UnitAddress, key: &str) -> Option<i64> {
        let unit = self.unit_at(address)?;
        let (key, simulator) = (key.to_owned(), self.simulator);
        let look = move |line: &mut SimulatedLine| simulator.hidden(line.machine_mut(), unit, &key);
        self.server.inspect(look).ok().flatten()
    }

    fn set(&self, address: UnitAddress, key: &str, value: i64) -> Result<(), String> {
        let unit =
            self.unit_at(address).ok_or_else(|| format!("There is no simulated unit at {address}."))?;
        let (key, simulator) = (key.to_owned(), self.simulator);
        let act = move |line: &mut SimulatedLine| simulator.set_hidden(line.machine_mut(), unit, &key, value);
        self.server.inspect(act).unwrap_or_else(|error| Err(format!("{error}.")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wait::{PATIENCE, until_some};
    use brushwork_link::Transport as _;
    use brushwork_mcp_sim::controller::Bus;
    use brushwork_mcp_wire::crc::crc16_xmodem;
    use brushwork_plant::server::Pace;
    use brushwork_script::debug::{Breakpoint, Reason};
    use std::time::Duration;

    fn start(text: &str) -> Result<Simulation, SimulationError> {
        simulator::install(&[&brushwork_mcp::McpSimulator]);
        Simulation::start(text)
    }

    /// Command 21 to 0x80; the reply begins with the name.
    fn name_of(transport: &mut ChannelTransport) -> String {
        transport.write(&[0x80, 21]).unwrap();
        let mut buffer = [0; 64];
        let count = transport.read(&mut buffer, Duration::from_secs(5)).unwrap();
        String::from_utf8_lossy(&buffer[..count]).into_owned()
    }

    #[test]
    fn a_simulated_controller_answers_and_outlives_its_client() {
        let simulation = start("mcp266").unwrap();
        let mut first = simulation.connect().unwrap();
        assert!(name_of(&mut first).contains("MCP266"));
        drop(first);
        assert!(name_of(&mut simulation.connect().unwrap()).contains("MCP266"));
        assert!(simulation.is("mcp266") && !simulation.is("mcp263"));
    }

    #[test]
    fn an_unplugged_cable_is_named_with_the_cure() {
        let simulation = start("mcp266").unwrap();
        simulation.apply(0, WorldAction::Unplug { unplugged: true }).unwrap();
        let error = simulation.connect().err().unwrap();
        assert!(error.to_string().contains("Plug it in again"), "{error}");
    }

    #[test]
    fn hidden_settings_reach_the_unit_at_their_address() {
        let simulation = start("mcp266,address=0x80,address=0x81").unwrap();
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
        let simulation = start("mcp266").unwrap();
        let mut transport = simulation.connect().unwrap();
        let program = brushwork_script::mcl::compile(DRIVER).program.unwrap();
        let image = brushwork_script::image::encode(&program);
        simulation
            .server()
            .inspect(move |line| line.get::<Bus>().map(|bus| bus.controllers_mut()[0].install_script(&image)))
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

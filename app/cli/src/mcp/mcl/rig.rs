//! A script on a simulated controller in virtual time: its streams, how far it is, how time passes.

use std::time::Duration;

use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{Address, number};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::ScriptRun;
use brushwork_script::image;
use brushwork_script::program::Program;
use brushwork_script::vm::{Machine, State};

use super::args::RunArgs;
use brushwork_mcp as simulation;
use brushwork_mcp::sim_spec::{SimOptions, SimSpec};

/// From power-up to the start of the script: the encoders have been read by then.
const WARM_UP: Duration = Duration::from_millis(10);
/// How long the command that starts it takes on its line.
const START_TIME: Duration = Duration::from_millis(1);
/// What a stream's buffer holds (see the simulated controller's streams).
const BUFFER_BYTES: usize = 255;
/// A stream of type MCL, and one that is off (command 145).
const TYPE_MCL: u8 = 0;
const TYPE_OFF: u8 = 2;
/// The port that stays with packet serial, for the command that starts the script. Scripts have no number for it.
const CONTROL: StreamIndex = StreamIndex::Uart2;

/// A simulated controller with a script.
pub struct Rig {
    controller: Controller,
    stream: u8,
    port: StreamIndex,
    began_at: Duration,
}

/// How far a script is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Run {
    /// It runs.
    Running {
        /// The line it stands on.
        line: u32,
    },
    /// END or STOP.
    Ended {
        /// The line it ended on.
        line: u32,
    },
    /// Something went wrong.
    Faulted {
        /// The line it was on.
        line: u32,
        /// What.
        what: String,
    },
}

impl Rig {
    /// A controller that has just been switched on, with the script in its memory and just started.
    ///
    /// # Errors
    /// A sentence: there is no such model or preset.
    pub fn new(args: &RunArgs, program: &Program) -> Result<Self, String> {
        let reported =
            |error: &dyn std::fmt::Display| format!("Could not start the simulated controller: {error}.");
        let options = SimOptions {
            models: vec![&args.model],
            generation: 1,
            presets: args.preset.iter().map(String::as_str).collect(),
            addresses: vec![0x80],
            seed: args.seed,
            can: None,
            nodes: vec![],
            rate_bps: None,
        };
        let spec = SimSpec::from_options(&options).map_err(|error| reported(&error))?;
        let unit = spec.units.first().ok_or_else(|| reported(&"no model is named"))?;
        let config = simulation::config_of(unit, spec.seed);
        let mut settings =
            Controller::new(config.clone()).map_err(|error| reported(&error))?.stored_settings();
        let port = match args.stream {
            2 => StreamIndex::Uart1,
            3 => StreamIndex::Uart0,
            _ => StreamIndex::Usb,
        };
        for index in StreamIndex::ALL.into_iter().filter(|index| *index != CONTROL) {
            settings.streams[index.index()].kind = kind_of(index, args)?;
        }
        let config = ControllerConfig { settings: Some(settings), ..config };
        let mut controller = Controller::new(config).map_err(|error| reported(&error))?;
        for action in args.buses.actions() {
            controller.apply(&action).map_err(|error| reported(&error))?;
        }
        controller.install_script(&image::encode(program));
        controller.advance(WARM_UP);
        controller.receive(CONTROL, &start_bytes());
        controller.advance(WARM_UP + START_TIME);
        // Its acknowledgement is nobody's.
        controller.take_output(CONTROL);
        let began_at = controller.now();
        let rig = Self { controller, stream: args.stream, port, began_at };
        Ok(rig)
    }

    fn machine(&self) -> Option<&Machine> {
        self.controller.unit()?.script()
    }

    /// Time since the script was begun.
    pub fn now(&self) -> Duration {
        self.controller.now().saturating_sub(self.began_at)
    }

    /// How far the script is.
    pub fn run(&self) -> Run {
        match self.controller.unit().map(|unit| unit.script_view().run) {
            Some(ScriptRun::Ended { line }) => Run::Ended { line },
            Some(ScriptRun::Faulted { line, what }) => Run::Faulted { line, what },
            Some(ScriptRun::Stopped { line }) => {
                Run::Faulted { line, what: "the controller stopped it".to_owned() }
            }
            Some(ScriptRun::Running { line }) => Run::Running { line },
            Some(ScriptRun::Idle) => {
                Run::Faulted { line: 0, what: "the controller did not start it".to_owned() }
            }
            None => Run::Faulted { line: 0, what: "the controller has lost its power".to_owned() },
        }
    }

    /// Instructions run so far.
    pub fn executed(&self) -> u64 {
        self.machine().map_or(0, Machine::executed)
    }

    /// Whether the script waits for a byte that has not come.
    pub fn is_listening(&self) -> bool {
        let state = self.machine().map(Machine::state);
        let listens = matches!(state, Some(State::Listening { stream }) if *stream == u32::from(self.stream));
        listens && self.waiting() == 0
    }

    fn waiting(&self) -> usize {
        self.controller.unit().map_or(0, |unit| unit.script_waiting(self.stream.into()))
    }

    /// Whether bytes are on their way out.
    pub fn is_sending(&self) -> bool {
        self.controller.next_output_at().is_some()
    }

    /// Takes as many of these bytes as there is room for, and says how many.
    pub fn feed(&mut self, bytes: &[u8]) -> usize {
        if self.machine().is_none() {
            return 0;
        }
        let taken = bytes.len().min(BUFFER_BYTES.saturating_sub(self.waiting()));
        self.controller.receive(self.port, &bytes[..taken]);
        taken
    }

    /// Lets time pass.
    pub fn advance(&mut self, by: Duration) {
        self.controller.advance(self.controller.now() + by);
    }

    /// What the script has sent and what has left the controller.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::iter::from_fn(|| self.controller.take_output(self.port)).flatten().collect()
    }
}

/// What a port is for: scripts, or nothing where its pins carry I2C or CAN (see the simulated controller's buses).
fn kind_of(port: StreamIndex, args: &RunArgs) -> Result<u8, String> {
    let (bus, stream, is_taken) = match port {
        StreamIndex::Uart0 => ("--can-peer", 3, args.buses.can_peer.is_some()),
        StreamIndex::Uart1 => ("--i2c", 2, !args.buses.i2c.is_empty()),
        StreamIndex::Usb | StreamIndex::Uart2 | StreamIndex::Uart3 => return Ok(TYPE_MCL),
    };
    match is_taken {
        false => Ok(TYPE_MCL),
        true if args.stream == stream => {
            Err(format!("{bus} and --stream {stream} want the same pins of the controller: leave one out."))
        }
        true => Ok(TYPE_OFF),
    }
}

/// Command 248 as it stands on the wire: address, command, checksum.
fn start_bytes() -> Vec<u8> {
    let mut bytes = vec![Address::DEFAULT.get(), number::START_SCRIPT];
    bytes.extend(crc16_xmodem(&bytes).to_be_bytes());
    bytes
}

//! The command line as clap sees it. No behaviour here: each subcommand's own file acts on its arguments.

use brushwork_core::addresses::{self, AddressList};
use std::path::PathBuf;
use std::time::Duration;

use super::terminal::TerminalArgs;
use super::tune::TuneArgs;
use brushwork_canopen::adapter::Form;
use brushwork_link::FamilyChoice;
use brushwork_plant::faults::FAULT_SYNTAX;
use brushwork_plant::machine::StreamIndex;
use brushwork_values::Motor;
use clap::{Args, Parser, Subcommand, ValueEnum};

use super::examine::ExamineArgs;
use super::examples;
use super::family::families;
use super::monitor::args::MonitorArgs;
use super::settings::args::SettingsArgs;
use super::shared_args::{LineArgs, ScriptBuses};
use super::{ConnectArgs, Replace, exit, parse_seconds};

/// Configures, drives and tunes brushed-DC motor controllers.
#[derive(Debug, Parser)]
#[command(
    name = "brushwork",
    version,
    about = "Configures, drives and tunes brushed-DC motor controllers",
    long_about = examples::about(),
    after_long_help = exit::HELP,
    args_conflicts_with_subcommands = true,
)]
pub struct Cli {
    /// How the window opens.
    #[command(flatten)]
    pub window: WindowArgs,
    /// What to do; the window opens when this is left out.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// How the window opens.
#[derive(Debug, Clone, Default, Args)]
pub struct WindowArgs {
    /// What to connect to at once.
    #[arg(long, value_name = "TARGET", help = examples::open_help())]
    pub open: Option<String>,
    /// Draw without smoothing, which spares the processor where there is no graphics card.
    #[arg(long)]
    pub plain: bool,
}

/// What `brushwork` can do without a window, whatever the controller. Between their places on the help page is room for families' own.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List serial ports and simulated controllers.
    List(ListArgs),
    /// List the nodes of a CANopen bus.
    Nodes(NodesArgs),
    /// Show measurements, indicators and why the motors do not run.
    Status(StatusArgs),
    /// Find out what a controller answers and how, for a report that its owner can send.
    #[command(display_order = 33)]
    Examine(ExamineArgs),
    /// Give controllers their addresses, so that several can share a line.
    Address(AddressArgs),
    /// Drive a motor until the time is over or you stop it.
    Drive(DriveArgs),
    /// Stop both motors at once.
    Stop(StopArgs),
    /// Read, write, compare and save a controller's settings.
    Settings(SettingsArgs),
    /// Run simulated controllers on a pseudo-terminal or a TCP port.
    #[command(display_order = 20)]
    Sim(SimArgs),
    /// Send commands to a controller as they are typed.
    #[command(display_order = 21)]
    Terminal(TerminalArgs),
    /// Print the reference of a family's protocol.
    #[command(display_order = 30)]
    Protocol(ProtocolArgs),
    /// Decode traffic: our own, another program's, or a file's.
    #[command(display_order = 31)]
    Monitor(MonitorArgs),
    /// Tune a motor's velocity or position loop on the machine.
    #[command(display_order = 32)]
    Tune(TuneArgs),
}

/// One of the controller's serial streams (MCP manual 2.3.1, command 145).
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StreamArg {
    /// The USB port.
    Usb,
    /// UART0, with RS-232 levels.
    Rs232,
    /// UART1, TTL levels.
    Ttl1,
    /// UART2, TTL levels.
    Ttl2,
    /// UART3, TTL levels.
    Ttl3,
}

impl StreamArg {
    /// Its number in a controller.
    pub fn index(self) -> StreamIndex {
        match self {
            Self::Usb => StreamIndex::Usb,
            Self::Rs232 => StreamIndex::Uart0,
            Self::Ttl1 => StreamIndex::Uart1,
            Self::Ttl2 => StreamIndex::Uart2,
            Self::Ttl3 => StreamIndex::Uart3,
        }
    }
}

/// Arguments of `brushwork list`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork list\n  \
    brushwork list --scan --json")]
pub struct ListArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Also open each port and ask who is there.
    #[arg(long)]
    pub scan: bool,
    /// List this line instead of the ports that there are; may be given again.
    #[arg(long, short = 'c', value_name = "TARGET", requires = "scan")]
    pub connect: Vec<String>,
}

/// Arguments of `brushwork nodes`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("nodes", &[
    "nodes --connect can:/dev/ttyUSB0",
    "nodes --connect can:COM5,form=binary,baud=230400 --json",
    "nodes --connect {sim},can,node=3,node=5",
], "Every node id is asked for its device type, and heartbeats are listened for. The bus rate is the adapter's own setting."))]
pub struct NodesArgs {
    /// The adapter: can:PORT[,baud=115200,form=ascii|binary], or simulated nodes.
    #[arg(long, short = 'c', value_name = "TARGET", default_value = examples::bus())]
    pub connect: String,
    /// Start this node first, which is stopped or pre-operational: an NMT command to it alone.
    #[arg(long, value_name = "NODE", value_parser = clap::value_parser!(u8).range(1..=127))]
    pub start: Option<u8>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork status`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("status", &[
    "status --connect {sim}",
    "status --connect /dev/ttyACM0 --watch",
    "status --connect tcp:127.0.0.1:7000 --address 0x81 --json",
    "status --connect /dev/ttyUSB0 --address 0x80-0x84 --together --watch",
], ""))]
pub struct StatusArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Print JSON (one object a line with --watch).
    #[arg(long)]
    pub json: bool,
    /// Also say which commands this firmware answers, as far as that has been learned.
    #[arg(long, conflicts_with = "watch")]
    pub commands: bool,
    /// Forget first which commands this firmware lacks, as far as that was learned, and ask for them again.
    #[arg(long)]
    pub learn_anew: bool,
    /// One row for each controller: batteries, temperatures, currents and what it reports.
    #[arg(long, conflicts_with = "commands")]
    pub together: bool,
    /// Go on until interrupted.
    #[arg(long)]
    pub watch: bool,
    /// Time between two lines of --watch.
    #[arg(long, value_name = "SECONDS", default_value = "1", value_parser = parse_seconds, requires = "watch")]
    pub interval: Duration,
}

const ADDRESS_NOTE: &str = "Units that have the same address cannot be told apart: connect new ones one at a time. With several addresses you are told when to \
     connect the next unit; those before it may stay on the line, and the factory's address is given last. The address is read back and \
     saved, and nothing is written where replies are garbled, as those of two units at one address are.";

/// Arguments of `brushwork address`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("address", &[
    "address 0x84 --connect /dev/ttyACM0",
    "address 0x81 --connect /dev/ttyUSB0 --address 0x80 --yes",
    "address 0x80-0x84 --connect /dev/ttyUSB0",
], ADDRESS_NOTE))]
pub struct AddressArgs {
    /// The new address, or several for one unit after the other.
    #[arg(value_name = "NEW", value_parser = addresses::parse_made)]
    pub to: AddressList,
    /// The controller; without --address the only one on the line, or the only one that has no address of this run.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Do it without asking.
    #[arg(long, short = 'y')]
    pub yes: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork drive`.
#[derive(Debug, Args)]
#[command(
    group(clap::ArgGroup::new("setpoint").required(true).args(["duty", "speed", "position", "by"])),
    after_help = examples::after("drive", &[
        "drive --connect {sim} --motor 1 --duty 25 --for 2",
        "drive --connect /dev/ttyACM0 --motor both --speed -12000 --accel 24000 --for 5",
        "drive --connect /dev/ttyACM0 --motor 2 --position 4000 --speed-limit 8000 --for 3",
        "drive --connect /dev/ttyUSB0,baud=115200 --address 0x80-0x84 --motor both --duty 20",
    ], "Both motors are stopped when the time is over, on Ctrl-C, SIGTERM, SIGHUP, a closed pipe, a fault or a lost link.")
)]
pub struct DriveArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Which motor.
    #[arg(long, value_enum, value_name = "1|2|both", default_value = "1")]
    pub motor: MotorArg,
    /// Duty cycle in percent, -100 to 100.
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = parse_duty_percent)]
    pub duty: Option<f64>,
    /// Speed in encoder counts per second.
    #[arg(long, value_name = "COUNTS/S", allow_negative_numbers = true)]
    pub speed: Option<i32>,
    /// Position in encoder counts.
    #[arg(long, value_name = "COUNTS", allow_negative_numbers = true)]
    pub position: Option<i32>,
    /// Distance in encoder counts from where the motor is.
    #[arg(long, value_name = "COUNTS", allow_negative_numbers = true)]
    pub by: Option<i32>,
    /// Acceleration: percent of duty per second with --duty, counts/s² with --speed and --position.
    #[arg(long, value_name = "RATE", value_parser = parse_positive)]
    pub accel: Option<f64>,
    /// Deceleration of a position move in counts/s² (default: the acceleration).
    #[arg(long, value_name = "RATE", requires = "position", value_parser = parse_positive)]
    pub decel: Option<f64>,
    /// Highest speed of a move in counts/s (default: the motor's QPPS).
    #[arg(long, value_name = "COUNTS/S", conflicts_with_all = ["duty", "speed"])]
    pub speed_limit: Option<u32>,
    /// How long to drive.
    #[arg(long = "for", value_name = "SECONDS", default_value = "1", value_parser = parse_seconds)]
    pub duration: Duration,
    /// Print each sample as a JSON object a line.
    #[arg(long)]
    pub json: bool,
}

/// One motor or both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MotorArg {
    /// Motor 1.
    #[value(name = "1")]
    M1,
    /// Motor 2.
    #[value(name = "2")]
    M2,
    /// Both motors.
    Both,
}

impl MotorArg {
    /// The motors that are meant.
    pub fn motors(self) -> &'static [Motor] {
        match self {
            Self::M1 => &[Motor::M1],
            Self::M2 => &[Motor::M2],
            Self::Both => &[Motor::M1, Motor::M2],
        }
    }
}

/// Arguments of `brushwork stop`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork stop --connect /dev/ttyACM0\n  \
    brushwork stop --connect /dev/ttyUSB0,baud=115200 --address 0x81,0x83\n  \
    brushwork stop --connect /dev/ttyACM0 --connect /dev/ttyACM1\n\n\
    Without --address every controller on the line is told to stop, and asked to confirm it.")]
pub struct StopArgs {
    /// The line.
    #[command(flatten)]
    pub line: LineArgs,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

const SIM_EXAMPLES: [&str; 5] = [
    "sim --pty /tmp/unit",
    "sim --port ttl1 --pace --address 0x80-0x84 --pty /tmp/bus",
    "sim --can ascii --node 3,5 --pty /tmp/can",
    "sim --like unit.json --pty /tmp/unit",
    "sim --pty /tmp/unit --fault drop=0.01 --fault 'plant:locked-shaft@4s,motor=1'",
];
const SIM_NOTE: &str = "Ctrl-C ends it. `brushwork sim --list` names the models and presets.";

/// Arguments of `brushwork sim`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("sim", &SIM_EXAMPLES, &format!("{SIM_NOTE}\n\nFaults: {FAULT_SYNTAX}")))]
pub struct SimArgs {
    /// Controller model; a comma-separated list makes a bus of several models.
    #[arg(long, value_name = "MODEL", default_value = examples::model(), value_delimiter = ',')]
    pub model: Vec<String>,
    /// Firmware generation, 1 to 4: widths and meanings of the replies.
    #[arg(long, value_name = "1..4", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=4))]
    pub generation: u8,
    /// Motor preset; two, separated by a comma, give motor 1 and motor 2 different ones.
    #[arg(long, value_name = "PRESET", value_delimiter = ',', num_args = 1)]
    pub preset: Vec<String>,
    /// Addresses of simulated units on one line.
    #[arg(long, value_name = "ADDRESS", value_parser = addresses::parse_made, help = examples::unit_help())]
    pub address: Option<AddressList>,
    /// What a family alone has.
    #[command(flatten)]
    pub of_families: OfFamilies,
    /// Which of the controller's ports is served; by default usb, which has one controller alone, and ttl1 for several.
    #[arg(long, value_enum, value_name = "PORT")]
    pub port: Option<StreamArg>,
    /// Make a pseudo-terminal and a symbolic link to it at PATH.
    #[arg(long, value_name = "PATH", conflicts_with = "tcp")]
    pub pty: Option<PathBuf>,
    /// Listen on this TCP address instead; port 0 picks a free one.
    #[arg(long, value_name = "127.0.0.1:PORT")]
    pub tcp: Option<String>,
    /// Put the units on a CAN bus behind a GridConnect adapter that writes frames this way; the line is the adapter's.
    #[arg(long, value_name = "ascii|binary", value_parser = parse_form, conflicts_with_all = ["port", "pace"])]
    pub can: Option<Form>,
    /// Node id on the CAN bus, or a comma-separated list: one simulated unit for each.
    #[arg(long, value_name = "1..127", value_delimiter = ',', requires = "can", value_parser = clap::value_parser!(u8).range(1..=127))]
    pub node: Vec<u8>,
    /// The baud rate that the served port is set to; --pace gives bytes the time of it. A Motion Mind 3 has 9600 and 19200 by its switch 5,
    /// which in mode 2 is the direction too.
    #[arg(long, value_name = "BAUD", conflicts_with = "can")]
    pub baud: Option<u32>,
    /// Send and take bytes at the port's set baud rate.
    #[arg(long)]
    pub pace: bool,
    /// A fault on the wire or in the plant; may be given more than once.
    #[arg(long, value_name = "FAULT")]
    pub fault: Vec<String>,
    /// Seed of noise and faults.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// A script that stands in the script memory from the start: a .mcl file or a compiled one. Command 248 starts it.
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// What a script finds on its buses.
    #[command(flatten)]
    pub buses: ScriptBuses,
    /// Hold the USB port's RTS line from the start, which forces packet serial where a script has taken the port.
    #[arg(long)]
    pub rts: bool,
    /// Take commands on standard input while it runs: "rts on", "rts off", "power off", "power on", "power cycle", with a
    /// unit's number behind it where there are several. A unit that loses its power in the midst of an update wakes up in its loader:
    /// that way recovery can be practised.
    #[arg(long)]
    pub control: bool,
    /// Write the simulator's own truth to FILE as JSON ten times a second.
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Whether an older truth is replaced.
    #[command(flatten)]
    pub replace: Replace,
    /// Make a unit that behaves as the report says that `brushwork examine --json FILE` wrote.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["model", "generation", "preset", "address", "port", "can", "baud", "script", "rts"])]
    pub like: Option<PathBuf>,
    /// Name the models and presets, and end.
    #[arg(long)]
    pub list: bool,
}

/// The arguments that families add to those of `brushwork sim`. Each family reads its own.
#[derive(Debug, Args)]
#[command(args = families().iter().flat_map(|family| family.sim_arguments()))]
pub struct OfFamilies {}

/// A unit's number as typed; what numbers there are depends on the model.
impl SimArgs {
    /// The port that is served.
    pub fn port(&self) -> StreamArg {
        let several = self.address.as_ref().is_some_and(|list| list.numbers().len() > 1);
        self.port.unwrap_or(if several { StreamArg::Ttl1 } else { StreamArg::Usb })
    }

    /// The addresses of its units, or that of one as it comes from the factory.
    pub fn addresses(&self, factory: u8) -> Vec<u8> {
        self.address.as_ref().map_or_else(|| vec![factory], |list| list.numbers().to_vec())
    }
}

/// Arguments of `brushwork protocol`.
#[derive(Debug, Args)]
#[command(after_help = examples::after("protocol", &["protocol", "protocol 28 read_status", "protocol --json"], ""))]
pub struct ProtocolArgs {
    /// Only these commands, by number or key, or registers by name where the family has some.
    #[arg(value_name = "COMMAND")]
    pub commands: Vec<String>,
    /// Whose protocol.
    #[arg(long, value_name = examples::names(&[]), default_value_t, hide_default_value = true)]
    pub family: FamilyChoice,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

fn parse_form(text: &str) -> Result<Form, String> {
    Form::from_key(text).ok_or_else(|| format!("\"{text}\" is no form of a CAN adapter: use ascii or binary"))
}

fn parse_duty_percent(text: &str) -> Result<f64, String> {
    text.trim()
        .trim_end_matches('%')
        .parse::<f64>()
        .ok()
        .filter(|percent| (-100.0..=100.0).contains(percent))
        .ok_or_else(|| format!("\"{text}\" is no duty: use -100 to 100 percent"))
}

fn parse_positive(text: &str) -> Result<f64, String> {
    text.trim()
        .parse::<f64>()
        .ok()
        .filter(|value| *value > 0.0 && value.is_finite())
        .ok_or_else(|| format!("\"{text}\" is no rate: use a number above zero"))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        crate::family::install(&[&crate::mcp::McpCommands, &crate::motion_mind::MotionMindCommands]);
        let own = families().iter().flat_map(|family| family.commands());
        own.fold(Cli::command(), |cli, tool| cli.subcommand(tool.command)).debug_assert();
    }

    #[test]
    fn the_window_can_be_opened_connected_but_not_beside_a_command() {
        let cli = Cli::try_parse_from(["brushwork", "--open", "sim:mcp266", "--plain"]).unwrap();
        assert!(cli.command.is_none() && cli.window.plain);
        assert_eq!(cli.window.open.as_deref(), Some("sim:mcp266"));
        assert!(Cli::try_parse_from(["brushwork", "--plain", "list"]).is_err());
    }

    #[test]
    fn a_duty_beyond_full_is_refused_with_its_range() {
        let error = Cli::try_parse_from(["brushwork", "drive", "--duty", "120"]).unwrap_err();
        assert!(error.to_string().contains("-100 to 100"), "{error}");
    }

    #[test]
    fn drive_wants_exactly_one_setpoint() {
        assert!(Cli::try_parse_from(["brushwork", "drive"]).is_err());
        assert!(Cli::try_parse_from(["brushwork", "drive", "--duty", "5", "--speed", "100"]).is_err());
        assert!(Cli::try_parse_from(["brushwork", "drive", "--duty", "-5"]).is_ok());
    }
}

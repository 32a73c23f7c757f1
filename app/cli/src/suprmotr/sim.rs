//! `brushwork sim --model suprmotr-v9`: simulated SuprMotrs, and the file that keeps their EEPROMs.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use brushwork_core::session::line::SimulatedLine;
use brushwork_link::{bounded, files};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_suprmotr::sim_spec::{MODEL, SuprMotrSpec, preset, rate, reply_form};
use brushwork_suprmotr_sim::{Eeprom, SuprMotr, SuprMotrBus};
use brushwork_suprmotr_wire::{Address, ReportForm};
use clap::{ArgMatches, Args, ValueEnum};

use crate::args::SimArgs;
use crate::family::Simulated;
use crate::messages::CliSimMessage;
use crate::say;
use crate::tool::typed;

/// What `--list` says about it.
pub const RATING: &str = "1 motor, 9-12 V, 1 A";
/// What `--list` says is guessed.
pub const ASSUMED: &str = "what its manual leaves open: the rate of its loop, the scales of TQ and DL, delays, what its short form only names";

/// How the boards are set up.
#[derive(Debug, Args)]
pub struct Switches {
    /// Addresses of the SuprMotrs on the line, a board each: 0 to 9 and A to F.
    #[arg(long, value_name = "0,3,F", value_delimiter = ',', conflicts_with = "address")]
    units: Vec<String>,
    /// How a SuprMotr begins its reports: with address, letter and channel, without the channel, or with the letter alone.
    #[arg(long, value_name = "full|address|id", value_parser = reply_form)]
    reply_form: Option<ReportForm>,
    /// Whether a SuprMotr sends back what it hears; on as from the factory.
    #[arg(long, value_enum, value_name = "on|off")]
    echo: Option<OnOff>,
    /// Whether a SuprMotr is selected after power-up; its manual says both.
    #[arg(long, value_enum, value_name = "yes|no")]
    addressed: Option<YesNo>,
    /// Keep the EEPROMs of SuprMotrs in FILE: read at the start if it is there, written when one of them changes.
    #[arg(long, value_name = "FILE")]
    eeprom: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OnOff {
    On,
    Off,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum YesNo {
    Yes,
    No,
}

/// What is wrong with these options where they are given to other controllers.
pub fn misplaced(sim: &ArgMatches) -> Option<String> {
    let Switches { units, reply_form, echo, addressed, eeprom } = typed(sim);
    let is_given = !units.is_empty()
        || reply_form.is_some()
        || echo.is_some()
        || addressed.is_some()
        || eeprom.is_some();
    is_given
        .then(|| format!("--units, --reply-form, --echo, --addressed and --eeprom are for --model {MODEL}."))
}

/// The units, and what they are in one line.
///
/// # Errors
/// A sentence about what does not fit together.
pub fn simulate(sim: &ArgMatches) -> Result<Simulated, String> {
    let (args, switches): (&SimArgs, Switches) = (&typed(sim), typed(sim));
    check_options(args)?;
    let spec = spec_of(args, &switches)?;
    let bus = spec.bus().map_err(|error| format!("Could not start the simulated controller: {error}."))?;
    let numbers: Vec<_> =
        bus.suprmotrs().iter().map(|unit| char::from(unit.address().character()).to_string()).collect();
    let who = if numbers.len() == 1 { "unit" } else { "units" };
    let what = format!("simulated SuprMotr V9, {who} {}", numbers.join(", "));
    let machine: Box<dyn Machine> = match switches.eeprom {
        Some(file) => Box::new(Kept { bus, file, written: 0, next_at: Duration::ZERO }),
        None => Box::new(bus),
    };
    Ok(Simulated { line: SimulatedLine::new(machine), what, is_found: false })
}

/// The address of the first unit, if the text behind `sim:` asks for any.
pub fn first_of(text: &str) -> Option<u8> {
    let first = || SuprMotrSpec::parse(text).ok()?.addresses.first().copied();
    SuprMotrSpec::is_asked_for(text).then(|| first().unwrap_or(Address::FACTORY).get())
}

fn spec_of(args: &SimArgs, switches: &Switches) -> Result<SuprMotrSpec, String> {
    let mut spec = SuprMotrSpec { addresses: Vec::new(), seed: args.seed, ..SuprMotrSpec::default() };
    if switches.units.is_empty() {
        for number in args.addresses(Address::FACTORY.get()) {
            let address = Address::new(number).map(|address| char::from(address.character()).to_string());
            let named = address.unwrap_or_else(|| number.to_string());
            spec.add_address(&named).map_err(|clause| refused(&clause))?;
        }
    }
    for unit in &switches.units {
        spec.add_address(unit.trim()).map_err(|clause| refused(&clause))?;
    }
    spec.reply_form = switches.reply_form.unwrap_or_default();
    spec.has_echo = switches.echo != Some(OnOff::Off);
    spec.is_addressed = switches.addressed == Some(YesNo::Yes);
    if let Some(baud) = args.baud {
        spec.rate_bps = rate(baud)
            .ok_or_else(|| format!("A SuprMotr has no {baud} baud: give --baud 9600, 19200 or 38400."))?;
    }
    spec.preset =
        args.preset.first().map(|name| preset(name).map_err(|clause| refused(&clause))).transpose()?;
    if let Some(file) = &switches.eeprom {
        spec.eeproms = read(file)?;
        let is_asked = args.address.is_some() || !switches.units.is_empty();
        let (kept, asked) = (spec.eeproms.len(), spec.addresses.len());
        if kept > 0 && is_asked && kept != asked {
            let file = file.display();
            return Err(format!(
                "{file} has the EEPROMs of {kept} boards, and {asked} are asked for: leave --units and --address out."
            ));
        }
    }
    Ok(spec)
}

fn refused(clause: &str) -> String {
    let mut letters = clause.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

fn check_options(args: &SimArgs) -> Result<(), String> {
    if let Some(other) = args.model.iter().find(|model| !model.eq_ignore_ascii_case(MODEL)) {
        return Err(format!("{MODEL} and {other} speak different protocols and cannot share a line."));
    }
    if args.can.is_some() {
        return Err("A SuprMotr has no CAN bus.".to_owned());
    }
    if args.script.is_some() || !args.buses.is_empty() || args.rts || args.control {
        return Err("A SuprMotr runs macros and no scripts: leave --script, --i2c, --can-peer, --rts and --control out.".to_owned());
    }
    Ok(())
}

/// What the file holds; nothing where it is not there yet.
fn read(file: &Path) -> Result<Vec<Eeprom>, String> {
    let text = match bounded::read_text(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        read => read.map_err(|error| format!("Could not read {}: {error}.", file.display()))?,
    };
    Eeprom::all_in(&text).map_err(|error| {
        format!(
            "{} is no file of EEPROMs: {error}. A new file is written where there is none.",
            file.display()
        )
    })
}

/// Boards whose EEPROMs are kept in a file.
struct Kept {
    bus: SuprMotrBus,
    file: PathBuf,
    /// Writes to the EEPROMs that the file has.
    written: u64,
    /// When it is written again at the earliest: a macro may store in each of its rounds.
    next_at: Duration,
}

/// Between two writes of the file.
const WRITE_INTERVAL: Duration = Duration::from_millis(50);

impl Kept {
    fn keep(&mut self) {
        let units = self.bus.suprmotrs();
        let writes = units.iter().map(SuprMotr::eeprom_writes).sum();
        if writes == self.written || self.bus.now() < self.next_at {
            return;
        }
        self.written = writes;
        self.next_at = self.bus.now() + WRITE_INTERVAL;
        let text = Eeprom::text_of(units.iter().map(SuprMotr::eeprom));
        if let Err(error) = files::replace_file(&self.file, text.as_bytes()) {
            let file = self.file.display().to_string();
            say(CliSimMessage::EepromNotKept { file, error: error.to_string() });
        }
    }
}

impl Machine for Kept {
    fn now(&self) -> Duration {
        self.bus.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.bus.receive(stream, bytes);
        self.keep();
    }

    fn advance(&mut self, to: Duration) {
        self.bus.advance(to);
        self.keep();
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.bus.next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.bus.take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.bus.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.bus.units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.bus.apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.bus.views()
    }

    fn plugged(&self) -> bool {
        self.bus.plugged()
    }
}

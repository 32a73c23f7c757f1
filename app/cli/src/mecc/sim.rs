//! `brushwork sim --model motorvator-3`: a simulated board, and the program that it runs.

use std::path::PathBuf;

use brushwork_core::session::line::SimulatedLine;
use brushwork_motorvator::MODEL;
use brushwork_motorvator::sim_spec::{MotorvatorSpec, library, preset, rate};
use brushwork_motorvator_client::Half;
use brushwork_script::program::Program;
use clap::{ArgMatches, Args, ValueEnum};

use super::language::compiled;
use crate::args::SimArgs;
use crate::messages::CliSimMessage;
use crate::tool::typed;
use crate::{Exit, Simulated};

/// What `--list` says about it.
pub const RATING: &str = "4 motors, or 2 steppers";
/// What `--list` says is guessed.
pub const ASSUMED: &str = "what its manual leaves open: the baud rate, units of waits and beeps, what H prints, and how fast it runs";

/// How the board is set up.
#[derive(Debug, Args)]
pub struct Switches {
    /// The MeccCode program of a MotorVator; the host library if none is named, through which this program drives it.
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Whether the program of a MotorVator has been started, or waits for G; the host library has, another program waits.
    #[arg(long, value_enum, value_name = "yes|no")]
    started: Option<YesNo>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum YesNo {
    Yes,
    No,
}

/// What is wrong with these options where they are given to other controllers.
pub fn misplaced(sim: &ArgMatches) -> Option<String> {
    let Switches { program, started } = typed(sim);
    (program.is_some() || started.is_some())
        .then(|| format!("--program and --started are for --model {MODEL}."))
}

/// The board, and what it is in one line.
///
/// # Errors
/// Says on standard error what does not fit together, or what is wrong with the program.
pub fn simulate(sim: &ArgMatches) -> Result<Simulated, Exit> {
    let (args, switches): (&SimArgs, Switches) = (&typed(sim), typed(sim));
    let spec = spec_of(args, &switches).map_err(|sentence| Exit::Usage.saying(sentence))?;
    let program: Program = match &switches.program {
        Some(file) => compiled(file, false)?,
        None => library(),
    };
    let board = spec
        .board(program)
        .map_err(|error| Exit::Usage.saying(CliSimMessage::NotStarted { why: error.to_string() }))?;
    let runs = match &switches.program {
        Some(file) => file.display().to_string(),
        None => "the host library".to_owned(),
    };
    let verb = if spec.is_started { "runs" } else { "has" };
    let what = format!("simulated MotorVator V3, {verb} {runs}");
    Ok(Simulated { line: SimulatedLine::new(Box::new(board)), what, is_found: false })
}

/// The half that is asked for first, if the text behind `sim:` asks for a board.
pub fn first_of(text: &str) -> Option<u8> {
    let named = || MotorvatorSpec::parse(text).ok()?.half;
    MotorvatorSpec::is_asked_for(text).then(|| named().unwrap_or(Half::First).number())
}

fn spec_of(args: &SimArgs, switches: &Switches) -> Result<MotorvatorSpec, String> {
    if let Some(other) = args.model.iter().find(|model| !model.eq_ignore_ascii_case(MODEL)) {
        return Err(format!("{MODEL} and {other} speak different protocols and cannot share a line."));
    }
    if args.model.len() > 1 || args.address.is_some() {
        return Err("A MotorVator has no address and its line alone: give --model motorvator-3 once, without --address.".to_owned());
    }
    if args.can.is_some() {
        return Err("A MotorVator has no CAN bus.".to_owned());
    }
    if args.script.is_some() || !args.buses.is_empty() || args.rts {
        return Err("A MotorVator runs a --program, and has no buses: leave --script, --i2c, --can-peer and --rts out.".to_owned());
    }
    let mut spec = MotorvatorSpec { seed: args.seed, ..MotorvatorSpec::default() };
    spec.is_started = match switches.started {
        Some(started) => started == YesNo::Yes,
        None => switches.program.is_none(),
    };
    if let Some(baud) = args.baud {
        spec.rate_bps = rate(baud).ok_or_else(|| {
            let rates = brushwork_motorvator::sim_spec::RATES_BPS.map(|rate| rate.to_string()).join(", ");
            format!("A simulated MotorVator has no {baud} baud: give --baud {rates}.")
        })?;
    }
    spec.preset = match args.preset.as_slice() {
        [] => None,
        [name] => Some(preset(name).map_err(|clause| format!("{clause}."))?),
        _ => return Err("The four motors of a simulated MotorVator are alike: give one --preset.".to_owned()),
    };
    Ok(spec)
}

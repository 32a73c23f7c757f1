//! `brushwork sim --model motion-mind-3`: simulated Motion Minds.

use brushwork_core::session::line::SimulatedLine;
use brushwork_motion_mind::sim_spec::{MODEL, MotionMindSpec, decode, preset};
use brushwork_motion_mind_sim::EncoderDecode;
use brushwork_motion_mind_sim::assumed::REVISION;
use brushwork_motion_mind_wire::{Address, Mode, Protocol};
use clap::{ArgMatches, Args, ValueEnum};

use crate::args::SimArgs;
use crate::family::Simulated;
use crate::tool::typed;

/// What `--list` says about it.
pub const RATING: &str = "1 motor, 6-24 V, 9 A, 25 A peak";
/// What `--list` says is guessed.
pub const ASSUMED: &str =
    "what its manual leaves open: delays, the start-up time, 28 register codes of its text protocol";

/// The switches of a Motion Mind 3, and its firmware.
#[derive(Debug, Args)]
pub struct Switches {
    /// What moves the motor of a Motion Mind 3, as its switches say; 4 if not given.
    #[arg(long, value_name = "0..7", value_parser = clap::value_parser!(u8).range(0..=7))]
    mode: Option<u8>,
    /// Which of its two protocols a Motion Mind 3 speaks.
    #[arg(long, value_enum, value_name = "PROTOCOL", default_value = "binary")]
    protocol: ProtocolArg,
    /// Switch 7 of a Motion Mind 3: which edges of the encoder count.
    #[arg(long, value_name = "1x|4x", value_parser = decode)]
    encoder: Option<EncoderDecode>,
    /// The firmware revision that a Motion Mind 3 tells.
    #[arg(long, value_name = "N")]
    revision: Option<u8>,
}

/// A protocol of the Motion Mind 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ProtocolArg {
    /// Frames with a checksum.
    Binary,
    /// Lines of text.
    Ascii,
}

/// What is wrong with switches that are given to controllers that have none.
pub fn misplaced(sim: &ArgMatches) -> Option<String> {
    let Switches { mode, protocol: _, encoder, revision } = typed(sim);
    let is_given = mode.is_some() || encoder.is_some() || revision.is_some();
    is_given.then(|| format!("--mode, --encoder and --revision are for --model {MODEL}."))
}

/// The units, and what they are in one line.
///
/// # Errors
/// A sentence about what does not fit together.
pub fn simulate(sim: &ArgMatches) -> Result<Simulated, String> {
    let args: &SimArgs = &typed(sim);
    check_options(args)?;
    let spec = spec_of(args, &typed(sim))?;
    let numbers: Vec<_> = spec.addresses.iter().map(|address| address.get().to_string()).collect();
    let who = if numbers.len() == 1 { "unit" } else { "units" };
    let (mode, protocol) = (spec.mode.number(), spec.protocol);
    let what = format!("simulated Motion Mind 3, mode {mode}, {protocol}, {who} {}", numbers.join(", "));
    let bus = spec.bus().map_err(|error| format!("Could not start the simulated controller: {error}."))?;
    Ok(Simulated { line: SimulatedLine::new(Box::new(bus)), what, is_found: false })
}

/// The address of the first unit, if the text behind `sim:` asks for any.
pub fn first_of(text: &str) -> Option<u8> {
    let first = || MotionMindSpec::parse(text).ok()?.addresses.first().copied();
    MotionMindSpec::is_asked_for(text).then(|| first().unwrap_or(Address::FACTORY).get())
}

fn spec_of(args: &SimArgs, switches: &Switches) -> Result<MotionMindSpec, String> {
    let mode = switches.mode.map_or(Some(Mode::SerialPid), Mode::from_number);
    let numbers = args.addresses(Address::FACTORY.get());
    let mut addresses = Vec::new();
    for number in numbers {
        let address =
            Address::unit(number).filter(|address| address.get() > 0 && !addresses.contains(address));
        addresses.push(address.ok_or_else(|| {
            format!("Could not use the address {number}: each Motion Mind 3 has an address from 1 to 98 of its own.")
        })?);
    }
    let preset = args.preset.first().map(|name| preset(name).map_err(|clause| format!("{clause}.")));
    Ok(MotionMindSpec {
        addresses,
        mode: mode.ok_or_else(|| "The modes of a Motion Mind 3 are 0 to 7.".to_owned())?,
        protocol: match switches.protocol {
            ProtocolArg::Binary => Protocol::Binary,
            ProtocolArg::Ascii => Protocol::Text,
        },
        is_fast: is_fast(args.baud)?,
        decode: switches.encoder.unwrap_or_default(),
        revision: switches.revision.unwrap_or(REVISION),
        preset: preset.transpose()?,
        seed: args.seed,
        ..MotionMindSpec::default()
    })
}

fn check_options(args: &SimArgs) -> Result<(), String> {
    if let Some(other) = args.model.iter().find(|model| !model.eq_ignore_ascii_case(MODEL)) {
        return Err(format!("{MODEL} and {other} speak different protocols and cannot share a line."));
    }
    if args.can.is_some() {
        return Err("A Motion Mind 3 has no CAN bus.".to_owned());
    }
    if args.script.is_some() || !args.buses.is_empty() || args.rts || args.control {
        return Err(
            "A Motion Mind 3 runs no scripts: leave --script, --i2c, --can-peer, --rts and --control out."
                .to_owned(),
        );
    }
    Ok(())
}

/// Where switch 5 stands.
fn is_fast(baud: Option<u32>) -> Result<bool, String> {
    match baud {
        None | Some(19_200) => Ok(true),
        Some(9_600) => Ok(false),
        Some(other) => {
            Err(format!("Switch 5 of a Motion Mind 3 has no {other} baud: give --baud 9600 or --baud 19200."))
        }
    }
}

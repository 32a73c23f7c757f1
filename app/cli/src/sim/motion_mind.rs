//! `brushwork sim --model motion-mind-3`: simulated units of the second family.

use brushwork_motion_mind_sim::MotionMindBus;
use brushwork_motion_mind_sim::assumed::REVISION;
use brushwork_motion_mind_wire::{Address, Mode, Protocol};

use super::super::args::{ProtocolArg, SimArgs};
use brushwork_motion_mind::sim_spec::{MODEL, MotionMindSpec, preset};

/// What `--list` says about it.
pub const RATING: &str = "1 motor, 6-24 V, 9 A, 25 A peak";
/// What `--list` says is guessed.
pub const ASSUMED: &str =
    "what its manual leaves open: delays, the start-up time, 28 register codes of its text protocol";

/// Whether the command line asks for units of this family.
pub fn is_asked_for(args: &SimArgs) -> bool {
    args.model.iter().any(|model| model.eq_ignore_ascii_case(MODEL))
}

/// The units, and what they are in one line.
///
/// # Errors
/// A sentence about what does not fit together.
pub fn bus_of(args: &SimArgs) -> Result<(MotionMindBus, String), String> {
    check_options(args)?;
    let spec = spec_of(args)?;
    let numbers: Vec<_> = spec.addresses.iter().map(|address| address.get().to_string()).collect();
    let who = if numbers.len() == 1 { "unit" } else { "units" };
    let (mode, protocol) = (spec.mode.number(), spec.protocol);
    let line = format!("simulated Motion Mind 3, mode {mode}, {protocol}, {who} {}", numbers.join(", "));
    let bus = spec.bus().map_err(|error| format!("Could not start the simulated controller: {error}."))?;
    Ok((bus, line))
}

fn spec_of(args: &SimArgs) -> Result<MotionMindSpec, String> {
    let mode = args.mode.map_or(Some(Mode::SerialPid), Mode::from_number);
    let numbers = if args.address.is_empty() { vec![Address::FACTORY.get()] } else { args.address.clone() };
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
        protocol: match args.protocol {
            ProtocolArg::Binary => Protocol::Binary,
            ProtocolArg::Ascii => Protocol::Text,
        },
        is_fast: args.switches.baud.is_none_or(|baud| baud == 19_200),
        decode: args.switches.encoder.unwrap_or_default(),
        revision: args.switches.revision.unwrap_or(REVISION),
        preset: preset.transpose()?,
        seed: args.seed,
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

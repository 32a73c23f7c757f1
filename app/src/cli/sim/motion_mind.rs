//! `brushwork sim --model motion-mind-3`: simulated units of the second family.

use brushwork_protocol::motion_mind::Address;
use brushwork_sim::motion_mind::{Mode, MotionMind, MotionMindBus, MotionMindConfig, Protocol, pin};
use brushwork_sim::presets;

use super::super::args::{ProtocolArg, SimArgs};

/// The name of the model in `--model`.
pub const MODEL: &str = "motion-mind-3";
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
    let mode = Mode::from_number(args.mode.unwrap_or(Mode::SerialPid.number()))
        .ok_or_else(|| "The modes of a Motion Mind 3 are 0 to 7.".to_owned())?;
    let addresses = if args.address.is_empty() { vec![Address::FACTORY.get()] } else { args.address.clone() };
    let units = addresses.iter().map(|number| unit(args, mode, *number)).collect::<Result<Vec<_>, _>>()?;
    let numbers: Vec<_> = addresses.iter().map(u8::to_string).collect();
    let protocol = match protocol(args) {
        Protocol::Binary => "binary",
        Protocol::Text => "ASCII",
    };
    let who = if numbers.len() == 1 { "unit" } else { "units" };
    let line =
        format!("simulated Motion Mind 3, mode {}, {protocol}, {who} {}", mode.number(), numbers.join(", "));
    Ok((MotionMindBus::new(units), line))
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

fn unit(args: &SimArgs, mode: Mode, number: u8) -> Result<MotionMind, String> {
    let address = Address::unit(number).map_or_else(
        || Err(format!("Could not use the address {number}: a Motion Mind 3 has an address from 1 to 98.")),
        Ok,
    )?;
    let mut config = MotionMindConfig { address, protocol: protocol(args), ..MotionMindConfig::new(mode) };
    config.seed = if args.seed == 0 { 0 } else { args.seed.wrapping_add(u64::from(number)).max(1) };
    if let Some(key) = args.preset.first() {
        let preset = presets::lookup(key).ok_or_else(|| {
            format!("There is no preset \"{key}\". There are: {}.", presets::keys().join(", "))
        })?;
        config.world = presets::world_of(preset, preset, pin::COUNT);
    }
    MotionMind::new(config).map_err(|error| format!("Could not start the simulated controller: {error}."))
}

fn protocol(args: &SimArgs) -> Protocol {
    match args.protocol {
        ProtocolArg::Binary => Protocol::Binary,
        ProtocolArg::Ascii => Protocol::Text,
    }
}

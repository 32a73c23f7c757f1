//! `brushwork sim --model mcp266`: simulated units of packet serial, and what their scripts find around them.

use crate::messages::CliSimMessage;
use brushwork_core::session::line::SimulatedLine;
use brushwork_mcp::sim_spec::SimOptions;
use brushwork_mcp::{self as simulation, SimSpec};
use brushwork_mcp_sim::controller::Bus;
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_plant::machine::Machine;
use brushwork_plant::world::WorldAction;
use clap::ArgMatches;

use super::script::download::image_of;
use crate::args::{SimArgs, StreamArg};
use crate::tool::typed;
use crate::{Exit, Simulated};

/// The units that are asked for.
///
/// # Errors
/// What does not fit together is said on standard error.
pub fn simulate(sim: &ArgMatches) -> Result<Simulated, Exit> {
    let args: &SimArgs = &typed(sim);
    let options = SimOptions {
        models: args.model.iter().map(String::as_str).collect(),
        generation: args.generation,
        presets: args.preset.iter().map(String::as_str).collect(),
        addresses: args.addresses(Address::ALL[0].get()),
        seed: args.seed,
        can: args.can,
        nodes: args.node.clone(),
        rate_bps: args.baud,
    };
    if args.baud.is_some() && args.port() == StreamArg::Usb {
        return Err(Exit::Usage.saying(CliSimMessage::UsbHasNoBaud));
    }
    let spec = SimSpec::from_options(&options)
        .map_err(|error| Exit::Usage.saying(CliSimMessage::NotStarted { why: error.to_string() }))?;
    let stream = args.port().index();
    let mut bus = simulation::bus_of(&spec, stream).map_err(|error| Exit::Usage.saying(error.to_string()))?;
    prepare(args, &mut bus)?;
    let what = if args.can.is_some() { spec.to_string() } else { format!("{spec}, port {}", stream.key()) };
    Ok(Simulated { line: SimulatedLine::new(Box::new(bus)), what, is_found: true })
}

/// Puts script, devices and peers into place before anything is served.
fn prepare(args: &SimArgs, bus: &mut Bus) -> Result<(), Exit> {
    let image = args.script.as_deref().map(image_of).transpose()?;
    let mut actions = args.buses.actions();
    if args.rts {
        actions.push(WorldAction::SetRts { on: true });
    }
    for unit in 0..bus.units() {
        actions.iter().for_each(|action| Machine::apply(bus, unit, action));
    }
    if let Some(image) = image {
        let bytes: Vec<u8> = image.blocks().flat_map(|block| block.bytes).collect();
        bus.controllers_mut().iter_mut().for_each(|unit| unit.install_script(&bytes));
    }
    Ok(())
}

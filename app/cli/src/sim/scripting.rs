//! What a simulated controller's scripts find around it, and the control of its RTS line while it runs.

use std::io;
use std::thread;

use brushwork_mcp_sim::controller::Bus;
use brushwork_plant::machine::Machine;
use brushwork_plant::server::SimHandle;
use brushwork_plant::world::WorldAction;
use crossbeam_channel::{Receiver, bounded};

use super::super::args::SimArgs;
use super::super::exit::Exit;
use super::super::output::say;
use super::super::script::download::image_of;

/// Lines of standard input that may wait.
const LINES: usize = 16;

/// Puts script, devices and peers into place before anything is served.
pub fn prepare(args: &SimArgs, bus: &mut Bus) -> Result<(), Exit> {
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

/// The lines of standard input, read on a thread of their own since reading waits.
pub fn control() -> Option<Receiver<String>> {
    let (sender, lines) = bounded(LINES);
    let read = move || {
        for line in io::stdin().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    };
    thread::Builder::new().name("sim-control".to_owned()).spawn(read).ok()?;
    Some(lines)
}

/// Does what a line says.
pub fn obey<M: Machine + 'static>(line: &str, server: &SimHandle<M>) {
    let on = match line.split_whitespace().collect::<Vec<_>>()[..] {
        ["rts", "on"] => true,
        ["rts", "off"] => false,
        [] => return,
        _ => return say(format!("\"{line}\" is no command. There are: rts on, rts off.")),
    };
    for unit in 0..server.views().len() {
        if let Err(error) = server.apply(unit, WorldAction::SetRts { on }) {
            return say(format!("Could not set RTS: {error}."));
        }
    }
    say(if on { "RTS is held: the USB port speaks packet serial." } else { "RTS is released." });
}

//! Commands on standard input while simulated controllers run: the control of their RTS line.

use std::{io, thread};

use brushwork_core::session::line::SimulatedLine;
use brushwork_plant::server::SimHandle;
use brushwork_plant::world::WorldAction;
use crossbeam_channel::{Receiver, bounded};

use crate::output::say;

/// Lines of standard input that may wait.
const LINES: usize = 16;

/// The lines of standard input, read on a thread of their own since reading waits.
pub fn lines() -> Option<Receiver<String>> {
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
pub fn obey(line: &str, server: &SimHandle<SimulatedLine>) {
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

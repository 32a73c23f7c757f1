//! Commands on standard input while simulated controllers run: their RTS line and their power.

use crate::messages::CliSimMessage;
use std::time::Duration;
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

/// How long the power stays off in a cycle.
const POWER_OFF: Duration = Duration::from_millis(500);

/// Does what a line says. A number behind it means that unit of several, counted from 1.
pub fn obey(line: &str, server: &SimHandle<SimulatedLine>) {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (words, unit) = match words.as_slice() {
        [first, second, number] => {
            (vec![*first, *second], number.parse::<usize>().ok().filter(|number| *number > 0))
        }
        _ => (words, Some(0)),
    };
    let power = |on| WorldAction::Power { on };
    let (steps, said) = match words[..] {
        ["rts", "on"] => {
            (vec![WorldAction::SetRts { on: true }], "RTS is held: the USB port speaks packet serial.")
        }
        ["rts", "off"] => (vec![WorldAction::SetRts { on: false }], "RTS is released."),
        ["power", "off"] => (vec![power(false)], "The power is off."),
        ["power", "on"] => (vec![power(true)], "The power is on."),
        ["power", "cycle"] => (vec![power(false), power(true)], "The power was off for half a second."),
        [] => return,
        _ => return say(unknown(line)),
    };
    let all = 0..server.views().len();
    let meant: Vec<usize> = match unit {
        Some(0) => all.collect(),
        Some(number) if all.contains(&(number - 1)) => vec![number - 1],
        Some(_) | None => return say(unknown(line)),
    };
    for (index, step) in steps.iter().enumerate() {
        if index > 0 {
            thread::sleep(POWER_OFF);
        }
        for unit in &meant {
            if let Err(error) = server.apply(*unit, step.clone()) {
                return say(CliSimMessage::NotDone { line: line.to_string(), error: error.to_string() });
            }
        }
    }
    say(said);
}

fn unknown(line: &str) -> String {
    format!(
        "\"{line}\" is no command. There are: rts on, rts off, power off, power on, power cycle; a number behind it means that unit \
         of several, counted from 1."
    )
}

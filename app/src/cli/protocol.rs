//! `brushwork protocol`: the packet serial reference, drawn from the command table.

use brushwork_protocol::packet_serial::reference;
use brushwork_protocol::packet_serial::{Command, lookup, lookup_key};

use super::args::ProtocolArgs;
use super::exit::Exit;
use super::output::{Output, OutputError, say};

/// Prints the whole page or the commands asked for.
pub fn run(args: &ProtocolArgs, out: &mut Output) -> Exit {
    let mut wanted = Vec::new();
    for name in &args.commands {
        match find(name) {
            Some(command) => wanted.push(command),
            None => {
                say(format!(
                    "There is no command \"{name}\". Use a number such as 28 or a key such as {}; \
                     `brushwork protocol` prints all.",
                    lookup(28).map_or("read_version", |command| command.key)
                ));
                return Exit::Usage;
            }
        }
    }
    let printed = if args.json { print_json(&wanted, out) } else { print_text(&wanted, out) };
    printed.map_or_else(Exit::from, |()| Exit::Done)
}

fn find(name: &str) -> Option<&'static Command> {
    name.parse().ok().and_then(lookup).or_else(|| lookup_key(name))
}

fn print_text(wanted: &[&'static Command], out: &mut Output) -> Result<(), OutputError> {
    if wanted.is_empty() {
        return out.line(reference::page().trim_end());
    }
    wanted.iter().try_for_each(|command| out.line(reference::section(command).trim_end()))
}

fn print_json(wanted: &[&'static Command], out: &mut Output) -> Result<(), OutputError> {
    let mut page = reference::reference();
    if !wanted.is_empty() {
        page.commands.retain(|row| wanted.iter().any(|command| command.number == row.number));
    }
    out.json(&page)
}

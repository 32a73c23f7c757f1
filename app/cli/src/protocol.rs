//! `brushwork protocol`: the reference of packet serial or of the Motion Mind, drawn from their tables.

use brushwork_link::FamilyChoice;
use brushwork_mcp_wire::packet_serial::reference;
use brushwork_mcp_wire::packet_serial::{Command, lookup, lookup_key};
use brushwork_motion_mind_wire as motion_mind;

use super::args::ProtocolArgs;
use super::exit::Exit;
use super::output::{Output, OutputError, say};

/// Prints the whole page or the commands asked for.
pub fn run(args: &ProtocolArgs, out: &mut Output) -> Exit {
    if args.family == FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND) {
        return motion_mind(args, out);
    }
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

/// The page of the second family.
fn motion_mind(args: &ProtocolArgs, out: &mut Output) -> Exit {
    let mut entries = Vec::new();
    for name in &args.commands {
        match motion_mind::reference_entry(name) {
            Some(entry) => entries.push(entry),
            None => {
                say(format!(
                    "There is no command or register \"{name}\" of a Motion Mind. Use a name such as WRITE_STORE or PTERM; \
                     `brushwork protocol --family motion-mind` prints all."
                ));
                return Exit::Usage;
            }
        }
    }
    let printed = match (args.json, entries.as_slice()) {
        (true, _) => out.json(&motion_mind::reference()),
        (false, []) => out.line(motion_mind::reference_page().trim_end()),
        (false, entries) => entries.iter().try_for_each(|entry| out.line(entry.trim_end())),
    };
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

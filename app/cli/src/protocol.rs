//! `brushwork protocol`: the reference of a family's protocol, drawn from its tables.

use super::args::ProtocolArgs;
use super::exit::Exit;
use super::family;
use super::output::Output;

/// Prints the whole page or what is asked for.
pub fn run(args: &ProtocolArgs, out: &mut Output) -> Exit {
    match family::chosen(args.family).protocol(&args.commands) {
        Ok(page) => page.print(args.json, out).map_or_else(Exit::from, |()| Exit::Done),
        Err(sentence) => Exit::Usage.saying(sentence),
    }
}

//! `brushwork protocol`: the reference of a family's protocol, drawn from its tables.

use super::args::ProtocolArgs;
use super::{Exit, Output, family};

/// Prints the whole page or what is asked for.
pub fn run(args: &ProtocolArgs, out: &mut Output) -> Result<Exit, Exit> {
    let page = family::chosen(args.family).protocol(&args.commands);
    page.map_err(|sentence| Exit::Usage.saying(sentence))?.print(args.json, out)?;
    Ok(Exit::Done)
}

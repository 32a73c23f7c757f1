//! `brushwork mcl`: scripts without a window: check, build, run, list, format, and the language reference.

pub mod args;
mod build;
mod check;
mod disasm;
mod fmt;
mod rig;
mod run;
pub mod source;

use brushwork_script::mcl::reference;

use crate::{Exit, Interrupt, Output, Page};
use args::{MclArgs, MclCommand};

/// Does what was asked for.
pub fn run(args: &MclArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        MclCommand::Check(args) => check::run(args, out),
        MclCommand::Build(args) => build::run(args, out),
        MclCommand::Run(args) => run::run(args, out, interrupt),
        MclCommand::Disasm(args) => disasm::run(args, out),
        MclCommand::Fmt(args) => fmt::run(args, out),
        MclCommand::Reference(args) => {
            Page::new(&reference::page(), &reference::reference()).print(args.json, out)?;
            Ok(Exit::Done)
        }
    }
}

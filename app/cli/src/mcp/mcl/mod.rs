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

use crate::exit::Exit;
use crate::interrupt::Interrupt;
use crate::output::Output;
use args::{MclArgs, MclCommand, ReferenceArgs};

/// Does what was asked for.
pub fn run(args: &MclArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    match &args.command {
        MclCommand::Check(args) => check::run(args, out),
        MclCommand::Build(args) => build::run(args, out),
        MclCommand::Run(args) => run::run(args, out, interrupt),
        MclCommand::Disasm(args) => disasm::run(args, out),
        MclCommand::Fmt(args) => fmt::run(args, out),
        MclCommand::Reference(args) => print_reference(args, out),
    }
}

fn print_reference(args: &ReferenceArgs, out: &mut Output) -> Exit {
    let printed =
        if args.json { out.json(&reference::reference()) } else { out.line(reference::page().trim_end()) };
    printed.map_or_else(Exit::from, |()| Exit::Done)
}

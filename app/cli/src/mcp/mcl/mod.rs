//! `brushwork mcl`: scripts without a window: check, build, run, list, format, and the language reference.

pub mod args;
mod build;
mod disasm;
mod rig;
mod run;

use brushwork_script::mcl::{self, reference};

use crate::scripts::{self, Language};
use crate::{Exit, Interrupt, Output, Page};
use args::{MclArgs, MclCommand};

/// The language.
pub const MCL: Language = Language {
    compile: |text| {
        let compiled = mcl::compile(text);
        (compiled.program, compiled.diagnostics)
    },
    format: mcl::format::format,
};

/// Does what was asked for.
pub fn run(args: &MclArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        MclCommand::Check(args) => scripts::check(MCL, &args.files, args.json, args.deny_warnings, out),
        MclCommand::Build(args) => build::run(args, out),
        MclCommand::Run(args) => run::run(args, out, interrupt),
        MclCommand::Disasm(args) => disasm::run(args, out),
        MclCommand::Fmt(args) => scripts::fmt(MCL, &args.files, args.check, out),
        MclCommand::Reference(args) => {
            Page::new(&reference::page(), &reference::reference()).print(args.json, out)?;
            Ok(Exit::Done)
        }
    }
}

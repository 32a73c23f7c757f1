//! `brushwork mecc`: programs without a window: check, run, format, and the language reference.

mod args;
mod run;

use brushwork_script::mecc::{self, reference};

use crate::scripts::{self, Language};
use crate::tool::Tool;
use crate::{Exit, Interrupt, Output, Page};
use args::{MeccArgs, MeccCommand};

/// The language.
const MECC: Language = Language {
    compile: |text| {
        let compiled = mecc::compile(text);
        (compiled.program, compiled.diagnostics)
    },
    format: mecc::format::format,
};

/// The command.
#[must_use]
pub fn tool() -> Tool {
    let about = "Check, run and format MeccCode programs; print the language reference";
    Tool::new("mecc", 41, about, run)
}

/// Does what was asked for.
fn run(args: &MeccArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        MeccCommand::Check(args) => scripts::check(MECC, &args.files, args.json, args.deny_warnings, out),
        MeccCommand::Run(args) => run::run(args, out, interrupt),
        MeccCommand::Fmt(args) => scripts::fmt(MECC, &args.files, args.check, out),
        MeccCommand::Reference(args) => {
            Page::new(&reference::page(), &reference::reference()).print(args.json, out)?;
            Ok(Exit::Done)
        }
    }
}

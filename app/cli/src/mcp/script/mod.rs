//! `brushwork script`: downloading, starting and stopping a controller's script.

pub mod args;
pub mod download;
mod run;
mod state;

use crate::{Exit, Interrupt, Output};
use args::{ScriptArgs, ScriptCommand};

/// Does what is asked.
pub fn run(args: &ScriptArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.command {
        ScriptCommand::Download(args) => download::run(args, out, interrupt),
        ScriptCommand::Start(args) => run::start(args, interrupt),
        ScriptCommand::Stop(args) => run::stop(args, interrupt),
        ScriptCommand::Autorun(args) => state::autorun(args, out, interrupt),
        ScriptCommand::Status(args) => state::status(args, out, interrupt),
    }
}

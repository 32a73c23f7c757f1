//! `brushwork script`: downloading, starting and stopping a controller's script.

pub mod args;
pub mod download;
mod run;
mod state;

use crate::units::PerUnit;
use crate::{ConnectArgs, Exit, Interrupt, Output};
use args::{ScriptArgs, ScriptCommand};

impl PerUnit for ScriptArgs {
    fn connect_mut(&mut self) -> Option<&mut ConnectArgs> {
        match &mut self.command {
            ScriptCommand::Download(args) => Some(&mut args.connect),
            ScriptCommand::Autorun(args) => Some(&mut args.connect),
            ScriptCommand::Status(args) => Some(&mut args.connect),
            // Several start and stop together.
            ScriptCommand::Start(_) | ScriptCommand::Stop(_) => None,
        }
    }

    fn run(&self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        match &self.command {
            ScriptCommand::Download(args) => download::run(args, out, interrupt),
            ScriptCommand::Start(args) => run::start(args, interrupt),
            ScriptCommand::Stop(args) => run::stop(args, interrupt),
            ScriptCommand::Autorun(args) => state::autorun(args, out, interrupt),
            ScriptCommand::Status(args) => state::status(args, out, interrupt),
        }
    }
}

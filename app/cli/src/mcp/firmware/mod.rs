//! `brushwork firmware`: what is installed, and an update from a file the user has.

pub mod args;
mod image;
mod info;
mod update;

use crate::{Exit, Interrupt, Output};
use args::{FirmwareAction, FirmwareArgs};

/// Does what the arguments ask for.
pub fn run(args: &FirmwareArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.action {
        FirmwareAction::Info(args) => info::run(args, out, interrupt),
        FirmwareAction::Update(args) => update::run(args, out, interrupt),
        FirmwareAction::Image(args) => image::run(args, out),
    }
}

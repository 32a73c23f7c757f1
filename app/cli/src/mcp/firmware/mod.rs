//! `brushwork firmware`: what is installed, and an update from a file the user has.

pub mod args;
mod image;
mod info;
mod update;

use std::path::PathBuf;

use crate::units::PerUnit;
use crate::{ConnectArgs, Exit, Interrupt, Output};
use args::{FirmwareAction, FirmwareArgs};

impl PerUnit for FirmwareArgs {
    fn connect_mut(&mut self) -> Option<&mut ConnectArgs> {
        match &mut self.action {
            FirmwareAction::Info(args) => Some(&mut args.connect),
            FirmwareAction::Update(args) => Some(&mut args.connect),
            FirmwareAction::Image(_) => None,
        }
    }

    fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match &mut self.action {
            FirmwareAction::Update(args) => args.backup.iter_mut().collect(),
            FirmwareAction::Info(_) | FirmwareAction::Image(_) => Vec::new(),
        }
    }

    /// An image that one of them does not take, or does not come back with, is no image for the next.
    fn goes_on(&self) -> bool {
        !matches!(self.action, FirmwareAction::Update(_))
    }

    fn run(&self, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
        match &self.action {
            FirmwareAction::Info(args) => info::run(args, out, interrupt),
            FirmwareAction::Update(args) => update::run(args, out, interrupt),
            FirmwareAction::Image(args) => image::run(args, out),
        }
    }
}

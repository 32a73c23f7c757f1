//! `brushwork settings`: reads, writes, compares and saves what a controller keeps.
//!
//! The table of `brushwork-link` says what there is; this module asks, shows and explains. Nothing is written
//! before the changes were shown and agreed to, and nothing reaches EEPROM unless that was asked for.

pub mod args;
pub(super) mod ask;
pub mod backups;
mod compare;
pub(super) mod controller;
mod copy;
pub(super) mod cut_short;
mod diff;
mod keys;
pub(super) mod memory;
mod profile;
mod raw;
mod read;
mod review;
mod side_name;
mod unfinished;
pub(super) mod write;

use super::{Exit, Interrupt, Output};
use args::{SettingsAction, SettingsArgs};

/// Does what the arguments ask for.
pub fn run(args: &SettingsArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    match &args.action {
        SettingsAction::Read(args) => read::run(args, out, interrupt),
        SettingsAction::Write(args) => write::run(args, out, interrupt),
        SettingsAction::Import(args) => write::import(args, out, interrupt),
        SettingsAction::Raw(args) => raw::run(args, out, interrupt),
        SettingsAction::Diff(args) => diff::run(args, out, interrupt),
        SettingsAction::Save(args) => memory::save(args, out, interrupt),
        SettingsAction::Defaults(args) => memory::defaults(args, out, interrupt),
        SettingsAction::Reload(args) => memory::reload(args, out, interrupt),
        SettingsAction::Export(args) => profile::export(args, out, interrupt),
        SettingsAction::Compare(args) => compare::run(args, out, interrupt),
        SettingsAction::Backups(args) => backups::list(args, out),
        SettingsAction::Restore(args) => backups::restore(args, out, interrupt),
        SettingsAction::CopyMotor(args) => copy::run(args, out, interrupt),
        SettingsAction::Unfinished(args) => unfinished::run(args, out, interrupt),
        SettingsAction::Reference(args) => read::reference(args, out),
    }
}

//! `brushwork settings`: reads, writes, compares and saves what a controller keeps.
//!
//! The table of `brushwork-link` says what there is; this module asks, shows and explains. Nothing is written
//! before the changes were shown and agreed to, and nothing reaches EEPROM unless that was asked for.

pub mod args;
pub(super) mod ask;
pub(super) mod controller;
mod diff;
mod keys;
mod memory;
mod profile;
mod read;
mod review;
mod write;

use super::exit::Exit;
use super::interrupt::Interrupt;
use super::output::Output;
use args::{SettingsAction, SettingsArgs};

/// Does what the arguments ask for.
pub fn run(args: &SettingsArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let done = match &args.action {
        SettingsAction::Read(args) => read::run(args, out, interrupt),
        SettingsAction::Write(args) => write::run(args, out, interrupt),
        SettingsAction::Import(args) => write::import(args, out, interrupt),
        SettingsAction::Diff(args) => diff::run(args, out, interrupt),
        SettingsAction::Save(args) => memory::save(args, out, interrupt),
        SettingsAction::Defaults(args) => memory::defaults(args, out, interrupt),
        SettingsAction::Export(args) => profile::export(args, out, interrupt),
        SettingsAction::Reference(args) => read::reference(args, out),
    };
    done.unwrap_or_else(|exit| exit)
}

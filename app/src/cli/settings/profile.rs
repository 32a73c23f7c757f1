//! `brushwork settings export`, and profiles as files.

use std::path::Path;

use brushwork_link::settings::{OpenedProfile, Profile, Strictness};

use super::args::ExportArgs;
use super::controller::Controller;
use super::review::settings_count;
use crate::cli::exit::Exit;
use crate::cli::interrupt::Interrupt;
use crate::cli::output::{Output, say};

/// Reads the controller and writes the profile.
pub fn export(args: &ExportArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let report = controller.read()?;
    let profile = controller.profile_of(&report, report.image.clone());
    profile.save(&args.file).map_err(|error| {
        say(error.to_string());
        Exit::Failed
    })?;
    let count = settings_count(profile.settings.len());
    out.line(format!("{count} of {} are in {}.", controller.describe(), args.file.display()))?;
    if report.failures.is_empty() {
        return Ok(Exit::Done);
    }
    say("What could not be read is not in the profile.");
    Ok(Exit::NotTaken)
}

/// The profile in a file; what is wrong with it is said on standard error.
pub fn open(path: &Path) -> Result<OpenedProfile, Exit> {
    Profile::open(path, Strictness::Refuse).map_err(|error| {
        say(error.to_string());
        Exit::NotTaken
    })
}

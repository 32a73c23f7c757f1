//! `brushwork settings export`, and profiles as files.

use std::path::Path;
use std::time::SystemTime;

use brushwork_link::settings::Profile;

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
    let profile = Profile {
        subject: *report.table.subject(),
        firmware: controller.identity().version_text.clone(),
        address: controller.address(),
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        unit: String::new(),
        note: String::new(),
        settings: report.image,
    };
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
pub fn load(path: &Path) -> Result<Profile, Exit> {
    Profile::load(path).map_err(|error| {
        say(error.to_string());
        Exit::NotTaken
    })
}

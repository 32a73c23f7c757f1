//! `brushwork settings export`, and profiles as files.

use crate::messages::CliSettingsMessage;
use std::path::Path;

use brushwork_link::settings::{OpenedProfile, Profile, ProfileFileError, Strictness};

use super::args::ExportArgs;
use super::controller::Controller;
use crate::new_file::NewFileError;
use crate::{Exit, Interrupt, NewFile, Output, say};
use brushwork_core::settings::counted;

/// Reads the controller and writes the profile.
pub fn export(args: &ExportArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let mut file = NewFile::new(&args.file, args.replace);
    file.check()?;
    let controller = Controller::connect(&args.connect, interrupt)?;
    let report = controller.read()?;
    let profile = controller.profile_of(&report);
    file.write(profile.to_json().as_bytes()).map_err(|error| match error {
        NewFileError::System { path, source } if source.kind() != std::io::ErrorKind::Interrupted => {
            Exit::Failed.saying(ProfileFileError::Write { path, source }.to_string())
        }
        refused @ (NewFileError::Exists { .. }
        | NewFileError::Link { .. }
        | NewFileError::OwnInput { .. }
        | NewFileError::Folder { .. }
        | NewFileError::System { .. }) => refused.into(),
    })?;
    let count = counted(profile.settings.len());
    out.line(format!("{count} of {} are in {}.", controller.describe(), args.file.display()))?;
    if report.is_whole() {
        return Ok(Exit::Done);
    }
    say(CliSettingsMessage::NotInProfile);
    Ok(Exit::NotTaken)
}

/// The profile in a file; what is wrong with it, or was changed in it by hand, is said on standard error.
pub fn open(path: &Path) -> Result<OpenedProfile, Exit> {
    let opened = Profile::open(path, Strictness::Refuse).map_err(|error| Exit::NotTaken.saying(error))?;
    opened.corrected.iter().for_each(|problem| say(problem.to_string()));
    Ok(opened)
}

//! `brushwork settings compare`: any two of RAM, EEPROM as last known, profile, defaults, backup.

use crate::messages::CliSettingsMessage;
use brushwork_core::messages::SideMessage;
use brushwork_link::settings::Profile;

use super::args::CompareArgs;
use super::controller::Controller;
use super::diff::{self, Side};
use super::side_name::SideName;
use super::{backups, profile};
use crate::interrupt::meanwhile;
use crate::{Exit, Interrupt, Output, say};
use brushwork_core::keep::{Store, today};
use brushwork_core::settings::{eeprom_title, known_defaults};

/// Compares and prints.
pub fn run(args: &CompareArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let names = [&args.left, &args.right];
    // The defaults of a file's own controller need no controller.
    let needs_controller = names.iter().any(|name| name.needs_controller())
        || names.iter().all(|name| matches!(name, SideName::Default));
    let controller = needs_controller.then(|| Controller::connect(&args.connect, interrupt)).transpose()?;
    let mut sides = [None, None];
    // Defaults come last: they are those of the other side where no controller is asked.
    for is_default in [false, true] {
        for index in 0..2 {
            if matches!(names[index], SideName::Default) == is_default {
                let other = sides[1 - index].clone();
                sides[index] = Some(side(names[index], controller.as_ref(), other)?);
            }
        }
    }
    let [Some(left), Some(right)] = sides else { return Err(Exit::Failed) };
    // A file as it would be on the controller, on whichever side that stands.
    if names[1].needs_controller() && !names[0].needs_controller() {
        return diff::compare(&diff::fitted(&right, left), &right, args.json, out);
    }
    diff::compare(&left, &diff::fitted(&left, right), args.json, out)
}

fn side(name: &SideName, controller: Option<&Controller<'_>>, other: Option<Side>) -> Result<Side, Exit> {
    match (name, controller) {
        (SideName::File(path), _) => {
            // Where a controller is connected too, a pipe that never ends must not keep Ctrl-C away.
            let own = path.clone();
            let read = move || profile::open(&own);
            let profile = match controller {
                Some(controller) => meanwhile(read, &|| controller.breathe())?.ok_or(Exit::Failed)?,
                None => read(),
            }?;
            Ok(Side::new(path.display().to_string(), opened(profile)))
        }
        (SideName::Backup(Some(name)), _) => backup(name),
        (SideName::Backup(None), Some(controller)) => {
            let store = Store::of_user();
            let newest = backups::listed(&store, Some(&controller.unit))?.into_iter().next();
            let newest = newest.ok_or_else(|| Exit::Refused.saying(CliSettingsMessage::NoBackup))?;
            backup(&newest.name)
        }
        (SideName::Ram, Some(controller)) => {
            let report = controller.read()?;
            let name = format!("RAM of {}", controller.describe());
            Ok(Side::new(name, controller.profile_of(&report)))
        }
        (SideName::Eeprom, Some(controller)) => {
            let known = super::memory::known_eeprom(&controller.unit);
            let known = known.ok_or_else(|| Exit::Refused.saying(SideMessage::EepromUnknown))?;
            Ok(Side::new(eeprom_title(&known), known))
        }
        (SideName::Default, None) => {
            let other = other.ok_or(Exit::Failed)?;
            let profile = defaults_of(&other.profile);
            Ok(Side::new("defaults".to_owned(), profile))
        }
        (SideName::Default, Some(controller)) => {
            let ram = controller.profile_of(&controller.read()?);
            Ok(Side::new("defaults".to_owned(), defaults_of(&ram)))
        }
        (SideName::Ram | SideName::Eeprom | SideName::Backup(None), None) => Err(Exit::Failed),
    }
}

/// Every default of the settings that the profile has.
fn defaults_of(profile: &Profile) -> Profile {
    let table = profile.table();
    let settings = known_defaults(&table, &profile.settings);
    Profile { settings, date: today(), note: "defaults".to_owned(), ..profile.clone() }
}

fn backup(name: &str) -> Result<Side, Exit> {
    let backup = backups::find(name)?;
    let title = format!("backup {}", backup.name);
    let opened = backup.open().map_err(|error| Exit::NotTaken.saying(error))?;
    Ok(Side::new(title, opened.profile))
}

/// The profile that was opened; what reading it changed is a note here, since nothing is written.
fn opened(opened: brushwork_link::settings::OpenedProfile) -> Profile {
    opened.upgraded.iter().for_each(say);
    opened.profile
}

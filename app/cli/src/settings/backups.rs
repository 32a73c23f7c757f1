//! `brushwork settings backups` and `restore`.

use crate::messages::CliSettingsMessage;
use serde_json::json;

use super::args::{BackupsArgs, RestoreArgs, WriteHow};
use super::controller::Controller;
use super::write;
use crate::{Exit, Interrupt, Output, say};
use brushwork_core::keep::{Backup, Store, UnitId};
use brushwork_link::settings::OpenedProfile;

/// Lists the backups of every unit; no controller is needed.
pub fn list(args: &BackupsArgs, out: &mut Output) -> Result<Exit, Exit> {
    let store = Store::of_user();
    let backups = listed(&store, None)?;
    if args.json {
        let list: Vec<_> = backups
            .iter()
            .map(|backup| json!({ "name": backup.name, "unit": backup.unit(), "path": backup.path }))
            .collect();
        out.json(&list)?;
        return Ok(Exit::Done);
    }
    let folder = store.root().map_or_else(|| "nowhere".to_owned(), |root| root.display().to_string());
    if backups.is_empty() {
        out.line(format!(
            "There are no backups in {folder}. One is made before every write, default and save."
        ))?;
    }
    let mut unit = String::new();
    let mut sorted = backups;
    // Stable: newest first within each unit.
    sorted.sort_by_key(Backup::unit);
    for backup in &sorted {
        if backup.unit() != unit {
            unit = backup.unit();
            out.line(format!("{unit}:"))?;
        }
        out.line(format!("  {}", backup.name))?;
    }
    Ok(Exit::Done)
}

/// Writes what a backup holds, as an import does: shown first, asked, backed up, read back.
pub fn restore(args: &RestoreArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let backup = match &args.name {
        Some(name) => find(name)?,
        None => {
            let newest = listed(&Store::of_user(), Some(&controller.unit))?.into_iter().next();
            newest.ok_or_else(|| Exit::Refused.saying(CliSettingsMessage::NoBackupOfThis))?
        }
    };
    say(CliSettingsMessage::BackupIs { name: backup.name.clone(), unit: backup.unit() });
    write::bring_about(&controller, Some(open(&backup)?), &[], &args.how, out)
}

/// Writes a backup back and saves it, asked for before.
pub fn write_back(controller: &Controller<'_>, name: &str, out: &mut Output) -> Result<Exit, Exit> {
    let opened = open(&find(name)?)?;
    let how = WriteHow { yes: true, dry_run: false, save: true, ..WriteHow::default() };
    write::bring_about(controller, Some(opened), &[], &how, out)
}

/// What a backup holds; what had to be corrected in it is said.
fn open(backup: &Backup) -> Result<OpenedProfile, Exit> {
    let opened = backup.open().map_err(|error| Exit::NotTaken.saying(error))?;
    opened.corrected.iter().for_each(|problem| say(problem.to_string()));
    Ok(opened)
}

/// The backups of a unit, or of all, newest first.
///
/// # Errors
/// Their folder cannot be read, which is said.
pub fn listed(store: &Store, unit: Option<&UnitId>) -> Result<Vec<Backup>, Exit> {
    if store.root().is_none() {
        return Ok(Vec::new());
    }
    store.listed_backups(unit).map_err(|fault| Exit::Failed.saying(fault))
}

/// The backup of that name, or the only one whose name begins so.
pub fn find(name: &str) -> Result<Backup, Exit> {
    let name = name.trim_end_matches(".json");
    let all = listed(&Store::of_user(), None)?;
    let mut found = all.iter().filter(|backup| backup.begins_with(name));
    match (all.iter().find(|backup| backup.name == name), found.next(), found.next()) {
        (Some(exact), ..) => Ok(exact.clone()),
        (None, Some(only), None) => Ok(only.clone()),
        (None, None, _) => {
            Err(Exit::Refused.saying(CliSettingsMessage::NoSuchBackup { name: name.to_string() }))
        }
        (None, Some(_), Some(_)) => {
            Err(Exit::Refused.saying(CliSettingsMessage::SeveralBackups { name: name.to_string() }))
        }
    }
}

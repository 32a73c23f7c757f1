//! `brushwork settings save` and `defaults`: acts on the controller's own memory, asked for and proven.

use crate::messages::CliActMessage;
use crate::messages::CliSettingsMessage;
use brushwork_core::messages::CoreActMessage;
use brushwork_link::settings::{DefaultsReport, Profile, SaveReport, SaveVerdict, SettingsTable};
use serde_json::json;

use super::args::MemoryArgs;
use super::ask;
use super::controller::Controller;
use super::review::{Change, change_lines, changes, tell};
use crate::{Exit, Interrupt, Output, OutputError, family, say};
use brushwork_core::keep::{Store, UnitId, WearLevel};
use brushwork_core::settings::{Act, Done, counted, known_defaults, merged};

/// Saves RAM to EEPROM and proves it.
pub fn save(args: &MemoryArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    let list = changes(&ram.table, &known_defaults(&ram.table, &ram.image), &ram.image);
    match known_eeprom(&controller.unit) {
        Some(known) => {
            let head = format!("What would change in EEPROM, as known since {}:", known.date_text());
            let unsaved = changes(&ram.table, &known.settings, &merged(&known.settings, &ram.image));
            show(args, out, &head, &unsaved, "nothing: it holds the same already")?;
        }
        None => show(
            args,
            out,
            "What EEPROM holds cannot be read without loading it over RAM. What would be saved, against the factory \
             defaults:",
            &list,
            AT_DEFAULT,
        )?,
    }
    tell_wear(&controller.unit);
    tell_note(&ram.table, &Act::Save);
    let question = format!("Save all settings of {} to EEPROM?", controller.describe());
    ask::agreed(&question, args.yes, &controller)?;
    let (report, exit) = save_to_eeprom(&controller, &ram.table)?;
    let wear = Store::of_user().wear(&controller.unit);
    let wear = wear.inspect_err(|fault| say(fault.to_string())).ok();
    if args.json {
        out.json(&json!({
            "identity": controller.identity(),
            "not_default": list,
            "save": report,
            "saves_counted": wear,
        }))?;
    } else if matches!(report.verdict, SaveVerdict::Verified | SaveVerdict::Stored) {
        out.line(report.sentence())?;
        wear.map_or(Ok(()), |wear| out.line(wear.sentence()))?;
    }
    if !matches!(report.verdict, SaveVerdict::Verified | SaveVerdict::Stored) {
        say(report.sentence());
    }
    Ok(exit)
}

/// Saves to EEPROM; the caller tells what the report says.
pub fn save_to_eeprom(
    controller: &Controller<'_>,
    table: &SettingsTable,
) -> Result<(SaveReport, Exit), Exit> {
    let finished =
        controller.act(CliActMessage::SaveSettings, Act::Save, table, controller.write_options())?;
    let report = match finished.value {
        Ok(Done::Saved(report)) => *report,
        Ok(_) => return Err(Exit::Failed),
        Err(failure) => {
            let exit = finished.broken.unwrap_or(Exit::Refused);
            return Err(exit.saying(CliSettingsMessage::NotSaved { failure }));
        }
    };
    let exit = match report.verdict {
        SaveVerdict::Verified | SaveVerdict::Stored | SaveVerdict::Acknowledged => Exit::Done,
        SaveVerdict::NotSaved | SaveVerdict::Unknown => Exit::NotTaken,
    };
    Ok((report, finished.broken.unwrap_or(exit)))
}

/// Restores the factory settings in RAM and proves it.
pub fn defaults(args: &MemoryArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    let list = changes(&ram.table, &ram.image, &known_defaults(&ram.table, &ram.image));
    show(args, out, "What would change, as far as the factory defaults are known:", &list, AT_DEFAULT)?;
    tell_note(&ram.table, &Act::RestoreDefaults);
    let question = format!("Restore the factory defaults of {}?", controller.describe());
    ask::agreed(&question, args.yes, &controller)?;
    let options = controller.write_options();
    let finished =
        controller.act(CliActMessage::RestoreDefaults, Act::RestoreDefaults, &ram.table, options)?;
    let report = match finished.value {
        Ok(Done::Restored(report)) => *report,
        Ok(_) => return Err(Exit::Failed),
        Err(failure) => return Err(finished.broken.unwrap_or(Exit::Refused).saying(failure)),
    };
    let others = tell_defaults(args, &controller, &list, &report, out)?;
    Ok(finished.broken.unwrap_or(if others == 0 { Exit::Done } else { Exit::NotTaken }))
}

/// Prints what came of it. How many settings are not at a default that the manual states.
fn tell_defaults(
    args: &MemoryArgs,
    controller: &Controller<'_>,
    list: &[Change],
    report: &DefaultsReport,
    out: &mut Output,
) -> Result<usize, OutputError> {
    let table = &report.read.table;
    let image = &report.read.image;
    let found = changes(table, &known_defaults(table, image), image);
    let is_assumed = |change: &Change| table.row(&change.key).is_some_and(|row| row.default_assumed);
    let (assumed, stated): (Vec<Change>, Vec<Change>) = found.into_iter().partition(is_assumed);
    if args.json {
        out.json(&json!({
            "identity": controller.identity(),
            "changes": list,
            "address": report.address,
            "not_at_default": stated,
            "not_at_assumed_default": assumed,
        }))?;
        return Ok(stated.len());
    }
    let place = if table.subject().family().settings().restores_eeprom() { "RAM and EEPROM" } else { "RAM" };
    if stated.is_empty() {
        out.line(format!("The factory defaults are restored in {place}; every setting was read back."))?;
    }
    tell_others("These are not at the factory default that the manual states:", &stated);
    tell_others("These came back other than assumed; the controller knows its defaults better:", &assumed);
    if report.address != controller.address() {
        out.line(format!("The controller answers at {} now.", report.address))?;
    }
    if table.subject().family().settings().restores_eeprom() {
        return Ok(stated.len());
    }
    out.line("A power cycle brings the saved settings back unless the defaults are saved (`brushwork settings save`).")?;
    Ok(stated.len())
}

/// Loads EEPROM over RAM and reads it.
pub fn reload(args: &MemoryArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    match known_eeprom(&controller.unit) {
        Some(known) => {
            let head = format!("What comes back, as EEPROM is known since {}:", known.date_text());
            let list = changes(&ram.table, &ram.image, &merged(&ram.image, &known.settings));
            show(args, out, &head, &list, "nothing: RAM holds the same")?;
        }
        None => say(CliSettingsMessage::EepromLost),
    }
    tell_note(&ram.table, &Act::Reload);
    let question = format!("Load the EEPROM of {} over its RAM?", controller.describe());
    ask::agreed(&question, args.yes, &controller)?;
    let options = controller.write_options();
    let finished = controller.act(CoreActMessage::LoadFromEeprom, Act::Reload, &ram.table, options)?;
    let report = match finished.value {
        Ok(Done::Reloaded(report)) => *report,
        Ok(_) => return Err(Exit::Failed),
        Err(failure) => return Err(finished.broken.unwrap_or(Exit::Refused).saying(failure)),
    };
    let came_back = changes(&ram.table, &ram.image, &merged(&ram.image, &report.image));
    if args.json {
        out.json(&json!({ "identity": controller.identity(), "changes": came_back }))?;
    } else {
        let count = counted(came_back.len());
        out.line(format!("EEPROM is loaded and read: {count} came back otherwise."))?;
        out.lines(change_lines(&came_back))?;
    }
    Ok(finished.broken.unwrap_or(if report.is_whole() { Exit::Done } else { Exit::NotTaken }))
}

/// Says what an act on the memory of the table's unit does to its motor.
fn tell_note(table: &SettingsTable, act: &Act) {
    if let Some(note) = family::of(table.subject().model.family).note_of(act) {
        say(CliSettingsMessage::Note { note: note.to_string() });
    }
}

fn tell_others(head: &str, changes: &[Change]) {
    if !changes.is_empty() {
        say(head);
        change_lines(changes).into_iter().for_each(say);
    }
}

const AT_DEFAULT: &str = "nothing: every setting is at its default";

/// Says how often the EEPROM was written where that begins to matter.
pub fn tell_wear(unit: &UnitId) {
    match Store::of_user().wear(unit) {
        Ok(wear) if wear.level() > WearLevel::Fine => {
            say(CliSettingsMessage::Wear { wear: wear.sentence(), limits: unit.limits() });
        }
        Ok(_) => {}
        Err(fault) => say(CliSettingsMessage::WearLost { fault: fault.to_string() }),
    }
}

/// What the unit's EEPROM held when that was proven last; a note that cannot be read is named and counts as none.
pub fn known_eeprom(unit: &UnitId) -> Option<Profile> {
    Store::of_user().eeprom(unit).inspect_err(|fault| say(fault.to_string())).ok().flatten()
}

fn show(
    args: &MemoryArgs,
    out: &mut Output,
    head: &str,
    list: &[Change],
    none: &str,
) -> Result<(), OutputError> {
    let mut lines = vec![head.to_owned()];
    lines.extend(change_lines(list));
    if list.is_empty() {
        lines.push(format!("  {none}"));
    } else {
        lines.push(format!("  ({})", counted(list.len())));
    }
    tell(lines, args.json, !args.yes, out)
}

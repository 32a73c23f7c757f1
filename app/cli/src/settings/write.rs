//! `brushwork settings write` and `import`: shows the changes, asks, writes, and names what did not take.

use brushwork_link::Message;
use brushwork_link::settings::{
    Known, OpenedProfile, Profile, ReadReport, Refusal, SaveReport, SaveVerdict, SettingsImage,
    SettingsTable, WriteOptions, WriteReport, changes,
};
use serde_json::{Value, json};
use std::fmt::Display;

use super::args::{Assignment, ImportArgs, Round, UnfinishedArgs, WriteArgs, WriteHow};
use super::controller::Controller;
use super::review::{self, Review};
use super::{ask, keys, memory, profile, read};
use crate::messages::{CliActMessage, CliSettingsMessage};
use crate::{Exit, Interrupt, Output, say};
use brushwork_core::examine::RawWrite;
use brushwork_core::settings::for_all::keep_addresses;
use brushwork_core::settings::{Act, Done, counted, fitted, merged, write_options};

/// Writes the changes given, and those of a profile.
pub fn run(args: &WriteArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let profile = args.profile.as_deref().map(profile::open).transpose()?;
    let controller = Controller::connect(&args.connect, interrupt)?;
    bring_about(&controller, profile, &args.changes, &args.how, out)
}

/// Writes what a profile says.
pub fn import(args: &ImportArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let profile = profile::open(&args.file)?;
    let controller = Controller::connect(&args.connect, interrupt)?;
    bring_about(&controller, Some(profile), &[], &args.how, out)
}

/// What is to be written, and what of the profile cannot be.
#[derive(Default)]
pub struct Wanted {
    /// The values that differ.
    pub changes: SettingsImage,
    /// A sentence for each setting of the profile that cannot be written here.
    pub left_out: Vec<Message>,
    /// The same as lines, with those that share a reason put together.
    pub left_out_lines: Vec<String>,
    /// What fitting a profile to this controller changed, a sentence each.
    upgraded: Vec<Message>,
    /// Those of them that were read from a unit once, so that they are written as they are.
    taken: SettingsImage,
    /// What is noted before they are, where they are one number that is written raw.
    pub raw: Option<RawWrite>,
}

impl Wanted {
    /// Changes that leave nothing out.
    pub fn of(changes: SettingsImage) -> Self {
        Self { changes, ..Self::default() }
    }

    /// Values that the unit had once.
    pub fn read(changes: SettingsImage) -> Self {
        Self { taken: changes.clone(), ..Self::of(changes) }
    }

    /// How they are written; refused where what was typed cannot be.
    fn options(&self, controller: &Controller<'_>, ram: &ReadReport) -> Result<WriteOptions, Exit> {
        let is_taken = |key: &str, value| self.taken.get(key) == Some(value);
        let options = controller.write_options();
        write_options(&ram.table, &ram.image, &self.changes, is_taken, options).map_err(cannot_be)
    }
}

/// What came of it.
#[derive(Default)]
struct Results {
    write: Option<WriteReport>,
    save: Option<SaveReport>,
}

/// Writes what a profile says, and assignments over it.
pub fn bring_about(
    controller: &Controller<'_>,
    profile: Option<OpenedProfile>,
    assignments: &[Assignment],
    how: &WriteHow,
    out: &mut Output,
) -> Result<Exit, Exit> {
    let ram = controller.read()?;
    let wanted = wanted(controller, &ram, profile, assignments, how)?;
    carry_out(controller, &ram, &wanted, how, out)
}

/// Shows the changes, asks, writes, reads back and tells.
pub fn carry_out(
    controller: &Controller<'_>,
    ram: &ReadReport,
    wanted: &Wanted,
    how: &WriteHow,
    out: &mut Output,
) -> Result<Exit, Exit> {
    let options = wanted.options(controller, ram)?;
    let review = review(controller, ram, wanted, options)?;
    if how.round != Round::Agreed {
        show(&review, wanted, how, out)?;
    }
    if how.round == Round::Review {
        return Ok(if review.changes.is_empty() { Exit::Done } else { Exit::Different });
    }
    if how.dry_run {
        print_json(controller, &review, wanted, how, &Results::default(), out)?;
        return Ok(Exit::Done);
    }
    let count = review.changes.len();
    if how.save {
        memory::tell_wear(&controller.unit);
    }
    if count > 0 || how.save {
        ask::agreed(&question(controller, count, how.save), how.is_agreed(), controller)?;
    }
    let mut results = Results::default();
    let exit = perform(controller, &ram.table, (wanted, options), how, &mut results);
    tell(&ram.table, &results, how, out)?;
    print_json(controller, &review, wanted, how, &results, out)?;
    exit
}

/// How something that was cut short is settled.
pub fn how(args: &UnfinishedArgs, save: bool) -> WriteHow {
    WriteHow { yes: args.yes, dry_run: args.dry_run, save, json: args.json, ..WriteHow::default() }
}

/// The profile as it is for this controller. Every change is told, and asked about before it is used.
fn upgraded(
    controller: &Controller<'_>,
    ram: &ReadReport,
    opened: OpenedProfile,
    how: &WriteHow,
) -> Result<(Profile, Vec<Message>), Exit> {
    let (profile, sentences) = fitted(opened, &ram.table);
    if sentences.is_empty() {
        return Ok((profile, sentences));
    }
    if how.round == Round::Agreed {
        return Ok((profile, sentences));
    }
    say(CliSettingsMessage::Fitted);
    sentences.iter().for_each(|sentence| say(CliSettingsMessage::Listed { sentence: sentence.to_string() }));
    if !how.only_shows() {
        ask::agreed("Use the profile with these changes?", how.is_agreed(), controller)?;
    }
    Ok((profile, sentences))
}

/// The changes that profile and assignments ask for.
fn wanted(
    controller: &Controller<'_>,
    ram: &ReadReport,
    profile: Option<OpenedProfile>,
    assignments: &[Assignment],
    how: &WriteHow,
) -> Result<Wanted, Exit> {
    let mut wanted = Wanted::default();
    if let Some(opened) = profile {
        let (profile, upgraded) = upgraded(controller, ram, opened, how)?;
        let asked = profile.changes_for(&ram.table, &ram.image, controller.identity().simulated);
        let asked = asked.map_err(|error| {
            Exit::NotTaken.saying(CliSettingsMessage::NotFitting {
                unit: controller.describe(),
                error: error.to_string(),
            })
        })?;
        let left_out_lines = left_out_lines(controller, ram, &profile);
        let changes = only(&ram.table, &asked.wanted, &how.only)?;
        wanted = Wanted { left_out: asked.left_out, left_out_lines, upgraded, ..Wanted::read(changes) };
        if how.several {
            keep_address(&ram.table, &mut wanted);
        }
    }
    let typed = keys::parse(&ram.table, assignments).map_err(|problems| refused(&problems))?;
    let addresses = ram.table.subject().family().settings().address_keys();
    if how.several && addresses.iter().any(|key| typed.get(key).is_some()) {
        return Err(refused(&[CliSettingsMessage::OneAddress]));
    }
    typed.iter().for_each(|(key, _)| wanted.taken.remove(key));
    wanted.changes.merge(&typed);
    wanted.changes = changes(&ram.table, &ram.image, &merged(&ram.image, &wanted.changes));
    Ok(wanted)
}

/// Takes the address out of what a profile has for several controllers.
fn keep_address(table: &SettingsTable, wanted: &mut Wanted) {
    for kept in keep_addresses(table, &mut wanted.changes) {
        wanted.left_out_lines.push(kept.to_string());
        wanted.left_out.push(kept);
    }
    let addresses = table.subject().family().settings().address_keys();
    addresses.iter().for_each(|key| wanted.taken.remove(key));
}

/// The changes whose keys begin with one of `starts`; all of them where there are none.
fn only(table: &SettingsTable, changes: &SettingsImage, starts: &[String]) -> Result<SettingsImage, Exit> {
    if let Some(problem) = keys::unmatched(table, starts) {
        return Err(Exit::NotTaken.saying(problem));
    }
    let is_meant = |key: &str| starts.is_empty() || starts.iter().any(|start| keys::begins_with(key, start));
    Ok(changes.iter().filter(|(key, _)| is_meant(key)).map(|(key, value)| (key.to_owned(), value)).collect())
}

/// What of the profile differs and cannot be written on this controller. A value is shown where it matters:
/// where it is not the default.
fn left_out_lines(controller: &Controller<'_>, ram: &ReadReport, profile: &Profile) -> Vec<String> {
    let differing = changes(&ram.table, &ram.image, &profile.settings);
    let locked = ram.table.rows().iter().filter_map(|row| {
        let (value, reason) = (differing.get(&row.key)?, row.locked(controller.identity().simulated)?);
        let shown = if value == row.default { String::new() } else { format!(" ({})", row.format(value)) };
        Some((reason, format!("{}{shown}", row.key)))
    });
    let mut lines = read::by_reason(locked);
    if !lines.is_empty() {
        lines.insert(
            0,
            "Left out of the profile, since they cannot be written on this controller:".to_owned(),
        );
    }
    lines
}

fn review(
    controller: &Controller<'_>,
    ram: &ReadReport,
    wanted: &Wanted,
    options: WriteOptions,
) -> Result<Review, Exit> {
    let mut review = Review::new(&ram.table, &ram.image, &wanted.changes, options, controller.address())
        .map_err(cannot_be)?;
    let touches_streams = review.changes.iter().any(|change| change.key.starts_with("stream."));
    if touches_streams && controller.client.stream.is_none() {
        review.warnings.push(CliSettingsMessage::StreamUnknown.into());
    }
    Ok(review)
}

fn cannot_be(refusals: Vec<Refusal>) -> Exit {
    refused(&refusals.into_iter().map(|refusal| refusal.sentence).collect::<Vec<_>>())
}

fn refused(problems: &[impl Display]) -> Exit {
    say(CliSettingsMessage::NothingWritten);
    problems.iter().for_each(say);
    Exit::NotTaken
}

/// The changes before anything is done: on standard output, or beside it where that carries JSON.
fn show(review: &Review, wanted: &Wanted, how: &WriteHow, out: &mut Output) -> Result<(), Exit> {
    let mut lines = Vec::new();
    if review.changes.is_empty() {
        lines.push("The controller holds these values already: there is nothing to write.".to_owned());
    }
    lines.extend(review.lines());
    lines.extend(wanted.left_out_lines.iter().cloned());
    if how.dry_run && !review.changes.is_empty() {
        lines.push("Commands that would be sent:".to_owned());
        lines.extend(review.command_lines());
    }
    Ok(review::tell(lines, how.json, !how.yes && !how.dry_run, out)?)
}

fn question(controller: &Controller<'_>, count: usize, save: bool) -> String {
    let place = controller.describe();
    match (count, save) {
        (0, _) => format!("Save all settings of {place} to EEPROM?"),
        (count, false) => format!("Write {} to RAM of {place}?", counted(count)),
        (count, true) => {
            format!("Write {} to RAM of {place} and save all settings to EEPROM?", counted(count))
        }
    }
}

/// Writes, then saves if that was asked for and everything took.
fn perform(
    controller: &Controller<'_>,
    table: &SettingsTable,
    (wanted, options): (&Wanted, WriteOptions),
    how: &WriteHow,
    results: &mut Results,
) -> Result<Exit, Exit> {
    let mut exit = Exit::Done;
    let changes = wanted.changes.clone();
    if !changes.is_empty() {
        let act = Act::Write { wanted: changes, known: Known::default() };
        let name = CliActMessage::WriteSettings;
        let finished = match &wanted.raw {
            Some(raw) => controller.act_raw(name, act, table, options, raw.clone())?,
            None => controller.act(name, act, table, options)?,
        };
        let refused = |why: &str| Err(finished.broken.unwrap_or(Exit::NotTaken).saying(why));
        let report = match finished.value {
            Ok(Done::Written(report, _)) => *report,
            Ok(Done::NotWritten(error)) => return refused(&error.to_string()),
            Ok(_) => return Err(Exit::Failed),
            Err(failure) => return refused(&failure.to_string()),
        };
        let is_complete = report.is_complete();
        results.write = Some(report);
        exit = finished.broken.unwrap_or(if is_complete { Exit::Done } else { Exit::NotTaken });
    }
    if !how.save {
        return Ok(exit);
    }
    if exit != Exit::Done {
        say(CliSettingsMessage::NotSavedEither);
        return Ok(exit);
    }
    let (report, exit) = memory::save_to_eeprom(controller, table)?;
    results.save = Some(report);
    Ok(exit)
}

fn tell(table: &SettingsTable, results: &Results, how: &WriteHow, out: &mut Output) -> Result<(), Exit> {
    if let Some(report) = &results.write {
        report.sentences(table).iter().for_each(say);
        if !report.is_complete() {
            report.warnings.iter().for_each(say);
        }
        if let Some(failure) = &report.ended_early {
            say(CliSettingsMessage::EndedEarly { failure: failure.to_string() });
        }
        let taken = report.rows.len() - report.did_not_take().count();
        if !how.json {
            out.line(format!("{} written and read back.", counted(taken)))?;
            if report.is_complete() && !how.save {
                out.line("A power cycle brings the old values back unless they are saved (`brushwork settings save`).")?;
            }
        }
    }
    if results.write.is_none() && !how.save && how.round == Round::Agreed && !how.json {
        out.line("There was nothing to write.")?;
    }
    match &results.save {
        Some(report) if report.verdict == SaveVerdict::Verified && !how.json => {
            out.line(report.sentence())?;
        }
        Some(report) if report.verdict != SaveVerdict::Verified => say(report.sentence()),
        _ => {}
    }
    Ok(())
}

fn print_json(
    controller: &Controller<'_>,
    review: &Review,
    wanted: &Wanted,
    how: &WriteHow,
    results: &Results,
    out: &mut Output,
) -> Result<(), Exit> {
    if !how.json {
        return Ok(());
    }
    let mut object = json!(review);
    if let Value::Object(members) = &mut object {
        members.insert("identity".to_owned(), json!(controller.identity()));
        members.insert("dry_run".to_owned(), json!(how.dry_run));
        members.insert("left_out".to_owned(), json!(wanted.left_out));
        members.insert("upgraded".to_owned(), json!(wanted.upgraded));
        members.insert("write".to_owned(), json!(results.write));
        members.insert("save".to_owned(), json!(results.save));
    }
    Ok(out.json(&object)?)
}

//! `brushwork settings diff`: a controller against a profile, or two profiles against each other.

use crate::messages::CliSettingsMessage;
use brushwork_link::settings::{Profile, SettingsImage, SettingsTable, Subject};
use serde_json::json;

use super::args::DiffArgs;
use super::controller::Controller;
use super::profile;
use super::review::{Change, change_lines, changes};
use crate::{Exit, Interrupt, Output, say};
use brushwork_core::settings::counted;

/// One side of a comparison.
#[derive(Clone)]
pub struct Side {
    /// What it is called.
    pub name: String,
    /// Its settings, and whose they are.
    pub profile: Profile,
    table: SettingsTable,
}

/// Compares and prints.
pub fn run(args: &DiffArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let mut sides = Vec::new();
    for path in &args.profiles {
        let opened = profile::open(path)?;
        opened.upgraded.iter().for_each(say);
        sides.push(Side::new(path.display().to_string(), opened.profile));
    }
    if sides.len() < 2 {
        sides.insert(0, Side::of_controller(&Controller::connect(&args.connect, interrupt)?)?);
    }
    let Ok([left, right]) = <[Side; 2]>::try_from(sides) else {
        return Err(Exit::Failed.saying(CliSettingsMessage::OneOrTwo));
    };
    compare(&left, &fitted(&left, right), args.json, out)
}

impl Side {
    /// A profile by a name.
    pub fn new(name: String, profile: Profile) -> Self {
        Self { name, table: profile.table(), profile }
    }

    fn of_controller(controller: &Controller<'_>) -> Result<Self, Exit> {
        let report = controller.read()?;
        let profile = controller.profile_of(&report);
        Ok(Self { name: controller.describe(), table: report.table, profile })
    }

    fn subject(&self) -> &Subject {
        self.table.subject()
    }
}

/// The other side as it would be on one's controller, so that like is compared with like.
pub fn fitted(one: &Side, other: Side) -> Side {
    let fitted = other.profile.fitted_to(&one.table);
    if fitted.changes.is_empty() {
        return other;
    }
    say(CliSettingsMessage::ComparedAs { right: other.name.clone(), left: one.name.clone() });
    fitted.changes.iter().for_each(say);
    Side::new(other.name, fitted.profile)
}

/// Prints what differs, from the left side to the right one.
pub fn compare(left: &Side, right: &Side, json: bool, out: &mut Output) -> Result<Exit, Exit> {
    warn_of_other_kind(left, right);
    let (differences, mut one_sided): (Vec<Change>, Vec<Change>) =
        changes(&left.table, &left.profile.settings, &right.profile.settings)
            .into_iter()
            .partition(|change| change.before.is_some() && change.after.is_some());
    let foreign = SettingsImage::default();
    one_sided.extend(
        changes(&right.table, &foreign, &right.profile.settings)
            .into_iter()
            .filter(|change| left.table.row(&change.key).is_none()),
    );
    let one_sided: Vec<&str> = one_sided.iter().map(|change| &*change.key).collect();
    if json {
        out.json(&json!({
            "left": left.name,
            "right": right.name,
            "differences": differences,
            "on_one_side_only": one_sided,
        }))?;
    } else {
        print(left, right, &differences, out)?;
        if !one_sided.is_empty() {
            say(CliSettingsMessage::OnOneSide { keys: one_sided.join(", ") });
        }
    }
    Ok(if differences.is_empty() { Exit::Done } else { Exit::Different })
}

fn print(left: &Side, right: &Side, differences: &[Change], out: &mut Output) -> Result<(), Exit> {
    if differences.is_empty() {
        out.line(format!("{} and {} agree.", left.name, right.name))?;
        return Ok(());
    }
    let count = counted(differences.len());
    out.line(format!("{count} with different values, {} -> {}:", left.name, right.name))?;
    out.lines(change_lines(differences))?;
    Ok(())
}

fn warn_of_other_kind(left: &Side, right: &Side) {
    let kind =
        |side: &Side| format!("{} with firmware {}", side.subject().model.name, side.subject().generation);
    let (one, other) = (kind(left), kind(right));
    if one != other {
        say(CliSettingsMessage::OtherKind { left: left.name.clone(), one, right: right.name.clone(), other });
    }
}

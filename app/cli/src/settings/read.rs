//! `brushwork settings read` and `reference`.

use crate::messages::CliSettingsMessage;
use std::collections::BTreeMap;

use brushwork_link::settings::{ListedSetting, list, list_text};
use serde_json::json;

use super::args::{ReadArgs, ReferenceArgs};
use super::controller::Controller;
use super::keys;
use crate::{Exit, Interrupt, Output, family, say};

/// Reads and prints.
pub fn run(args: &ReadArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let report = controller.read()?;
    if let Some(problem) = keys::unmatched(&report.table, &args.keys) {
        return Err(Exit::NotTaken.saying(problem));
    }
    let mut settings = list(&report.table, &report.image, controller.identity().simulated);
    if !args.keys.is_empty() {
        settings.retain(|setting| args.keys.iter().any(|start| keys::begins_with(&setting.key, start)));
    }
    let family = family::of(controller.identity().family);
    let conflicts = family.conflicts(&report.table, &report.image);
    if args.json {
        out.json(&json!({
            "identity": controller.identity(),
            "settings": settings,
            "failures": report.failures,
            "conflicts": conflicts.iter().map(|conflict| &conflict.data).collect::<Vec<_>>(),
        }))?;
    } else {
        out.line(list_text(&settings))?;
        out.lines(legend(&settings))?;
        for conflict in conflicts {
            say(CliSettingsMessage::Warning { conflict: conflict.sentence.to_string() });
        }
    }
    Ok(if report.is_whole() { Exit::Done } else { Exit::Failed })
}

/// Prints the reference page of the first family that has one; no controller is needed.
pub fn reference(args: &ReferenceArgs, out: &mut Output) -> Result<Exit, Exit> {
    if let Some(page) = family::families().iter().find_map(|family| family.settings_reference()) {
        page.print(args.json, out)?;
    }
    Ok(Exit::Done)
}

/// What the marks of the list mean, as far as they stand in it.
fn legend(settings: &[ListedSetting]) -> Vec<String> {
    let mut lines = Vec::new();
    if settings.iter().any(|setting| setting.is_default == Some(false)) {
        lines.push("\n*  is not the default".to_owned());
    }
    let locked = settings.iter().filter(|setting| !setting.locked.is_empty());
    let reasons = by_reason(locked.map(|setting| (setting.locked, setting.key.clone())));
    if !reasons.is_empty() {
        lines.push("\n#  cannot be written on this controller:".to_owned());
    }
    lines.extend(reasons);
    lines
}

/// Each reason once, followed by what it is the reason for.
pub fn by_reason<'r>(locked: impl Iterator<Item = (&'r str, String)>) -> Vec<String> {
    let mut reasons: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (reason, what) in locked {
        reasons.entry(reason).or_default().push(what);
    }
    reasons.iter().map(|(reason, what)| format!("   {reason}\n      {}", what.join(", "))).collect()
}

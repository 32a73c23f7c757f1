//! What a write will do, for people and as JSON: the changes with their units, and the commands that make them.

use brushwork_link::settings::{Plan, Refusal, diff, plan};
use brushwork_link::{Message, SettingValue, SettingsImage, SettingsTable, UnitAddress, WriteOptions};
use brushwork_values::hex;
use serde::Serialize;

use crate::output::{Output, OutputError, say};

/// What a write will do.
#[derive(Serialize)]
pub struct Review {
    /// What changes, in screen order.
    pub changes: Vec<Change>,
    /// The commands, in the order in which they are sent.
    pub commands: Vec<PlannedCommand>,
    /// Settings that are set past the wire of a simulated controller: key and raw value.
    pub past_the_wire: Vec<(String, i64)>,
    /// What should be known before it is done.
    pub warnings: Vec<Message>,
}

/// One setting that changes.
#[derive(Serialize)]
pub struct Change {
    /// The row's key.
    pub key: String,
    /// "Motor 1: velocity P".
    pub title: String,
    /// The value now; none when it is not known.
    pub before: Option<SettingValue>,
    /// The value afterwards; none when it is not known.
    pub after: Option<SettingValue>,
    /// The value now with its unit.
    pub before_text: String,
    /// The value afterwards with its unit.
    pub after_text: String,
}

/// One command of the plan.
#[derive(Serialize)]
pub struct PlannedCommand {
    /// The command decoded, as the traffic monitor shows it.
    pub text: String,
    /// Its bytes in hexadecimal.
    pub bytes: String,
    /// The settings it changes.
    pub keys: Vec<String>,
}

impl Review {
    /// What turns `ram` into `ram` with `wanted`.
    ///
    /// # Errors
    /// Every reason why something cannot be written.
    pub fn new(
        table: &SettingsTable,
        ram: &SettingsImage,
        wanted: &SettingsImage,
        options: WriteOptions,
        address: UnitAddress,
    ) -> Result<Self, Vec<Refusal>> {
        let plan = plan(table, ram, wanted, options)?;
        let mut after = ram.clone();
        after.merge(wanted);
        Ok(Self {
            changes: changes(table, ram, &after),
            commands: commands(table, &plan, address),
            past_the_wire: plan.hidden,
            warnings: plan.warnings,
        })
    }

    /// The changes and warnings as lines.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = change_lines(&self.changes);
        lines.extend(self.warnings.iter().map(|warning| format!("Note: {warning}")));
        lines
    }

    /// The commands and their bytes as lines.
    pub fn command_lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for command in &self.commands {
            lines.push(format!("  {}", command.text));
            lines.push(format!("      {}", command.bytes));
        }
        let past = self.past_the_wire.iter();
        lines.extend(
            past.map(|(key, raw)| format!("  {key} = {raw}, past the wire of the simulated controller")),
        );
        lines
    }
}

/// Lines before anything is done: on standard output, or beside it where that carries JSON and somebody is asked.
pub fn tell(lines: Vec<String>, json: bool, is_asked: bool, out: &mut Output) -> Result<(), OutputError> {
    match (json, is_asked) {
        (false, _) => out.lines(lines)?,
        (true, true) => lines.into_iter().for_each(say),
        (true, false) => {}
    }
    Ok(())
}

/// What differs between two images, both sides with their units.
pub fn changes(table: &SettingsTable, before: &SettingsImage, after: &SettingsImage) -> Vec<Change> {
    let change = |difference: brushwork_link::settings::Difference| {
        let row = table.row(&difference.key)?;
        let [before_text, after_text] = row.format_both([difference.left, difference.right]);
        Some(Change {
            title: row.title(),
            before_text,
            after_text,
            before: difference.left,
            after: difference.right,
            key: difference.key,
        })
    };
    diff(table, before, after).into_iter().filter_map(change).collect()
}

/// One line for each change: key, old -> new.
pub fn change_lines(changes: &[Change]) -> Vec<String> {
    let width = |text: fn(&Change) -> &str| {
        changes.iter().map(|change| text(change).chars().count()).max().unwrap_or_default()
    };
    let (keys, olds) = (width(|change| &change.key), width(|change| &change.before_text));
    let line = |change: &Change| {
        let Change { key, before_text, after_text, .. } = change;
        format!("  {key:<keys$}  {before_text:>olds$} -> {after_text}")
    };
    changes.iter().map(line).collect()
}

fn commands(table: &SettingsTable, plan: &Plan, address: UnitAddress) -> Vec<PlannedCommand> {
    let generation = table.subject().generation;
    let planned = |step: &brushwork_link::settings::Step| PlannedCommand {
        text: step.words(address, generation),
        bytes: step.bytes(address, generation).map_or_else(|why| why.to_string(), |bytes| hex(&bytes)),
        keys: step.keys.clone(),
    };
    plan.steps.iter().map(planned).collect()
}

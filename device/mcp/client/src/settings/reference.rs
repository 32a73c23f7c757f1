//! The table as a reference: one entry per setting, whatever the controller, as text and as rows for JSON.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::Generation;
use serde::Serialize;

use crate::settings::rows::{NOT_SETTINGS, templates};
use crate::settings::template::Template;
use crate::subject;
use brushwork_link::settings::Kind;
use brushwork_link::settings::{Access, Bits, Bound, Carrier, Group, Place, Row, Source};

/// One setting of the reference. Ranges and defaults that depend on the model are those of
/// [`ReferenceRow::example`].
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceRow {
    /// The key, "{n}" standing for the number or name of a motor, pin, stream or output.
    pub key: &'static str,
    /// Name within its group.
    pub label: &'static str,
    /// The group.
    pub group: Group,
    /// "yes or no", "whole number", "number" or "choice".
    pub kind: &'static str,
    /// The unit's symbol; empty for bare numbers.
    pub unit: &'static str,
    /// The range as text; empty for yes or no and for choices.
    pub range: String,
    /// Whether range or default depend on the model.
    pub depends_on_model: bool,
    /// The model and generation that range and default were taken from.
    pub example: String,
    /// The keys of the named values, in the newest generation; empty when there are none.
    pub choices: Vec<&'static str>,
    /// The default as text.
    pub default: String,
    /// Whether the default is our assumption.
    pub default_assumed: bool,
    /// Product line, if only one has it.
    pub family: Option<&'static str>,
    /// Firmware generations that have it.
    pub generations: Vec<Generation>,
    /// How it is read and written, by run of generations.
    pub forms: Vec<ReferenceForm>,
    /// What it means.
    pub help: &'static str,
}

/// How a setting is read and written in a run of generations; for repeated settings, of the first one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ReferenceForm {
    /// First generation.
    pub first: Generation,
    /// Last generation.
    pub last: Generation,
    /// "63 p": command and field; empty when there is none.
    pub read: String,
    /// "61 p": command and field; empty when there is none.
    pub write: String,
    /// Why it cannot be written, or only on simulated controllers; empty when it can.
    pub locked: &'static str,
}

/// Every setting of the table, in screen order.
pub fn reference() -> Vec<ReferenceRow> {
    templates().filter_map(reference_row).collect()
}

/// The reference as text, by group.
pub fn reference_text() -> String {
    let rows = reference();
    let mut text = String::from("Settings of the MCP and RoboClaw controllers\n");
    let groups: BTreeSet<Group> = rows.iter().map(|row| row.group).collect();
    for group in groups {
        push_line(&mut text, format_args!("\n{}\n{}", group.label(), "-".repeat(group.label().len())));
        rows.iter().filter(|row| row.group == group).for_each(|row| push_row(&mut text, row));
    }
    text.push_str("\nCommands that set something and are no settings\n");
    for (number, reason) in NOT_SETTINGS {
        push_line(&mut text, format_args!("  {number}: {reason}"));
    }
    text
}

fn reference_row(template: &'static Template) -> Option<ReferenceRow> {
    let generations = template.generations();
    let newest = *generations.last()?;
    let row = example_row(template, example_model(template), newest)?;
    let other = example_row(template, other_model(template), newest)?;
    let choices = match row.kind {
        Kind::Choice(codes) => codes.iter().map(|code| code.key).collect(),
        Kind::Bool | Kind::Int | Kind::Fixed { .. } => Vec::new(),
    };
    Some(ReferenceRow {
        key: template.key,
        label: template.label,
        group: template.group,
        kind: row.kind.name(),
        unit: row.unit.symbol(),
        range: row.range_text(),
        depends_on_model: row.range.bound == Bound::Model || row.default != other.default,
        example: format!("{}, {newest}", row.model),
        choices,
        default: row.format(row.default),
        default_assumed: row.default_assumed,
        family: template.family.map(Family::name),
        forms: reference_forms(template, &generations),
        generations,
        help: template.help,
    })
}

/// The forms of neighbouring generations that are alike count as one.
fn reference_forms(template: &Template, generations: &[Generation]) -> Vec<ReferenceForm> {
    let mut forms: Vec<ReferenceForm> = Vec::new();
    for generation in generations {
        let Some(row) = example_row(template, example_model(template), *generation) else { continue };
        let form = reference_form(&row, *generation);
        match forms.last_mut() {
            Some(last)
                if (&last.read, &last.write, last.locked) == (&form.read, &form.write, form.locked) =>
            {
                last.last = *generation;
            }
            _ => forms.push(form),
        }
    }
    forms
}

fn reference_form(row: &Row, generation: Generation) -> ReferenceForm {
    let (read, write) = match row.carrier {
        Carrier::NoWireForm { .. } => (String::new(), String::new()),
        Carrier::Wire { read, write } => {
            (source_text(read), write.map_or_else(String::new, |sink| place_text(sink.command, sink.place)))
        }
    };
    let locked = match row.access {
        Access::ReadWrite => "",
        Access::ReadOnly { reason } | Access::SimulatedOnly { reason } => reason,
    };
    ReferenceForm { first: generation, last: generation, read, write, locked }
}

fn source_text(source: Source) -> String {
    match source {
        Source::LinkAddress => "the address of the link".to_owned(),
        Source::Reply { command, place, .. } => place_text(command, place),
    }
}

fn place_text(command: u8, place: Place) -> String {
    match place.bits {
        None => format!("{command} {}", place.field),
        Some(Bits { shift, width: 1 }) => format!("{command} {} bit {shift}", place.field),
        Some(Bits { shift, width }) => {
            format!("{command} {} bits {shift} to {}", place.field, shift + width - 1)
        }
    }
}

fn example_row(template: &Template, model: &'static Model, generation: Generation) -> Option<Row> {
    template.expand(&subject(model, generation)).into_iter().next()
}

/// The MCP266 of the manual's examples, or the RoboClaw where only that has the setting.
fn example_model(template: &Template) -> &'static Model {
    models::lookup(match template.family {
        Some(Family::RoboClaw) => "roboclaw-2x7a",
        _ => "mcp266",
    })
    .expect("both models are in the list")
}

/// Another model of the same line, to see what depends on the model.
fn other_model(template: &Template) -> &'static Model {
    models::lookup(match template.family {
        Some(Family::RoboClaw) => "roboclaw-2x7a",
        _ => "mcp233",
    })
    .expect("both models are in the list")
}

fn push_row(text: &mut String, row: &ReferenceRow) {
    let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
    push_line(text, format_args!("\n{}{unit}\n    {}. {}", row.key, row.label, row.help));
    if !row.range.is_empty() {
        let note = if row.depends_on_model { " (depends on the model)" } else { "" };
        push_line(text, format_args!("    Range: {}{note}", row.range));
    }
    if !row.choices.is_empty() {
        push_line(text, format_args!("    One of: {}", row.choices.join(", ")));
    }
    let assumed = if row.default_assumed { " (assumed)" } else { "" };
    push_line(text, format_args!("    Default: {}{assumed}", row.default));
    if let Some(family) = row.family {
        push_line(text, format_args!("    Only on: {family}"));
    }
    for form in &row.forms {
        push_line(text, format_args!("    {}", form_text(form)));
    }
}

fn form_text(form: &ReferenceForm) -> String {
    let generations = match (form.first.number(), form.last.number()) {
        (first, last) if first == last => format!("Generation {first}"),
        (first, last) => format!("Generations {first} to {last}"),
    };
    let way = match (form.read.as_str(), form.write.as_str()) {
        ("", "") => "no public wire form".to_owned(),
        (read, "") => format!("read with {read}"),
        (read, write) => format!("read with {read}, written with {write}"),
    };
    match form.locked {
        "" => format!("{generations}: {way}."),
        reason => format!("{generations}: {way}. {reason}"),
    }
}

fn push_line(text: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing into a string cannot fail.
    let _ = writeln!(text, "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_has_every_line_of_the_table_once() {
        let rows = reference();
        assert_eq!(rows.len(), templates().count());
        assert!(rows.iter().all(|row| !row.forms.is_empty() && !row.generations.is_empty()));
    }

    #[test]
    fn an_entry_tells_range_default_and_commands() {
        let text = reference_text();
        let at = text.find("\nmotor{n}.current.max_amps [A]\n").expect("it is in the reference");
        let entry: Vec<&str> = text[at..].lines().skip(1).take(5).collect();
        assert_eq!(entry[2], "    Range: 0.00 A to 60.00 A (depends on the model)");
        assert_eq!(entry[3], "    Default: 60.00 A");
        assert_eq!(entry[4], "    Generations 1 to 4: read with 135 max, written with 133 max.");
    }

    #[test]
    fn forms_that_differ_by_generation_are_told_apart() {
        let rows = reference();
        let row = rows.iter().find(|row| row.key == "pin.{n}.low_pass").expect("it is in the reference");
        let reported: Vec<String> = row.forms.iter().map(form_text).collect();
        assert_eq!(
            reported,
            [
                "Generation 1: no public wire form. Command 143 of this firmware generation has no field \
                 for the low pass; from generation 2 on it has.",
                "Generations 2 to 4: read with 144 low_pass, written with 143 low_pass.",
            ]
        );
    }
}

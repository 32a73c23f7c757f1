//! The references of settings and of packet serial.

use std::sync::OnceLock;

use brushwork_mcp_client::settings::{ReferenceForm, ReferenceRow, reference};
use brushwork_mcp_wire::packet_serial::{COMMANDS, reference as protocol};
use egui::{Grid, Label, Ui};

use crate::help::list::{Entry, list_ui};
use crate::help::scrolled_ui;
use crate::mcp::messages::McpScreenMessage;
use crate::model::help::Help;

pub fn settings_ui(ui: &mut Ui, help: &mut Help) {
    static ROWS: OnceLock<Vec<ReferenceRow>> = OnceLock::new();
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    let rows = ROWS.get_or_init(reference);
    let entry = |row: &ReferenceRow| Entry {
        key: row.key.to_owned(),
        title: format!("{}: {}", row.group.label(), row.label),
        words: format!("{} {} {} {}", row.group.label(), row.label, row.key, row.help).to_lowercase(),
    };
    let entries = ENTRIES.get_or_init(|| rows.iter().map(entry).collect());
    list_ui(ui, entries, help);
    let chosen = rows.iter().find(|row| Some(row.key) == help.entry.as_deref());
    scrolled_ui(ui, |ui| {
        match chosen {
        Some(row) => setting_ui(ui, row),
        None => drop(ui.weak("Choose a setting at the left. A pair of braces in a key stands for the number or name of a motor, pin, \
             stream or output.")),
    }
    });
}

fn setting_ui(ui: &mut Ui, row: &ReferenceRow) {
    ui.heading(row.label);
    ui.add(Label::new(row.help).wrap());
    ui.add_space(6.0);
    let of_model = if row.depends_on_model {
        McpScreenMessage::OnModel { example: row.example.to_string() }.to_string()
    } else {
        String::new()
    };
    let assumed = if row.default_assumed { " (assumed)" } else { "" };
    let generations: Vec<String> = row.generations.iter().map(|each| each.number().to_string()).collect();
    let mut lines = vec![
        ("Key", row.key.to_owned()),
        ("Kind", row.kind.to_owned()),
        ("Unit", row.unit.to_owned()),
        ("Range", if row.range.is_empty() { String::new() } else { format!("{}{of_model}", row.range) }),
        ("One of", row.choices.join(", ")),
        ("Default", format!("{}{assumed}", row.default)),
        (
            "Only",
            row.family.map(|family| McpScreenMessage::OnlyFamily { family }.to_string()).unwrap_or_default(),
        ),
        ("Generations", generations.join(", ")),
    ];
    lines.extend(row.forms.iter().map(|form| ("On the wire", form_text(form))));
    lines.retain(|(_, text)| !text.is_empty());
    table_ui(ui, &lines);
}

fn form_text(form: &ReferenceForm) -> String {
    let (first, last) = (form.first.number(), form.last.number());
    let span = if first == last {
        McpScreenMessage::Generation { number: first }.to_string()
    } else {
        McpScreenMessage::Generations { first, last }.to_string()
    };
    let part =
        |word: &str, text: &str| if text.is_empty() { String::new() } else { format!(", {word} {text}") };
    let locked = if form.locked.is_empty() { String::new() } else { format!(". {}", form.locked) };
    let none = if form.read.is_empty() && form.write.is_empty() { ", no public form" } else { "" };
    format!("{span}{}{}{none}{locked}", part("read by", &form.read), part("written by", &form.write))
}

fn table_ui(ui: &mut Ui, lines: &[(&str, String)]) {
    Grid::new("setting").num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for (label, text) in lines {
            ui.weak(*label);
            ui.add(Label::new(text).wrap());
            ui.end_row();
        }
    });
}

/// The key of the entry about the status word, which is no command.
const STATUS: &str = "status word";

pub fn packet_serial_ui(ui: &mut Ui, help: &mut Help) {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    let entries = ENTRIES.get_or_init(|| {
        let of_command = |command: &brushwork_mcp_wire::packet_serial::Command| Entry {
            key: command.key.to_owned(),
            title: format!("{} {}", command.number, command.title),
            words: format!("{} {} {}", command.number, command.title, command.key).to_lowercase(),
        };
        let status = Entry {
            key: STATUS.to_owned(),
            title: "The status word".to_owned(),
            words: "90 status word bits".to_owned(),
        };
        std::iter::once(status).chain(COMMANDS.iter().map(of_command)).collect()
    });
    list_ui(ui, entries, help);
    scrolled_ui(ui, |ui| match help.entry.as_deref() {
        None => text_ui(ui, protocol::page().split("## Commands").next().unwrap_or_default()),
        Some(STATUS) => status_ui(ui),
        Some(key) => {
            if let Some(command) = COMMANDS.iter().find(|command| command.key == key) {
                text_ui(ui, &protocol::section(command));
            }
        }
    });
}

fn status_ui(ui: &mut Ui) {
    static ROWS: OnceLock<Vec<protocol::StatusEntry>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| protocol::reference().status);
    ui.heading("The status word");
    ui.label("Masks of each condition in the four firmware generations; a dash where a generation has no such bit.");
    Grid::new("status word").num_columns(7).striped(true).spacing([14.0, 3.0]).show(ui, |ui| {
        for head in ["Condition", "Indicator", "Gravity", "1", "2", "3", "4"] {
            ui.strong(head);
        }
        ui.end_row();
        for row in rows {
            ui.label(row.title);
            ui.label(row.indicator.unwrap_or("–"));
            ui.label(format!("{:?}", row.severity).to_lowercase());
            for mask in row.masks {
                let text = if mask == 0 { "–".to_owned() } else { format!("0x{mask:X}") };
                ui.monospace(text);
            }
            ui.end_row();
        }
    });
}

/// The little Markdown that the reference is written in: headings, and lines that begin with a dash.
fn text_ui(ui: &mut Ui, text: &str) {
    for line in text.lines() {
        let bare = line.replace("**", "");
        match bare.trim_start_matches('#') {
            title if title.len() < bare.len() => {
                ui.heading(title.trim());
            }
            "" => ui.add_space(4.0),
            line => {
                ui.add(Label::new(line).wrap());
            }
        }
    }
}

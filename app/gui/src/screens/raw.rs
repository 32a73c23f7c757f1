//! The page for settings without public meaning: one number for one register, at its owner's word.

use brushwork_core::examine::RawWrite;
use brushwork_core::messages::RawMessage;
use brushwork_core::words::capital;
use brushwork_link::Message;
use egui::{Button, Checkbox, ComboBox, Context, Label, Rect, RichText, Ui, vec2};

use super::dialog::{dialog_ui, said_ui, weak_ui};
use crate::command::{Command, Commands};
use crate::messages::RawPageMessage;
use crate::model::raw::{RawAction, rows};
use crate::model::{Connection, Model};
use crate::theme::Palette;
use crate::widgets::{choice_ui, heading_ui, text_field_ui};

/// Draws the window, if it is open, within `room`.
pub fn raw_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if model.front.raw.open {
        let size = vec2(600.0, 520.0);
        let title = ("Raw settings, at your own risk", model.front.errand.is_running());
        model.front.raw.open = dialog_ui(ctx, title, (room, size), |ui| {
            contents_ui(ui, &mut model.front, commands);
        });
    }
}

fn contents_ui(ui: &mut Ui, front: &mut Connection, commands: &mut Commands) {
    weak_ui(
        ui,
        "For settings whose numbers have no public meaning, which no usual write sends to a real controller. One number goes to one register, \
         with a backup before, read back after, and noted for the report of an examination.",
    );
    ui.add_space(6.0);
    if !front.is_connected() {
        ui.weak("No controller is connected.");
        return;
    }
    let Some(unit) = front.settings.unit().filter(|unit| unit.ram().is_some()) else {
        ui.weak("The settings are being read.");
        return;
    };
    let known: Vec<(String, String)> = rows(unit).map(|row| (row.key.clone(), row.title())).collect();
    if known.is_empty() {
        ui.weak("This controller has no such settings.");
        return;
    }
    let page = &mut front.raw;
    if !known.iter().any(|(key, _)| *key == page.key) {
        page.key = known.first().map(|(key, _)| key.clone()).unwrap_or_default();
    }
    let title = |wanted: &str| {
        let found = known.iter().find(|(key, _)| key == wanted);
        found.map_or_else(|| wanted.to_owned(), |(key, title)| format!("{title} ({key})"))
    };
    ui.horizontal_wrapped(|ui| {
        let list = ComboBox::from_id_salt("raw setting").width(380.0);
        let before = page.key.clone();
        let mut chosen = before.as_str();
        let keys = known.iter().map(|(key, _)| key.as_str());
        choice_ui(ui, list, "Setting", &mut chosen, keys, title);
        if chosen != before {
            page.key = chosen.to_owned();
            page.is_agreed = false;
        }
    });
    facts_ui(ui, front);
    let page = &mut front.raw;
    ui.horizontal(|ui| {
        ui.label("Number");
        if text_field_ui(ui, &mut page.typed, "Raw number", "2 or 0x02").changed() {
            page.is_agreed = false;
        }
    });
    ui.add_space(4.0);
    let color = Palette::of(ui).warning;
    ui.add(Label::new(RichText::new(RawMessage::Warning.to_string()).color(color)).wrap());
    let is_running = page.is_running();
    let progress = front.errand.progress().filter(|_| is_running).map(|(_, text)| capital(text));
    ui.add_enabled(!is_running, Checkbox::new(&mut page.is_agreed, "I answer for what this number does"));
    let can_write = page.is_agreed && !is_running && !page.typed.trim().is_empty();
    ui.horizontal(|ui| {
        let size = vec2(140.0, 30.0);
        if ui.add_enabled(can_write, Button::new("Write this number").min_size(size)).clicked() {
            commands.push(Command::WriteRaw(RawAction::Write));
        }
        if let Some(text) = &progress {
            ui.spinner();
            ui.weak(text);
        }
    });
    said_ui(ui, front.raw.ended.as_ref());
    writes_ui(ui, front, commands);
}

/// What the chosen setting's register holds, and which command writes it.
fn facts_ui(ui: &mut Ui, front: &Connection) {
    let row = front.settings.unit().and_then(|unit| unit.table().row(&front.raw.key));
    if let Some(sink) = row.and_then(brushwork_link::settings::Row::sink) {
        let (command, field) = (sink.command, sink.place.field.to_owned());
        let text: Message = match sink.index {
            Some(index) => RawPageMessage::CommandOf { command, field, index }.into(),
            None => RawPageMessage::Command { command, field }.into(),
        };
        ui.weak(text.to_string());
    }
    match front.raw_held() {
        Some(raw) => drop(ui.label(Message::from(RawPageMessage::HoldsNow { raw }).to_string())),
        None => drop(ui.weak("What the register holds could not be read.")),
    }
    if let Some(reason) = row.and_then(|row| row.locked(false)) {
        weak_ui(ui, reason);
    }
}

/// What was written before, the newest first.
fn writes_ui(ui: &mut Ui, front: &Connection, commands: &mut Commands) {
    if front.raw.writes().is_empty() {
        return;
    }
    ui.add_space(8.0);
    heading_ui(ui, "Written raw to this controller");
    if let Some((key, raw)) = front.raw_undo() {
        let text = Message::from(RawPageMessage::Undo { key, raw }).to_string();
        if ui.add_enabled(!front.raw.is_running(), Button::new(text)).clicked() {
            commands.push(Command::WriteRaw(RawAction::Undo));
        }
    }
    for write in front.raw.writes().iter().rev() {
        weak_ui(ui, &was(write).to_string());
    }
}

fn was(write: &RawWrite) -> Message {
    let number = |raw: Option<i64>| raw.map_or_else(|| "?".to_owned(), |raw| raw.to_string());
    let RawWrite { date, key, wanted, .. } = write.clone();
    let (before, found) = (number(write.before), number(write.found));
    match write.is_open {
        true => RawPageMessage::WasCutOff { date, key, wanted, before }.into(),
        false => RawPageMessage::Was { date, key, wanted, before, found }.into(),
    }
}

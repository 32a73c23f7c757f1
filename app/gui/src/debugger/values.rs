//! Variables and registers: what they are, and which of them have changed since the script stood here last.

use brushwork_script::debug::{Show, one};
use brushwork_script::language::Language;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::op::Array;
use brushwork_script::program::Variable;
use brushwork_script::vm::{Memory, element};
use egui::{CollapsingHeader, ComboBox, Label, RichText, Sense, Ui};

use super::state::{Debugging, RegisterGroup};
use crate::debugger::messages::DebuggerMessage;
use crate::theme::Palette;
use crate::widgets::{choice_ui, heading_ui};

/// Elements of an array that are listed.
const LISTED: u32 = 256;

/// How much of a line is for the name.
const NAME_SHARE: f32 = 0.5;
const ROW_HEIGHT: f32 = 17.0;

/// One line of the list.
struct Row<'a> {
    /// What Set takes.
    place: String,
    text: String,
    hint: &'a str,
    changed: bool,
}

pub fn values_ui(ui: &mut Ui, debug: &mut Debugging) {
    ui.horizontal(|ui| {
        heading_ui(ui, "Variables");
        show_ui(ui, "Number form", &mut debug.show);
    });
    variables_ui(ui, debug);
    ui.add_space(6.0);
    // Registers are of MCL alone.
    if debug.language() != Language::Mcl {
        debug.open_groups.clear();
        return;
    }
    heading_ui(ui, "Registers");
    for group in RegisterGroup::ALL {
        let shown = CollapsingHeader::new(group.title()).id_salt(("registers", group)).show(ui, |ui| {
            registers_ui(ui, debug, group);
        });
        if shown.fully_open() {
            debug.open_groups.insert(group);
        } else {
            debug.open_groups.remove(&group);
        }
    }
}

/// How numbers are written.
pub fn show_ui(ui: &mut Ui, name: &str, show: &mut Show) {
    let list = ComboBox::from_id_salt(name).width(72.0);
    choice_ui(ui, list, name, show, Show::ALL, Show::name);
}

fn variables_ui(ui: &mut Ui, debug: &mut Debugging) {
    let Some(program) = debug.program().cloned() else {
        ui.weak("They are shown once a script whose text is open has been started.");
        return;
    };
    if program.variables.is_empty() {
        ui.weak("This program has no variables.");
    }
    let (now, before) = (debug.memory(), debug.memory_before());
    let mut chosen = None;
    for is_array in [false, true] {
        for variable in program.variables.iter().filter(|variable| variable.is_array == is_array) {
            let picked = variable_ui(ui, variable, (&now, before.as_ref()), debug.show);
            chosen = picked.or(chosen);
        }
    }
    choose(debug, chosen);
}

fn variable_ui(
    ui: &mut Ui,
    variable: &Variable,
    (now, before): (&Memory, Option<&Memory>),
    show: Show,
) -> Option<(String, String)> {
    let Array { length, .. } = variable.memory;
    let cell_row = |index: u32| {
        let cell = element(variable.memory, index)?;
        let value = now.load(cell);
        let changed = before.is_some_and(|before| before.load(cell) != value);
        let place =
            if variable.is_array { format!("{}({index})", variable.name) } else { variable.name.clone() };
        Some(Row { place, text: one(variable.kind(), value, show), hint: variable.kind().name(), changed })
    };
    if !variable.is_array {
        return cell_row(0).and_then(|row| row_ui(ui, &row));
    }
    let changed = (0..length).filter_map(cell_row).any(|row| row.changed);
    let mark = if changed { " (changed)" } else { "" };
    let title = format!("{}, {length} × {}{mark}", variable.name, variable.kind().name());
    let listed = CollapsingHeader::new(title).id_salt(&variable.name).show(ui, |ui| {
        let mut chosen = None;
        for row in (0..length.min(LISTED)).filter_map(cell_row) {
            chosen = row_ui(ui, &row).or(chosen);
        }
        if length > LISTED {
            ui.weak(DebuggerMessage::MoreElements { more: length - LISTED }.to_string());
        }
        chosen
    });
    listed.body_returned.flatten()
}

/// A name and its value. A click takes it to where a new value is typed.
fn row_ui(ui: &mut Ui, row: &Row<'_>) -> Option<(String, String)> {
    let palette = Palette::of(ui);
    let Row { place, text, hint, changed } = row;
    let line_ui = |ui: &mut Ui| {
        let name = egui::vec2(ui.available_width() * NAME_SHARE, ROW_HEIGHT);
        ui.allocate_ui_with_layout(name, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_width(name.x);
            ui.add(Label::new(RichText::new(place).monospace()).truncate());
        });
        let color = if *changed { palette.warning } else { palette.text };
        let mark = if *changed { " *" } else { "" };
        let value = RichText::new(format!("{text}{mark}")).monospace().color(color);
        let value = if *changed { value.strong() } else { value };
        let response = ui.add(Label::new(value).sense(Sense::click()).truncate());
        let state = if *changed { ", changed" } else { "" };
        response.widget_info(|| {
            egui::WidgetInfo::labeled(
                egui::Role::Button,
                true,
                DebuggerMessage::Is { place: place.clone(), value: text.clone(), state }.to_string(),
            )
        });
        response.on_hover_text(DebuggerMessage::ClickToSet { hint: hint.to_string() }.to_string()).clicked()
    };
    let scope = ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = ROW_HEIGHT;
        ui.horizontal(line_ui).inner
    });
    let clicked = scope.inner;
    clicked.then(|| (place.clone(), text.clone()))
}

fn registers_ui(ui: &mut Ui, debug: &mut Debugging, group: RegisterGroup) {
    let wanted = debug.registers_of(group);
    let Some(view) = debug.view.clone() else { return };
    if wanted.is_empty() {
        ui.weak("None.");
    }
    let mut chosen = None;
    for id in wanted {
        let Some(reading) = view.registers.iter().find(|reading| reading.id == id) else { continue };
        let before = debug.register_before(id);
        for (index, cell) in reading.cells.iter().enumerate() {
            let changed = before.and_then(|before| before.get(index)).is_some_and(|before| before != cell);
            let row = Row {
                place: place_of(id, index),
                text: one(id.row().kind, *cell, debug.show),
                hint: id.row().meaning,
                changed,
            };
            chosen = row_ui(ui, &row).or(chosen);
        }
    }
    choose(debug, chosen);
}

fn place_of(id: RegisterId, index: usize) -> String {
    let row = id.row();
    if row.length == 1 { row.name.to_owned() } else { format!("{}({index})", row.name) }
}

fn choose(debug: &mut Debugging, chosen: Option<(String, String)>) {
    if let Some((place, value)) = chosen {
        debug.set_place = place;
        debug.set_value = value;
        debug.set_answer = None;
    }
}

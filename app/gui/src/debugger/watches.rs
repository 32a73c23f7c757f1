//! Watched expressions, and the line that sets a variable or register to something else.

use brushwork_script::language::Language;
use egui::{Label, RichText, TextEdit, Ui};

use super::action::DebugAction;
use super::state::Debugging;
use super::values::show_ui;
use crate::command::{Command, Commands};
use crate::debugger::messages::DebuggerMessage;
use crate::theme::Palette;
use crate::widgets::{heading_ui, text_field_ui};

/// A column that has room for a watch and its form side by side.
const WIDE: f32 = 300.0;

pub fn watches_ui(ui: &mut Ui, debug: &mut Debugging, commands: &mut Commands) {
    heading_ui(ui, "Watches");
    let mut removed = None;
    let view = debug.view.clone();
    let is_wide = ui.available_width() >= WIDE;
    for (index, row) in debug.watches.iter_mut().enumerate() {
        let value = view.as_ref().and_then(|view| view.watches.get(index));
        let (text, is_wrong) = match value {
            Some(Ok(value)) => (value.text(row.show), false),
            Some(Err(why)) => (why.clone(), true),
            None => ("not known yet".to_owned(), false),
        };
        ui.horizontal(|ui| {
            let name = DebuggerMessage::RemoveWatch { watch: row.text.clone() }.to_string();
            if remove_ui(ui, &name) {
                removed = Some(index);
            }
            show_ui(ui, &DebuggerMessage::FormOfWatch { watch: row.text.clone() }.to_string(), &mut row.show);
            if is_wide {
                value_ui(ui, &row.text, &text, is_wrong);
            }
        });
        if !is_wide {
            ui.horizontal(|ui| value_ui(ui, &row.text, &text, is_wrong));
        }
    }
    removed.into_iter().for_each(|index| drop(debug.watches.remove(index)));
    let hint = match debug.language() {
        Language::Mcl => "e.g. total / 2, text(3), MOTORENCPOS(0)",
        Language::Mecc => "e.g. total / 2, table(3), GetClock()",
        Language::Brought(_) => "",
    };
    let field = text_field_ui(ui, &mut debug.new_watch, "Add watch", hint);
    if field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
        debug.add_watch();
        field.request_focus();
    }
    ui.add_space(8.0);
    set_ui(ui, debug, commands);
}

/// An expression and what it is.
fn value_ui(ui: &mut Ui, expression: &str, value: &str, is_wrong: bool) {
    ui.add(Label::new(RichText::new(format!("{expression} =")).monospace()).truncate());
    let color = if is_wrong { Palette::of(ui).warning } else { Palette::of(ui).text };
    ui.add(Label::new(RichText::new(value).monospace().color(color)).truncate()).on_hover_text(value);
}

fn set_ui(ui: &mut Ui, debug: &mut Debugging, commands: &mut Commands) {
    heading_ui(ui, "Set");
    ui.horizontal(|ui| {
        let width = ((ui.available_width() - 76.0) / 2.0).max(40.0);
        let place = ui.add(TextEdit::singleline(&mut debug.set_place).desired_width(width).hint_text("name"));
        ui.ctx().accesskit_node_builder(place.id, |node| node.set_label("Variable or register to set"));
        ui.label("=");
        let value =
            ui.add(TextEdit::singleline(&mut debug.set_value).desired_width(width).hint_text("value"));
        ui.ctx().accesskit_node_builder(value.id, |node| node.set_label("New value"));
        let entered = value.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if ui.button("Set").clicked() || entered {
            commands.push(Command::Debug(DebugAction::SetValue));
        }
    });
    match &debug.set_answer {
        Some(Ok(done)) => drop(ui.add(Label::new(done).wrap())),
        Some(Err(why)) => {
            ui.add(Label::new(RichText::new(why).color(Palette::of(ui).error)).wrap());
        }
        None => drop(ui.weak(match debug.language() {
            Language::Mcl => {
                "Sets a variable, an element, a part (x.bit3) or a register while the script is paused."
            }
            Language::Mecc => "Sets a variable or a byte of a table while the program is paused.",
            Language::Brought(_) => "",
        })),
    }
}

/// A small button that takes something away.
pub fn remove_ui(ui: &mut Ui, name: &str) -> bool {
    let response = ui.small_button("×").on_hover_text(name);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
    response.clicked()
}

//! The bar for finding and replacing, above the text.

use egui::{Button, Key, Label, Modifiers, Role, TextEdit, Ui, WidgetInfo};

use super::{Editor, MclAction};
use crate::widgets::text_field::keep_space;

const FIELD_WIDTH: f32 = 220.0;
const TOLD_WIDTH: f32 = 150.0;

pub fn findbar_ui(ui: &mut Ui, editor: &mut Editor, actions: &mut Vec<MclAction>) {
    if !editor.find.open {
        return;
    }
    let wants_focus = std::mem::take(&mut editor.find.wants_focus);
    let reported = editor.find.reported(editor.front().caret);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let entered = field_ui(ui, &mut editor.find.query.text, "Find", wants_focus);
        match entered {
            Some(Entered::Enter) => actions.push(MclAction::FindNext),
            Some(Entered::ShiftEnter) => actions.push(MclAction::FindPrevious),
            Some(Entered::Escape) => actions.push(MclAction::CloseFind),
            None => {}
        }
        let query = &mut editor.find.query;
        toggle_ui(ui, &mut query.case, "Aa", "Match case");
        toggle_ui(ui, &mut query.word, "Word", "Whole words");
        toggle_ui(ui, &mut query.regex, ".*", "Regular expression");
        for (reads, action, name) in [
            ("Previous", MclAction::FindPrevious, "Find previous match"),
            ("Next", MclAction::FindNext, "Find next match"),
        ] {
            if named(ui, reads, name).clicked() {
                actions.push(action);
            }
        }
        told_ui(ui, &reported);
        if named(ui, "Close", "Close the find bar").clicked() {
            actions.push(MclAction::CloseFind);
        }
    });
    if editor.find.replaces {
        replace_ui(ui, editor, actions);
    }
    ui.add_space(2.0);
}

fn replace_ui(ui: &mut Ui, editor: &mut Editor, actions: &mut Vec<MclAction>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        match field_ui(ui, &mut editor.find.replacement, "Replace with", false) {
            Some(Entered::Enter | Entered::ShiftEnter) => actions.push(MclAction::ReplaceOne),
            Some(Entered::Escape) => actions.push(MclAction::CloseFind),
            None => {}
        }
        if named(ui, "Replace", "Replace this match").clicked() {
            actions.push(MclAction::ReplaceOne);
        }
        if named(ui, "Replace all", "Replace all matches").clicked() {
            actions.push(MclAction::ReplaceAll);
        }
    });
}

/// How a field was left.
enum Entered {
    Enter,
    ShiftEnter,
    Escape,
}

fn field_ui(ui: &mut Ui, text: &mut String, name: &str, wants_focus: bool) -> Option<Entered> {
    // A field of one line gives the keyboard away at Enter; here it stays, for the next match.
    let edit = TextEdit::singleline(text).hint_text(name).desired_width(FIELD_WIDTH);
    let response = ui.add(edit.return_key(None));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
    if wants_focus {
        response.request_focus();
    }
    if !response.has_focus() && !response.lost_focus() {
        return None;
    }
    keep_space(ui, response.id);
    ui.input_mut(|input| {
        if input.consume_key(Modifiers::SHIFT, Key::Enter) {
            Some(Entered::ShiftEnter)
        } else if input.consume_key(Modifiers::NONE, Key::Enter) {
            Some(Entered::Enter)
        } else if input.key_pressed(Key::Escape) {
            Some(Entered::Escape)
        } else {
            None
        }
    })
}

fn toggle_ui(ui: &mut Ui, on: &mut bool, reads: &str, name: &str) {
    let response = ui.add(Button::selectable(*on, reads));
    let is_on = *on;
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_on, name));
    if response.on_hover_text(name).clicked() {
        *on = !*on;
    }
}

fn named(ui: &mut Ui, reads: &str, name: &str) -> egui::Response {
    let response = ui.button(reads);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    response.on_hover_text(name)
}

fn told_ui(ui: &mut Ui, reported: &str) {
    let label = Label::new(egui::RichText::new(reported).weak()).truncate().selectable(false);
    ui.add_sized(egui::vec2(TOLD_WIDTH, ui.spacing().interact_size.y), label).on_hover_text(reported);
}

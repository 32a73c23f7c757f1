//! A field for words, the only kind of widget that keeps the Space key for itself.
//!
//! Space stops the motors. A field in which a space is part of what is typed says so here while it has focus; a
//! field for a number does not, so Space stops there too.

use egui::{Context, Id, Response, TextEdit, Ui};

/// Draws a one-line field as wide as what is left, named `name`.
pub fn text_field_ui(ui: &mut Ui, text: &mut String, name: &str, hint: &str) -> Response {
    let response = ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(f32::INFINITY));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
    if response.has_focus() {
        keep_space(ui, response.id);
    }
    response
}

/// Lets the widget `id`, which has the keyboard, take a space as a letter.
pub fn keep_space(ui: &Ui, id: Id) {
    ui.data_mut(|data| data.insert_temp(key(), id));
}

/// Whether the widget with keyboard focus takes a space as a letter.
pub fn takes_space(ctx: &Context) -> bool {
    let typing = ctx.data(|data| data.get_temp::<Id>(key()));
    typing.is_some() && ctx.memory(egui::Memory::focused) == typing
}

fn key() -> Id {
    Id::unique("brushwork: field being typed in")
}

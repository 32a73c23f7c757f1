//! A field for words, the only kind of widget that keeps the Space key for itself.
//!
//! Space stops the motors. A field in which a space is part of what is typed says so here while it has focus; a
//! field for a number does not, so Space stops there too.

use egui::{Context, Event, Id, Response, TextEdit, Ui};

/// Longest text that is pasted into a field, bytes: one is laid out again in each frame.
pub const MOST_PASTED_BYTES: usize = 16 << 10;
/// The same for a text that is laid out by the line, as a program is: the largest for which its readers answer within a second.
pub const MOST_PASTED_LINES_BYTES: usize = 1 << 20;

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

/// Lets the widget `id`, which has the keyboard, take a text of many lines from the clipboard.
pub fn take_many_lines(ui: &Ui, id: Id) {
    ui.data_mut(|data| data.insert_temp(many_lines_key(), id));
}

/// Takes a text out of the input that is too long for where it would be pasted. Returns its length and what there would have been room for, bytes.
/// Called before anything is drawn.
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
pub fn refuse_long_paste(ctx: &Context) -> Option<(usize, usize)> {
    let with_lines = ctx.data(|data| data.get_temp::<Id>(many_lines_key()));
    let has_lines = with_lines.is_some() && ctx.memory(egui::Memory::focused) == with_lines;
    let most = if has_lines { MOST_PASTED_LINES_BYTES } else { MOST_PASTED_BYTES };
    let mut refused = None;
    ctx.input_mut(|input| {
        input.events.retain(|event| match event {
            Event::Paste(text) if text.len() > most => {
                refused = Some((text.len(), most));
                false
            }
            _ => true,
        });
    });
    refused
}

fn key() -> Id {
    Id::unique("brushwork: field being typed in")
}

fn many_lines_key() -> Id {
    Id::unique("brushwork: lines being typed in")
}

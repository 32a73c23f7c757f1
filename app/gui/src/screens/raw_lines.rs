//! A terminal of lines: what was sent and came back, and the field for the next.

use egui::{Key, Label, RichText, ScrollArea, Ui, vec2};

use crate::model::raw_lines::{RawLine, RawLines};
use crate::theme::Palette;
use crate::widgets::text_field_ui;

/// Room below the list: the field and what it means.
const ENTRY_HEIGHT: f32 = 84.0;

/// The lines so far, and the field with `hint`; true when Enter was pressed in it. `beginning` stands where nothing was sent yet.
pub fn raw_lines_ui<K>(ui: &mut Ui, lines: &mut RawLines<K>, beginning: &str, hint: &str) -> bool {
    let height = (ui.available_height() - ENTRY_HEIGHT).max(80.0);
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        list_ui(ui, lines, beginning);
    });
    ui.separator();
    field_ui(ui, lines, hint)
}

fn list_ui<K>(ui: &mut Ui, lines: &RawLines<K>, beginning: &str) {
    if lines.entries.is_empty() {
        ui.add(Label::new(RichText::new(beginning).weak()).wrap());
    }
    ScrollArea::vertical().id_salt("terminal").auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
        lines.entries.iter().for_each(|line| line_ui(ui, line));
    });
}

fn line_ui<K>(ui: &mut Ui, line: &RawLine<K>) {
    let palette = Palette::of(ui);
    if !line.sent.is_empty() {
        ui.add(Label::new(RichText::new(format!("> {}", line.sent)).monospace()).wrap());
        ui.indent(&line.sent, |ui| ui.add(Label::new(RichText::new(&line.meaning).weak()).wrap()));
    }
    let answer = match &line.answer {
        None => RichText::new("waiting for the answer …"),
        Some(Ok((received, words))) => {
            if !received.is_empty() {
                ui.add(Label::new(RichText::new(format!("< {received}")).monospace()).wrap());
            }
            RichText::new(words)
        }
        Some(Err(why)) => RichText::new(why).color(palette.error),
    };
    ui.indent((&line.sent, "answer"), |ui| ui.add(Label::new(answer).wrap()));
}

fn field_ui<K>(ui: &mut Ui, lines: &mut RawLines<K>, hint: &str) -> bool {
    ui.horizontal(|ui| {
        let room = vec2(ui.available_width() - 60.0, ui.spacing().interact_size.y);
        let field = ui.allocate_ui(room, |ui| text_field_ui(ui, &mut lines.typed, "Line", hint)).inner;
        if ui.button("Clear").on_hover_text("Empties the list").clicked() {
            lines.entries.clear();
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if entered {
            // The next line is typed at once, and a space in it is no stop.
            field.request_focus();
        }
        entered
    })
    .inner
}

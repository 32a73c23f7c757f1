//! The terminal: lines of commands and commands of one character, in words both ways.

use brushwork_suprmotr_wire::{Radix, operation};
use egui::{Button, Key, Label, RichText, ScrollArea, Ui, vec2};

use crate::command::Commands;
use crate::model::Model;
use crate::screens::{not_connected_text, nothing_ui, title_ui};
use crate::suprmotr::model::channels::{holds_lines, status_in};
use crate::suprmotr::model::terminal::{Entry, Terminal};
use crate::theme::Palette;
use crate::widgets::text_field_ui;

/// Room below the list: the field and what it means.
const ENTRY_HEIGHT: f32 = 84.0;

pub fn terminal_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "Lines as the controller takes them, and its characters ' ? \\ % # ! alone. What may move the motor is refused here.";
    title_ui(ui, "Terminal", note);
    let status = model.front.link.status.as_ref().map(status_in).unwrap_or_default();
    let is_hexadecimal = status.operation & operation::HEXADECIMAL != 0;
    let radix = if is_hexadecimal { Radix::Hexadecimal } else { Radix::Decimal };
    let terminal = &mut model.front.suprmotr_mut().terminal;
    let height = (ui.available_height() - ENTRY_HEIGHT).max(80.0);
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        list_ui(ui, terminal);
    });
    ui.separator();
    let entered = field_ui(ui, terminal);
    ui.horizontal(|ui| {
        let meaning = terminal.meaning(radix);
        let clicked = ui.add_enabled(meaning.is_ok(), Button::new("Send line")).clicked();
        let ends_macro = holds_lines(status) && terminal.is_line();
        if clicked || entered {
            commands.extend(terminal.send(radix));
        }
        let text = match meaning {
            Ok(_) if ends_macro => RichText::new("A macro or a wait is in process: any line ends it.")
                .color(Palette::of(ui).warning),
            Ok(meaning) => RichText::new(meaning),
            Err(why) => RichText::new(why).weak(),
        };
        ui.add(Label::new(text).truncate());
    });
}

fn list_ui(ui: &mut Ui, terminal: &Terminal) {
    if terminal.entries.is_empty() {
        let hint = "Nothing was sent yet. % tells the status, TM lists the macros, TG the gains; CN 3 switches output 3 on.";
        ui.add(Label::new(RichText::new(hint).weak()).wrap());
    }
    ScrollArea::vertical().id_salt("terminal").auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
        terminal.entries.iter().for_each(|entry| entry_ui(ui, entry));
    });
}

fn entry_ui(ui: &mut Ui, entry: &Entry) {
    let palette = Palette::of(ui);
    ui.add(Label::new(RichText::new(format!("> {}", entry.sent)).monospace()).wrap());
    ui.indent(&entry.sent, |ui| ui.add(Label::new(RichText::new(&entry.meaning).weak()).wrap()));
    let answer = match &entry.answer {
        None => RichText::new("waiting for the answer …"),
        Some(Ok((received, words))) => {
            if !received.is_empty() {
                ui.add(Label::new(RichText::new(format!("< {received}")).monospace()).wrap());
            }
            RichText::new(words)
        }
        Some(Err(why)) => RichText::new(why).color(palette.error),
    };
    ui.indent((&entry.sent, "answer"), |ui| ui.add(Label::new(answer).wrap()));
}

/// The field; true when Enter was pressed in it.
fn field_ui(ui: &mut Ui, terminal: &mut Terminal) -> bool {
    ui.horizontal(|ui| {
        let room = vec2(ui.available_width() - 60.0, ui.spacing().interact_size.y);
        let field =
            ui.allocate_ui(room, |ui| text_field_ui(ui, &mut terminal.typed, "Line", "TP, or %")).inner;
        if ui.button("Clear").on_hover_text("Empties the list").clicked() {
            terminal.entries.clear();
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

//! The terminal: lines and triplets, in words both ways.

use egui::{Button, Key, Label, RichText, ScrollArea, Ui, vec2};

use crate::command::Commands;
use crate::model::Model;
use crate::motorvator::model::terminal::{Entry, Terminal};
use crate::screens::{not_connected_text, nothing_ui, title_ui};
use crate::theme::Palette;
use crate::widgets::text_field_ui;

/// Room below the list: the field and what it means.
const ENTRY_HEIGHT: f32 = 84.0;

pub fn terminal_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "Lines for the board's command line and data for its program, which travel as triplets. What may move a motor is refused here; G asks first.";
    title_ui(ui, "Terminal", note);
    let terminal = &mut model.front.motorvator_mut().terminal;
    let height = (ui.available_height() - ENTRY_HEIGHT).max(80.0);
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        list_ui(ui, terminal);
    });
    ui.separator();
    let entered = field_ui(ui, terminal);
    if terminal.is_start() {
        return start_ui(ui, terminal, commands);
    }
    ui.horizontal(|ui| {
        let meaning = terminal.meaning();
        let clicked = ui.add_enabled(meaning.is_ok(), Button::new("Send line")).clicked();
        if clicked || entered {
            commands.extend(terminal.send());
        }
        match meaning {
            Ok(meaning) => ui.add(Label::new(meaning).truncate()),
            Err(why) => ui.add(Label::new(RichText::new(why).weak()).truncate()),
        };
    });
}

/// G begins a program of which nobody here knows what it does: no key alone starts it.
fn start_ui(ui: &mut Ui, terminal: &mut Terminal, commands: &mut Commands) {
    ui.horizontal(|ui| {
        if ui.add_enabled(terminal.accepts_risk, Button::new("Start the program")).clicked() {
            commands.extend(terminal.start());
        }
        ui.checkbox(&mut terminal.accepts_risk, "I have the switch of the motors' power at hand");
    });
    let risk = "It may move motors at once, and unless it is the host library nothing on this line stops it.";
    ui.add(Label::new(RichText::new(risk).weak()).truncate());
}

fn list_ui(ui: &mut Ui, terminal: &Terminal) {
    if terminal.entries.is_empty() {
        let hint = "Nothing was sent yet. H shows the version; 80 1 pings the host library, as I080001 does.";
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
        let hint = "I001002003, or 1 2 3";
        let field = ui.allocate_ui(room, |ui| text_field_ui(ui, &mut terminal.typed, "Line", hint)).inner;
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

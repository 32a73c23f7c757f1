//! The terminal: lines of commands and commands of one character, in words both ways.

use brushwork_suprmotr_wire::{Radix, operation};
use egui::{Button, Label, RichText, Ui};

use crate::command::Commands;
use crate::model::Model;
use crate::screens::raw_lines::raw_lines_ui;
use crate::screens::{not_connected_text, nothing_ui, title_ui};
use crate::suprmotr::model::channels::{holds_lines, status_in};
use crate::theme::Palette;

/// What stands where nothing was sent yet.
const BEGINNING: &str =
    "Nothing was sent yet. % tells the status, TM lists the macros, TG the gains; CN 3 switches output 3 on.";

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
    let entered = raw_lines_ui(ui, &mut terminal.0, BEGINNING, "TP, or %");
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

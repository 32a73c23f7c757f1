//! The terminal: lines and triplets, in words both ways.

use egui::{Button, Label, RichText, Ui};

use crate::command::Commands;
use crate::model::Model;
use crate::motorvator::model::terminal::Terminal;
use crate::screens::raw_lines::raw_lines_ui;
use crate::screens::{not_connected_text, nothing_ui, title_ui};

/// What stands where nothing was sent yet.
const BEGINNING: &str =
    "Nothing was sent yet. H shows the version; 80 1 pings the host library, as I080001 does.";

pub fn terminal_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "Lines for the board's command line and data for its program, which travel as triplets. What may move a motor is refused here; G asks first.";
    title_ui(ui, "Terminal", note);
    let terminal = &mut model.front.motorvator_mut().terminal;
    let entered = raw_lines_ui(ui, &mut terminal.lines, BEGINNING, "I001002003, or 1 2 3");
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

//! The terminal on the screen: what the script sent, and the line that is typed to it.

use egui::{ComboBox, Label, RichText, ScrollArea, TextEdit, Ui};

use super::action::DebugAction;
use super::needs::why_not;
use super::terminal::{LineEnd, Terminal};
use crate::command::{Command, Commands};
use crate::debugger::messages::DebuggerMessage;
use crate::model::Model;
use crate::theme::Palette;
use crate::widgets::{choice_ui, keep_space};

/// Streams of GETS and PUTS.
const STREAMS: u32 = 5;

/// Draws the terminal.
pub fn terminal_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let why = why_not(model);
    let waiting = model.front.debug.view.as_ref().map_or(0, |view| view.typed_waiting);
    let terminal = &mut model.front.debug.terminal;
    if let Some(why) = &why
        && terminal.streams().is_empty()
    {
        ui.add_space(6.0);
        ui.add(Label::new(why.as_ref()).wrap());
        return;
    }
    ui.add_space(4.0);
    head_ui(ui, terminal);
    let height = (ui.available_height() - 52.0).max(24.0);
    let scroll = ScrollArea::vertical().id_salt("script terminal").auto_shrink(false).stick_to_bottom(true);
    scroll.max_height(height).show(ui, |ui| {
        let text = terminal.text();
        let shown = if text.is_empty() { "Nothing was sent yet." } else { text };
        let response = ui.add(Label::new(RichText::new(shown).monospace()).wrap().selectable(true));
        let received = text.to_owned();
        response.widget_info(|| {
            egui::WidgetInfo::labeled(
                egui::Role::Label,
                true,
                DebuggerMessage::Output { received: received.clone() }.to_string(),
            )
        });
    });
    ui.add_enabled_ui(why.is_none(), |ui| input_ui(ui, terminal, waiting, commands));
}

fn head_ui(ui: &mut Ui, terminal: &mut Terminal) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Shows");
        let name = |stream: Option<u32>| {
            stream.map_or("all streams".to_owned(), |stream| DebuggerMessage::Stream { stream }.to_string())
        };
        let streams: Vec<Option<u32>> = std::iter::once(None).chain((0..STREAMS).map(Some)).collect();
        let list = ComboBox::from_id_salt("terminal stream");
        choice_ui(ui, list, "Shows", &mut terminal.stream, streams, name);
        ui.checkbox(&mut terminal.hex, "Output in hex");
        if ui.button("Clear terminal").clicked() {
            terminal.clear();
        }
    });
}

fn input_ui(ui: &mut Ui, terminal: &mut Terminal, waiting: usize, commands: &mut Commands) {
    ui.horizontal(|ui| {
        ui.label("To stream");
        let list = ComboBox::from_id_salt("terminal to").width(40.0);
        choice_ui(ui, list, "To stream", &mut terminal.to_stream, 0..STREAMS, |stream| stream.to_string());
        let list = ComboBox::from_id_salt("line end").width(84.0);
        choice_ui(ui, list, "Line end", &mut terminal.line_end, LineEnd::ALL, LineEnd::name);
        ui.checkbox(&mut terminal.hex_input, "Hex");
        let width = (ui.available_width() - 60.0).max(60.0);
        let hint = if terminal.hex_input { "48 65 6c 6c 6f" } else { "for GETS" };
        let field = ui.add(TextEdit::singleline(&mut terminal.input).desired_width(width).hint_text(hint));
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Input for the script"));
        if field.has_focus() {
            keep_space(ui, field.id);
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if ui.button("Send").clicked() || entered {
            commands.push(Command::Debug(DebugAction::Send));
        }
        if entered {
            field.request_focus();
        }
    });
    let palette = Palette::of(ui);
    match (&terminal.refused, waiting) {
        (Some(why), _) => drop(ui.label(RichText::new(why.to_string()).color(palette.error))),
        (None, 0) => {}
        (None, 1) => drop(ui.weak("1 byte waits for GETS.")),
        (None, waiting) => drop(ui.weak(DebuggerMessage::BytesWait { waiting }.to_string())),
    }
}

//! The terminal: commands in text or hex, decoded as they are typed.

use brushwork_motion_mind_client::MotionMindFacts;
use brushwork_motion_mind_wire::Protocol;
use egui::{ComboBox, Key, Label, RichText, ScrollArea, Ui, vec2};

use crate::command::{Command, Commands};
use crate::messages::PacketMessage;
use crate::model::Model;
use crate::motion_mind::model::terminal::{Entry, Form, Terminal, Understood};
use crate::screens::title_ui;
use crate::theme::Palette;
use crate::widgets::{choice_ui, text_field_ui};

/// Room below the list: the field and what it means.
const ENTRY_HEIGHT: f32 = 118.0;

pub fn terminal_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let unit = model
        .front
        .link
        .identity()
        .and_then(|identity| Some((identity.address, MotionMindFacts::of(identity)?)));
    let Some((address, facts)) = unit else { return };
    let note = match facts.protocol {
        Protocol::Binary => {
            "Commands by hand, in text or in hex. This unit speaks binary. The traffic panel shows every byte."
        }
        Protocol::Text => {
            "Commands by hand, in text or in hex. This unit speaks text. The traffic panel shows every byte."
        }
    };
    title_ui(ui, "Terminal", note);
    let terminal = &mut model.front.mind_mut().terminal;
    let height = (ui.available_height() - ENTRY_HEIGHT).max(80.0);
    ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
        ui.set_min_height(height);
        list_ui(ui, terminal);
    });
    ui.separator();
    let entered = field_ui(ui, terminal);
    match terminal.understood() {
        Ok(understood) => {
            understood_ui(ui, terminal, &understood, (address, facts), entered, commands);
        }
        Err(why) => {
            ui.add(Label::new(RichText::new(why.to_string()).weak()).wrap());
            as_typed_ui(ui, terminal, facts, commands);
        }
    }
}

fn list_ui(ui: &mut Ui, terminal: &Terminal) {
    let _palette = Palette::of(ui);
    if terminal.entries.is_empty() {
        let hint = "Nothing was sent yet. R01 04 reads PTERM of unit 1, W01 04 6000 writes it to RAM, S01 04 6000 stores it, \
                    R01 99 reads all registers. In hex the same are 1D 01 04 22 and 18 01 04 70 17 A4.";
        ui.add(Label::new(RichText::new(hint).weak()).wrap());
    }
    ScrollArea::vertical().id_salt("terminal").auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
        terminal.entries.iter().for_each(|entry| entry_ui(ui, entry));
    });
}

fn entry_ui(ui: &mut Ui, entry: &Entry) {
    let palette = Palette::of(ui);
    ui.add(Label::new(RichText::new(format!("> {}", entry.sent)).monospace()).wrap());
    ui.indent(&entry.sent, |ui| {
        ui.add(Label::new(RichText::new(&entry.meaning).weak()).wrap());
    });
    if let Some(received) = &entry.received {
        ui.add(Label::new(RichText::new(format!("< {received}")).monospace()).wrap());
    }
    ui.indent((&entry.sent, "answer"), |ui| match &entry.answer {
        None => ui.label("waiting for the answer …"),
        Some(Ok(answer)) => {
            ui.add(Label::new(PacketMessage::Answer { answer: answer.to_string() }.to_string()).wrap())
        }
        Some(Err(why)) => ui.add(Label::new(RichText::new(why).color(palette.error)).wrap()),
    });
}

/// The field; true when Enter was pressed in it.
fn field_ui(ui: &mut Ui, terminal: &mut Terminal) -> bool {
    ui.horizontal(|ui| {
        let text = |form: Form| if form == Form::Text { "Text" } else { "Hex" };
        let list = ComboBox::from_id_salt("form").width(64.0);
        choice_ui(ui, list, "Form of the command", &mut terminal.form, [Form::Text, Form::Hex], text);
        let hint = if terminal.form == Form::Text { "R01 04" } else { "1D 01 04 22" };
        let room = vec2(ui.available_width() - 90.0, ui.spacing().interact_size.y);
        let field =
            ui.allocate_ui(room, |ui| text_field_ui(ui, &mut terminal.typed, "Command line", hint)).inner;
        if field.has_focus() {
            let (up, down) =
                ui.input(|input| (input.key_pressed(Key::ArrowUp), input.key_pressed(Key::ArrowDown)));
            if up || down {
                terminal.recall(up);
            }
        }
        if ui.button("Clear").on_hover_text("Empties the list").clicked() {
            terminal.clear();
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

/// What is no command can be sent as it is, in the unit's own protocol, to see what comes back.
fn as_typed_ui(ui: &mut Ui, terminal: &mut Terminal, facts: MotionMindFacts, commands: &mut Commands) {
    let can = terminal.as_typed(facts);
    if terminal.typed.trim().is_empty() {
        return;
    }
    ui.horizontal(|ui| {
        let send = ui.add_enabled(can.is_ok(), egui::Button::new("Send as typed"));
        if send.on_hover_text("Byte for byte, though it is no command; a real unit gets only lines").clicked()
        {
            commands.extend(terminal.send_as_typed(facts).map(Command::from));
        }
        if let Err(why) = can {
            ui.add(Label::new(RichText::new(why).weak()).truncate());
        }
    });
}

/// What will be sent, and the button that sends it.
fn understood_ui(
    ui: &mut Ui,
    terminal: &mut Terminal,
    understood: &Understood,
    (address, facts): (u8, MotionMindFacts),
    entered: bool,
    commands: &mut Commands,
) {
    let palette = Palette::of(ui);
    let forms =
        [understood.line(), understood.bytes()].into_iter().flatten().collect::<Vec<_>>().join("  |  ");
    ui.add(
        Label::new(PacketMessage::Means { meaning: understood.meaning().to_string() }.to_string()).truncate(),
    );
    ui.add(Label::new(RichText::new(forms).monospace().weak()).truncate());
    let refusal = understood.refusal(address);
    ui.horizontal(|ui| {
        let send = ui.add_enabled(refusal.is_none(), egui::Button::new("Send command")).clicked();
        if (send || entered)
            && let Some(sending) = terminal.send(address, facts)
        {
            commands.push(sending.into());
        }
        if let Some(why) = &refusal {
            ui.add(
                Label::new(
                    RichText::new(PacketMessage::NotSent { why: why.to_string() }.to_string())
                        .color(palette.error),
                )
                .truncate(),
            );
        } else if let Some(care) = understood.care() {
            ui.add(Label::new(RichText::new(care).color(palette.warning)).truncate());
        }
    });
}

//! One raw command of the table: its arguments, the bytes it will send, and what came back.

use brushwork_link::exchange::Permit;
use brushwork_mcp_client::{packet_address, packet_generation};
use brushwork_mcp_wire::packet_serial::{Address, Effect, Generation};
use brushwork_values::{Field, hex};
use egui::{Grid, Label, RichText, ScrollArea, TextEdit, Ui, vec2};

use crate::command::{Command, Commands};
use crate::mcp::messages::McpScreenMessage;
use crate::mcp::model::composer::{Composer, Prepared};
use crate::messages::{NameMessage, PacketMessage};
use crate::model::{Arming, Connection, Model};
use crate::theme::Palette;
use crate::widgets::text_field_ui;

const LIST_WIDTH: f32 = 250.0;

/// Nothing without a unit.
pub fn composer_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> Option<()> {
    let (address, generation) = unit(&model.front)?;
    let permit = permit(&model.front);
    let composer = &mut model.front.mcp_mut().composer;
    let height = ui.available_height();
    ui.horizontal_top(|ui| {
        ui.allocate_ui(vec2(LIST_WIDTH, height), |ui| {
            ui.vertical(|ui| choice_ui(ui, composer, generation));
        });
        ui.separator();
        ui.vertical(|ui| {
            ScrollArea::vertical().id_salt("composed").show(ui, |ui| {
                arguments_ui(ui, composer, generation);
                match composer.prepare(address, generation, permit) {
                    Ok(prepared) => send_ui(ui, composer, generation, prepared, commands),
                    Err(why) => {
                        ui.weak(why.to_string());
                    }
                }
                answer_ui(ui, composer);
            });
        });
    });
    Some(())
}

fn unit(connection: &Connection) -> Option<(Address, Generation)> {
    let identity = connection.link.identity()?;
    Some((packet_address(identity.unit_address())?, packet_generation(identity.generation)?))
}

/// What may go out: as the device thread will judge too.
fn permit(connection: &Connection) -> Permit {
    let (motion, script) = match connection.link.arming {
        Arming::Armed { scope, .. } => (scope.allows_motion(), scope.allows_scripts()),
        Arming::Disarmed | Arming::Asked(_) => (false, false),
    };
    let guesses = connection.link.identity().is_some_and(|identity| identity.simulated);
    Permit { motion, script, guesses, ..Permit::default() }
}

fn choice_ui(ui: &mut Ui, composer: &mut Composer, generation: Generation) {
    ui.scope(|ui| {
        ui.set_max_width(LIST_WIDTH - 8.0);
        text_field_ui(ui, &mut composer.search, "Find a command", "Number or name");
    });
    let found: Vec<_> = composer.found(generation).collect();
    if found.is_empty() {
        ui.weak("No command of this generation is called so.");
    }
    let chosen = composer.command().map(|row| row.number);
    let row_height = ui.spacing().interact_size.y;
    ScrollArea::vertical().id_salt("commands").auto_shrink([false, false]).show_rows(
        ui,
        row_height,
        found.len(),
        |ui, rows| {
            for row in &found[rows] {
                let title = format!("{} {}", row.number, row.title(generation));
                if ui.selectable_label(chosen == Some(row.number), title).clicked() {
                    composer.choose(row.number, generation);
                }
            }
        },
    );
}

fn arguments_ui(ui: &mut Ui, composer: &mut Composer, generation: Generation) {
    let fields = composer.fields(generation);
    if composer.command().is_some() && fields.is_empty() {
        ui.weak("No arguments.");
    }
    composer.arguments.resize(fields.len(), String::new());
    Grid::new("arguments").num_columns(3).spacing([10.0, 3.0]).show(ui, |ui| {
        for (field, text) in fields.into_iter().zip(&mut composer.arguments) {
            ui.label(field.name);
            let response = ui.add(TextEdit::singleline(text).desired_width(110.0));
            let name = McpScreenMessage::Argument { name: field.name }.to_string();
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
            ui.add(Label::new(RichText::new(explained(field)).small()).truncate()).on_hover_text(field.doc);
            ui.end_row();
        }
    });
}

/// The range of the raw number, and what one step of it is.
fn explained(field: &Field) -> String {
    let range = field.raw_range.or(field.kind.limits());
    let range = range.map_or(String::new(), |(least, most)| {
        NameMessage::To { from: least.to_string(), to: most.to_string() }.to_string()
    });
    let symbol = field.unit.symbol();
    let step = if symbol.is_empty() {
        String::new()
    } else {
        McpScreenMessage::OneIs { scale: field.scale, symbol }.to_string()
    };
    format!("{range}{step}")
}

fn send_ui(
    ui: &mut Ui,
    composer: &mut Composer,
    generation: Generation,
    prepared: Prepared,
    commands: &mut Commands,
) {
    let bytes = hex(&prepared.bytes);
    ui.add(Label::new(PacketMessage::WillSend { text: prepared.text.clone() }.to_string()).wrap());
    ui.add(Label::new(RichText::new(PacketMessage::Bytes { bytes }.to_string()).monospace()).wrap());
    if let Some(why) = &prepared.refusal {
        ui.label(
            RichText::new(PacketMessage::NotSent { why: why.to_string() }.to_string())
                .color(Palette::of(ui).error),
        );
    } else if let Some(care) = care(prepared.effect) {
        ui.label(RichText::new(care).color(Palette::of(ui).warning));
    }
    let can = prepared.refusal.is_none() && !composer.is_waiting();
    if ui.add_enabled(can, egui::Button::new("Send these bytes")).clicked() {
        let id = composer.send(prepared.request.clone(), generation);
        let request = prepared.request;
        commands.push(Command::Transact { id, command: request.command, values: request.values });
    }
}

const fn care(effect: Effect) -> Option<&'static str> {
    match effect {
        Effect::Motion | Effect::RelativeMotion | Effect::Buffered | Effect::Script => {
            Some("This moves motors. Esc stops.")
        }
        Effect::Memory => Some("This changes what the controller keeps without power."),
        Effect::Setting => Some("This changes a setting in the controller's RAM."),
        Effect::Loader => Some("This ends normal operation: the controller waits for new firmware."),
        Effect::Query | Effect::Encoder | Effect::Stop | Effect::Bus => None,
    }
}

fn answer_ui(ui: &mut Ui, composer: &Composer) {
    match &composer.answer {
        Some(Ok(answer)) => {
            ui.add(Label::new(PacketMessage::Answer { answer: answer.to_string() }.to_string()).wrap());
        }
        Some(Err(failure)) => {
            ui.add(Label::new(RichText::new(failure).color(Palette::of(ui).error)).wrap());
        }
        None if composer.is_waiting() => {
            ui.label("Waiting for the answer …");
        }
        None => {}
    }
}

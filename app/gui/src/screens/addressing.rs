//! The assistant that gives boards their addresses: which has its own, which is next, and what to do now.

use brushwork_core::addresses::name;
use brushwork_core::words::capital;
use brushwork_link::Message;
use egui::{Button, Context, Grid, Rect, Ui, vec2};

use super::dialog::{dialog_ui, said_ui, weak_ui};
use crate::command::{Command, Commands};
use crate::messages::AddressingMessage;
use crate::model::addressing::{AddressingAction, Step};
use crate::model::{IndicatorState, Model};
use crate::widgets::{heading_ui, text_field_ui};

const FIELD_WIDTH: f32 = 260.0;
const STEP_SIZE: egui::Vec2 = vec2(140.0, 30.0);

/// Draws the window, if it is open, within `room`.
pub fn addressing_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if model.addressing.open {
        let size = vec2(560.0, 460.0);
        let title =
            ("Give boards their addresses", model.front.is_assisted || model.front.errand.is_running());
        model.addressing.open = dialog_ui(ctx, title, (room, size), |ui| {
            contents_ui(ui, model, commands);
        });
    }
}

fn contents_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    weak_ui(
        ui,
        "For boards that are to share a line. New boards all have the factory's address, so each is plugged in by itself and given its own; \
         the factory's address is given last.",
    );
    ui.add_space(6.0);
    let progress = model
        .addressing
        .connection()
        .and_then(|id| model.connection(id))
        .and_then(|connection| connection.errand.progress())
        .map(|(_, text)| capital(text));
    let addressing = &mut model.addressing;
    ui.horizontal(|ui| {
        ui.label("Addresses");
        ui.add_enabled_ui(!addressing.is_running(), |ui| {
            ui.set_max_width(FIELD_WIDTH);
            text_field_ui(ui, &mut addressing.typed, "Addresses to give", "0x80-0x84, or 0x81,0x83");
        });
        if !addressing.is_running() && ui.button("Begin").clicked() {
            commands.push(Command::Addressing(AddressingAction::Begin));
        }
    });
    places_ui(ui, model);
    ui.add_space(6.0);
    match model.addressing.step() {
        Some(Step::PlugIn(number)) => {
            weak_ui(ui, &Message::from(AddressingMessage::PlugIn { address: name(number) }).to_string());
            step_ui(ui, "Find the board", AddressingAction::Find, commands);
        }
        Some(Step::Choose(addresses)) => {
            step_ui(ui, "Find the board", AddressingAction::Find, commands);
            ui.horizontal_wrapped(|ui| {
                for address in addresses {
                    let text =
                        Message::from(AddressingMessage::TheOne { address: name(address) }).to_string();
                    if ui.button(text).clicked() {
                        commands.push(Command::Addressing(AddressingAction::Choose(address)));
                    }
                }
            });
        }
        Some(Step::Give { unit, number, stays }) => {
            let address = name(number);
            let place = address.clone();
            let will = match stays {
                true => AddressingMessage::WillStay { unit, address: place },
                false => AddressingMessage::WillGive { unit, address: place },
            };
            ui.add(egui::Label::new(Message::from(will).to_string()).wrap());
            let text = Message::from(AddressingMessage::Give { address }).to_string();
            step_ui(ui, &text, AddressingAction::Give, commands);
        }
        Some(Step::Works(what)) => {
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(what.to_string());
                end_ui(ui, commands);
            });
            if let Some(text) = progress {
                ui.weak(text);
            }
        }
        None => {}
    }
    said_ui(ui, model.addressing.said.as_ref());
}

/// The button of a step. It takes the keyboard that nothing else has, so that Enter goes from step to step.
fn step_ui(ui: &mut Ui, text: &str, action: AddressingAction, commands: &mut Commands) {
    ui.horizontal(|ui| {
        let button = ui.add(Button::new(text).min_size(STEP_SIZE));
        if ui.memory(|memory| memory.focused().is_none()) {
            button.request_focus();
        }
        if button.clicked() {
            commands.push(Command::Addressing(action));
        }
        end_ui(ui, commands);
    });
}

fn end_ui(ui: &mut Ui, commands: &mut Commands) {
    let end = ui.add(Button::new("End").min_size(vec2(70.0, STEP_SIZE.y)));
    if end.on_hover_text("What was given stays given").clicked() {
        commands.push(Command::Addressing(AddressingAction::End));
    }
}

fn places_ui(ui: &mut Ui, model: &Model) {
    let addressing = &model.addressing;
    if addressing.places().is_empty() {
        return;
    }
    ui.add_space(6.0);
    heading_ui(ui, "Boards");
    let next = addressing.next_number();
    Grid::new("addresses").num_columns(3).spacing([14.0, 3.0]).show(ui, |ui| {
        for place in addressing.places() {
            let (state, text) = match &place.has {
                Some(unit) => (IndicatorState::Ok, unit.clone()),
                None if next == Some(place.number) => (IndicatorState::Active, "next".to_owned()),
                None => (IndicatorState::Unknown, "waits".to_owned()),
            };
            state.ui(ui, vec2(14.0, 14.0), 4.0);
            ui.monospace(name(place.number));
            ui.label(text);
            ui.end_row();
        }
    });
}

//! The window for connecting to a CANopen bus (MCP manual 1.2.8, "Connect CANOpen Bus"), and who is on the bus in front.

use std::time::Duration;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use brushwork_core::session::bus::BusList;
use egui::{Button, ComboBox, Context, DragValue, Grid, Rect, RichText, Ui, Window, vec2};

use crate::command::{Command, Commands};
use crate::keys::escape_closes;
use crate::messages::ButtonMessage;
use crate::model::Model;
use crate::model::canopen::ADAPTER_BAUD_RATES;
use crate::widgets::{choice_ui, heading_ui};

/// Emergencies that are listed.
const EMERGENCIES: usize = 8;
/// How often the ages of heartbeats are drawn anew.
const AGE_INTERVAL: Duration = Duration::from_millis(200);
const SIMULATED: &str = "Simulated bus, in this program";

/// Draws the window, if it is open, within `room`.
pub fn canopen_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if !model.canopen.open {
        return;
    }
    let mut open = true;
    let size = vec2(440.0, 250.0).min(room.size() - vec2(24.0, 60.0));
    let shown = Window::new("CANopen bus")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .default_pos(room.center() - size / 2.0)
        .default_width(size.x)
        .constrain_to(room)
        .show(ctx, |ui| contents_ui(ui, model, commands));
    if !open || escape_closes(ctx, shown.as_ref()) {
        model.canopen.open = false;
    }
}

fn contents_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    weak_ui(ui, "Controllers on a CANopen bus are reached through a GridConnect adapter on a serial port.");
    Grid::new("canopen").num_columns(2).spacing(vec2(12.0, 6.0)).show(ui, |ui| {
        ui.label("Adapter");
        adapter_ui(ui, model);
        ui.end_row();
        let choice = &mut model.canopen;
        ui.label("Its form");
        ui.horizontal(|ui| {
            ui.radio_value(&mut choice.form, Form::Ascii, "ASCII").on_hover_text(":S601N40;");
            ui.radio_value(&mut choice.form, Form::Binary, "Binary")
                .on_hover_text("FF 00, flags, identifier, data");
        });
        ui.end_row();
        if choice.port.is_some() {
            ui.label("Its baud rate");
            let list = ComboBox::from_id_salt("adapter baud");
            choice_ui(ui, list, "Adapter baud rate", &mut choice.baud, ADAPTER_BAUD_RATES, |baud| {
                baud.to_string()
            });
            ui.end_row();
        }
        ui.label("Nodes");
        ui.horizontal(|ui| {
            let mut all = choice.node.is_none();
            if ui.checkbox(&mut all, "All that answer").changed() {
                choice.node = if all { None } else { Some(NodeId::DEFAULT.get()) };
            }
            if let Some(node) = &mut choice.node {
                let response = ui.add(DragValue::new(node).range(1..=NodeId::MAX).prefix("node "));
                ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Node id"));
            }
        });
        ui.end_row();
    });
    weak_ui(
        ui,
        "The bus rate is set at the adapter: 250 kbit/s unless the controller was set to another one. Settings and readings work as over \
         USB. Motors of a real controller are not armed here: over CANopen it has no time-out that would stop them.",
    );
    if ui.button("Connect to the bus").clicked() {
        model.canopen.open = false;
        commands.push(Command::ConnectTo(model.canopen.target()));
    }
    if let Some(bus) = &model.front.bus {
        ui.separator();
        bus_ui(ui, bus, model.front.phase.is_open(), model.canopen.starting.is_some(), commands);
    }
}

/// Who is on the bus in front, what each says of itself, and which emergencies were heard.
fn bus_ui(ui: &mut Ui, bus: &Monitor, is_open: bool, is_starting: bool, commands: &mut Commands) {
    let list = BusList::of(bus);
    heading_ui(ui, "Nodes on the bus");
    if !is_open {
        weak_ui(ui, "As they were when the link was open.");
    }
    Grid::new("nodes of the bus").num_columns(5).striped(true).spacing(vec2(12.0, 4.0)).show(ui, |ui| {
        for head in ["Node", "State", "Heartbeat", "Who"] {
            ui.strong(head);
        }
        ui.end_row();
        for view in &list.nodes {
            ui.label(view.node.get().to_string());
            ui.label(view.state_text());
            ui.label(view.heartbeat_text());
            ui.label(view.who_text());
            if view.can_be_started() {
                let title = ButtonMessage::Start { what: view.node.to_string() }.to_string();
                let help = "Sends the NMT command \"start\" to this node alone.";
                if ui.add_enabled(!is_starting, Button::new(title)).on_hover_text(help).clicked() {
                    commands.push(Command::StartNode(view.node));
                }
            }
            ui.end_row();
        }
    });
    if !list.emergencies.is_empty() {
        heading_ui(ui, "Emergencies, oldest first");
        for sentence in list.emergencies.iter().rev().take(EMERGENCIES).rev() {
            ui.label(sentence);
        }
    }
    // Ages go on without anything that happens.
    ui.ctx().request_repaint_after(AGE_INTERVAL);
}

fn adapter_ui(ui: &mut Ui, model: &mut Model) {
    let ports: Vec<_> = model.devices.ports.iter().map(|port| port.name.clone()).collect();
    let chosen = &mut model.canopen.port;
    let text = chosen.clone().unwrap_or_else(|| SIMULATED.to_owned());
    let response = ComboBox::from_id_salt("can adapter").width(240.0).selected_text(text).show_ui(ui, |ui| {
        ui.selectable_value(chosen, None, SIMULATED);
        for port in ports {
            ui.selectable_value(chosen, Some(port.clone()), port);
        }
    });
    ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("CAN adapter"));
}

fn weak_ui(ui: &mut Ui, text: &str) {
    ui.add(egui::Label::new(RichText::new(text).weak()).wrap());
}

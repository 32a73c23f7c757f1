//! The traffic panel: every transaction as it goes over the wire, one command put together by hand, and the bytes that wait to
//! be sent. It lies below any screen, so that one can watch while driving.

use egui::{Key, Ui};

use super::command::Commands;
use super::keys::as_written;
use super::model::Model;
use super::model::traffic::Tab;
use super::screens::face;
use super::widgets::heading::heading_ui;

mod log;
mod pending;

pub fn traffic_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let tab = model.front.traffic.tab;
    ui.horizontal(|ui| {
        heading_ui(ui, "Traffic");
        let tabs = [(Tab::Log, "Log"), (Tab::Composer, "Send a command"), (Tab::Pending, "Before sending")];
        for (each, title) in tabs {
            let response = ui.selectable_label(tab == each, title);
            if response.clicked() || (response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter)))
            {
                model.front.traffic.tab = each;
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hint = as_written(ui.ctx(), "Hides the panel and ends the recording (Ctrl+T)");
            if ui.button("Close").on_hover_text(hint).clicked() {
                model.front.traffic.open = false;
            }
            if tab == Tab::Log {
                log::head_ui(ui, model, commands);
            }
        });
    });
    match tab {
        Tab::Log => log::log_ui(ui, model, commands),
        Tab::Composer => {
            if !face::of(model.front.family()).composer_ui(ui, model, commands) {
                let hint = "Not connected. A command can be put together here and sent to a controller.";
                ui.weak(hint);
            }
        }
        Tab::Pending => pending::pending_ui(ui, model),
    }
}

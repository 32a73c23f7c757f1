//! The screens, one file each.

use crate::screens::messages::ScreenMessage;
use egui::{Align, Layout, RichText, Ui};

use super::command::Commands;
use super::focus;
use super::mcl;
use super::model::screen::Screen;
use super::model::{Model, Phase};

pub mod addressing;
pub mod canopen;
pub(super) mod dialog;
mod direction;
mod drawer;
pub(super) mod drive;
pub mod examination;
pub mod face;
pub(super) mod general;
mod generator;
pub(super) mod graph_place;
mod loops;
pub mod messages;
pub mod offline;
mod position;
mod progress;
mod pwm;
mod qpps;
pub mod raw;
pub(super) mod raw_lines;
mod settings_file;
mod split;
mod start;
pub(super) mod status;
pub mod stream;
pub mod to_all;
mod velocity;

/// The screen that is open, as the family of the controller in front draws it.
pub fn screen_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if !model.is_connected() && model.screen != Screen::MclEditor {
        return offline::offline_ui(ui, model, commands);
    }
    let is_large = model.front.graph.large && !model.front.graph.detached && !drawer::is_tuning(model);
    let drives = model.screen.arm_scope().filter(|_| is_large && model.is_connected());
    if let Some(scope) = drives.filter(|scope| scope.allows_motion()) {
        return drive::large_graph_ui(ui, scope, model, commands);
    }
    if !face::of(model.front.family()).screen_ui(ui, model, commands) {
        shared_ui(ui, model, commands);
    }
}

/// The screens as a family has them that draws none of its own.
fn shared_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if !model.front.screens().contains(&model.screen) {
        return nothing_ui(ui, "This controller has no such screen. Choose another at the left.");
    }
    match model.screen {
        Screen::DeviceStatus => status::status_ui(ui, model, commands),
        Screen::GeneralSettings => general::general_ui(ui, model, commands),
        Screen::Pwm => pwm::pwm_ui(ui, model, commands),
        Screen::Velocity => velocity::velocity_ui(ui, model, commands),
        Screen::Position => position::position_ui(ui, model, commands),
        Screen::MclEditor => mcl::screen_ui(ui, model, commands),
        Screen::Motion | Screen::Inputs | Screen::Terminal => {
            nothing_ui(ui, "This controller has no such screen. Choose another at the left.");
        }
    }
}

/// What a screen shows while it has nothing to show.
pub(super) fn nothing_ui(ui: &mut Ui, hint: &str) {
    ui.with_layout(Layout::centered_and_justified(egui::Direction::LeftToRight), |ui| {
        ui.with_layout(Layout::top_down(Align::Center), |ui| {
            ui.add_space(ui.available_height() * 0.35);
            ui.label(RichText::new(hint).size(15.0).weak());
        });
    });
}

/// Why there is nothing to show before a controller has answered.
pub(super) fn not_connected_text(phase: &Phase) -> String {
    match phase {
        Phase::Closed => "Not connected.".to_owned(),
        Phase::Opening { target } => ScreenMessage::Connecting { target: target.clone() }.to_string(),
        Phase::Open { target } => ScreenMessage::Looking { target: target.clone() }.to_string(),
        Phase::Closing { target } => ScreenMessage::Disconnecting { target: target.clone() }.to_string(),
    }
}

/// The screen's title, with a line of explanation at its right.
pub(super) fn title_ui(ui: &mut Ui, title: &str, note: &str) {
    ui.horizontal(|ui| {
        focus::heading_ui(ui, title);
        // Where there is too little room it ends in an ellipsis, and the whole of it comes up under the pointer.
        ui.add(egui::Label::new(RichText::new(note).weak()).truncate());
    });
    ui.add_space(4.0);
}

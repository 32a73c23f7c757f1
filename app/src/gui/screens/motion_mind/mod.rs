//! The screens of a Motion Mind 3.

use egui::Ui;

use super::{nothing_ui, status};
use crate::gui::command::Commands;
use crate::gui::model::Model;
use crate::gui::model::screen::Screen;

pub fn screen_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    match model.screen {
        Screen::DeviceStatus => status::status_ui(ui, model, commands),
        _ => nothing_ui(ui, "This controller has no such screen. Choose another at the left."),
    }
}

//! The screens of a Motion Mind 3.

use egui::Ui;

use super::{nothing_ui, status};
use crate::command::Commands;
use crate::model::Model;
use crate::model::screen::Screen;

mod bits;
mod drive;
mod inputs;
mod registers;
pub mod steps;
mod terminal;

pub fn screen_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    match model.screen {
        Screen::DeviceStatus => status::status_ui(ui, model, commands),
        Screen::GeneralSettings => registers::registers_ui(ui, model, commands),
        Screen::Pwm => drive::duty_ui(ui, model, commands),
        Screen::Velocity => drive::velocity_ui(ui, model, commands),
        Screen::Position => drive::position_ui(ui, model, commands),
        Screen::Motion => drive::motion_ui(ui, model, commands),
        Screen::Inputs => inputs::inputs_ui(ui, model, commands),
        Screen::Terminal => terminal::terminal_ui(ui, model, commands),
        Screen::MclEditor => {
            nothing_ui(ui, "A Motion Mind 3 runs no scripts. Choose another screen at the left.");
        }
    }
}

//! The screens of a Motion Mind 3.

use egui::Ui;

use super::MotionMind;
use super::model::family::HELP;
use super::model::terminal::Sending;
use crate::actions::{Action, Keys, page};
use crate::command::{Command, Commands};
use crate::model::{Help, HelpPage, Model, Screen, Simulated};
use crate::screens::face::Face;
use crate::screens::{nothing_ui, status};

mod bits;
mod drive;
mod help;
mod inputs;
mod registers;
mod simulated;
mod steps;
mod terminal;

impl Face for MotionMind {
    fn screen_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> bool {
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
        true
    }

    fn steps_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
        steps::steps_ui(ui, model, commands);
    }

    fn help_ui(&self, ui: &mut Ui, page: HelpPage, help: &mut Help) -> bool {
        let is_own = page == HELP;
        if is_own {
            help::motion_mind_ui(ui, help);
        }
        is_own
    }

    fn simulated_ui(&self, ui: &mut Ui, simulated: &mut Simulated) {
        simulated::switches_ui(ui, simulated);
    }

    fn actions(&self) -> &'static [Action] {
        &[ACTION]
    }
}

const ACTION: Action = page!("help.motion-mind": HELP.title, Keys::None, HELP, "How to connect, drive and tune a Motion Mind 3; its commands, registers and bits.");

impl From<Sending> for Command {
    fn from(sending: Sending) -> Self {
        match sending {
            Sending::Transact { id, command, values } => Self::Transact { id, command, values },
            Sending::Raw { id, bytes } => Self::Raw { id, bytes },
        }
    }
}

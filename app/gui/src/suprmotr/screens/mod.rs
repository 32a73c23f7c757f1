//! The screens of a SuprMotr: moves to a place, by slider and by steps, inputs and outputs, macros, terminal; all else is shared.

mod channels;
mod gains;
mod home;
mod macros;
mod terminal;

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Button, Context, Ui};

use super::SuprMotr;
use crate::command::Commands;
use crate::family_action::Host;
use crate::model::{ConnectionId, Model, Screen, Tab};
use crate::screens::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui};
use crate::screens::face::Face;
use crate::screens::{not_connected_text, nothing_ui};
use crate::widgets::{Numeric, Setpoint};

impl Face for SuprMotr {
    fn screen_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> bool {
        match model.screen {
            Screen::Position => motion_ui(ui, model, commands),
            Screen::Inputs => channels::channels_ui(ui, model, commands),
            Screen::Terminal => terminal::terminal_ui(ui, model, commands),
            Screen::DeviceStatus
            | Screen::GeneralSettings
            | Screen::Pwm
            | Screen::Velocity
            | Screen::MclEditor
            | Screen::Motion => return false,
        }
        true
    }

    fn run_ui(&self, ui: &mut Ui, model: &mut Model, _commands: &mut Commands) -> bool {
        macros::run_ui(ui, model);
        true
    }

    fn tab_ui(&self, ui: &mut Ui, model: &mut Model, tab: Tab, commands: &mut Commands) {
        match tab {
            Tab::Gains => gains::gains_ui(ui, model, commands),
            Tab::Home => home::home_ui(ui, model),
            Tab::Settings
            | Tab::VelocityLoop
            | Tab::Direction
            | Tab::Generator
            | Tab::Qpps
            | Tab::Steps
            | Tab::ByHand
            | Tab::Tune => {}
        }
    }

    fn go_on(&self, host: &mut dyn Host, connection: ConnectionId, ctx: &Context) {
        macros::look_after_macros(host, connection, ctx);
        home::look_after_home(host, connection);
    }
}

const OUTPUT: Output = Output {
    scope: ArmScope::Position,
    word: "measured",
    channels: [Channel::M1_POSITION; 2],
    unit: "counts",
    digits: 9,
    unit_letters: 7,
    width: 204.0,
};

fn motion_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note = "The unit goes to a count of the encoder by a trajectory of its own, and holds it.";
    drive_ui(ui, model, ("Motion", note, ArmScope::Position), commands, controls_ui);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    // No velocity can be commanded, so the jog buttons step.
    let held = motor_ui(ui, model, Motor::M1, &OUTPUT, |ui, model| {
        let connection = &mut model.front;
        let span = connection.suprmotr().span_counts;
        let seen = connection.seen(Motor::M1).counts;
        connection.position.setpoints.show(Motor::M1, seen);
        let slider =
            Setpoint { name: "Motor position", unit: "", range: -span..=span, decimals: 0, step: 1.0 };
        let shown = connection.position.setpoints.values[0].clamp(-span, span);
        let mut counts = shown;
        let moved = slider.ui(ui, &mut counts);
        if ui.is_enabled() {
            connection.position.setpoints.hold(Motor::M1, moved.held);
            if counts != shown {
                connection.move_suprmotr(counts);
            }
        }
    });
    let step = model.front.suprmotr().step_counts;
    if let Some(Some(direction)) = model.front.position.setpoints.jog(Motor::M1, held) {
        model.front.step_suprmotr(direction.sign() * step);
    }
    options_ui(ui, |ui| {
        on_release_ui(ui, &mut model.front.position.setpoints);
        ui.separator();
        let own = model.front.suprmotr_mut();
        let size = number("Step size", 1.0..=10_000_000.0, 10.0);
        pace_ui(ui, "Step", "What a step moves", &size, &mut own.step_counts);
        steps_ui(ui, model);
        ui.separator();
        let span = number("Slider span", 10.0..=1_000_000_000.0, 100.0);
        let own = model.front.suprmotr_mut();
        pace_ui(ui, "Slider ±", "How far the slider goes either way", &span, &mut own.span_counts);
        ui.weak("Speed and acceleration are settings (DV, DA).");
    });
}

/// The two buttons that move by one step.
fn steps_ui(ui: &mut Ui, model: &mut Model) {
    let armed = model.front.link.arming.is_armed_for(ArmScope::Position);
    let step = model.front.suprmotr().step_counts;
    for (text, name, sign) in [("− Step", "Step backward", -1.0), ("Step +", "Step forward", 1.0)] {
        let response = ui.add_enabled(armed, Button::new(text));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, armed, name));
        if response.clicked() {
            model.front.step_suprmotr(sign * step);
        }
    }
}

fn number<'a>(name: &'a str, range: std::ops::RangeInclusive<f64>, step: f64) -> Numeric<'a> {
    Numeric { name, unit: "counts", range, decimals: 0, step, width: 108.0 }
}

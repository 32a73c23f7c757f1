//! The screens of a MotorVator: two motors by duty and the servos, the stepper, inputs, and what the board shows; all else is shared.

mod display;
mod inputs;
mod servos;
mod stepper;
mod terminal;

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Context, Ui};

use super::Motorvator;
use crate::command::Commands;
use crate::family_action::Host;
use crate::model::{Connection, ConnectionId, Model, Screen};
use crate::screens::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui, sync_ui};
use crate::screens::face::Face;
use crate::screens::{not_connected_text, nothing_ui};
use crate::widgets::{Numeric, Setpoint};

impl Face for Motorvator {
    fn screen_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands) -> bool {
        match model.screen {
            Screen::Pwm => motors_ui(ui, model, commands),
            Screen::Position => stepper::stepper_ui(ui, model, commands),
            Screen::Inputs => inputs::inputs_ui(ui, model, commands),
            Screen::Terminal => terminal::terminal_ui(ui, model, commands),
            Screen::DeviceStatus
            | Screen::GeneralSettings
            | Screen::Velocity
            | Screen::MclEditor
            | Screen::Motion => return false,
        }
        true
    }

    fn go_on(&self, host: &mut dyn Host, connection: ConnectionId, _ctx: &Context) {
        stepper::look_after_stepper(host, connection);
    }

    fn leds_ui(&self, ui: &mut Ui, connection: &Connection) {
        display::display_and_inputs_ui(ui, connection);
    }
}

const OUTPUT: Output = Output {
    scope: ArmScope::Pwm,
    word: "told",
    channels: [Channel::M1_PWM, Channel::M2_PWM],
    unit: "%",
    digits: 6,
    unit_letters: 1,
    width: 112.0,
};

fn motors_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    let note =
        "Open loop, in whole percent: the board measures nothing, so that the graph shows what it was told.";
    let mut asked = Vec::new();
    drive_ui(ui, model, ("Motors", note, ArmScope::Pwm), commands, |ui, model| {
        controls_ui(ui, model);
        asked.extend(servos::servos_ui(ui, model));
    });
    commands.extend(asked);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in Motor::BOTH {
        let held = motor_ui(ui, model, motor, &OUTPUT, |ui, model| duty_ui(ui, model, motor));
        model.front.pwm.jog(motor, held);
    }
    let motors = model.front.motors();
    options_ui(ui, |ui| {
        let pwm = &mut model.front.pwm;
        sync_ui(ui, motors, &mut pwm.setpoints);
        on_release_ui(ui, &mut pwm.setpoints);
        ui.separator();
        let jog =
            Numeric { name: "Jog duty", unit: "%", range: 0.0..=100.0, decimals: 0, step: 1.0, width: 92.0 };
        pace_ui(ui, "Jog", "The duty while a jog button is held", &jog, &mut pwm.jog_percent);
    });
}

fn duty_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let name = if motor == Motor::M1 { "M1 duty" } else { "M2 duty" };
    let slider = Setpoint { name, unit: "%", range: -100.0..=100.0, decimals: 0, step: 1.0 };
    let mut duty = model.front.pwm.setpoints.values[motor.index()];
    let moved = slider.ui(ui, &mut duty);
    if !ui.is_enabled() {
        return;
    }
    model.front.pwm.setpoints.hold(motor, moved.held);
    if moved.changed {
        model.front.pwm.set_duty(motor, duty);
    }
}

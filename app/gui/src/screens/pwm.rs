//! PWM Settings (MCP manual 1.2.11): two duty sliders behind an arm switch, and the live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::Ui;

use super::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui, sync_ui};
use crate::command::Commands;
use crate::model::Model;
use crate::model::pwm::ACCEL_RANGE_PERCENT_PER_S;
use crate::widgets::{Numeric, Setpoint};

const OUTPUT: Output = Output {
    scope: ArmScope::Pwm,
    word: "output",
    channels: [Channel::M1_PWM, Channel::M2_PWM],
    unit: "%",
    digits: 6,
    unit_letters: 1,
    width: 126.0,
};

pub fn pwm_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let note = "Open loop: the duty is what the motor gets, whatever it does with it.";
    drive_ui(ui, model, ("PWM Settings", note, ArmScope::Pwm), commands, controls_ui);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in model.front.motors().iter().copied() {
        let held = motor_ui(ui, model, motor, &OUTPUT, |ui, model| duty_ui(ui, model, motor));
        model.front.pwm.jog(motor, held);
    }
    let motors = model.front.motors();
    options_ui(ui, |ui| {
        let pwm = &mut model.front.pwm;
        sync_ui(ui, motors, &mut pwm.setpoints);
        on_release_ui(ui, &mut pwm.setpoints);
        ui.separator();
        let field =
            |name, unit, range, decimals, step| Numeric { name, unit, range, decimals, step, width: 92.0 };
        let accel = field("Acceleration", "%/s", ACCEL_RANGE_PERCENT_PER_S, 0, 5.0);
        let hint = "How fast the duty follows the slider; 0 means at once";
        pace_ui(ui, "Accel", hint, &accel, &mut pwm.accel_percent_per_s);
        let jog = field("Jog duty", "%", 0.0..=100.0, 1, 1.0);
        pace_ui(ui, "Jog", "The duty while a jog button is held", &jog, &mut pwm.jog_percent);
    });
}

fn duty_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let name = if motor == Motor::M1 { "M1 duty" } else { "M2 duty" };
    let slider = Setpoint { name, unit: "%", range: -100.0..=100.0, decimals: 1, step: 0.1 };
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

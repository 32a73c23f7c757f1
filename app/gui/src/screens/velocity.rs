//! Velocity Settings (MCP manual 1.2.12): the speed loop's settings, two speed sliders behind an arm switch, and the
//! live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Label, Ui};

use super::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui, sync_ui};
use crate::command::Commands;
use crate::messages::MotorFieldMessage;
use crate::model::Model;
use crate::model::velocity::ACCEL_RANGE_COUNTS_PER_S2;
use crate::widgets::{Numeric, Setpoint};

const OUTPUT: Output = Output {
    scope: ArmScope::Velocity,
    word: "measured",
    channels: [Channel::M1_VELOCITY, Channel::M2_VELOCITY],
    unit: "counts/s",
    digits: 7,
    unit_letters: 7,
    width: 204.0,
};

pub fn velocity_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let note = "Closed loop: the controller holds a speed in counts/s by the encoder.";
    drive_ui(ui, model, ("Velocity Settings", note, ArmScope::Velocity), commands, controls_ui);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in model.front.motors().iter().copied() {
        let held = motor_ui(ui, model, motor, &OUTPUT, |ui, model| speed_ui(ui, model, motor));
        let qpps = model.front.top_speeds();
        model.front.velocity.jog(motor, held, qpps);
    }
    let motors = model.front.motors();
    options_ui(ui, |ui| {
        let velocity = &mut model.front.velocity;
        sync_ui(ui, motors, &mut velocity.setpoints);
        on_release_ui(ui, &mut velocity.setpoints);
        ui.separator();
        let field =
            |name, unit, range| Numeric { name, unit, range, decimals: 0, step: 1000.0, width: 130.0 };
        let accel = field("Acceleration", "counts/s²", ACCEL_RANGE_COUNTS_PER_S2);
        let hint = "How fast the speed follows the slider; 0 leaves it to the controller";
        pace_ui(ui, "Accel", hint, &accel, &mut velocity.accel_counts_per_s2);
        let jog = field("Jog speed", "counts/s", 0.0..=f64::from(i32::MAX));
        pace_ui(ui, "Jog", "The speed while a jog button is held", &jog, &mut velocity.jog_counts_per_s);
    });
}

fn speed_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let qpps = model.front.top_speeds();
    let reach = qpps[motor.index()];
    if reach < 1.0 {
        let is_known = model.front.settings.unit().is_some_and(|unit| unit.qpps(motor).is_some());
        ui.add(Label::new(why_no_slider(is_known)).truncate());
        return;
    }
    let name = MotorFieldMessage::Speed { motor }.to_string();
    let slider = Setpoint { name: &name, unit: "", range: -reach..=reach, decimals: 0, step: 1.0 };
    let mut speed = model.front.velocity.setpoints.values[motor.index()];
    let moved = slider.ui(ui, &mut speed);
    if !ui.is_enabled() {
        return;
    }
    model.front.velocity.setpoints.hold(motor, moved.held);
    if moved.changed {
        model.front.velocity.set_speed(motor, speed, qpps);
    }
}

fn why_no_slider(is_known: bool) -> &'static str {
    if is_known {
        "QPPS is 0: set it below and apply it, or measure it on the PWM screen."
    } else {
        "QPPS has not been read."
    }
}

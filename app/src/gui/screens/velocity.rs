//! Velocity Settings (MCP manual 1.2.12): the speed loop's settings, two speed sliders behind an arm switch, and the
//! live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_protocol::packet_serial::Motor;
use egui::Ui;

use super::drive::{Output, arm_ui, graph_ui, motor_ui, on_release_ui, sync_ui};
use super::loops::loops_ui;
use super::{not_connected_text, nothing_ui, title_ui};
use crate::gui::command::Commands;
use crate::gui::model::Model;
use crate::gui::model::loop_settings::VELOCITY;
use crate::gui::model::velocity::ACCEL_RANGE_COUNTS_PER_S2;
use crate::gui::widgets::numeric::Numeric;
use crate::gui::widgets::setpoint::Setpoint;

const OUTPUT: Output = Output {
    scope: ArmScope::Velocity,
    word: "measured",
    channels: [Channel::M1Velocity, Channel::M2Velocity],
    unit: "counts/s",
    digits: 7,
    unit_letters: 7,
    width: 204.0,
};

pub fn velocity_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    title_ui(
        ui,
        "Velocity Settings",
        "Closed loop: the controller holds a speed in counts/s by the encoder.",
    );
    loops_ui(ui, &mut model.front.loops, VELOCITY, commands);
    ui.add_space(4.0);
    arm_ui(ui, ArmScope::Velocity, &model.front.link, commands);
    ui.add_space(4.0);
    controls_ui(ui, model);
    ui.add_space(6.0);
    graph_ui(ui, model, commands);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in Motor::BOTH {
        motor_ui(ui, model, motor, &OUTPUT, |ui, model| speed_ui(ui, model, motor));
    }
    ui.horizontal(|ui| {
        ui.add_space(70.0);
        sync_ui(ui, &mut model.front.velocity.setpoints);
        on_release_ui(ui, &mut model.front.velocity.setpoints);
        ui.separator();
        ui.label("Accel");
        let accel = Numeric {
            name: "Acceleration",
            unit: "counts/s²",
            range: ACCEL_RANGE_COUNTS_PER_S2,
            decimals: 0,
            step: 1000.0,
            width: 130.0,
        };
        let response = accel.ui(ui, &mut model.front.velocity.accel_counts_per_s2);
        let hint = "How fast the speed follows the slider; 0 leaves it to the controller";
        response.on_hover_text(hint);
    });
}

fn speed_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let qpps = Motor::BOTH.map(|motor| model.front.loops.qpps(motor).unwrap_or(0.0).min(f64::from(i32::MAX)));
    let reach = qpps[motor.index()];
    if reach < 1.0 {
        ui.label(if model.front.loops.qpps(motor).is_some() {
            "QPPS is 0, so this motor has no speed to go to. Set QPPS above and apply it."
        } else {
            "QPPS has not been read, so the range of speeds is not known."
        });
        return;
    }
    let name = format!("{motor} speed");
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

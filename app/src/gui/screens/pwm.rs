//! PWM Settings (MCP manual 1.2.11): two duty sliders behind an arm switch, and the live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_protocol::packet_serial::Motor;
use egui::Ui;

use super::drive::{Output, arm_ui, graph_ui, motor_ui, sync_ui};
use super::{not_connected_text, nothing_ui, title_ui};
use crate::gui::command::Commands;
use crate::gui::model::Model;
use crate::gui::model::pwm::ACCEL_RANGE_PERCENT_PER_S;
use crate::gui::widgets::numeric::Numeric;
use crate::gui::widgets::setpoint::Setpoint;

const OUTPUT: Output = Output {
    scope: ArmScope::Pwm,
    word: "output",
    channels: [Channel::M1Pwm, Channel::M2Pwm],
    unit: "%",
    digits: 6,
    unit_letters: 1,
    width: 126.0,
};

pub fn pwm_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    if model.front.link.identity().is_none() {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    title_ui(ui, "PWM Settings", "Open loop: the duty is what the motor gets, whatever it does with it.");
    arm_ui(ui, ArmScope::Pwm, &model.front.link, commands);
    ui.add_space(4.0);
    controls_ui(ui, model);
    ui.add_space(6.0);
    graph_ui(ui, model, commands);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in Motor::BOTH {
        motor_ui(ui, model, motor, &OUTPUT, |ui, model| duty_ui(ui, model, motor));
    }
    ui.horizontal(|ui| {
        ui.add_space(70.0);
        sync_ui(ui, &mut model.front.pwm.setpoints);
        ui.separator();
        let label = ui.label("Accel");
        let accel = Numeric {
            name: "Acceleration",
            unit: "%/s",
            range: ACCEL_RANGE_PERCENT_PER_S,
            decimals: 0,
            step: 5.0,
            width: 92.0,
        };
        let response = accel.ui(ui, &mut model.front.pwm.accel_percent_per_s);
        response.labelled_by(label.id).on_hover_text("How fast the duty follows the slider; 0 means at once");
    });
}

fn duty_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let name = if motor == Motor::M1 { "M1 duty" } else { "M2 duty" };
    let slider = Setpoint { name, unit: "%", range: -100.0..=100.0, decimals: 1, step: 0.1 };
    let mut duty = model.front.pwm.setpoints.values[motor.index()];
    if slider.ui(ui, &mut duty).changed && ui.is_enabled() {
        model.front.pwm.set_duty(motor, duty);
    }
}

//! Position Settings (MCP manual 1.2.13): the position loop's settings, two position sliders behind an arm switch, and
//! the live graph.

use brushwork_link::device::{ArmScope, Channel};
use brushwork_values::Motor;
use egui::{Label, Ui};

use super::drive::{Output, drive_ui, motor_ui, on_release_ui, options_ui, pace_ui};
use crate::command::Commands;
use crate::messages::MotorFieldMessage;
use crate::model::position::PACE_RANGE;
use crate::model::{Connection, Direction, Model, UnitSettings};
use crate::widgets::{Numeric, Setpoint};

const OUTPUT: Output = Output {
    scope: ArmScope::Position,
    word: "measured",
    channels: [Channel::M1_POSITION, Channel::M2_POSITION],
    unit: "counts",
    digits: 11,
    unit_letters: 5,
    width: 224.0,
};

pub fn position_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let note = "Closed loop: the controller goes to a count of the encoder and holds it.";
    drive_ui(ui, model, ("Position Settings", note, ArmScope::Position), commands, controls_ui);
}

fn controls_ui(ui: &mut Ui, model: &mut Model) {
    for motor in model.front.motors().iter().copied() {
        let held = motor_ui(ui, model, motor, &OUTPUT, |ui, model| slider_ui(ui, model, motor));
        jog(&mut model.front, motor, held);
    }
    let has_two = model.front.motors().len() > 1;
    options_ui(ui, |ui| {
        let position = &mut model.front.position;
        // Coupling alone moves nothing: the motors may have different travels.
        if has_two {
            ui.checkbox(&mut position.setpoints.sync, "Sync motors")
                .on_hover_text("Both sliders move together");
        }
        on_release_ui(ui, &mut position.setpoints);
        ui.separator();
        for (label, name, unit, hint, value) in [
            (
                "Accel",
                "Acceleration",
                "counts/s²",
                "How fast a move gathers speed",
                &mut position.accel_counts_per_s2,
            ),
            (
                "Decel",
                "Deceleration",
                "counts/s²",
                "How fast a move loses speed",
                &mut position.decel_counts_per_s2,
            ),
            (
                "Speed",
                "Travel speed",
                "counts/s",
                "The greatest speed on the way",
                &mut position.speed_counts_per_s,
            ),
        ] {
            let field = Numeric { name, unit, range: PACE_RANGE, decimals: 0, step: 1000.0, width: 130.0 };
            pace_ui(ui, label, hint, &field, value);
        }
    });
}

fn slider_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let connection = &mut model.front;
    let travels = connection.near_travels();
    let Some((low, high)) = travels[motor.index()] else {
        ui.add(
            Label::new(why_no_slider(connection.settings.unit().is_some_and(UnitSettings::is_known)))
                .truncate(),
        );
        return;
    };
    // Where the motor is, until a hand asks for something.
    connection.position.setpoints.show(motor, connection.seen(motor).counts);
    let name = MotorFieldMessage::Position { motor }.to_string();
    let slider = Setpoint { name: &name, unit: "", range: low..=high, decimals: 0, step: 1.0 };
    let shown = connection.position.setpoints.values[motor.index()].clamp(low, high);
    let mut counts = shown;
    let moved = slider.ui(ui, &mut counts);
    if !ui.is_enabled() {
        return;
    }
    connection.position.setpoints.hold(motor, moved.held);
    // Outside the travel the slider stands at its end; only a hand moves the motor.
    if counts != shown {
        connection.position.set_position(motor, counts, travels);
    }
}

fn why_no_slider(is_known: bool) -> &'static str {
    if is_known {
        "No travel: set Min and Max below and apply them."
    } else {
        "Min and Max have not been read."
    }
}

fn jog(connection: &mut Connection, motor: Motor, held: Option<Direction>) {
    let (travels, seen) = (connection.near_travels(), Motor::BOTH.map(|motor| connection.seen(motor)));
    connection.position.jog(motor, held, travels, seen);
}

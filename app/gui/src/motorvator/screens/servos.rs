//! The two servos, below the motors: they turn when they are told, and stay.

use brushwork_link::device::ArmScope;
use egui::{Button, Label, RichText, Role, Ui, WidgetInfo};

use crate::command::Command;
use crate::model::Model;
use crate::motorvator::messages::BoardMessage;
use crate::motorvator::model::servos::{FURTHEST_DEGREES, SERVOS};
use crate::screens::drive::options_ui;
use crate::widgets::Numeric;

/// Draws the row; what is to be sent.
pub fn servos_ui(ui: &mut Ui, model: &mut Model) -> Vec<Command> {
    let armed = model.front.link.arming.is_armed_for(ArmScope::Pwm);
    let servos = &mut model.front.motorvator_mut().servos;
    let mut asked = Vec::new();
    options_ui(ui, |ui| {
        for index in 0..SERVOS {
            let servo = index + 1;
            let name = BoardMessage::Servo { servo }.to_string();
            ui.label(&name)
                .on_hover_text("From its middle; backward with a minus. A stop leaves it where it is.");
            let range = -FURTHEST_DEGREES..=FURTHEST_DEGREES;
            let field = Numeric { name: &name, unit: "°", range, decimals: 0, step: 5.0, width: 84.0 };
            field.ui(ui, &mut servos.wanted[index]);
            let response = ui.add_enabled(armed, Button::new("Turn"));
            let spoken = BoardMessage::TurnServo { servo }.to_string();
            response.widget_info(|| WidgetInfo::labeled(Role::Button, armed, &spoken));
            if response.on_disabled_hover_text("Arm first: a servo moves at once").clicked() {
                asked.extend(servos.turn(index));
            }
            let told = match servos.told[index] {
                Some(degrees) => BoardMessage::ServoTold { servo, degrees },
                None => BoardMessage::ServoUnknown { servo },
            };
            ui.weak(told.to_string());
            if index + 1 < SERVOS {
                ui.separator();
            }
        }
    });
    if let Some(trouble) = &servos.trouble {
        ui.add(Label::new(RichText::new(trouble).color(ui.visuals().error_fg_color)).wrap());
    }
    asked
}

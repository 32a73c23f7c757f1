//! The guided measurement of QPPS (MCP manual 2.4.5): what it will do, its limits, how far it is, what it found.

use egui::{Button, Label, RichText, Ui};

use super::progress::progress_ui;
use crate::command::{Command, Commands, GuidedAction};
use crate::messages::ButtonMessage;
use crate::model::qpps::lines;
use crate::model::{IndicatorState, Model};
use crate::theme::Palette;
use crate::widgets::numeric::Numeric;

const WHAT_IT_DOES: &str = "Checks with little duty that the encoder counts up when the motor goes forward, then runs it at \
    100 % in both directions at Accel until its speed holds. Lift the wheels or unhitch the load first.";

pub fn qpps_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let _palette = Palette::of(ui);
    ui.add(Label::new(RichText::new(WHAT_IT_DOES).small().weak()).wrap());
    let is_running = model.front.is_guided();
    ui.horizontal(|ui| {
        ui.add_enabled_ui(!is_running, |ui| task_ui(ui, model));
        if is_running {
            return progress_ui(ui, model.front.qpps.job.progress(), commands);
        }
        let scope = model.screen.arm_scope();
        let is_armed = scope.is_some_and(|scope| model.front.link.arming.is_armed_for(scope));
        let label = ButtonMessage::Measure { motor: model.front.qpps.motor }.to_string();
        let measure = ui.add_enabled(is_armed, Button::new(label));
        if measure.on_disabled_hover_text("Arm this screen first").clicked() {
            commands.push(Command::Guided(GuidedAction::MeasureQpps));
        }
        if !is_armed {
            let hint = RichText::new("Arm this screen to measure.").small().weak();
            ui.add(Label::new(hint).truncate());
        }
    });
    result_ui(ui, model);
}

fn task_ui(ui: &mut Ui, model: &mut Model) {
    let motors = model.front.motors();
    let panel = &mut model.front.qpps;
    for motor in motors {
        ui.radio_value(&mut panel.motor, *motor, motor.to_string());
    }
    ui.separator();
    ui.label("Travel up to");
    let travel = Numeric::new("Travel limit", "counts", 100.0..=2e9, (0, 1000.0, 130.0));
    travel.ui(ui, &mut panel.travel_limit_counts).on_hover_text("How far it may go in one direction");
    ui.label("Time up to");
    let time =
        Numeric { name: "Time limit", unit: "s", range: 1.0..=120.0, decimals: 0, step: 1.0, width: 60.0 };
    time.ui(ui, &mut panel.time_limit_s).on_hover_text("How long it may run in one direction");
    ui.separator();
}

fn result_ui(ui: &mut Ui, model: &mut Model) {
    let _palette = Palette::of(ui);
    let mut taken_over = None;
    match (&model.front.qpps.measured, &model.front.qpps.refusal) {
        (Some(measured), _) => {
            let lines = lines(measured);
            ui.horizontal(|ui| {
                ui.label(&lines[0]);
                let label = ButtonMessage::SetQpps { motor: measured.motor }.to_string();
                let hint = "Puts it into the settings beside L and R, where it is applied";
                if ui.button(label).on_hover_text(hint).clicked() {
                    taken_over = Some((measured.motor, measured.qpps()));
                }
            });
            for line in &lines[1..] {
                ui.label(RichText::new(line).small().weak());
            }
        }
        (None, Some(refusal)) => {
            IndicatorState::Error.line_ui(ui, &refusal.to_string());
        }
        (None, None) => {
            ui.label(RichText::new("Nothing measured yet.").small().weak());
        }
    }
    if let Some((motor, qpps)) = taken_over {
        model.front.take_over_qpps(motor, qpps);
    }
}

//! The assistant for calibration by hand, above the sliders and the graph.

use brushwork_link::device::PollRate;
use brushwork_values::Motor;
use egui::{Button, Label, RichText, Ui};

use super::calibration::{Advice, Calibration};
use super::{Loop, TuneAction};
use crate::command::{Command, Commands};
use crate::model::{IndicatorState, Model, Screen, Tab};
use crate::theme::{self, Palette};
use brushwork_core::tune::law::AnyRegisters;
use brushwork_tuning::registers::RegisterTable as _;

pub fn by_hand_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let Some(which) = Loop::of(model.screen) else { return };
    head_ui(ui, model, which, commands);
    let calibration = model.front.tune.calibration(which);
    let (motor, at) = (calibration.motor, calibration.step);
    let held = model.front.held_gains(motor, which == Loop::Position);
    let step = &Calibration::steps(which)[at];
    ui.add(Label::new(step.text).wrap());
    ui.horizontal_wrapped(|ui| {
        let is_free = !model.front.is_guided() && !model.front.settings.is_busy();
        for change in step.changes {
            let button = ui.add_enabled(is_free && held.is_some(), Button::new(change.label));
            if button.on_hover_text(change.hint).clicked()
                && let Some(held) = held
            {
                let registers = change.made(held);
                commands.push(Command::Tune(TuneAction::Adjust(motor, registers)));
            }
        }
        if which == Loop::Velocity && at == 0 && ui.button("Measure QPPS…").clicked() {
            commands.push(Command::OpenDrawer(Screen::Pwm, Tab::Qpps));
        }
        if which == Loop::Position && at == 0 {
            travel_speed_ui(ui, model, motor);
        }
    });
    // A row of its own, so that no figure is parted from its name.
    ui.horizontal(|ui| held_ui(ui, which, held));
    advice_ui(ui, &model.front.tune.calibration(which).advice(which, held));
}

/// Motor, steps, and how often is looked.
fn head_ui(ui: &mut Ui, model: &mut Model, which: Loop, commands: &mut Commands) {
    let _palette = Palette::of(ui);
    let poll = model.front.poll;
    let motors = model.front.motors();
    let calibration = model.front.tune.calibration_mut(which);
    ui.horizontal_wrapped(|ui| {
        for motor in motors {
            if ui.radio(calibration.motor == *motor, motor.to_string()).clicked() {
                calibration.look_at(*motor);
            }
        }
        ui.separator();
        let at = calibration.step;
        let steps = Calibration::steps(which);
        for (index, step) in steps.iter().enumerate() {
            if ui.selectable_label(index == at, format!("{}. {}", index + 1, step.title)).clicked() {
                calibration.go_to(which, index);
            }
        }
        ui.separator();
        if ui.add_enabled(at + 1 < steps.len(), Button::new("Next step")).clicked() {
            calibration.go_to(which, at + 1);
        }
        if poll == PollRate::Fastest {
            ui.label(RichText::new("sampling as fast as the link allows").small().weak());
        } else {
            let faster = ui.button("Sample faster");
            let hint = "As fast as the link allows: vibrations are seen better";
            if faster.on_hover_text(hint).clicked() {
                commands.push(Command::Poll(PollRate::Fastest));
            }
        }
    });
}

/// The bound of the speed on the way, which the manual wants to be QPPS.
fn travel_speed_ui(ui: &mut Ui, model: &mut Model, motor: Motor) {
    let qpps = model.front.top_speeds()[motor.index()];
    let button = ui.add_enabled(qpps >= 1.0, Button::new("Travel speed to QPPS"));
    if button.on_hover_text("The greatest speed on the way, for the slider of this screen").clicked() {
        model.front.position.speed_counts_per_s = qpps;
    }
}

/// What the controller holds of the gains that this procedure turns.
fn held_ui(ui: &mut Ui, which: Loop, held: Option<AnyRegisters>) {
    let _palette = Palette::of(ui);
    let Some(held) = held else { return };
    ui.label(RichText::new("In the controller:").small().weak());
    let keys: &[&str] = match which {
        Loop::Velocity => &["velocity.p", "velocity.i", "velocity.d"],
        Loop::Position => &["position.p", "position.i", "position.d", "position.max_i", "position.deadzone"],
    };
    for field in AnyRegisters::fields().into_iter().filter(|field| keys.contains(&field.key)) {
        if let Some(value) = held.value(field) {
            ui.label(RichText::new(field.label).small().weak());
            ui.label(RichText::new(field.text(value)).text_style(theme::figures()));
        }
    }
}

fn advice_ui(ui: &mut Ui, advice: &Advice) {
    match advice {
        Advice::Wait(text) => IndicatorState::Unknown.line_ui(ui, &text.to_string()),
        Advice::Good(text) => IndicatorState::Ok.line_ui(ui, &text.to_string()),
        Advice::Change(text) => IndicatorState::Warning.line_ui(ui, &text.to_string()),
        Advice::Danger(text) => IndicatorState::Error.line_ui(ui, &text.to_string()),
    }
}

//! The step-response assistant above the graph (Motion Mind manual 3.14).

use brushwork_motion_mind_wire::register_named;
use egui::{Button, Label, RichText, Ui};

use crate::command::{Command, Commands};
use crate::model::Model;
use crate::motion_mind::MindAction;
use crate::motion_mind::messages::MindMessage;
use crate::motion_mind::model::steps::{Outcome, STAGES, prepared};
use crate::theme::{self};

pub fn steps_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let at = model.front.mind().steps.stage.min(STAGES.len() - 1);
    let stage = &STAGES[at];
    stages_ui(ui, model, at);
    ui.add(Label::new(stage.text).wrap());
    let is_free = !model.front.is_guided() && !model.front.settings.is_busy();
    ui.horizontal_wrapped(|ui| {
        if at == 0 {
            let hint = "Writes five changes to RAM; nothing is stored";
            if ui.add_enabled(is_free, Button::new("Prepare the registers")).on_hover_text(hint).clicked() {
                commands.push(Command::own(MindAction::Turn(prepared())));
            }
        }
        for change in stage.changes {
            let image = change.image(|name| model.front.register(name));
            let button = ui.add_enabled(is_free && image.is_some(), Button::new(change.label));
            if button.on_hover_text(change.hint).clicked()
                && let Some(image) = image
            {
                commands.push(Command::own(MindAction::Turn(image)));
            }
        }
        if let Some(before) = &model.front.mind().steps.before {
            let hint = "The registers as they were when the assistant first changed one";
            if ui.add_enabled(is_free, Button::new("Put all back")).on_hover_text(hint).clicked() {
                commands.push(Command::own(MindAction::PutBack(before.clone())));
            }
        }
        held_ui(ui, model);
    });
    outcome_ui(ui, model);
}

fn stages_ui(ui: &mut Ui, model: &mut Model, at: usize) {
    ui.horizontal_wrapped(|ui| {
        for (index, stage) in STAGES.iter().enumerate() {
            if ui.selectable_label(index == at, format!("{}. {}", index + 1, stage.title)).clicked() {
                model.front.mind_mut().steps.stage = index;
            }
        }
        if ui.add_enabled(at + 1 < STAGES.len(), Button::new("Next stage")).clicked() {
            model.front.mind_mut().steps.stage = at + 1;
        }
    });
}

/// What the registers hold now.
fn held_ui(ui: &mut Ui, model: &Model) {
    ui.separator();
    for name in ["PTERM", "ITERM", "DTERM", "PIDSCALAR", "VELOCITYFF"] {
        let value = register_named(name).and_then(|_| model.front.register(name));
        let text = value.map_or_else(|| "–".to_owned(), |value| value.to_string());
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            ui.label(RichText::new(name).small().weak());
            let figure = ui.label(RichText::new(&text).text_style(theme::figures()));
            let spoken = MindMessage::Held { name, value: text.clone() }.to_string();
            figure.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &spoken));
        });
    }
}

/// The last step in figures, and what it says.
fn outcome_ui(ui: &mut Ui, model: &Model) {
    let steps = &model.front.mind().steps;
    let text = match (steps.is_recording(), steps.last) {
        (true, _) => "Recording the response for 4 s …".to_owned(),
        (false, Some(last)) => figures_text(last),
        (false, None) => "No step yet. Use Step + and − Step above; their size is beside them.".to_owned(),
    };
    let label = ui.add(Label::new(&text).truncate());
    label.widget_info(|| {
        egui::WidgetInfo::labeled(
            egui::Role::Label,
            true,
            MindMessage::LastStep { text: text.clone() }.to_string(),
        )
    });
    let advice = steps.advice();
    let reported = ui.add(Label::new(RichText::new(advice).strong()).wrap());
    reported.widget_info(|| {
        egui::WidgetInfo::labeled(
            egui::Role::Label,
            true,
            MindMessage::Advice { advice: advice.to_string() }.to_string(),
        )
    });
}

fn figures_text(last: Outcome) -> String {
    let figures = &last.figures;
    let seconds =
        |time: Option<f64>| time.map_or_else(|| "not reached".to_owned(), |time| format!("{time:.2} s"));
    MindMessage::Step {
        counts: last.step_counts,
        rise: seconds(figures.rise_time_s),
        overshoot_percent: figures.overshoot * 100.0,
        settled: seconds(figures.settling_time_s),
        off: figures.final_error,
    }
    .to_string()
}

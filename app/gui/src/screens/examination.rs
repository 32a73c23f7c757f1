//! The window that examines a controller: what each step does, what was agreed to, how far it is, and the report.

use brushwork_core::examine::{Need, Step};
use brushwork_core::words::capital;
use brushwork_link::device::Identity;
use brushwork_values::Motor;
use egui::{
    Align, Button, ComboBox, Context, Label, ProgressBar, Rect, RichText, ScrollArea, TextEdit, Ui, Window,
    vec2,
};

use crate::command::{Command, Commands};
use crate::keys::escape_closes;
use crate::model::examination::{ExaminationAction, ExaminationPanel};
use crate::model::{Gravity, Model};
use crate::screens::messages::ScreenMessage;
use crate::theme::Palette;
use crate::widgets::{choice_ui, heading_ui, text_field_ui, with_time_left};
use brushwork_core::messages::ExamineMessage;

/// Lines of the report that are shown at once, at least.
const REPORT_LINES: usize = 12;

/// Draws the window, if it is open, within `room`.
pub fn examination_ui(ctx: &Context, model: &mut Model, commands: &mut Commands, room: Rect) {
    if !model.front.examination.open {
        return;
    }
    let mut open = true;
    let size = vec2(680.0, 620.0).min(room.size() - vec2(24.0, 60.0));
    let shown = Window::new("Examine this controller")
        .open(&mut open)
        .collapsible(false)
        .default_size(size)
        .default_pos(room.center() - size / 2.0)
        .min_size(vec2(420.0, 260.0))
        .constrain_to(room)
        .show(ctx, |ui| {
            ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| contents_ui(ui, model, commands));
        });
    // The window can be put away while the examination goes on.
    let closes = escape_closes(ctx, shown.as_ref()) && !model.front.examination.is_running();
    model.front.examination.open = open && !closes;
}

fn contents_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    wrapped_ui(
        ui,
        "Finds out what the controller answers and how, and writes a report that holds nothing of this computer. It reads. Whatever does more \
         is done only where you tick it, and is put back afterwards.",
    );
    ui.add_space(6.0);
    let front = &mut model.front;
    let identity = front.link.identity().cloned();
    let is_guided = front.is_guided();
    let motors = front.motors();
    let panel = &mut front.examination;
    match (panel.is_running(), identity) {
        (true, _) => running_ui(ui, panel, commands),
        (false, Some(identity)) => ask_ui(ui, panel, &identity, motors, is_guided, commands),
        (false, None) => drop(ui.weak("No controller is connected.")),
    }
    if let Some((gravity, text)) = &panel.ended {
        let palette = Palette::of(ui);
        let text = RichText::new(text.to_string());
        ui.add_space(4.0);
        let headline = ui.add(Label::new(match gravity {
            Gravity::Note => text,
            Gravity::Warning => text.color(palette.warning),
            Gravity::Error => text.color(palette.error),
        }));
        if std::mem::take(&mut panel.is_new) {
            headline.scroll_to_me(Some(Align::Min));
        }
    }
    report_ui(ui, panel, commands);
}

fn ask_ui(
    ui: &mut Ui,
    panel: &mut ExaminationPanel,
    identity: &Identity,
    motors: &[Motor],
    is_guided: bool,
    commands: &mut Commands,
) {
    let steps = ExaminationPanel::steps(identity);
    if steps.is_empty() {
        ui.weak(ExamineMessage::NoQuestions { unit: identity.title().to_owned() }.to_string());
        return;
    }
    for (step, is_open) in steps {
        step_ui(ui, panel, step, is_open);
        if step.need == Need::Move && motors.len() > 1 && panel.agreed.contains(step.key) {
            ui.indent("motor", |ui| {
                ui.label("Motor that moves");
                let list = ComboBox::from_id_salt("examined motor");
                choice_ui(ui, list, "Motor that moves", &mut panel.motor, motors.iter().copied(), |motor| {
                    motor.to_string()
                });
            });
        }
    }
    ui.add_space(4.0);
    let why_not = is_guided.then_some("Another job runs. Wait for it or cancel it.");
    let begin = ui.add_enabled(why_not.is_none(), Button::new("Examine"));
    if begin.clicked() {
        commands.push(Command::Examination(ExaminationAction::Begin));
    }
    if let Some(why) = why_not {
        ui.weak(why);
    }
}

/// A step with its box; reading needs none.
fn step_ui(ui: &mut Ui, panel: &mut ExaminationPanel, step: &'static Step, is_open: bool) {
    let title = capital(step.title);
    ui.horizontal(|ui| {
        // Reading needs no word of anybody.
        let is_reading = step.need == Need::Read;
        let mut agreed = is_reading || panel.agreed.contains(step.key);
        let can_choose = is_open && !is_reading;
        if ui.add_enabled(can_choose, egui::Checkbox::new(&mut agreed, title)).changed() {
            match agreed {
                true => drop(panel.agreed.insert(step.key)),
                false => drop(panel.agreed.remove(step.key)),
            }
        }
        let mark = RichText::new(format!("({})", step.need.label()));
        let color = Palette::of(ui).warning;
        ui.label(if step.need > Need::Guess { mark.color(color) } else { mark.weak() });
    });
    ui.indent(step.key, |ui| wrapped_ui(ui, step.does));
    if !is_open {
        ui.weak("This model's settings are not known to this program, so that nothing could be put back afterwards.");
    }
    ui.add_space(4.0);
}

fn running_ui(ui: &mut Ui, panel: &ExaminationPanel, commands: &mut Commands) {
    let Some((number, of, title, text, share)) = panel.progress() else { return };
    heading_ui(ui, &ScreenMessage::StepOf { number, of, title }.to_string());
    ui.add(ProgressBar::new(share).show_percentage().desired_height(18.0));
    ui.label(with_time_left(ui, "examination", share, &capital(&text)));
    if ui.button("Cancel").on_hover_text("What was changed is put back").clicked() {
        commands.push(Command::Examination(ExaminationAction::Cancel));
    }
}

fn report_ui(ui: &mut Ui, panel: &mut ExaminationPanel, commands: &mut Commands) {
    let Some(found) = panel.found() else { return };
    let text = found.text();
    ui.add_space(8.0);
    heading_ui(ui, "Report");
    if !panel.is_running() {
        ui.horizontal(|ui| {
            if ui.button("Copy").on_hover_text("The report as text").clicked() {
                ui.ctx().copy_text(text.clone());
            }
            if ui.button("Save").on_hover_text("As JSON where the name ends in .json, else as text").clicked()
            {
                commands.push(Command::Examination(ExaminationAction::Save));
            }
            text_field_ui(ui, &mut panel.path, "Report file", "Path, such as unit.json or unit.txt");
        });
    }
    let mut shown = text.as_str();
    let report = ui.add(
        TextEdit::multiline(&mut shown)
            .font(egui::TextStyle::Monospace)
            .desired_width(f32::INFINITY)
            .desired_rows(REPORT_LINES),
    );
    ui.ctx().accesskit_node_builder(report.id, |node| node.set_label("Report of the examination"));
}

fn wrapped_ui(ui: &mut Ui, text: &str) {
    ui.add(Label::new(RichText::new(text).weak()).wrap());
}

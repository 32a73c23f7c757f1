//! A refusal that teaches: what was seen, what is likely wrong, what to do, and another try.

use egui::{Button, Label, RichText, Ui};

use super::model::{Loop, TuneWish};
use super::result::lamp_ui;
use crate::gui::command::{Command, Commands};
use crate::gui::model::Model;
use crate::gui::theme::Palette;
use crate::gui::widgets::LampState;

pub fn refusal_ui(ui: &mut Ui, model: &Model, which: Loop, commands: &mut Commands) {
    let Some(run) = model.front.tune.front(which).run() else { return };
    let motor = model.front.tune.motor(which);
    lamp_ui(
        ui,
        LampState::Error,
        &format!("{motor} was not tuned · run {} · {:.1} s", run.number, run.report.seconds.1),
    );
    for cause in &run.report.causes {
        ui.add(Label::new(cause.sentence()).wrap());
    }
    ui.label(
        RichText::new("The motors were stopped and the old gains are in force.")
            .color(Palette::of(ui).weak_text),
    );
    let is_armed = model.front.link.arming.is_armed_for(which.scope());
    let again = ui.add_enabled(is_armed && !model.front.is_guided(), Button::new("Try again"));
    if again.on_disabled_hover_text("Arm this screen first").clicked() {
        commands.push(Command::Tune(TuneWish::Start(motor)));
    }
}

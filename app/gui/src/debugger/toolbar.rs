//! Run, pause, step; the world's time; and the sentence that says why the script is where it is.

use brushwork_plant::server::Pace;
use brushwork_script::debug::{Reason, StepKind};
use egui::{ComboBox, RichText, Ui};

use super::action::DebugAction;
use crate::command::{Command, Commands};
use crate::keys::as_written;
use crate::model::{IndicatorState, Model};
use crate::theme::Palette;
use crate::widgets::choice_ui;

pub fn toolbar_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let debug = &model.front.debug;
    let (paused, running) = (debug.is_paused(), debug.is_running());
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let mut button = |ui: &mut Ui, enabled: bool, text: &str, hint: &str, action: DebugAction| {
            let hint = as_written(ui.ctx(), hint);
            let response = ui.add_enabled(enabled, egui::Button::new(text)).on_hover_text(&hint);
            if response.on_disabled_hover_text(hint).clicked() {
                commands.push(Command::Debug(action));
            }
        };
        let run = if paused { "Continue" } else { "Run" };
        // A program for a simulated board takes the place of what runs there.
        let can_run = !running || debug.takes_mecc;
        button(ui, can_run, run, "Goes on, or starts the script (Ctrl+F5)", DebugAction::Run);
        button(ui, running, "Pause", "Stops the script before its next line; the motors go on (Ctrl+F6)", DebugAction::Pause);
        let step = |kind| DebugAction::Step(kind);
        button(ui, paused, "Step into", "Runs one line (F11)", step(StepKind::Into));
        let over = "Runs one line with the subroutines it calls (F12)";
        button(ui, paused, "Step over", over, step(StepKind::Over));
        button(ui, paused, "Step out", "Runs on until the subroutine has returned (Shift+F11)", step(StepKind::Out));
        let cursor = "Runs on to the line of the caret (Ctrl+F10)";
        button(ui, paused || running, "Run to cursor", cursor, DebugAction::RunToCursor);
        ui.separator();
        let hint = "A script that is started, by hand, by autorun or by a pin, stops before its first line";
        let mut on = debug.stops_at_entry;
        if ui.checkbox(&mut on, "Stop at start").on_hover_text(hint).changed() {
            commands.push(Command::Debug(DebugAction::StopAtEntry(on)));
        }
        let hint = "On: while the script is paused the motors stand still in mid-motion, and the controller's clock and \
                    time-outs with them. Off, as in a real controller: they go on as the script told them, and nothing \
                    stops them but Stop";
        let mut on = debug.freezes_world;
        if ui.checkbox(&mut on, "Freeze world too").on_hover_text(hint).changed() {
            commands.push(Command::Debug(DebugAction::FreezeWorld(on)));
        }
        let hint = "How often each line was run, beside its number";
        let mut on = debug.shows_counts;
        if ui.checkbox(&mut on, "Counts").on_hover_text(hint).changed() {
            commands.push(Command::Debug(DebugAction::ShowCounts(on)));
        }
        if debug.shows_counts && ui.small_button("Clear counts").clicked() {
            commands.push(Command::Debug(DebugAction::ClearCounts));
        }
        pace_ui(ui, model, commands);
    });
}

/// How fast the simulated controller's time goes.
fn pace_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let Some(pace) = model.front.debug.pace else { return };
    ui.label("Time");
    let hint = "How fast the simulated controller's time goes. Max lasts until the script is paused or ends. The graph \
                keeps the clock of this computer, and the controller's own time-outs count its fast time: motors that \
                the window drives may be stopped by them";
    let (list, mut chosen) = (ComboBox::from_id_salt("pace").width(60.0), pace);
    let response = choice_ui(ui, list, "Time", &mut chosen, [Pace::REAL, Pace::TEN, Pace::Max], Pace::name);
    if chosen != pace {
        commands.push(Command::Debug(DebugAction::Pace(chosen)));
    }
    response.on_hover_text(hint);
}

/// Why the script is where it is.
pub fn reason_ui(ui: &mut Ui, model: &Model) {
    let Some(view) = &model.front.debug.view else { return };
    let palette = Palette::of(ui);
    ui.horizontal(|ui| {
        indicator_of(view.is_paused, view.is_running, &view.reason).ui(ui, egui::vec2(14.0, 16.0), 5.0);
        let color = if view.is_paused { palette.warning } else { palette.text };
        ui.add(egui::Label::new(RichText::new(view.sentence()).strong().color(color)).truncate());
        let notes = [
            (view.world_frozen, "The world stands still."),
            (view.is_paused && !view.world_frozen, "The motors go on as they were told."),
        ];
        for (_, note) in notes.iter().filter(|(holds, _)| *holds) {
            ui.weak(*note);
        }
    });
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn indicator_of(is_paused: bool, is_running: bool, reason: &Reason) -> IndicatorState {
    match reason {
        Reason::Faulted(_) => IndicatorState::Error,
        _ if is_paused => IndicatorState::Warning,
        _ if is_running => IndicatorState::Ok,
        _ => IndicatorState::Unknown,
    }
}

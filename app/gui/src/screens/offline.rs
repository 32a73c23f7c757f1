//! What stands in the place of a screen while no controller is connected: what is left of the one that was, a recording, or the start page.

use egui::{Color32, CornerRadius, Frame, Margin, RichText, Role, Stroke, Ui, WidgetInfo};

use super::graph_place::graph_place_ui;
use super::{not_connected_text, nothing_ui, settings_file, start, status};
use crate::command::{Command, Commands};
use crate::model::{Connection, IndicatorState, Model, Phase, Screen, Tab};
use crate::screens::messages::ScreenMessage;
use crate::theme::Palette;
use crate::tune::{Loop, guide};

/// What the events have of the status's height above its graph.
const EVENTS_PART: f32 = 0.4;

/// The place of a screen that needs a controller.
pub fn offline_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let is_closed = model.front.phase == Phase::Closed;
    let shows_file = is_closed && !model.front.shows_start;
    if shows_file && model.screen == Screen::GeneralSettings && settings_file::has_any(&model.files) {
        return settings_file::settings_file_ui(ui, model, commands);
    }
    if let Some(which) = report(model).filter(|_| shows_file) {
        band_ui(ui, model, commands);
        ui.add_space(6.0);
        return guide::found_ui(ui, model, which, commands);
    }
    let has_record = has_record(&model.front, model.screen);
    if is_closed && (!has_record || model.front.shows_start) {
        return start::start_ui(ui, model, commands);
    }
    if !has_record {
        return nothing_ui(ui, &not_connected_text(&model.front.phase));
    }
    band_ui(ui, model, commands);
    ui.add_space(6.0);
    if model.screen == Screen::DeviceStatus {
        let has_samples = !model.front.graph.live.track.history.is_empty();
        let height = ui.available_height() * if has_samples { EVENTS_PART } else { 1.0 };
        status::history_ui(ui, &mut model.front.history, height);
        if !has_samples {
            return;
        }
    }
    graph_place_ui(ui, model, commands);
}

/// The loop whose tuning runs are shown: those of the link that was, or one from a file.
fn report(model: &Model) -> Option<Loop> {
    let which = Loop::of(model.screen)?;
    let is_open = model.front.open_tab(model.screen) == Some(Tab::Tune);
    (is_open && model.front.tune.front(which).run().is_some()).then_some(which)
}

/// Whether there is something to see of what was: events, or the graph of a screen that drives.
fn has_record(front: &Connection, screen: Screen) -> bool {
    match screen.arm_scope() {
        Some(scope) if scope.allows_motion() => {
            front.graph.opened.is_some() || !front.graph.live.track.history.is_empty()
        }
        _ => screen == Screen::DeviceStatus && !front.history.is_empty(),
    }
}

/// What became of the link, what the controller does without it, and the way back.
fn band_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let palette = Palette::of(ui);
    let now_s = ui.input(|input| input.time);
    let front = &mut model.front;
    let (state, color, text) = match &mut front.lost {
        Some(lost) => {
            let since_s = now_s - *lost.noticed_s.get_or_insert(now_s);
            let ago = ago_text(since_s);
            ui.ctx().request_repaint_after(std::time::Duration::from_secs(1));
            (
                IndicatorState::Error,
                palette.error,
                ScreenMessage::LinkLost { ago, why: lost.text.clone() }.to_string(),
            )
        }
        None => (IndicatorState::Unknown, palette.line, not_connected_headline(front)),
    };
    let target = front.target.clone();
    let is_closed = front.phase == Phase::Closed;
    let fill = if front.lost.is_some() { palette.error.gamma_multiply(0.18) } else { Color32::TRANSPARENT };
    let frame = Frame::new().fill(fill).stroke(Stroke::new(1.5, color)).corner_radius(CornerRadius::same(4));
    frame.inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let response = ui.horizontal_wrapped(|ui| state.line_ui(ui, &text)).response;
        response.widget_info(|| WidgetInfo::labeled(Role::Alert, true, &text));
        // How long ago it was changes all the time: what it says is read out by the newest event, once.
        ui.horizontal(|ui| {
            if let Some(target) = target {
                let hint = "Opens the same link again. Nothing is armed by it";
                let connect =
                    egui::Button::new(ScreenMessage::ConnectAgain { target: target.to_string() }.to_string());
                if ui.add_enabled(is_closed, connect).on_hover_text(hint).clicked() {
                    commands.push(Command::ConnectTo(target));
                }
            }
            if ui.button("Start page").on_hover_text("Ports, simulated controllers and files").clicked() {
                model.show_start();
            }
            ui.label(
                RichText::new("What was sampled stays here, and can be saved and exported.").small().weak(),
            );
        });
    });
}

fn not_connected_headline(front: &Connection) -> String {
    match &front.phase {
        Phase::Closed if front.target.is_none() => "No controller is connected.".to_owned(),
        Phase::Closed => "Disconnected: these are the last values, and nothing new comes in.".to_owned(),
        phase @ (Phase::Opening { .. } | Phase::Open { .. } | Phase::Closing { .. }) => {
            not_connected_text(phase)
        }
    }
}

fn ago_text(since_s: f64) -> String {
    match since_s {
        s if s < 2.0 => "just now".to_owned(),
        s if s < 120.0 => ScreenMessage::SecondsAgo { seconds: s }.to_string(),
        s if s < 7200.0 => ScreenMessage::MinutesAgo { minutes: s / 60.0 }.to_string(),
        s => ScreenMessage::HoursAgo { hours: s / 3600.0 }.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_long_ago_is_told_in_a_unit_that_can_be_read() {
        assert_eq!(
            [0.4, 7.2, 119.0, 121.0, 7300.0].map(ago_text),
            ["just now", "7 s ago", "119 s ago", "2 min ago", "2 h ago"]
        );
    }
}

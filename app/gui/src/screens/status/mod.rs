//! Device Status (MCP manual 1.2.3 to 1.2.5): what to do next, why the motors do not run, thirteen indicators in full, the LEDs, who the unit is,
//! and what happened since the connection.

use egui::{Align, Layout, Ui};

use super::graph_place::graph_place_ui;
use super::split::Split;
use super::{face, title_ui};
use crate::command::Commands;
use crate::model::{IndicatorState, Model};

mod history;
mod indicators;
pub(crate) mod path;
mod unit;

pub(super) use history::history_ui;

/// Width from which two columns fit.
const TWO_COLUMNS_FROM: f32 = 600.0;

pub fn status_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    title_ui(ui, "Device Status", headline(model));
    // Side by side where there is room, else below each other.
    let columns = if ui.available_width() < TWO_COLUMNS_FROM { 1 } else { 2 };
    let bottom = ui.max_rect().bottom();
    if model.front.graph.large && !model.front.graph.detached {
        return graph_place_ui(ui, model, commands);
    }
    let split = Split::of_long(ui, model.screen, bottom);
    split.above_ui(ui, model, |ui, model| details_ui(ui, model, columns, commands));
    split.graph_ui(ui, model, commands);
}

fn details_ui(ui: &mut Ui, model: &mut Model, columns: usize, commands: &mut Commands) {
    let face = face::of(model.front.family());
    // What keeps the motors from running is to be done before all else.
    let is_blocked = model.front.link.indicators.worst() >= IndicatorState::Warning;
    if is_blocked {
        face.reasons_ui(ui, &model.front, commands);
    }
    path::path_ui(ui, model, commands);
    if !is_blocked {
        face.reasons_ui(ui, &model.front, commands);
    }
    indicators::indicators_ui(ui, &model.front, columns);
    ui.add_space(8.0);
    let height = ui.available_height().max(history::LEAST_HEIGHT);
    ui.columns(columns, |ui| {
        // Columns stretch their text from edge to edge, which no paragraph is read by.
        let left = Layout::top_down(Align::Min);
        ui[0].with_layout(left, |ui| history_ui(ui, &mut model.front.history, height));
        ui[columns - 1].with_layout(left, |ui| {
            face.leds_ui(ui, &model.front);
            indicators::active_ui(ui, &model.front);
            ui.add_space(6.0);
            unit::unit_ui(ui, &model.front, commands);
        });
    });
}

fn headline(model: &Model) -> &'static str {
    match model.front.link.indicators.worst() {
        IndicatorState::Error => "At least one error: the controller has stopped a motor or both.",
        IndicatorState::Warning => "At least one warning: a limit is close.",
        IndicatorState::Active => "No warning and no error; a signal is active.",
        IndicatorState::Ok => "No warning and no error.",
        IndicatorState::Unknown | IndicatorState::NotApplicable => "The status has not been read yet.",
    }
}

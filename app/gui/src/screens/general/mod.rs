//! General Settings (MCP manual 1.2.10 and 1.9): every setting of the controller, grouped as Ion Studio groups them.
//!
//! Changing a row changes nothing on the controller; the write sheet shows what will be written, old and new. Sheets
//! stand in place of the list and not above the window, so that nothing ever covers Stop All.

use egui::{Align, Layout, Ui, vec2};

use super::face;
use crate::command::{Command, Commands};
use crate::model::{Model, Section, SettingsAction};

mod compare;
pub(crate) mod editor;
mod head;
pub(crate) mod help;
mod kept;
mod nav;
mod profile;
pub(crate) mod recipes;
pub(crate) mod rows;
pub(crate) mod sheet;
pub(crate) mod sheet_parts;
mod wiring;

/// The share of the screen that the list of sections takes, and its least and greatest width.
const NAV_SHARE: f32 = 0.25;
const NAV_WIDTH: (f32, f32) = (176.0, 250.0);
/// Below this width the list of sections unfolds above instead.
const SIDE_BY_SIDE: f32 = 560.0;

pub fn general_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    framed_ui(ui, model, commands, |ui, model, commands| {
        sections_ui(ui, model, commands, &[], |_, _, _, _| false);
    });
}

/// What the settings of every family have around their list: the head, and the sheets that stand in its place.
pub fn framed_ui(
    ui: &mut Ui,
    model: &mut Model,
    commands: &mut Commands,
    list_ui: impl FnOnce(&mut Ui, &mut Model, &mut Commands),
) {
    let family = model.front.family();
    let stream = model.front.link.stream;
    let will = family.recipes().map(|known| recipes::consequences(&model.front, known)).unwrap_or_default();
    let general = &mut model.front.general_view();
    if general.settings.wants_reading() {
        commands.push(Command::Settings(SettingsAction::Read));
    }
    head::head_ui(ui, general, family, commands);
    ui.add_space(4.0);
    match general.sheet.is_some() {
        true => sheet::sheet_ui(ui, general, (stream, &will), family.words(), commands),
        false => list_ui(ui, model, commands),
    }
}

/// A part of the settings that only one family has: what it is called, and what stands right of its name.
pub type OwnSection = (Section, &'static str, String);

/// The parts at the left, or above in a list that unfolds where that leaves too little room, and what the open one has. `own_ui` draws a part
/// in the room that is left, or leaves it to the list of rows.
pub fn sections_ui(
    ui: &mut Ui,
    model: &mut Model,
    commands: &mut Commands,
    own: &[OwnSection],
    own_ui: impl Fn(&mut Ui, &mut Model, f32, &mut Commands) -> bool,
) {
    model.front.general_view().leave_missing();
    let size = ui.available_size();
    let recipes = model.front.family().recipes().map(|_| (Section::Recipes, "Recipes", String::new()));
    let own: Vec<OwnSection> = recipes.into_iter().chain(own.iter().cloned()).collect();
    let own = &own[..];
    if size.x < SIDE_BY_SIDE {
        nav::choice_ui(ui, &mut model.front.general_view(), own);
        return section_ui(ui, model, commands, own_ui);
    }
    let nav_width = (size.x * NAV_SHARE).clamp(NAV_WIDTH.0, NAV_WIDTH.1);
    ui.horizontal_top(|ui| {
        ui.allocate_ui_with_layout(vec2(nav_width, size.y), Layout::top_down(Align::Min), |ui| {
            ui.set_width(nav_width);
            nav::nav_ui(ui, &mut model.front.general_view(), own);
        });
        let width = ui.available_width();
        ui.allocate_ui_with_layout(vec2(width, size.y), Layout::top_down(Align::Min), |ui| {
            ui.set_width(width);
            section_ui(ui, model, commands, own_ui);
        });
    });
}

/// What the open part has, and the explanation of one row.
fn section_ui(
    ui: &mut Ui,
    model: &mut Model,
    commands: &mut Commands,
    own_ui: impl Fn(&mut Ui, &mut Model, f32, &mut Commands) -> bool,
) {
    let room = ui.available_height();
    let help_height = help::height(room);
    let height = (room - help_height - ui.spacing().item_spacing.y).max(0.0);
    // Pages without rows have nothing to explain.
    let has_rows = !matches!(model.front.general.section, Section::Conflicts | Section::ClampTest)
        || model.front.general.is_filtered();
    let recipes = model.front.family().recipes();
    let shows_recipes = model.front.general.section == Section::Recipes && !model.front.general.is_filtered();
    if let Some(recipes) = recipes.filter(|_| shows_recipes) {
        return recipes::recipes_ui(ui, &mut model.front, recipes, room, commands);
    }
    if !own_ui(ui, model, if has_rows { height } else { room }, commands) {
        let face = face::of(model.front.family());
        rows::rows_ui(ui, &mut model.front.general_view(), face, height);
    }
    if has_rows {
        help::help_ui(ui, &model.front.general_view(), help_height);
    }
}

//! What General Settings has of an MCP's own (MCP manual 1.2.10 and 1.9): pins with their graphs, conflicts, the voltage clamp test.

use brushwork_link::settings::{Group, SettingValue};
use brushwork_mcp_client::messages::McpSettingsMessage;
use brushwork_mcp_client::settings::SHORTEST_AUTORUN_MS;
use egui::{Ui, vec2};

use super::{clamp, conflicts, pin};
use crate::command::Commands;
use crate::family::recipe::Goal;
use crate::messages::NameMessage;
use crate::model::{GeneralView, IndicatorState, Model, Section, UnitSettings};
use crate::screens::general::rows::{HEIGHT, MARK_WIDTH};
use crate::screens::general::sheet_parts::indicator_ui;
use crate::screens::general::{framed_ui, sections_ui};

pub fn general_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    framed_ui(ui, model, commands, |ui, model, commands| {
        let count = model.front.settings.unit().map_or(0, |unit| unit.conflicts().len());
        let found = if count == 0 { "none".to_owned() } else { NameMessage::Found { count }.to_string() };
        let own = [
            (Section::Conflicts, "Conflicts", found),
            (Section::ClampTest, "Voltage clamp test", String::new()),
        ];
        sections_ui(ui, model, commands, &own, section_ui);
    });
}

fn section_ui(ui: &mut Ui, model: &mut Model, height: f32, commands: &mut Commands) -> bool {
    let family = model.front.family();
    let link = &model.front.link;
    let general = &mut GeneralView::new(&mut model.front.settings, &mut model.front.general);
    match (general.section, general.pin()) {
        (Section::Conflicts, _) if !general.is_filtered() => conflicts::conflicts_ui(ui, general, height),
        (Section::ClampTest, _) if !general.is_filtered() => {
            clamp::clamp_ui(ui, general, (link, family), height, commands);
        }
        (_, Some(pin)) => pin::pin_ui(ui, general, pin, link.readings.signal(pin), height, commands),
        (_, None) => return false,
    }
    true
}

/// What stands before and behind the rows of a part.
pub fn around_rows_ui(ui: &mut Ui, general: &mut GeneralView<'_>, is_before: bool) {
    match general.section {
        Section::Group(Group::SCRIPTING) if is_before => autorun_ui(ui, general),
        Section::Group(Group::ENCODERS) if !is_before => encoder_ui(ui, general),
        Section::Group(Group::UNIT) if !is_before => bridge_ui(ui, general.unit()),
        Section::Group(_) | Section::One(..) | Section::Conflicts | Section::ClampTest | Section::Recipes => {
        }
    }
}

/// The kind of an encoder is set at its pins: the way to what sets both.
fn encoder_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    ui.add_space(6.0);
    if ui
        .button("Recipe: Encoder")
        .on_hover_text("Its kind, its pins, its wiring, and where it stands")
        .clicked()
    {
        general.recipes.job = Some(Goal::Encoder);
        general.turn_to(Section::Recipes);
    }
}

/// Ion Studio's box over the delay (MCP manual 1.2.10): a delay too short for a start is none.
fn autorun_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    const DELAY: &str = "script.autorun_delay";
    let Some(unit) = general.unit_mut() else { return };
    let Some(SettingValue::Int(delay_ms)) = unit.wanted(DELAY) else { return };
    let mut runs = delay_ms >= SHORTEST_AUTORUN_MS;
    ui.horizontal(|ui| {
        ui.allocate_space(vec2(MARK_WIDTH, HEIGHT));
        if ui.checkbox(&mut runs, "Execute script on power-up").changed() {
            unit.set_number(DELAY, if runs { SHORTEST_AUTORUN_MS as f64 } else { 0.0 });
        }
    });
}

/// The wiring warning of bridged channels, while they are wanted (MCP manual 1.8).
fn bridge_ui(ui: &mut Ui, unit: Option<&UnitSettings>) {
    let is_on = |unit: &UnitSettings| unit.wanted("unit.bridge_channels") == Some(SettingValue::Bool(true));
    if unit.is_some_and(is_on) {
        ui.add_space(6.0);
        indicator_ui(ui, IndicatorState::Warning, &McpSettingsMessage::Bridged);
    }
}

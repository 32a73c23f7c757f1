//! The gains beside the graph of what they do: each a byte, with the pace of moves (SuprMotr manual, Define P-Term to Define Integral Limit).

use std::rc::Rc;

use brushwork_link::settings::{SettingValue, SettingsImage};
use egui::{Button, Grid, RichText, Role, Ui, WidgetInfo};

use crate::command::{Command, Commands};
use crate::model::{Model, UnitSettings};
use crate::suprmotr::action::WriteGains;
use crate::suprmotr::messages::GainsMessage;
use crate::theme::Palette;
use crate::widgets::{NO_VALUE, Numeric};

/// The keys, with what stands above each field, its room, and what an arrow key changes.
const FIELDS: [(&str, &str, f32, f64); 6] = [
    ("loop.p", "P (DP)", 72.0, 1.0),
    ("loop.i", "I (DI)", 72.0, 1.0),
    ("loop.d", "D (DD)", 72.0, 1.0),
    ("loop.integral_limit", "I limit (DL)", 84.0, 1.0),
    ("motion.velocity", "DV (counts/s)", 108.0, 1_000.0),
    ("motion.acceleration", "DA (counts/s²)", 112.0, 10_000.0),
];

pub fn gains_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let is_free = !model.front.is_guided() && !model.front.settings.is_busy();
    let Some(unit) = model.front.settings.unit_mut() else { return };
    Grid::new("gains").spacing([8.0, 4.0]).show(ui, |ui| {
        for (_, label, ..) in FIELDS {
            ui.label(RichText::new(label).small().weak());
        }
        ui.end_row();
        for (key, _, width, step) in FIELDS {
            field_ui(ui, unit, key, width, step);
        }
        ui.end_row();
    });
    let edits = edits(unit);
    ui.horizontal_wrapped(|ui| {
        let can = is_free && !edits.is_empty();
        let response = ui.add_enabled(can, Button::new("Apply to RAM"));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, can, "Apply gains to RAM"));
        let hint = "Writes the changes and reads them back. A motor that is held may move a little. Save to EEPROM in the settings keeps them";
        if response.on_hover_text(hint).on_disabled_hover_text(hint).clicked() {
            commands.push(Command::Own(Rc::new(WriteGains(edits.clone()))));
        }
        if ui.add_enabled(!edits.is_empty(), Button::new("Revert")).clicked() {
            FIELDS.iter().for_each(|(key, ..)| unit.revert(key));
        }
        ui.label(RichText::new(state_text(unit, edits.len())).small().weak());
    });
    if is_integral_off(unit) {
        ui.label(RichText::new("DI does nothing while DL is 0.").color(Palette::of(ui).warning));
    }
}

fn field_ui(ui: &mut Ui, unit: &mut UnitSettings, key: &str, width: f32, step: f64) {
    let Some((row, SettingValue::Int(value))) = unit.table().row(key).zip(unit.wanted(key)) else {
        ui.label(NO_VALUE).on_hover_text("Not read yet");
        return;
    };
    let (label, help, range) = (row.label, row.help, row.range.min..=row.range.max);
    let is_edited = unit.is_edited(key);
    let mut shown = value as f64;
    let response = ui
        .scope(|ui| {
            if is_edited {
                ui.visuals_mut().override_text_color = Some(Palette::of(ui).accent);
            }
            Numeric { name: label, unit: "", range, decimals: 0, step, width }.ui(ui, &mut shown)
        })
        .inner;
    if response.on_hover_text(help).changed() {
        unit.set(key, SettingValue::Int(shown.round() as i64));
    }
}

/// The edits among the fields.
fn edits(unit: &UnitSettings) -> SettingsImage {
    let edited = |(key, ..): &(&str, &str, f32, f64)| Some(((*key).to_owned(), unit.edits().get(key)?));
    FIELDS.iter().filter_map(edited).collect()
}

fn is_integral_off(unit: &UnitSettings) -> bool {
    let number = |key: &str| {
        unit.wanted(key).and_then(|value| if let SettingValue::Int(n) = value { Some(n) } else { None })
    };
    number("loop.i").is_some_and(|gain| gain > 0) && number("loop.integral_limit") == Some(0)
}

fn state_text(unit: &UnitSettings, edits: usize) -> String {
    if unit.on_controller("loop.p").is_none() {
        return "Not read yet.".to_owned();
    }
    match edits {
        0 => "As the unit holds them: whole numbers, gains up to 255.".to_owned(),
        edits => GainsMessage::NotApplied { edits }.to_string(),
    }
}

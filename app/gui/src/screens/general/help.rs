//! The explanation of one row, below the list and always as high.

use brushwork_link::settings::{Bound, Row};
use egui::{Frame, Label, Margin, RichText, ScrollArea, Stroke, Ui};

use crate::messages::ButtonMessage;
use crate::model::{GeneralView, UnitSettings};
use crate::screens::messages::SettingMessage;
use crate::theme::Palette;
use crate::widgets::NO_VALUE;

/// Its height on a screen of `available` points: less where the settings themselves have little room.
pub fn height(available: f32) -> f32 {
    if available < 460.0 { 74.0 } else { 116.0 }
}

pub fn help_ui(ui: &mut Ui, general: &GeneralView<'_>, height: f32) {
    let palette = Palette::of(ui);
    let frame = Frame::new().stroke(Stroke::new(1.0, palette.line)).corner_radius(4.0);
    frame.inner_margin(Margin::symmetric(10, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.set_height(height - 14.0);
        ScrollArea::vertical().id_salt("help").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 3.0;
            let explained = general.explained.as_deref();
            match general.unit().and_then(|unit| Some((unit, unit.table().row(explained?)?))) {
                Some((unit, row)) => row_ui(ui, unit, row),
                None => {
                    let hint = "Point at a setting, or move the keyboard focus to it, to read what it does.";
                    ui.weak(hint);
                }
            }
        });
    });
}

pub fn row_ui(ui: &mut Ui, unit: &UnitSettings, row: &Row) {
    let palette = Palette::of(ui);
    ui.horizontal(|ui| {
        ui.strong(row.title());
        copies_ui(ui, unit, row);
    });
    if let Some(trouble) = unit.trouble(&row.key) {
        ui.add(Label::new(RichText::new(trouble.to_string()).color(palette.error)).wrap());
    }
    if let Some(reason) = unit.locked(row) {
        ui.add(Label::new(RichText::new(reason).color(palette.warning)).wrap());
    }
    ui.add(Label::new(row.help).wrap());
    ui.add(Label::new(RichText::new(figures(unit, row)).weak()).wrap());
}

/// What can be taken along as text: the value, and the row as the lines of a table have it.
pub fn copies_ui(ui: &mut Ui, unit: &UnitSettings, row: &Row) {
    let text = |value: Option<_>| value.map_or_else(|| NO_VALUE.to_owned(), |value| row.format(value));
    let wanted = text(unit.wanted(&row.key));
    let cells =
        [&row.title(), &wanted, &text(unit.on_controller(&row.key)), &row.format(row.default), &row.key];
    let line = cells.map(String::as_str).join("\t");
    for (title, copied) in [("Copy value", wanted), ("Copy row", line)] {
        if ui
            .small_button(title)
            .on_hover_text(ButtonMessage::Copies { text: copied.replace('\t', ", ") }.to_string())
            .clicked()
        {
            ui.ctx().copy_text(copied);
            ui.close();
        }
    }
}

/// Range, default, and what the value means besides its text.
fn figures(unit: &UnitSettings, row: &Row) -> String {
    let mut text = String::new();
    if row.range.bound != Bound::Unbounded {
        text += &SettingMessage::Range { range: row.range_text() }.to_string();
    }
    let assumed = if row.default_assumed { " (assumed)" } else { "" };
    text += &SettingMessage::Default { value: row.format(row.default), assumed }.to_string();
    let note = unit.wanted(&row.key).and_then(|value| unit.table().note(row, value));
    if let Some(note) = note {
        text += &SettingMessage::Number { note }.to_string();
    }
    text + &SettingMessage::Key { key: row.key.clone() }.to_string()
}

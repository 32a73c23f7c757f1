//! Settings without a controller: what stands in a profile or a backup, and the list of backups. Nothing here can be changed.

use std::collections::BTreeMap;
use std::path::PathBuf;

use brushwork_core::keep::Backup;
use brushwork_link::settings::ListedSetting;
use egui::{Button, Frame, Grid, Label, Margin, RichText, Role, ScrollArea, Ui, WidgetInfo, vec2};

use super::general::sheet_parts::{indicator_ui, text_ui};
use crate::command::{Command, Commands};
use crate::focus::{self, Region, region_ui};
use crate::model::open_files::{OpenFiles, SettingsFile};
use crate::model::{IndicatorState, Model};
use crate::screens::messages::SettingsFileMessage;
use crate::theme::Palette;
use crate::widgets::heading_ui;
use crate::widgets::text_field::text_field_ui;

const NAME_WIDTH: f32 = 320.0;
const VALUE_WIDTH: f32 = 190.0;
const ROW_HEIGHT: f32 = 20.0;
const SEARCH_WIDTH: f32 = 190.0;

/// Whether there is something to show.
pub fn has_any(files: &OpenFiles) -> bool {
    files.settings.is_some() || files.backups.is_some()
}

pub fn settings_file_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    let has_backups = model.files.backups.is_some();
    let mut close = false;
    match &mut model.files.settings {
        Some(file) => close = file_ui(ui, file, has_backups),
        None => {
            if let Some(backups) = &model.files.backups {
                backups_ui(ui, backups, &model.files.noted, commands);
            }
        }
    }
    if close {
        model.files.settings = None;
        model.front.shows_start = !has_backups;
    }
}

/// One file; true when it is to be closed.
fn file_ui(ui: &mut Ui, file: &mut SettingsFile, has_backups: bool) -> bool {
    let mut close = false;
    ui.horizontal_wrapped(|ui| {
        focus::heading_ui(ui, &file.title);
        let back = if has_backups { "All backups" } else { "Start page" };
        close = ui.button(back).clicked();
    });
    let profile = &file.profile;
    let place = if profile.unit.is_empty() {
        String::new()
    } else {
        SettingsFileMessage::At { unit: profile.unit.clone() }.to_string()
    };
    let note = if profile.note.is_empty() { String::new() } else { format!(", {}", profile.note) };
    let of = SettingsFileMessage::Of {
        model: profile.subject.model.name,
        place,
        address: profile.address,
        firmware: profile.firmware.clone(),
        generation: profile.subject.generation.to_string(),
        read: profile.date_text(),
        note,
    }
    .to_string();
    text_ui(ui, &of);
    ui.weak(file.path.display().to_string());
    for note in &file.notes {
        indicator_ui(ui, IndicatorState::Warning, note);
    }
    region_ui(ui, Region::Controls);
    let shown_count = file.shown().len();
    let all = file.rows.iter().filter(|row| row.value.is_some()).count();
    ui.horizontal_wrapped(|ui| {
        ui.allocate_ui(vec2(SEARCH_WIDTH, ui.spacing().interact_size.y), |ui| {
            text_field_ui(ui, &mut file.search, "Search settings", "Search");
        });
        let differs = SettingsFileMessage::OnlyDiffering { count: file.changed() }.to_string();
        ui.checkbox(&mut file.only_changed, differs);
        ui.weak(SettingsFileMessage::Shown { shown: shown_count, all }.to_string());
    });
    rows_ui(ui, file);
    close
}

fn rows_ui(ui: &mut Ui, file: &SettingsFile) {
    cells_ui(ui, ["Setting", "Value", "Factory"].map(|text| RichText::new(text).small().weak()));
    let palette = Palette::of(ui);
    let table = file.profile.table();
    ScrollArea::vertical().auto_shrink(false).id_salt("settings of a file").show(ui, |ui| {
        let shown = file.shown();
        if shown.is_empty() {
            ui.label("No setting of this file fits.");
        }
        let mut group = None;
        for row in shown {
            if group.replace(row.group) != Some(row.group) {
                ui.add_space(6.0);
                heading_ui(ui, row.group.label());
            }
            let response = row_ui(ui, row, palette);
            if let Some(help) = table.row(&row.key).map(|row| row.help) {
                response.on_hover_text(format!("{help}\n{}", row.key));
            }
        }
    });
}

fn row_ui(ui: &mut Ui, row: &ListedSetting, palette: &Palette) -> egui::Response {
    let differs = row.is_default == Some(false);
    let value = RichText::new(&row.text);
    let value = if differs { value.strong().color(palette.accent) } else { value };
    let cells = [RichText::new(&row.title), value, RichText::new(&row.default).weak()];
    let response = cells_ui(ui, cells);
    let rest = if differs {
        SettingsFileMessage::FactoryHas { value: row.default.clone() }.to_string()
    } else {
        ", as the factory has it".to_owned()
    };
    let spoken = format!("{}: {}{rest}", row.title, row.text);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response
}

/// Three texts in columns.
fn cells_ui(ui: &mut Ui, texts: [RichText; 3]) -> egui::Response {
    let widths = [NAME_WIDTH.min(ui.available_width() * 0.45), VALUE_WIDTH, VALUE_WIDTH];
    ui.horizontal(|ui| {
        for (text, width) in texts.into_iter().zip(widths) {
            let width = width.min(ui.available_width());
            ui.allocate_ui_with_layout(vec2(width, ROW_HEIGHT), *ui.layout(), |ui| {
                ui.set_min_width(width);
                ui.add(Label::new(text).selectable(false).truncate());
            });
        }
    })
    .response
}

fn backups_ui(ui: &mut Ui, backups: &[Backup], notes: &BTreeMap<String, String>, commands: &mut Commands) {
    ui.horizontal_wrapped(|ui| {
        focus::heading_ui(ui, "Backups");
        if ui.button("Start page").clicked() {
            commands.push(Command::ShowStart);
        }
    });
    text_ui(
        ui,
        "What this computer keeps of each controller, newest first. To restore one, connect its controller: Backups… has it there.",
    );
    region_ui(ui, Region::Controls);
    if backups.is_empty() {
        return indicator_ui(
            ui,
            IndicatorState::Unknown,
            "There is none yet. The first is made before the first write.",
        );
    }
    let mut units: Vec<String> = Vec::new();
    for unit in backups.iter().map(Backup::unit) {
        if !units.contains(&unit) {
            units.push(unit);
        }
    }
    let mut wanted: Option<PathBuf> = None;
    ScrollArea::vertical().auto_shrink(false).id_salt("backups of all units").show(ui, |ui| {
        for unit in &units {
            Frame::new().inner_margin(Margin::symmetric(0, 4)).show(ui, |ui| {
                ui.strong(unit);
                if let Some(text) = notes.get(unit).filter(|text| !text.is_empty()) {
                    text_ui(ui, text);
                }
                Grid::new(("backups of", unit)).num_columns(2).striped(true).spacing([16.0, 4.0]).show(
                    ui,
                    |ui| {
                        for backup in backups.iter().filter(|backup| backup.unit() == *unit) {
                            ui.label(backup.title());
                            let response = ui.add(Button::new("Open").small());
                            let name = SettingsFileMessage::Open { title: backup.title() }.to_string();
                            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
                            if response.clicked() {
                                wanted = Some(backup.path.clone());
                            }
                            ui.end_row();
                        }
                    },
                );
            });
        }
    });
    wanted.into_iter().for_each(|path| commands.push(Command::OpenFile(path)));
}

//! The sheets of what is kept on this computer: backups, what was cut short; and the one that copies a motor.

use brushwork_link::Message;
use brushwork_link::settings::{Aftermath, Difference, Held, Row};
use egui::{Button, Grid, Role, TextEdit, Ui, WidgetInfo};

use super::sheet_parts::{Act, Offer, differences_ui, indicator_ui, text_ui, title_ui};
use crate::model::{GeneralView, IndicatorState, Settle, Sheet, Side, UnitSettings};
use crate::screens::messages::SettingMessage;
use crate::widgets::text_field::keep_space;

/// Size of the field for notes.
const NOTE_ROWS: usize = 3;
const NOTE_WIDTH: f32 = 640.0;

pub fn backups_ui(ui: &mut Ui, general: &mut GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Backups");
    let folder =
        general.settings.backup_folder().unwrap_or_else(|| "nowhere: there is no home folder".to_owned());
    text_ui(
        ui,
        "Before every write, save, restore of defaults and firmware change the settings are kept here, newest first. \
         Restoring one makes its values changes, to be looked at and written.",
    );
    ui.weak(SettingMessage::KeptIn { folder: folder.to_string() }.to_string());
    notes_ui(ui, general);
    if general.settings.backups().is_empty() {
        indicator_ui(
            ui,
            IndicatorState::Unknown,
            "There is no backup of this controller yet. The first is made before the first write.",
        );
        return Vec::new();
    }
    let mut wanted = None;
    Grid::new("backups").num_columns(3).striped(true).spacing([16.0, 4.0]).show(ui, |ui| {
        for backup in general.settings.backups() {
            ui.label(backup.title());
            for (text, restores) in [("Compare", false), ("Restore…", true)] {
                let response = ui.add(Button::new(text).small());
                let name =
                    SettingMessage::ActOfBackup { act: text.trim_end_matches('…'), backup: backup.title() }
                        .to_string();
                response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
                if response.clicked() {
                    wanted = Some((backup.name.clone(), restores));
                }
            }
            ui.end_row();
        }
    });
    match wanted {
        Some((name, true)) if general.restore(&name) => general.open(Sheet::Write),
        Some((name, _)) => {
            general.compare_with(Side::Ram, Side::Backup(name));
            general.open(Sheet::Compare);
        }
        None => {}
    }
    Vec::new()
}

/// What people want to remember of this unit: where it is built in, what was tried.
fn notes_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    ui.add_space(4.0);
    ui.strong("Notes");
    let hint = "Where it is built in, what was tried, who has changed what. Kept beside its backups.";
    let field = TextEdit::multiline(general.settings.notes_mut()).hint_text(hint);
    let response = ui.add(field.desired_rows(NOTE_ROWS).desired_width(ui.available_width().min(NOTE_WIDTH)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Notes on this unit"));
    if response.has_focus() {
        keep_space(ui, response.id);
    }
    if response.lost_focus() {
        general.settings.keep_notes();
    }
    ui.add_space(4.0);
}

pub fn copy_motor_ui(ui: &mut Ui, general: &mut GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Copy motor");
    text_ui(ui, "Makes one motor's settings those of the other. They become changes here; Write sends them.");
    ui.horizontal(|ui| {
        let from = general.motor_to_copy();
        for (motor, text) in [(1, "Motor 1 to motor 2"), (2, "Motor 2 to motor 1")] {
            if ui.radio(from == motor, text).clicked() {
                general.copied_motor = motor;
            }
        }
    });
    let (Some(copied), Some(unit)) = (general.motor_copy(), general.unit()) else {
        indicator_ui(ui, IndicatorState::Unknown, "The settings have not been read.");
        return Vec::new();
    };
    if copied.wanted.is_empty() {
        indicator_ui(ui, IndicatorState::Ok, "The other motor has the same settings already.");
    }
    let difference = |row: &Row| {
        let right = Some(copied.wanted.get(&row.key)?);
        Some(Difference { key: row.key.clone(), left: unit.wanted(&row.key), right })
    };
    differences_ui(ui, unit, unit.table().rows().iter().filter_map(difference));
    for sentence in &copied.left_out {
        indicator_ui(ui, IndicatorState::Unknown, sentence);
    }
    vec![("Copy", Act::CopyMotor, !copied.wanted.is_empty())]
}

pub fn unfinished_ui(ui: &mut Ui, general: &GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Unfinished");
    let aftermaths = general.settings.aftermaths();
    let Some(unit) = general.unit() else { return Vec::new() };
    let damaged: Vec<Message> = general.settings.damaged_journals().collect();
    damaged.iter().for_each(|fault| indicator_ui(ui, IndicatorState::Error, fault));
    if aftermaths.is_empty() && !damaged.is_empty() {
        return vec![("Leave as it is", Act::Settle(Settle::Leave), true)];
    }
    if aftermaths.is_empty() {
        let text = if general.settings.has_unfinished() {
            "Something was cut short on this controller. Read the settings to see what became of it."
        } else {
            "Nothing that was begun on this controller was cut short."
        };
        indicator_ui(ui, IndicatorState::Unknown, text);
        return Vec::new();
    }
    // The newest decides; those before it were overtaken by it.
    for aftermath in aftermaths.iter().rev() {
        indicator_ui(ui, IndicatorState::Error, &aftermath.headline());
        lists_ui(ui, unit, aftermath);
    }
    let newest = aftermaths.last();
    let can_undo = newest.is_some_and(|aftermath| {
        aftermath
            .new
            .iter()
            .chain(&aftermath.other)
            .chain(&aftermath.disturbed)
            .any(|held| held.old.is_some())
    });
    vec![
        ("Finish with the new values", Act::Settle(Settle::Finish), true),
        ("Go back to the old values", Act::Settle(Settle::Undo), can_undo),
        ("Leave as it is", Act::Settle(Settle::Leave), true),
    ]
}

fn lists_ui(ui: &mut Ui, unit: &UnitSettings, aftermath: &Aftermath) {
    for (title, list) in aftermath.lists() {
        ui.add_space(4.0);
        ui.strong(format!("{title} ({})", list.len()));
        Grid::new((title, aftermath.begun.as_str())).num_columns(4).spacing([16.0, 3.0]).show(ui, |ui| {
            for held in list {
                held_ui(ui, unit, held);
            }
        });
    }
}

fn held_ui(ui: &mut Ui, unit: &UnitSettings, held: &Held) {
    let Some(row) = unit.table().row(&held.key) else { return };
    let text = |value: Option<_>| value.map_or_else(|| "not known".to_owned(), |value| row.format(value));
    ui.label(row.title());
    let now = ui.strong(text(held.now));
    now.widget_info(|| WidgetInfo::labeled(Role::Label, true, held.sentence(row)));
    ui.weak(SettingMessage::Old { value: text(held.old) }.to_string());
    ui.weak(SettingMessage::New { value: text(held.new.or(held.old)) }.to_string());
    ui.end_row();
}

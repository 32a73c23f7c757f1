//! The sheets of profiles: opening and saving a file, and a profile beside the controller.

use brushwork_link::settings::Difference;
use egui::{Button, Grid, RichText, Ui, vec2};

use super::sheet::{Act, Offer, lamp_ui, text_ui, title_ui};
use crate::gui::app::FRAME_INTERVAL;
use crate::gui::model::general::{Comparison, General, Purpose, Told, UnitSettings};
use crate::gui::theme::Palette;
use crate::gui::widgets::LampState;
use crate::gui::widgets::text_field::text_field_ui;

pub fn open_ui(ui: &mut Ui, general: &mut General) -> Vec<Offer> {
    title_ui(ui, "Open profile");
    text_ui(
        ui,
        "Reads a profile file and shows it beside the controller. Nothing is written; you choose what to take over.",
    );
    path_ui(ui, general, Purpose::Open);
    let can_be_mended = told_ui(ui, general.profiles.told());
    let has_path = !general.profiles.path.trim().is_empty();
    let mut acts = vec![("Open", Act::OpenProfile { mending: false }, has_path)];
    if can_be_mended {
        acts.push(("Open without what is wrong", Act::OpenProfile { mending: true }, has_path));
    }
    acts
}

pub fn save_ui(ui: &mut Ui, general: &mut General) -> Vec<Offer> {
    title_ui(ui, "Save profile");
    text_ui(
        ui,
        "Keeps the settings that were read from the controller in a file. A file of that name is replaced.",
    );
    path_ui(ui, general, Purpose::Save);
    let edits = general.unit().map_or(0, |unit| unit.edits().len());
    if edits > 0 {
        let text = format!("Include what is changed here and not written ({edits})");
        ui.checkbox(&mut general.profiles.with_edits, text);
    } else {
        general.profiles.with_edits = false;
    }
    told_ui(ui, general.profiles.told());
    let is_read = general.unit().is_some_and(UnitSettings::is_read);
    if !is_read {
        lamp_ui(ui, LampState::Warning, "The settings have not been read, so there is nothing to save yet.");
    }
    let has_path = !general.profiles.path.trim().is_empty();
    vec![("Save profile", Act::SaveProfile, is_read && has_path)]
}

/// The path, and the desktop's own dialog for it.
fn path_ui(ui: &mut Ui, general: &mut General, purpose: Purpose) {
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 110.0).clamp(120.0, 620.0);
        ui.allocate_ui(vec2(width, ui.spacing().interact_size.y), |ui| {
            let response =
                text_field_ui(ui, &mut general.profiles.path, "Profile file", "Path of a .json file");
            if response.changed() {
                general.profiles.forget_told();
            }
        });
        let is_free = !general.profiles.is_browsing();
        if ui.add_enabled(is_free, Button::new("Browse…")).clicked() {
            general.profiles.forget_told();
            general.profiles.browse(purpose);
        }
    });
    if general.profiles.is_browsing() {
        ui.request_repaint_after(FRAME_INTERVAL);
    }
}

/// What came of the last attempt; true when the file can be opened without what is wrong with it.
fn told_ui(ui: &mut Ui, told: &Told) -> bool {
    match told {
        Told::Nothing => false,
        Told::Done(sentence) => {
            lamp_ui(ui, LampState::Ok, sentence);
            false
        }
        Told::Failed { sentences, can_be_mended } => {
            for sentence in sentences {
                lamp_ui(ui, LampState::Error, sentence);
            }
            *can_be_mended
        }
    }
}

pub fn compare_ui(ui: &mut Ui, general: &mut General) -> Vec<Offer> {
    let comparison = general.comparison();
    let Some(opened) = general.profiles.opened() else { return Vec::new() };
    title_ui(ui, &format!("Profile {}", opened.name));
    let subject = &opened.profile.subject;
    text_ui(
        ui,
        &format!(
            "Made for the {}, firmware {}, address 0x{:02X}, on {}. Taking a value over makes it a change here; \
             Write sends it.",
            subject.model.name,
            subject.generation,
            opened.profile.address.get(),
            opened.profile.date
        ),
    );
    for sentence in &opened.mended {
        lamp_ui(ui, LampState::Warning, sentence);
    }
    for misfit in &comparison.misfits {
        lamp_ui(ui, LampState::Error, misfit);
    }
    if comparison.differences.is_empty() {
        lamp_ui(ui, LampState::Ok, "The controller has every value of the profile.");
    }
    let can_be_taken = comparison.misfits.is_empty();
    let taken = general.unit().and_then(|unit| table_ui(ui, unit, &comparison, can_be_taken));
    for sentence in &comparison.left_out {
        lamp_ui(ui, LampState::Unknown, sentence);
    }
    if let Some(key) = taken {
        general.take_over(Some(&key));
    }
    vec![("Take over all", Act::TakeOverAll, can_be_taken && !comparison.differences.is_empty())]
}

/// Controller and profile side by side; the key of a row that was taken over.
fn table_ui(ui: &mut Ui, unit: &UnitSettings, comparison: &Comparison, can_be_taken: bool) -> Option<String> {
    let weak = Palette::of(ui).weak_text;
    if comparison.differences.is_empty() {
        return None;
    }
    let mut taken = None;
    Grid::new("comparison").num_columns(4).spacing([16.0, 3.0]).show(ui, |ui| {
        for title in ["Setting", "On the controller", "In the profile", ""] {
            ui.label(RichText::new(title).color(weak));
        }
        ui.end_row();
        for difference in &comparison.differences {
            if comparison_row_ui(ui, unit, difference, can_be_taken) {
                taken = Some(difference.key.clone());
            }
        }
    });
    taken
}

fn comparison_row_ui(ui: &mut Ui, unit: &UnitSettings, difference: &Difference, can_be_taken: bool) -> bool {
    let Some(row) = unit.table().row(&difference.key) else { return false };
    let weak = Palette::of(ui).weak_text;
    let text = |value: Option<_>| value.map_or_else(|| "not known".to_owned(), |value| row.format(value));
    ui.label(row.title());
    ui.label(RichText::new(text(difference.left)).color(weak));
    let new = ui.label(RichText::new(text(difference.right)).strong());
    new.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, difference.describe(row)));
    let is_taken = unit.edits().get(&row.key) == difference.right;
    let clicked = if is_taken {
        ui.label(RichText::new("taken over").color(weak));
        false
    } else {
        let enabled = can_be_taken && unit.is_writable(row);
        let response = ui.add_enabled(enabled, Button::new("Take over").small());
        let name = format!("Take over {}", row.title());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, &name));
        response.clicked()
    };
    ui.end_row();
    clicked
}

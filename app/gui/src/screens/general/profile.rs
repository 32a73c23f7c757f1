//! The sheets of profiles: opening and saving a file, and a profile beside the controller.

use egui::{Button, Ui, vec2};

use super::sheet_parts::{Act, Offer, indicator_ui, text_ui, title_ui};
use crate::frame::FRAME_INTERVAL;
use crate::model::general::{Purpose, Reported};
use crate::model::{GeneralView, IndicatorState, UnitSettings};
use crate::screens::messages::{SettingMessage, SettingsFileMessage};
use crate::widgets::text_field::text_field_ui;

pub fn open_ui(ui: &mut Ui, general: &mut GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Open profile");
    text_ui(
        ui,
        "Reads a profile file and shows it beside the controller. Nothing is written; you choose what to take over.",
    );
    path_ui(ui, general, Purpose::Open);
    let can_be_corrected = told_ui(ui, &general.profiles.reported);
    let has_path = !general.profiles.path.trim().is_empty();
    let mut acts = vec![("Open", Act::OpenProfile { mending: false }, has_path)];
    if can_be_corrected {
        acts.push(("Open without what is wrong", Act::OpenProfile { mending: true }, has_path));
    }
    acts
}

pub fn save_ui(ui: &mut Ui, general: &mut GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Save profile");
    text_ui(ui, "Keeps the settings that were read from the controller in a file.");
    path_ui(ui, general, Purpose::Save);
    let edits = general.unit().map_or(0, |unit| unit.edits().len());
    if edits > 0 {
        let text = SettingMessage::WithEdits { edits }.to_string();
        ui.checkbox(&mut general.profiles.with_edits, text);
    } else {
        general.profiles.with_edits = false;
    }
    told_ui(ui, &general.profiles.reported);
    let is_read = general.unit().is_some_and(UnitSettings::is_read);
    if !is_read {
        indicator_ui(
            ui,
            IndicatorState::Warning,
            "The settings have not been read, so there is nothing to save yet.",
        );
    }
    let has_path = !general.profiles.path.trim().is_empty();
    let title = if general.profiles.is_in_the_way { "Replace the file" } else { "Save profile" };
    vec![(title, Act::SaveProfile, is_read && has_path)]
}

/// The path, and the desktop's own dialog for it.
fn path_ui(ui: &mut Ui, general: &mut GeneralView<'_>, purpose: Purpose) {
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 110.0).clamp(120.0, 620.0);
        ui.allocate_ui(vec2(width, ui.spacing().interact_size.y), |ui| {
            let response =
                text_field_ui(ui, &mut general.profiles.path, "Profile file", "Path of a .json file");
            if response.changed() {
                general.profiles.forget_reported();
            }
        });
        let is_free = !general.profiles.is_browsing();
        if ui.add_enabled(is_free, Button::new("Browse…")).clicked() {
            general.profiles.forget_reported();
            general.profiles.browse(purpose);
        }
    });
    if general.profiles.is_browsing() {
        ui.request_repaint_after(FRAME_INTERVAL);
    }
}

/// What came of the last attempt; true when the file can be opened without what is wrong with it.
fn told_ui(ui: &mut Ui, reported: &Reported) -> bool {
    match reported {
        Reported::Nothing => false,
        Reported::Done(sentence) => {
            indicator_ui(ui, IndicatorState::Ok, sentence);
            false
        }
        Reported::Failed { sentences, can_be_corrected } => {
            for sentence in sentences {
                indicator_ui(ui, IndicatorState::Error, sentence);
            }
            *can_be_corrected
        }
    }
}

/// What has to be changed of a profile before it fits; nothing is used before that is agreed to.
pub fn upgrade_ui(ui: &mut Ui, general: &GeneralView<'_>) -> Vec<Offer> {
    let Some((name, changes)) = general.profiles.pending() else { return Vec::new() };
    title_ui(ui, &SettingsFileMessage::Upgrade { name: name.to_string() }.to_string());
    text_ui(
        ui,
        "The profile was made for another controller, another firmware generation or by an older program. To fit the \
         controller here it is changed as follows; the file stays as it is, and nothing is written yet.",
    );
    for change in changes {
        indicator_ui(ui, IndicatorState::Warning, change);
    }
    vec![("Use with these changes", Act::UseUpgraded, true)]
}

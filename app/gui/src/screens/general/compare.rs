//! The sheet that sets any two copies of the settings side by side.

use brushwork_link::settings::{Difference, Group};
use egui::{Button, ComboBox, Grid, RichText, Role, Ui, WidgetInfo};

use super::sheet_parts::{Act, Offer, indicator_ui, text_ui, title_ui};
use crate::model::general::{Comparison, Side, Take};
use crate::model::{GeneralView, IndicatorState, UnitSettings};
use crate::screens::messages::{SettingMessage, SettingsFileMessage};

/// Room for the longest name of a backup.
const SIDE_WIDTH: f32 = 300.0;
/// Columns of the list, so that groups line up.
const COLUMNS: [f32; 3] = [300.0, 170.0, 170.0];

pub fn compare_ui(ui: &mut Ui, general: &mut GeneralView<'_>) -> Vec<Offer> {
    title_ui(ui, "Compare settings");
    text_ui(ui, "Taking a value over from the right side makes it a change here; Write sends it.");
    sides_ui(ui, general);
    let comparison = general.comparison();
    for missing in &comparison.missing {
        indicator_ui(ui, IndicatorState::Unknown, &missing.to_string());
    }
    for note in &comparison.notes {
        indicator_ui(ui, IndicatorState::Warning, note);
    }
    if let (Side::Profile, Some(opened)) = (&general.comparing.right, &general.profiles.opened) {
        for sentence in &opened.corrected {
            indicator_ui(ui, IndicatorState::Warning, sentence);
        }
        text_ui(
            ui,
            &SettingsFileMessage::ProfileRead { name: opened.name.clone(), date: opened.profile.date_text() }
                .to_string(),
        );
    }
    if comparison.missing.is_empty() {
        count_ui(ui, &comparison);
    }
    let taken = general.unit().and_then(|unit| groups_ui(ui, unit, &comparison));
    if let Some(take) = taken {
        general.take_over(&take);
    }
    let has_profile = general.profiles.opened.is_some();
    vec![
        ("Take over all", Act::TakeOverAll, comparison.count() > 0),
        ("Write to all units…", Act::ToAll, has_profile),
    ]
}

fn sides_ui(ui: &mut Ui, general: &mut GeneralView<'_>) {
    let (mut left, mut right) = (general.comparing.left.clone(), general.comparing.right.clone());
    ui.horizontal_wrapped(|ui| {
        side_ui(ui, general, &mut left, "Left side");
        if ui.button("Swap sides").clicked() {
            std::mem::swap(&mut left, &mut right);
        }
        side_ui(ui, general, &mut right, "Right side");
    });
    if left != general.comparing.left || right != general.comparing.right {
        general.compare_with(left, right);
    }
}

fn side_ui(ui: &mut Ui, general: &GeneralView<'_>, side: &mut Side, name: &str) {
    let combo = ComboBox::from_id_salt(name).width(SIDE_WIDTH).selected_text(general.side_title(side));
    let response = combo.show_ui(ui, |ui| {
        for each in general.sides() {
            if ui.selectable_label(each == *side, general.side_title(&each)).clicked() {
                *side = each;
            }
        }
    });
    ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label(name));
}

fn count_ui(ui: &mut Ui, comparison: &Comparison) {
    match comparison.count() {
        0 => indicator_ui(ui, IndicatorState::Ok, "Both sides have the same values."),
        1 => text_ui(ui, "1 setting differs."),
        count => text_ui(ui, &SettingMessage::Differ { count }.to_string()),
    }
}

fn groups_ui(ui: &mut Ui, unit: &UnitSettings, comparison: &Comparison) -> Option<Take> {
    let mut taken = None;
    for (group, differences) in &comparison.groups {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            ui.strong(group.label());
            let response = ui.add(Button::new("Take over group").small());
            let name = SettingMessage::TakeOverGroup { group: group.label() }.to_string();
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            if response.clicked() {
                taken = Some(Take::Group(*group));
            }
        });
        taken = group_ui(ui, unit, *group, differences).or(taken);
    }
    taken
}

fn group_ui(ui: &mut Ui, unit: &UnitSettings, group: Group, differences: &[Difference]) -> Option<Take> {
    let mut taken = None;
    Grid::new(("comparison", group.label())).num_columns(4).spacing([16.0, 3.0]).show(ui, |ui| {
        for difference in differences {
            if row_ui(ui, unit, difference) {
                taken = Some(Take::Key(difference.key.clone()));
            }
        }
    });
    taken
}

fn row_ui(ui: &mut Ui, unit: &UnitSettings, difference: &Difference) -> bool {
    let Some(row) = unit.table().row(&difference.key) else { return false };
    let text = |value: Option<_>| value.map_or_else(|| "not known".to_owned(), |value| row.format(value));
    cell_ui(ui, COLUMNS[0], RichText::new(row.title()));
    cell_ui(ui, COLUMNS[1], RichText::new(text(difference.left)).weak());
    let new = cell_ui(ui, COLUMNS[2], RichText::new(text(difference.right)).strong());
    new.widget_info(|| WidgetInfo::labeled(Role::Label, true, difference.describe(row)));
    let locked = row.locked(unit.is_simulated);
    let is_taken = unit.edits().get(&row.key).is_some() && unit.edits().get(&row.key) == difference.right;
    let clicked = if is_taken {
        ui.weak("taken over");
        false
    } else if let Some(reason) = locked {
        ui.weak("cannot be written here").on_hover_text(reason);
        false
    } else {
        let response = ui.add(Button::new("Take over").small());
        let name = SettingMessage::TakeOver { title: row.title() }.to_string();
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        response.clicked()
    };
    ui.end_row();
    clicked
}

/// A cell that is as wide in every group.
fn cell_ui(ui: &mut Ui, width: f32, text: RichText) -> egui::Response {
    let height = ui.spacing().interact_size.y.min(20.0);
    ui.scope(|ui| {
        ui.set_min_size(egui::vec2(width, height));
        ui.add(egui::Label::new(text).truncate())
    })
    .inner
}

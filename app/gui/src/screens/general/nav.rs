//! The parts of the settings at the left: the unit's own, then its pins (MCP manual 1.9.2).

use brushwork_link::settings::SettingsTable;
use egui::{Align, Button, ComboBox, Layout, Response, RichText, Role, ScrollArea, Ui, WidgetInfo};

use super::OwnSection;
use crate::model::general::{GeneralView, Section, sections};
use crate::model::settings::UnitSettings;
use crate::screens::messages::SettingMessage;
use crate::widgets::heading_ui;

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 10.0;
/// The list that unfolds.
const LIST_WIDTH: f32 = 220.0;
const LIST_HEIGHT: f32 = 400.0;

pub fn nav_ui(ui: &mut Ui, general: &mut GeneralView<'_>, own: &[OwnSection]) {
    let wanted = ScrollArea::vertical().id_salt("sections").auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(ui.available_width() - BAR_WIDTH);
        entries_ui(ui, general, own)
    });
    if let Some(section) = wanted.inner {
        general.turn_to(section);
    }
}

/// The same parts in a list that unfolds, where there is no room beside the settings.
pub fn choice_ui(ui: &mut Ui, general: &mut GeneralView<'_>, own: &[OwnSection]) {
    let Some(unit) = general.unit() else { return };
    let current = match general.section {
        _ if general.is_filtered() => "all sections".to_owned(),
        section @ (Section::Group(_)
        | Section::One(..)
        | Section::Conflicts
        | Section::ClampTest
        | Section::Recipes) => {
            let own = own.iter().map(|(section, name, _)| (*section, *name));
            let named = sections(unit.table()).into_iter().chain(own).find(|(other, _)| *other == section);
            named.map_or_else(String::new, |(_, name)| name.to_owned())
        }
    };
    ui.horizontal(|ui| {
        let label = ui.label("Section");
        let list =
            ComboBox::from_id_salt("section").selected_text(current).width(LIST_WIDTH).height(LIST_HEIGHT);
        let shown = list.show_ui(ui, |ui| entries_ui(ui, general, own));
        shown.response.labelled_by(label.id);
        if let Some(section) = shown.inner.flatten() {
            general.turn_to(section);
        }
    });
}

/// One entry per part; the one that was pressed.
fn entries_ui(ui: &mut Ui, general: &GeneralView<'_>, own: &[OwnSection]) -> Option<Section> {
    let unit = general.unit()?;
    let current = (!general.is_filtered()).then_some(general.section);
    let mut wanted = None;
    ui.spacing_mut().item_spacing.y = 1.0;
    let sections = sections(unit.table());
    for (heading, pins) in [("Unit", false), ("Pin settings", true)] {
        if sections.iter().any(|(section, _)| section.is_pin() == pins) {
            heading_ui(ui, heading);
        }
        for (section, name) in sections.iter().filter(|(section, _)| section.is_pin() == pins) {
            let function = function_of(unit, *section);
            let mark = mark_of(unit, *section, function.as_deref());
            let is_current = current == Some(*section);
            let response = section_ui(ui, name, function.as_deref(), mark, is_current);
            if is_current && general.sought.is_some() {
                response.scroll_to_me(None);
            }
            if response.clicked() {
                wanted = Some(*section);
            }
        }
        if !pins {
            for (section, name, mark) in own {
                if section_ui(ui, name, None, mark.clone(), current == Some(*section)).clicked() {
                    wanted = Some(*section);
                }
            }
        }
        ui.add_space(6.0);
    }
    wanted
}

fn section_ui(ui: &mut Ui, name: &str, function: Option<&str>, mark: String, is_current: bool) -> Response {
    let response = ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        let button = Button::selectable(is_current, name).truncate();
        ui.add(button.right_text(RichText::new(mark).small()))
    });
    let response = response.inner;
    let spoken = SettingMessage::Section { name: name.to_string() }.to_string();
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_current, &spoken));
    let Some(function) = function else { return response.on_hover_text(name) };
    let described = format!("{name}: {function}");
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(described.clone()));
    response.on_hover_text(described)
}

/// What a port, pin or output does.
fn function_of(unit: &UnitSettings, section: Section) -> Option<String> {
    match section {
        Section::One(group, number) => unit.function(group, number),
        Section::Group(_) | Section::Conflicts | Section::ClampTest | Section::Recipes => None,
    }
}

/// What stands right of a section's name: what was changed in it, or what the pin does.
fn mark_of(unit: &UnitSettings, section: Section, function: Option<&str>) -> String {
    match (edits_in(unit, section), function) {
        (0, function) => function.unwrap_or_default().to_owned(),
        (_, Some(function)) => format!("{function} *"),
        (edits, None) => SettingMessage::Changed { edits }.to_string(),
    }
}

fn edits_in(unit: &UnitSettings, section: Section) -> usize {
    let table: &SettingsTable = unit.table();
    let keys = unit.edits().iter().filter_map(|(key, _)| table.row(key));
    keys.filter(|row| Section::of(row) == section).count()
}

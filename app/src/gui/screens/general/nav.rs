//! The parts of the settings at the left: the unit's own, then its pins (MCP manual 1.9.2).

use brushwork_link::settings::SettingsTable;
use egui::{Align, Button, Layout, Response, RichText, Role, ScrollArea, Ui, WidgetInfo};

use crate::gui::model::general::{General, Section, UnitSettings, sections};
use crate::gui::shell::heading_ui;

/// Room that the scroll bar may take.
const BAR_WIDTH: f32 = 10.0;

pub fn nav_ui(ui: &mut Ui, general: &mut General) {
    let Some(unit) = general.unit() else { return };
    let current = (!general.is_filtered()).then_some(general.section);
    let seeks = general.is_seeking();
    let mut wanted = None;
    ScrollArea::vertical().id_salt("sections").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        ui.set_max_width(ui.available_width() - BAR_WIDTH);
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
                if is_current && seeks {
                    response.scroll_to_me(None);
                }
                if response.clicked() {
                    wanted = Some(*section);
                }
            }
            if !pins {
                let count = unit.conflicts().len();
                let mark = if count == 0 { "none".to_owned() } else { format!("{count} found") };
                let is_current = current == Some(Section::Conflicts);
                if section_ui(ui, "Conflicts", None, mark, is_current).clicked() {
                    wanted = Some(Section::Conflicts);
                }
                let is_current = current == Some(Section::ClampTest);
                if section_ui(ui, "Voltage clamp test", None, String::new(), is_current).clicked() {
                    wanted = Some(Section::ClampTest);
                }
            }
            ui.add_space(6.0);
        }
    });
    if let Some(section) = wanted {
        general.turn_to(section);
    }
}

fn section_ui(ui: &mut Ui, name: &str, function: Option<&str>, mark: String, is_current: bool) -> Response {
    let response = ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
        let button = Button::selectable(is_current, name).truncate();
        ui.add(button.right_text(RichText::new(mark).small()))
    });
    let response = response.inner;
    let spoken = format!("Section {name}");
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
        _ => None,
    }
}

/// What stands right of a section's name: what was changed in it, or what the pin does.
fn mark_of(unit: &UnitSettings, section: Section, function: Option<&str>) -> String {
    match (edits_in(unit, section), function) {
        (0, function) => function.unwrap_or_default().to_owned(),
        (_, Some(function)) => format!("{function} *"),
        (edits, None) => format!("{edits} changed"),
    }
}

fn edits_in(unit: &UnitSettings, section: Section) -> usize {
    let table: &SettingsTable = unit.table();
    let keys = unit.edits().iter().filter_map(|(key, _)| table.row(key));
    keys.filter(|row| Section::of(row) == section).count()
}
